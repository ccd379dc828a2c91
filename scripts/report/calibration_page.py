"""The page of a calibration, section by section."""

import math
import re

from markupsafe import Markup

from . import fit_figures
from .calibration import (compared_observables, curve_groups, label_of, measured_points, method_curves, planed, pulled,
                          search_steps, sign_runs, simulated_curve, spending, toughness_rows, with_labels)
from .calibration_methods import methods_paragraph
from .cut_page import add_chip, add_force_history, add_ledger, facts_of
from .estimates import interval_of, name_of, plain_name, value_text
from .page import Page, chip, finite, html, integer, number, pretty_unit, prose, symbol
from .uncertainty_page import add_uncertainty


def page_of_calibration(calibration):
    result = calibration.result
    manifest = calibration.manifest or {}
    page = Page(kicker="Kerf · calibration", title=result.get("title") or "Calibration", headline=_headline(result),
                code_version=str(manifest.get("code_version") or manifest.get("version") or ""))
    _parameters(page, calibration)
    _data(page, calibration)
    _residuals(page, result)
    add_uncertainty(page, result)
    _edge(page, result)
    _intercepts(page, calibration)
    _cut(page, calibration)
    _search(page, result)
    _cost(page, calibration)
    _methods(page, calibration)
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
    section = page.section("What was measured" if result["parameters"] else "Where the search stood", "verdict",
                           "verdict")
    if result.get("partial"):
        section.warnings([html("The search was stopped before its end; this is what was known by then. "
                               "<code>kerf resume {}</code> goes on from there.", calibration.directory)])
    if not result["parameters"]:
        return _where_it_stopped(section, calibration)
    # With several assumptions on the edge only what holds under all of them may be claimed.
    either = any(p.get("interval_over_assumptions") for p in result["parameters"].values())
    key = "interval_over_assumptions" if either else "interval"
    rows = []
    for name, p in result["parameters"].items():
        rows.append([name_of(name), value_text(p), interval_of(p, key), _track(p, key), _verdict(p.get("verdict"))])
    for name, p in (result.get("derived") or {}).items():
        rows.append([name_of(name), value_text(p), interval_of(p, key), "", _verdict(p.get("verdict"))])
    heads = ["parameter", html("estimate ±<br>standard error"),
             html("95 % interval,<br>both edge assumptions") if either else "95 % interval",
             html("within the<br>search’s bounds"), "verdict"]
    section.table(heads, rows, numeric=(1, 2))
    if finite(result.get("chi2")):
        section.text(html("Misfit {} = {} on {} degrees of freedom{}.", Markup("χ²"), number(result["chi2"]),
                          result.get("degrees_of_freedom", "?"), _scale_remark(result)))
    rest = _statement(result)[1]
    if rest:
        section.text(prose(rest))
    section.warnings(calibration.notes)


def _where_it_stopped(section, calibration):
    """A search without slopes has no errors: only where it stood."""
    result = calibration.result
    steps = search_steps(result)
    point = result.get("stopped_at") or {name: {"value": value, "unit": "1"} for name, value in
                                         (min(steps, key=lambda e: e["chi2"])["parameters"] if steps else {}).items()}
    section.table(["parameter", "value"], [[name_of(name), value_text(p)] for name, p in point.items()],
                  numeric=(1,))
    if finite(result.get("chi2")):
        section.text(html("Misfit there {} = {}; without slopes nothing can be said about errors.", Markup("χ²"),
                          number(result["chi2"])))
    section.warnings(calibration.notes)


def _scale_remark(result):
    scale = result.get("error_scale")
    if finite(scale) and scale > 1.0001:
        return f"; errors are widened by {number(scale)}, the square root of the misfit per degree of freedom"
    return ""


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


def _data(page, calibration):
    result = calibration.result
    section = page.section("Data and fitted curves", "data", "data")
    groups, observables, specimens = curve_groups(result), compared_observables(result), pulled(result)
    if not observables and not specimens:
        section.missing("The result holds no measured cuts.")
        return
    known = result.get("identifiability") or {}
    scale = result.get("error_scale") or 1
    quantile = known.get("interval_half_width_in_se") or 1.96
    banded = any(finite(cut[key].get("fitted_se")) for cut in result["cuts"] for key in observables + ["G_R"]
                 if isinstance(cut.get(key), dict))
    if specimens:
        section.figure(fit_figures.data_and_bands(specimens, ["G_R"], scale, quantile, fit_figures.EXTENSION),
                       "R-curve: one simulated pull of the specimen at the estimate, read at the measured extensions of "
                       "its crack.")
    if observables:
        section.figure(fit_figures.data_and_bands(groups, observables, scale, quantile),
                       "The simulation at the estimate through the measured depths" +
                       (", the 95 % band of its curve that the uncertain parameters leave (dark), and with the scatter, "
                        "noise and stated model error of a measurement added (pale)." if banded else
                        "; it has no bands without slopes, or in a result of an older version."))
    section.warnings([html("The {} counts for nothing: {}.",
                           f"point at an extension of {number(cut['extension_mm'])} mm" if "extension_mm" in cut else
                           f"cut at depth {number(cut['depth_mm'])} mm", prose("; ".join(cut.get("refusals") or ["it could not be compared"])))
                      for cut in result["cuts"] if not cut.get("usable", True)])


