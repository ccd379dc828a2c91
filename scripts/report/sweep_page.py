"""The page of a sweep, section by section."""

from . import sweep as drawing
from .calibration import with_labels
from .calibration_page import add_manifest
from .page import Page, chip, finite, html, integer, interval_text, number, prose, with_error


def page_of_sweep(sweep):
    result = sweep.result
    manifest = result.get("manifest") or {}
    page = Page(kicker="Kerf · a sweep of virtual experiments", title=result.get("title") or "Sweep",
                headline=[_headline(sweep)], code_version=str(manifest.get("version") or ""))
    _swept(page, sweep)
    _forces(page, sweep)
    _chip(page, sweep)
    _intercepts(page, sweep)
    _runs(page, sweep)
    _cost(page, sweep)
    add_manifest(page, manifest)
    return page


def result_of_bodies(sweep):
    return bool(sweep.result.get("bodies"))


def _headline(sweep):
    cost = sweep.result["cost"]
    swept = " and ".join(drawing.name_of(sweep.axes[k]) for k in drawing.varied(sweep))
    outcome = ("all accepted" if cost["accepted"] == cost["runs"] else
               f"{integer(cost['accepted'])} accepted, {integer(cost['refused'])} refused")
    text = f"{integer(cost['runs'])} {'runs' if result_of_bodies(sweep) else 'simulated cuts'} over {swept}: {outcome}."
    if not sweep.result["complete"]:
        text += f" {integer(cost['runs'] - cost['finished'])} are still to be simulated."
    return prose(text)


def _swept(page, sweep):
    section = page.section("What was varied")
    section.table(["key of the scene", "values"],
                  [[html("{}", " = ".join(axis["paths"])), drawing.range_text(axis)] for axis in sweep.axes])
    if len(sweep.axes) > 1:
        section.text("Values of one row belong to each other: they were changed together, pair by pair."
                     if sweep.result["zip"] else "Every value was combined with every other.")


def _forces(page, sweep):
    section = page.section("What was found" if result_of_bodies(sweep) else "Forces")
    picture = drawing.forces(sweep)
    if not picture:
        section.missing("No run found anything." if result_of_bodies(sweep) else "No run left a force.")
        return
    if result_of_bodies(sweep):
        section.figure(picture, "Open symbols are runs that were refused: their numbers are no results, and no line "
                                "passes through them.")
        return
    section.figure(picture, "Means over the steady part of each cut with ± one standard error (often smaller than the "
                            "symbol). Open symbols are runs that an acceptance test refused: their forces are no "
                            "results, and no line passes through them.")


def _chip(page, sweep):
    if result_of_bodies(sweep):
        return
    picture = drawing.chip(sweep)
    if picture:
        page.section("Chip and crack").figure(
            picture, "A crack tip behind the tool’s tip has a negative distance. The mode I share is that of the energy "
                     "spent in separation.")


def _intercepts(page, sweep):
    lines = sweep.result.get("intercepts") or []
    if not lines:
        return
    section = page.section("What an extrapolation to zero depth would have said")
    picture = drawing.extrapolations(sweep)
    if picture:
        section.figure(picture, "The cutting force fitted over the depths that were simulated (solid) and continued to "
                                "zero depth (dashed), where it is read as a toughness. Left of zero: each method’s "
                                "answer with its 95 % interval, and the toughness that was put into the scene (black). "
                                "The scatter about each fit sets its interval.")
    rows = []
    for line in lines:
        title = html("{}", drawing.held_text(sweep, line) or "all runs")
        if line.get("not_applied"):
            rows.append([title, "–", "–", "–", "–", line["not_applied"]])
            continue
        for label, value, error, interval, deviation, says in drawing.intercept_rows(line):
            found = finite(value)
            rows.append([title, label, with_error(value, error) if found else "–",
                         interval_text(interval) if found and finite(error) else "–",
                         f"{100 * deviation:+.0f} %".replace("-", "−") if finite(deviation) else "–",
                         html('<span class="why">{}</span>', prose(says))])
            title = ""
        low, high = drawing.toughness_span(line)
        rows.append(["", "in the scene", html("<b>{}</b>", number(low, digits=4) if low == high else
                                              f"{number(low, digits=4)} … {number(high, digits=4)}"), "", "", ""])
    section.table(["held", "extrapolation", "J/m²", "95 % interval", "off by", ""], rows, numeric=(2, 3, 4))
    warnings = [(f"{held}: " if (held := drawing.held_text(sweep, line)) else "") + text for line in lines
                for text in line.get("warnings", [])]
    section.warnings([prose(with_labels(text)) for text in dict.fromkeys(warnings)])


