"""The page of a study, section by section."""

from . import study as drawing
from .calibration_page import add_manifest
from .page import Page, chip, finite, html, integer, interval_text, number, prose, with_error


def page_of_job_study(study):
    """What accuracy changes in the answer of a calibration."""
    result = study.result
    manifest = result.get("manifest") or {}
    page = Page(kicker="Kerf · what accuracy costs", title=result.get("title") or "Study",
                headline=["One calibration at every preset: what a cheaper simulation changes in its answer."],
                code_version=str(manifest.get("version") or ""))
    section = page.section("Estimates against cost")
    picture = drawing.estimates(study)
    if picture:
        section.figure(picture, "Each free parameter at each preset with its 95 % interval. A shift that is small against "
                                "the interval costs less than the measurement does.")
    rows = []
    for preset in result["presets"]:
        title = preset["preset"]
        for name, p in preset["parameters"].items():
            rows.append([title, name.replace("_", " "), with_error(p["value"], p["se"], p["unit"]),
                         interval_text(p["interval"]), number(p["error"]) if finite(p["error"]) else "–",
                         number(p["error_in_se"], digits=2) if finite(p["error_in_se"]) else "–", p["verdict"]])
            title = ""
    section.table(["preset", "parameter", "estimate", "95 % interval", "off the reference", "in standard errors", ""],
                  rows, numeric=(2, 3, 4, 5))
    page.section("Cost").table(
        ["preset", "simulated cuts", "failed", "core-seconds", "ended"],
        [[preset["preset"], integer(preset["runs"]), integer(preset["failed_runs"]), integer(preset["core_s"]),
          preset["reason"]] for preset in result["presets"]], numeric=(1, 2, 3))
    return page


def page_of_study(study):
    if study.of_job:
        return page_of_job_study(study)
    result = study.result
    manifest = result.get("manifest") or {}
    page = Page(kicker="Kerf · what accuracy costs", title=result.get("title") or "Study", headline=[_headline(study)],
                code_version=str(manifest.get("version") or ""))
    _work_precision(page, study)
    _convergence(page, study)
    _runs(page, study)
    _cost(page, study)
    add_manifest(page, manifest)
    return page


def _headline(study):
    cost = study.result["cost"]
    base = study.as_it_is
    text = (f"{integer(cost['runs'])} {'cuts' if study.looked_at is None else 'runs'}, {len(study.knobs)} knobs turned "
            "one at a time")
    error, seconds = base.get("error"), drawing.core_seconds(base)
    if error and seconds and study.looked_at is not None:
        text += (f": the scene as it is takes {number(seconds, digits=2)} core-seconds, and its "
                 f"{_looked_at(study)} by {number(error['larger']['value'], digits=2)} %")
    elif error and seconds:
        text += (f": the scene as it is takes {number(seconds, digits=2)} core-seconds, and its F_c differs from the "
                 f"reference by {with_error(error['F_c']['value'], error['F_c']['se'])} %")
    if not study.result["complete"]:
        text += f"; {integer(cost['runs'] - cost['finished'])} are still to be simulated"
    return prose(text + ".")



def _looked_at(study):
    name = study.looked_at.removesuffix("_error").replace("_", " ")
    return name + (" is off its closed form" if study.result["bodies"]["closed_form"] else " differs from the reference’s")


def _work_precision(page, study):
    section = page.section("Error against cost")
    picture = drawing.work_precision(study)
    if not picture:
        section.missing("No run can be compared with the reference" +
                        ("." if study.reference["verdict"] == "accepted" else ", which was not accepted."))
        return
    if study.looked_at is not None:
        section.figure(picture, f"By how much the {_looked_at(study)}. The pale stair is the front: no run is at once "
                                "cheaper and nearer.")
        return
    section.figure(picture, "The larger of the errors of both forces against the reference run, with ± one standard "
                            "error of both runs together. An error that is below its standard error counts as that and "
                            "is drawn open. The pale stair is the front: no run is at once cheaper and more precise.")


def _convergence(page, study):
    section = page.section("Convergence in the cell size")
    picture = drawing.convergence(study)
    if study.looked_at is not None:
        _order(section, study, picture)
        return
    if picture:
        section.figure(picture, "A power law in the cell height, F = F₀ + C hᵖ, and its limit for vanishing cells "
                                "(diamond, with its 95 % interval). Dashed and open: the order is not resolvable.")
    rows = []
    for key in ("F_c", "F_t"):
        law = study.result["convergence"][key]
        limit, order = law.get("limit"), law.get("order")
        rows.append([prose(key), with_error(limit["value"], limit["se"]) if limit else "–",
                     interval_text(limit["interval"], digits=4) if limit else "–",
                     with_error(order["value"], order["se"]) if order else "–",
                     interval_text(order["interval"]) if order else "–",
                     html('<span class="why">{}</span>', prose(law["not_resolved"] or "resolved"))])
    section.table(["force", "limit, N/m", "95 % interval", "order", "95 % interval", ""], rows, numeric=(1, 2, 3, 4))


