"""The sections that show one simulated cut."""

from . import cut as drawing
from .page import Page, chip, finite, html, integer, number, prose, symbol, with_error


FACES = {"rake": "rake face", "bottom": "clearance side", "tip": "round tip", "lead_in": "lead-in"}


def page_of_cut(cut):
    """The page of a single file of `kerf simulate -o`."""
    result = cut.result
    specimen = "r_curve" in result
    if result["accepted"] and specimen:
        headline = [html("The specimen's crack grew by {} mm and passed every acceptance test.",
                         number(result["r_curve"]["extension"][-1]))]
    elif result["accepted"]:
        headline = [html("The cut ran steadily from {} mm of tool travel on and passed every acceptance test: "
                         "cutting force {}, transverse force {}, crack tip {} by the tool.",
                         number(result["steady_from"]), _estimate(result["F_c"]), _estimate(result["F_t"]),
                         "touched" if result["branch"] == "touching" else "not touched")]
    else:
        headline = ["The cut was not accepted; its forces below are no result."]
    page = Page(kicker="Kerf · one simulated cut", title=cut.title, headline=headline, code_version=cut.code_version)

    section = page.section("What it says")
    section.warnings([prose(reason) for reason in result["refusals"]])
    section.facts(facts_of_specimen(result) if specimen else facts_of(result))
    faces = result["faces"]
    names = [key.removesuffix("_normal") for key in faces if key.endswith("_normal")]
    if names:
        section.table(["force on a tool face, N/m", "normal", "along the face", "contact length, mm"],
                      [[FACES.get(name, name.replace("_", " "))] +
                       [_bare(faces[f"{name}_{what}"]) for what in ("normal", "tangential", "contact_length")]
                       for name in names], numeric=(1, 2, 3))
    if specimen:
        page.section("Resistance").figure(drawing.r_curve(cut), "The energy release rate twice: from pull and rotation at "
                                          "the grips, and as the area under the laws up to the openings at the notch.")
    else:
        add_force_history(page.section("Force along the cut"), cut)
    add_chip(page.section("The specimen" if specimen else "The chip"), cut)
    add_ledger(page.section("Where the energy went"), cut)

    cost = result["cost"]
    page.section("Cost").facts([
        ("wall time", f"{number(cost['wall_s'])} s", ""),
        ("time steps", integer(cost["steps"]), ""),
        ("particle-steps", f"{number(cost['particle_steps'] / 1e6)} million", ""),
        ("speed", f"{number((cost['particle_steps_per_s'] or 0) / 1e6)} million/s", "particle-steps per second"),
    ])
    page.section("Scene").source("the scene as it was read", cut.scene)
    return page


def add_force_history(section, cut):
    """The figure, or a note in its place; so do the other two."""
    if len(cut.history["travel"]) > 1:
        section.figure(drawing.force_history(cut), html(
            "Means over whole cell crossings of the tool. Shaded: the part found steady, from which the dashed mean is "
            "taken. The crack is broken {} the tool tip.", _lead(cut.result["crack_lead"])))
    else:
        section.missing("The run ended before the tool had crossed a cell.")


def add_chip(section, cut):
    specimen = "r_curve" in cut.result
    picture = (drawing.chip_picture(cut, "equivalent_stress", "equivalent stress, MPa") if specimen else
               drawing.chip_picture(cut))
    if specimen and picture:
        section.figure(picture, "Particles at the last instant, coloured by equivalent stress; the faces of the crack in "
                                "orange.")
    elif picture:
        section.figure(picture, "Particles at the last instant, coloured by equivalent plastic strain; the faces of "
                                "the crack in orange, the tool outlined (its clearance side is only sketched).")
    else:
        section.missing("The file holds no particles.")
    if picture and "temperature" in cut.particles:
        heat = cut.result["temperature"]
        section.figure(drawing.chip_picture(cut, "temperature", "temperature, K"), html(
            "Temperature: the chip has {} K in the mean, the hottest particle {} K.", number(heat["chip"], digits=4),
            number(heat["highest"], digits=4)))


def add_ledger(section, cut):
    ledger = drawing.energy_ledger(cut)
    if ledger:
        book = cut.result["ledger"]
        section.figure(ledger, html(
            "Tool work {} J per metre of width; what the entries leave unexplained is {} J/m ({} %).",
            number(book["tool_work"]), number(book["residue"]),
            number(100 * book["residue"] / book["tool_work"], digits=2)))
    else:
        section.missing("The tool has done no work.")


def facts_of(result):
    curl, ledger = result["curl_radius"], result["ledger"]
    residue = ledger["residue"] / ledger["tool_work"] if finite(ledger["residue"]) and ledger["tool_work"] else None
    return [
        ("verdict", chip("accepted") if result["accepted"] else chip("not accepted", "no"),
         f"steady from {number(result['steady_from'])} mm" if result["steady"] else "never steady"),
        (html("cutting force {}", symbol("F", "c")), _estimate(result["F_c"]), ""),
        (html("transverse force {}", symbol("F", "t")), _estimate(result["F_t"]), ""),
        ("branch", result["branch"], "does the tool touch the crack tip?"),
        ("chip ratio", _estimate(result["chip_ratio"]), "chip thickness over depth of cut"),
        ("curl radius", _estimate(curl) if finite(curl["value"]) else "straight", "positive curls away from the tool"),
        ("crack lead", f"{number(result['crack_lead'])} mm", "foremost broken pair ahead of the tip"),
        ("mode I share", _in_percent(result["mode_I_fraction"]), "of the energy of separation"),
        ("fracture energy", number(result["fracture_energy_ratio"], digits=4), "booked per new area, over the law’s"),
        ("deepest penetration", f"{number(result['deepest_penetration'])} cells", "of a crack face into the tool"),
        ("ledger’s residue", _in_percent(residue, digits=2), "of the tool’s work, unexplained"),
        ("wall time", f"{number(result['cost']['wall_s'])} s", ""),
    ]


def facts_of_specimen(result):
    kept = ("verdict", "mode I share", "ledger’s residue", "wall time")
    facts = [fact for fact in facts_of(result) if fact[0] in kept]
    curve = result["r_curve"]
    return [facts[0][:2] + ("",), ("crack extension", f"{number(curve['extension'][-1])} mm", ""),
            ("largest resistance", f"{number(max(filter(finite, curve['G_R'])))} J/m²", "read at the grips"), *facts[1:]]


def _lead(millimetres):
    if not finite(millimetres):
        return "up to"
    return f"up to {number(abs(millimetres))} mm {'ahead of' if millimetres >= 0 else 'behind'}"


def percent(share):
    return 100 * share if finite(share) else None


def _in_percent(share, **format):
    return f"{number(percent(share), **format)} %" if finite(share) else "–"


def _estimate(estimate):
    return with_error(estimate["value"], estimate["se"], estimate["unit"])


def _bare(estimate):
    return with_error(estimate["value"], estimate["se"])
