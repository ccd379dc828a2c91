"""The page of a calibration, section by section."""

import math
import re

from markupsafe import Markup

from . import fit_figures
from .calibration import label_of, measured_points, method_curves, simulated_curve, toughness_rows, with_labels
from .cut_page import add_cut_figures, facts_of
from .page import (Page, chip, finite, html, integer, interval_text, large_unit, number, pretty_unit, prose, symbol,
                   with_error)

SYMBOLS = {"toughness": symbol("G", "c"), "yield_stress": symbol("σ", "y"), "friction": symbol("μ"),
           "edge_force": symbol("F", "b"), "strength": symbol("σ", "c"), "adhesion_toughness": symbol("G", "a"),
           "elastic_modulus": symbol("E"), "hardening_modulus": symbol("H")}
PLAIN = {"toughness": "G_c", "yield_stress": "σ_y", "friction": "μ", "edge_force": "F_b", "strength": "σ_c"}


def page_of_calibration(calibration):
    result = calibration.result
    manifest = calibration.manifest or {}
    page = Page(kicker="Kerf · calibration", title=result.get("title") or "Calibration", headline=_headline(result),
                code_version=str(manifest.get("code_version") or manifest.get("version") or ""))
    _parameters(page, calibration)
    _fit(page, calibration)
    _intercepts(page, calibration)
    _residuals(page, calibration)
    _identifiability(page, calibration)
    _edge(page, calibration)
    _cut(page, calibration)
    _search(page, calibration)
    _cost(page, calibration)
    add_manifest(page, calibration.manifest)
    return page


LEAD_LENGTH = 330  # characters of the statement that stand at the top; the rest follows the table


def _statement(result):
    """The statement as (lead, rest), parted between sentences."""
    sentences = re.split(r"(?<=[.)])\s+(?=[A-Z(])", result.get("statement") or "")
    lead = sentences[:1]
    while len(lead) < len(sentences) and len(" ".join(lead + [sentences[len(lead)]])) <= LEAD_LENGTH:
        lead.append(sentences[len(lead)])
    return " ".join(lead), " ".join(sentences[len(lead):])


def _headline(result):
    lead, _ = _statement(result)
    if lead:
        return [prose(lead)]
    return [html("The search did not converge: {}.", result.get("reason", "no reason was given"))
            if result.get("converged") is False else "The calibration left no statement."]


def _parameters(page, calibration):
    result = calibration.result
    section = page.section("What was measured")
    # With several assumptions on the edge only what holds under all of them may be claimed.
    either = any(p.get("interval_over_assumptions") for p in result["parameters"].values())
    key = "interval_over_assumptions" if either else "interval"
    rows = []
    for name, p in result["parameters"].items():
        rows.append([_name(name), _value(p), _interval(p, key), _track(p, key), _verdict(p.get("verdict"))])
    heads = ["parameter", "estimate ± standard error",
             html("95 % interval,<br>both edge assumptions") if either else "95 % interval",
             "within the search’s bounds", "verdict"]
    section.table(heads, rows, numeric=(1, 2))
    if finite(result.get("chi2")):
        section.text(html("Misfit {} = {} on {} degrees of freedom{}.", Markup("χ²"), number(result["chi2"]),
                          result.get("degrees_of_freedom", "?"), _scale_remark(result)))
    rest = _statement(result)[1]
    if rest:
        section.text(prose(rest))
    section.warnings(calibration.notes)


def _name(name):
    return html('<span style="white-space:nowrap">{} {}</span>', name.replace("_", " "), SYMBOLS.get(name, ""))


def _scale_remark(result):
    scale = result.get("error_scale")
    if finite(scale) and scale > 1.0001:
        return f"; errors are widened by {number(scale)} because the model does not fit within the measured scatter"
    return ""


def _value(p):
    if not finite(p.get("value")):
        return "–"
    factor, unit = large_unit(p["unit"], [p["value"]])
    error = p.get("se")
    return with_error(p["value"] * factor, error * factor if finite(error) else None, unit)


def _interval(p, key="interval"):
    interval = p.get(key)
    if not interval:
        return "–"
    factor, unit = large_unit(p["unit"], [p.get("value")])
    return interval_text(interval, factor)