def _residuals(page, result):
    groups, observables = curve_groups(result), compared_observables(result)
    observables = [key for key in observables if any(finite((cut.get(key) or {}).get("weighted_residual"))
                                                     for cut in planed(result))]
    specimens = [(label, points) for label, points in pulled(result)
                 if any(finite(point["G_R"].get("weighted_residual")) for point in points)]
    if not observables and not specimens:
        return
    section = page.section("Residuals", "residuals", "residuals")
    if specimens:
        section.figure(fit_figures.residuals(specimens, ["G_R"], fit_figures.EXTENSION),
                       "Measured minus fitted resistance, over the standard deviation of the difference.")
    if not observables:
        return
    section.figure(fit_figures.residuals(groups, observables),
                   "Measured minus fitted, over the standard deviation of the difference; 95 % of them should lie between "
                   "the dashed lines.")
    deepest = max(cut["depth_mm"] for cut in planed(result))
    section.text(_about_runs(sign_runs(result), *((1e3, "µm") if deepest < 0.5 else (1, "mm"))))


def _about_runs(runs, factor, unit):
    """The least likely run of equal signs in words, against what chance makes in any of the curves looked at."""
    if not runs:
        return "No curve has the three depths from which runs of equal signs could mean something."
    worst = runs[0]
    chance = 1 - (1 - worst["chance"]) ** len(runs)
    if worst["length"] < 3:
        return "No three neighbours in depth lie on the same side of the fit: there are no runs of equal signs."
    told = html("{} measured {} in a row lie {} the fit ({} to {} {}, {}); chance alone makes such a run in {} % of such "
                "data", worst["length"], symbol(*worst["observable"].split("_"))
                if worst["observable"] in ("F_c", "F_t") else worst["observable"].replace("_", " "),
                "above" if worst["above"] else "below", number(worst["depths"][0] * factor, digits=2),
                number(worst["depths"][1] * factor, digits=2), unit, worst["curve"], number(100 * chance, digits=2))
    if chance < 0.05:
        return told + ": the model misses a trend with depth."
    return html("No run of equal signs is longer than chance explains: at most {}.", told)


def _edge(page, result):
    alternatives = result.get("alternatives") or []
    if not alternatives:
        return
    section = page.section("With both assumptions on the edge force", "edge", "edge force")
    section.text("How much of the force on the worn edge adds to the cutting force is not measured. What the fit says "
                 "under each assumption:")
    fits = [result] + alternatives
    rows = []
    for name, fitted in result["parameters"].items():
        row = [name_of(name)]
        for fit in fits:
            p = fit.get("parameters", {}).get(name)
            row.append(html('{}<br><span class="why">{} · {}</span>', value_text(p), interval_of(p), p.get("verdict", "")) if p
                       else "–")
        row.append(interval_of(fitted, "interval_over_assumptions"))
        rows.append(row)
    rows.append([Markup("χ²")] + [html("{} <span class=\"why\">on {}</span>", number(fit.get("chi2")),
                                      fit.get("degrees_of_freedom", "?")) for fit in fits] + [""])
    section.table(["parameter"] + [prose(fit.get("assumption", "as fitted")) for fit in fits] + ["interval, either way"],
                  rows)