def _runs_of_bodies(section, sweep, shown):
    names = drawing.found_by_bodies(sweep)
    rows = []
    for run in sweep.runs:
        result = run.get("result") or {}
        found = result.get("results") or {}
        rows.append([integer(run["run"])]
                    + [drawing.value_text(sweep.axes[k] | {"unit": "1"}, run["values"][k]) for k in shown]
                    + [number(found.get(name), digits=5) for name in names]
                    + [number((result.get("cost") or {}).get("processor_s"), digits=3),
                       chip(run["verdict"], {"refused": "no", "not run": "bounded"}.get(run["verdict"], ""))])
    section.table(["run"] + [prose(drawing.short_with_unit(sweep.axes[k])) for k in shown]
                  + [name.replace("_", " ") for name in names] + ["core-s", "verdict"], rows,
                  numeric=range(len(shown) + len(names) + 2))
    section.warnings([html("run {}: {}", run["run"], prose("; ".join(run["refusals"])))
                      for run in sweep.runs if run["refusals"]])


def _runs(page, sweep):
    section = page.section("Every run")
    shown = drawing.varied(sweep)
    if result_of_bodies(sweep):
        _runs_of_bodies(section, sweep, shown)
        return
    heads = (["run"] + [prose(drawing.short_with_unit(sweep.axes[k])) for k in shown]
             + [prose("F_c, N/m"), prose("F_t, N/m"), prose("F_t/F_c"), "branch", "mode I", "chip ratio", prose("G/G_c"),
                "residue", "verdict"])
    rows = []
    for run in sweep.runs:
        result = run.get("result") or {}
        ledger = result.get("ledger") or {}
        work, residue = ledger.get("tool_work"), ledger.get("residue")
        rows.append([integer(run["run"])]
                    + [drawing.value_text(sweep.axes[k] | {"unit": "1"}, run["values"][k]) for k in shown]
                    + [drawing.amount_text(run, "F_c"), drawing.amount_text(run, "F_t"),
                       drawing.amount_text(run, "ratio", error=False), result.get("branch", "–"),
                       number(result.get("mode_I_fraction"), digits=2),
                       number((result.get("chip_ratio") or {}).get("value")),
                       number(result.get("fracture_energy_ratio"), digits=4),
                       f"{number(100 * residue / work, digits=2)} %" if finite(residue) and work else "–",
                       chip(run["verdict"], {"accepted": "", "not run": "bounded"}.get(run["verdict"], "no"))])
    count = len(heads)
    section.table(heads, rows, numeric=[k for k in range(count) if k not in (len(shown) + 4, count - 1)])
    section.text(html("{} is the energy booked per new area over that of the law; the residue is what the energy ledger "
                      "leaves unexplained of the tool’s work.", prose("G/G_c")))
    section.warnings([html("Run {} ({}): {}", run["run"], run["label"], prose("; ".join(run["refusals"])))
                      for run in sweep.runs if run["refusals"]])


def _cost(page, sweep):
    cost = sweep.result["cost"]
    page.section("Cost").facts([
        ("runs" if result_of_bodies(sweep) else "simulated cuts", integer(cost["finished"]), f"of {integer(cost['runs'])}"),
        ("core time", f"{number(cost['core_s'])} s", "one core per simulation"),
        ("wall time", f"{number(cost['wall_s'])} s", "over all sessions"),
    ])