def _track(p, key="interval"):
    """Where the interval lies within the bounds of the search, on a logarithmic scale when they are positive."""
    bounds, interval = p.get("bounds"), p.get(key) or [None, None]
    if not bounds or not all(map(finite, bounds)) or not finite(p.get("value")) or bounds[1] <= bounds[0]:
        return ""
    scale = math.log if bounds[0] > 0 else float

    def place(value, otherwise):
        inside = min(max(value, bounds[0]), bounds[1]) if finite(value) else otherwise
        return 100 * (scale(inside) - scale(bounds[0])) / (scale(bounds[1]) - scale(bounds[0]))

    left, right = place(interval[0], bounds[0]), place(interval[1], bounds[1])
    return html('<div class="track" title="{} … {} {}"><b style="left:{}%;width:{}%"></b>'
                '<i style="left:{}%"></i></div>',
                number(bounds[0]), number(bounds[1]), pretty_unit(p["unit"]), f"{left:.1f}", f"{right - left:.1f}",
                f"{place(p['value'], bounds[0]):.1f}")


def _verdict(verdict):
    text = str(verdict or "–")
    kind = "" if text.startswith("measured") else "bounded" if text.startswith("bounded") else "no"
    return chip(text, kind)


def _fit(page, calibration):
    section = page.section("Measured points and fitted curves")
    points = measured_points(calibration.result)
    curves = method_curves(calibration.reduction) + ([simulated_curve(calibration.result)] if points else [])
    picture = fit_figures.measured_and_fitted(points, curves) if points else None
    if not picture:
        section.missing("The result holds no measured cuts.")
        return
    section.figure(picture, "Squares are measurements with their standard error. The simulation is drawn through the "
                            "depths that were simulated; closed forms and extrapolations run on to zero depth, where "
                            "they are read as a toughness.")
    section.warnings([html("The cut at depth {} mm counts for nothing: {}.", number(cut["depth_mm"]),
                           prose("; ".join(cut.get("refusals") or ["it could not be compared"])))
                      for cut in calibration.result["cuts"] if not cut.get("usable", True)])
    if calibration.reduction is None:
        section.missing("reduction.json is not there: closed forms and intercepts are left out.")


def _intercepts(page, calibration):
    section = page.section("Toughness, method by method")
    rows = toughness_rows(calibration)
    picture = fit_figures.intercept_comparison(rows)
    if not picture:
        section.missing("Neither the calibration nor a simple method estimates a toughness here.")
        return
    section.figure(picture, "Estimates with 95 % intervals; an arrow marks an interval that leaves the axis, a hollow "
                            "dot a method that its own fit rejects or whose range it leaves. A straight line "
                            "through forces overshoots: with friction the force approaches its intercept like the square "
                            "root of the depth.")
    reduction = calibration.reduction or {}
    section.warnings([prose(with_labels(line)) for line in reduction.get("warnings", [])])
    methods = reduction.get("methods") or {}
    statements = {name: (method.get("verdict") or {}).get("statement", "") for name, method in methods.items()}
    verdicts = [[html('<span style="white-space:nowrap">{}</span>', label_of(name)),
                 html('<span class="why">{}</span>', prose(with_labels(statement)))]
                for name, statement in statements.items()]
    if verdicts:
        section.table(["method", "what its fit says"], verdicts)


def _residuals(page, calibration):
    section = page.section("Residuals")
    points = measured_points(calibration.result)
    picture = fit_figures.residuals(points) if points else None
    if picture:
        section.figure(picture, "Measured minus fitted, over the standard deviation of the difference; the band holds "
                                "95 % of what scatter alone would give.")
    else:
        section.missing("The result holds no residuals.")


def _identifiability(page, calibration):
    section = page.section("What these cuts can tell apart")
    seen = calibration.result.get("identifiability") or {}
    values = seen.get("singular_values")
    if not values:
        section.missing("No slopes were computed, so nothing is known about identifiability.")
        return
    names = [PLAIN.get(name, name) for name in seen["names"]]
    section.figure(fit_figures.identifiability(names, values, seen["singular_vectors"], seen.get("correlation")),
                   "Directions of (logarithmic) parameter space, best known first. The inverse of a singular value is "
                   "the relative error along its direction: below 2 (orange) the data do not determine it.")
    weakest = len(values) - 1
    if finite(values[weakest]) and values[weakest] > 0:
        shares = sorted(zip(seen["names"], seen["singular_vectors"][weakest]), key=lambda pair: -abs(pair[1]))
        makers = [SYMBOLS.get(name, name) for name, share in shares if abs(share) > 0.3][:2]
        section.text(html("Least known is the direction of {}: a relative error of {} %.",
                          html(" with ").join(makers), number(100 / values[weakest], digits=2)))