def _order(section, study, picture):
    found = study.result["convergence"]
    if not picture:
        section.missing("Fewer than two accepted runs differ in the cell alone.")
        return
    section.figure(picture, "Runs that differ in the cell alone, and the power of the cell that passes through them.")
    between = ["–"] + [f"{order:.2f}" for order in found["orders_between"]]
    section.table(["cell, mm", "off by, %", "order from the coarser"],
                  [[number(entry["cell"], digits=4), number(entry["error"], digits=3), order]
                   for entry, order in zip(found["resolutions"], between)], numeric=range(3))


def _percent(estimate):
    if not finite(estimate.get("value")):
        return "–"
    return f"{estimate['value']:+.2f}".replace("-", "−") + (f" ± {estimate['se']:.2f}" if finite(estimate["se"]) else "")


def _turned(run):
    """The label in one line."""
    return run["label"].replace("_", " ").replace("x ", "×").replace(" ", "\u00a0")


def _runs(page, study):
    section = page.section("Every run")
    if study.looked_at is not None:
        _runs_of_bodies(section, study)
        return
    rows = []
    for run in study.runs:
        result, error = run.get("result") or {}, run.get("error")
        cost = result.get("cost") or {}
        force = result.get("F_c")
        verdict = run["verdict"] if run["role"] != "reference" or run["verdict"] != "accepted" else "reference"
        if error and error["front"]:
            verdict = "on the front"
        rows.append([_turned(run), f"{integer(force['value'])} ± {integer(force['se'])}" if force else "–",
                     _percent(error["F_c"]) if error else "–", _percent(error["F_t"]) if error else "–",
                     number(cost.get("processor_s"), digits=3),
                     f"{cost['particle_steps'] / 1e6:.0f}" if finite(cost.get("particle_steps")) else "–",
                     chip(verdict, {"refused": "no", "not run": "bounded"}.get(verdict, ""))])
    section.table(["what is turned", prose("F_c, N/m"), html("Δ{}, %", prose("F_c")),
                   html("Δ{}, %", prose("F_t")), "core-s", "10⁶ p.-steps", "verdict"], rows,
                  numeric=range(1, 6))
    section.text(html("Δ is the difference to the reference run in shares of its {}, ± one standard error of both runs "
                      "together. A particle-step is one particle moved by one time step: the same cost, whatever the "
                      "machine does.", prose("F_c")))
    section.warnings([html("{}: {}", _turned(run), prose("; ".join(run["refusals"])))
                      for run in study.runs if run["refusals"]])


def _runs_of_bodies(section, study):
    rows = []
    for run in study.runs:
        result, error = run.get("result") or {}, run.get("error")
        cost = result.get("cost") or {}
        verdict = run["verdict"] if run["role"] != "reference" or run["verdict"] != "accepted" else "reference"
        if error and error["front"]:
            verdict = "on the front"
        found = (result.get("results") or {}).get(study.looked_at)
        rows.append([_turned(run), number(found, digits=5),
                     f"{error['signed']['value']:+.3g}".replace("-", "−") if error else "–",
                     number(cost.get("processor_s"), digits=3),
                     f"{cost['particle_steps'] / 1e6:.3g}" if finite(cost.get("particle_steps")) else "–",
                     chip(verdict, {"refused": "no", "not run": "bounded"}.get(verdict, ""))])
    section.table(["what is turned", study.looked_at.replace("_", " "), "off by, %", "core-s", "10⁶ p.-steps", "verdict"],
                  rows, numeric=range(1, 5))
    section.warnings([html("{}: {}", _turned(run), prose("; ".join(run["refusals"])))
                      for run in study.runs if run["refusals"]])


def _cost(page, study):
    cost = study.result["cost"]
    page.section("Cost").facts([
        ("simulated cuts" if study.looked_at is None else "runs", integer(cost["finished"]), f"of {integer(cost['runs'])}"),
        ("core time", f"{number(cost['core_s'])} s", "processor time of the runs"),
        ("wall time", f"{number(cost['wall_s'])} s", "over all sessions"),
    ])