def _intercepts(page, calibration):
    section = page.section("Toughness, method by method", "toughness", "other methods")
    rows = toughness_rows(calibration)
    picture = fit_figures.intercept_comparison(rows)
    if not picture:
        section.missing("Neither the calibration nor a simple method estimates a toughness here.")
        return
    section.figure(picture, "Estimates with 95 % intervals; an arrow marks an interval that leaves the axis, a hollow "
                            "dot a method that its own fit rejects or whose range it leaves. A straight line "
                            "through forces overshoots: with friction the force approaches its intercept like the square "
                            "root of the depth.")
    reduction = calibration.reduction
    if reduction is None:
        section.missing("reduction.json is not there: closed forms and intercepts are left out."
                        if planed(calibration.result) else "Closed forms and intercepts want a planing curve.")
        return
    methods = reduction.get("methods") or {}
    points, curves = measured_points(calibration.result), method_curves(reduction)
    if points and curves:
        overlay = fit_figures.measured_and_fitted(points, curves + [simulated_curve(calibration.result)])
        section.fold("The fitted curves of all methods").figure(
            overlay, "Closed forms and extrapolations run on to zero depth, where they are read as a toughness" +
            ("; shown is the first of several rakes." if len(curve_groups(calibration.result)) > 1 else "."))
    fold = section.fold("What their fits say")
    fold.warnings([prose(with_labels(line)) for line in reduction.get("warnings", [])])
    verdicts = [[html('<span style="white-space:nowrap">{}</span>', label_of(name)),
                 html('<span class="why">{}</span>', prose(with_labels((method.get("verdict") or {}).get("statement", ""))))]
                for name, method in methods.items()]
    if verdicts:
        fold.table(["method", "what its fit says"], verdicts)


def _cut(page, calibration):
    if not calibration.cuts:
        return
    cut = max(calibration.cuts, key=lambda candidate: (candidate.result["accepted"], candidate.tool["depth"]))
    section = page.section("One of the cuts, as simulated at the estimate", "cut", "a cut")
    section.warnings([prose(reason) for reason in cut.result["refusals"]])
    add_chip(section, cut)
    section.text(html("Depth of cut {} mm, rake {}°; kept in cuts/{}, to be opened with ParaView through the .xdmf "
                      "beside it. The forces are those of the simulated, sharp tool, without an edge force.",
                      number(cut.tool["depth"]), number(math.degrees(cut.tool["rake"])), cut.path.name))
    fold = section.fold("Its numbers, force history and energy ledger")
    fold.facts(facts_of(cut.result))
    add_force_history(fold, cut)
    add_ledger(fold, cut)


def _search(page, result):
    steps = search_steps(result)
    if len(steps) < 2:
        return
    section = page.section("How the search went", "search", "search")
    names = [name for name in steps[-1]["parameters"] if name in result["parameters"] or not result["parameters"]]
    taken = sum(step["kind"] == "accepted" and step["step"] != "start" for step in steps)
    refused = sum(step["kind"] == "refused" for step in steps)
    section.figure(fit_figures.trace(steps, [(name, plain_name(name)) for name in names]),
                   html("{} step{} taken (filled), {} not (hollow); it ended because {}. Start: {}.", taken,
                        "" if taken == 1 else "s", refused, result.get("reason") or "nobody said why",
                        result.get("start_origin", "as the job says").replace("_", " ")))
    audit = result.get("noise_audit")
    if audit:
        section.text(html("Noise audit ({} runs): {}. Used: noise {}, step {}.", integer(audit["runs"]),
                          audit["note"], number(audit["used_noise"]), number(audit["used_step"])))


def _cost(page, calibration):
    result = calibration.result
    facts = [("simulated cuts", integer(result.get("runs")), ""),
             ("failed among them", integer(result.get("failed_runs")), ""),
             ("core time", _duration(result.get("core_s")), "of all simulations"),
             ("wall time", _duration(result.get("wall_s")), "over all sessions")]
    speeds = [cut.result["cost"]["particle_steps_per_s"] for cut in calibration.cuts]
    speeds = [speed for speed in speeds if finite(speed)]
    if speeds:
        mean = sum(speeds) / len(speeds)
        facts.append(("speed", f"{number(mean / 1e6)} million/s", "particle-steps per second and run"))
    section = page.section("Cost", "cost", "cost").facts([fact for fact in facts if fact[1] != "–"])
    spent = spending(result)
    if len(spent) > 1:
        timed = all(finite(seconds) for _, _, seconds in spent)
        section.table(["spent on", "simulated cuts"] + ["core-seconds"] * timed,
                      [[what, integer(runs)] + [integer(seconds)] * timed for what, runs, seconds in spent],
                      numeric=(1, 2))


def _methods(page, calibration):
    if calibration.manifest is None or not calibration.result["parameters"]:
        return
    section = page.section("Methods, to be pasted", "methods", "methods")
    section.paste(prose(methods_paragraph(calibration)))
    section.text("Made from result.json and manifest.json; one click selects all of it.")


def _duration(seconds):
    if not finite(seconds):
        return "–"
    return f"{number(seconds)} s" if seconds < 120 else f"{number(seconds / 60, digits=2)} min"


def add_manifest(page, manifest):
    section = page.section("Manifest")
    if not manifest:
        section.missing("manifest.json is not there.")
        return
    section = section.fold("versions, machine, inputs, scene")
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