def _edge(page, calibration):
    result = calibration.result
    alternatives = result.get("alternatives") or []
    if not alternatives:
        return
    section = page.section("With both assumptions on the edge force")
    section.text("How much of the force on the worn edge adds to the cutting force is not measured. What the fit says "
                 "under each assumption:")
    fits = [result] + alternatives
    rows = []
    for name, fitted in result["parameters"].items():
        row = [_name(name)]
        for fit in fits:
            p = fit.get("parameters", {}).get(name)
            row.append(html('{}<br><span class="why">{} · {}</span>', _value(p), _interval(p), p.get("verdict", "")) if p
                       else "–")
        row.append(_interval(fitted, "interval_over_assumptions"))
        rows.append(row)
    rows.append([Markup("χ²")] + [html("{} <span class=\"why\">on {}</span>", number(fit.get("chi2")),
                                      fit.get("degrees_of_freedom", "?")) for fit in fits] + [""])
    section.table(["parameter"] + [prose(fit.get("assumption", "as fitted")) for fit in fits] + ["interval, either way"],
                  rows)


def _cut(page, calibration):
    if not calibration.cuts:
        page.section("One of the cuts").missing("No simulated cut was kept in cuts/.")
        return
    cut = max(calibration.cuts, key=lambda candidate: (candidate.result["accepted"], candidate.tool["depth"]))
    section = page.section("One of the cuts, as simulated at the estimate")
    section.text(html("Depth of cut {} mm, rake {}°; kept in cuts/{}, to be opened with ParaView through the .xdmf "
                      "beside it. The forces are those of the simulated, sharp tool, without an edge force.",
                      number(cut.tool["depth"]), number(math.degrees(cut.tool["rake"])), cut.path.name))
    section.warnings([prose(reason) for reason in cut.result["refusals"]])
    section.facts(facts_of(cut.result))
    add_cut_figures(page, cut)


def _search(page, calibration):
    section = page.section("How the search went")
    entries = [e for e in calibration.result.get("trace", []) if finite(e.get("chi2"))]
    if len(entries) < 2:
        section.missing("The search left no trace of several steps.")
        return
    names = [name for name in calibration.result["parameters"] if name in entries[0].get("parameters", {})]
    for entry in entries:
        entry["parameters"] = {PLAIN.get(name, name): value for name, value in entry["parameters"].items()}
    section.figure(fit_figures.trace(entries, [PLAIN.get(name, name) for name in names]),
                   html("{} steps. Start: {}.", len(entries), calibration.result.get("start_origin", "as the job says")))
    audit = calibration.result.get("noise_audit")
    if audit:
        section.text(html("Noise audit ({} runs): {}. Used: noise {}, step {}.", integer(audit["runs"]),
                          audit["note"], number(audit["used_noise"]), number(audit["used_step"])))


def _cost(page, calibration):
    result = calibration.result
    facts = [("simulated cuts", integer(result.get("runs")), ""),
             ("failed among them", integer(result.get("failed_runs")), ""),
             ("wall time", _duration(result.get("wall_s")), "")]
    speeds = [cut.result["cost"]["particle_steps_per_s"] for cut in calibration.cuts]
    speeds = [speed for speed in speeds if finite(speed)]
    if speeds:
        mean = sum(speeds) / len(speeds)
        facts.append(("speed", f"{number(mean / 1e6)} million/s", "particle-steps per second and run"))
    page.section("Cost").facts([fact for fact in facts if fact[1] != "–"])


def _duration(seconds):
    if not finite(seconds):
        return "–"
    return f"{number(seconds)} s" if seconds < 120 else f"{number(seconds / 60, digits=2)} min"


def add_manifest(page, manifest):
    section = page.section("Manifest")
    if not manifest:
        section.missing("manifest.json is not there.")
        return
    rows = []

    def flatten(value, path):
        if isinstance(value, dict):
            for key, inner in value.items():
                flatten(inner, f"{path} › {key}" if path else key)
        elif isinstance(value, list) and all(not isinstance(v, (dict, list)) for v in value):
            rows.append([path, ", ".join(map(str, value))])
        elif isinstance(value, list):
            for place, inner in enumerate(value):
                name = inner.get("name") if isinstance(inner, dict) else None
                flatten(inner, f"{path} › {name or place + 1}")
        elif isinstance(value, str) and "\n" in value:
            long_texts.append((path, value))
        else:
            rows.append([path, html('<span style="overflow-wrap:anywhere">{}</span>', str(value))])

    long_texts = []
    flatten(manifest, "")
    section.table(["", ""], rows)
    for name, text in long_texts:
        section.source(name, text)
