"""What a calibration left in its directory.

    result.json     parameters, cuts (measured and fitted), identifiability, alternatives, trace, cost   required
    reduction.json  the same curve by closed forms and intercepts, as `kerf reduce --json` prints it     optional
    manifest.json   versions, machine, inputs                                                            optional
    cuts/*.h5       simulated cuts at the estimate                                                       optional
"""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path

from .cut import Unreadable, read_cut
from .page import finite


@dataclass
class Calibration:
    directory: Path
    result: dict
    reduction: dict | None = None
    manifest: dict | None = None
    cuts: list = field(default_factory=list)
    notes: list = field(default_factory=list)  # what is missing or could not be read


def read_calibration(directory):
    """Raises Unreadable without a usable result.json; other gaps become notes."""
    directory = Path(directory)
    result = _json(directory / "result.json")
    if result is None:
        remedy = (f"the calibration is not finished, continue it with `kerf resume {directory}`"
                  if (directory / "journal.jsonl").exists() else "give the directory that `kerf calibrate -o` wrote")
        raise Unreadable(f"{directory / 'result.json'}: not there; {remedy}")
    if not isinstance(result.get("parameters"), dict) or not (result["parameters"] or result.get("trace")):
        raise Unreadable(f"{directory / 'result.json'}: has no parameters")
    calibration = Calibration(directory, result)
    calibration.manifest = _json(directory / "manifest.json")
    calibration.reduction = _json(directory / "reduction.json")
    for file in sorted((directory / "cuts").glob("*.h5")):
        try:
            calibration.cuts.append(read_cut(file))
        except Unreadable as error:
            calibration.notes.append(str(error))
    return calibration


def _json(file):
    try:
        value = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (ValueError, OSError) as error:
        raise Unreadable(f"{file}: cannot be read ({error})") from error
    if not isinstance(value, dict):
        raise Unreadable(f"{file}: is not a JSON object")
    return value


OBSERVABLES = ("F_c", "F_t", "chip_ratio", "chip_curvature")


def planed(result):
    """The cuts; the other entries are points of R-curves."""
    return [cut for cut in result.get("cuts", []) if "extension_mm" not in cut]


def pulled(result):
    """[(label, points by extension)]: the R-curves, one per specimen."""
    groups = {}
    for point in result.get("cuts", []):
        if "extension_mm" in point:
            groups.setdefault(point.get("curve", ""), []).append(point)
    return [(Path(file).stem.replace("_", " "), sorted(points, key=lambda point: point["extension_mm"]))
            for file, points in sorted(groups.items())]


def compared_observables(result):
    return [key for key in OBSERVABLES if any(isinstance(cut.get(key), dict) and finite(cut[key].get("measured"))
                                              for cut in planed(result))]


def curve_groups(result):
    """[(label, cuts by depth)]: the measured cuts of one curve at one rake, named by what tells them apart."""
    groups = {}
    for cut in planed(result):
        groups.setdefault((cut.get("curve", ""), round(cut.get("rake_deg") or 0, 3)), []).append(cut)
    files, rakes = {key[0] for key in groups}, {key[1] for key in groups}

    def label(file, rake):
        parts = [Path(file).stem.replace("_", " ")] if len(files) > 1 and len(rakes) < len(groups) else []
        if len(rakes) > 1 or not parts:
            parts.append(f"rake {rake:g}°")
        return ", ".join(parts)

    return [(label(*key), sorted(cuts, key=lambda cut: cut["depth_mm"])) for key, cuts in sorted(groups.items())]


def longest_run(values):
    """(first, length) of the longest run of equal signs."""
    best, begin = (0, 0), 0
    for k in range(1, len(values) + 1):
        if k == len(values) or (values[k] > 0) != (values[begin] > 0):
            best = max(best, (begin, k - begin), key=lambda run: run[1])
            begin = k
    return best


def chance_of_run(length, count):
    """Probability that `count` fair signs hold a run of `length` or more equal ones."""
    ways = [1]  # of writing n as a sum of parts below `length`: what n signs without such a run look like
    for n in range(1, count + 1):
        ways.append(sum(ways[max(0, n - length + 1):n]))
    return 1 - 2 * ways[count] / 2 ** count


def sign_runs(result):
    """The longest run of equal residual signs along the depth of every curve and observable with three points or more:
    [{"curve", "observable", "length", "count", "above", "depths": (from, to), "chance"}], least likely first."""
    runs = []
    for label, cuts in curve_groups(result):
        for key in compared_observables(result):
            pairs = [(cut["depth_mm"], cut[key]["weighted_residual"]) for cut in cuts
                     if isinstance(cut.get(key), dict) and finite(cut[key].get("weighted_residual"))]
            if len(pairs) < 3:
                continue
            first, length = longest_run([r for _, r in pairs])
            runs.append({"curve": label, "observable": key, "length": length, "count": len(pairs),
                         "above": pairs[first][1] > 0, "depths": (pairs[first][0], pairs[first + length - 1][0]),
                         "chance": chance_of_run(length, len(pairs))})
    return sorted(runs, key=lambda run: run["chance"])


ACCEPTED = ("start", "trial accepted", "better", "fine run at the coarse minimum", "best of the surrogate's minima",
            "start in the middle of the ranges", "trial")


def search_steps(result):
    """The trace as fit_figures.trace draws it: what was spent, and of every step whether the search moved there.
    Simulations that only check an interval are left out, repeats of a point without a difference too."""
    entries = [e for e in result.get("trace", []) if finite(e.get("chi2"))]
    timed = all(finite(e.get("core_s")) for e in entries)
    steps, fidelity_after = [], "fine"
    for entry in entries:
        step = entry.get("step") or "trial accepted"
        coarse = step.startswith("coarse: ")
        step = step.removeprefix("coarse: ")
        if step == "other edge assumption":
            fidelity_after, step = "other", "start"
        if step.startswith("end of the interval") or step == "noise audit":
            continue
        kind = "differences" if step == "differences" else "accepted" if step in ACCEPTED else "refused"
        steps.append({"spent": entry["core_s"] if timed else entry["runs"], "unit": "core-seconds" if timed else "simulations",
                      "chi2": entry["chi2"], "kind": kind, "fidelity": "coarse" if coarse else fidelity_after,
                      "parameters": entry.get("parameters") or {}, "step": step})
    return steps


def spending(result):
    """[(what, runs, core-seconds or None)] of a search, in the order in which it began to spend on each."""
    spent, before = {}, (0, 0.0)
    for entry in result.get("trace", []):
        step = entry.get("step") or ""
        what = ("coarse runs" if step.startswith("coarse: ") else "slopes by differences" if step == "differences" else
                "ends of intervals" if step.startswith("end of the interval") else
                step if step in ("start", "noise audit") else "trial steps")
        now = (entry.get("runs") or 0, entry.get("core_s"))
        runs, seconds = spent.get(what, (0, 0.0))
        timed = finite(now[1]) and finite(before[1]) and seconds is not None
        spent[what] = (runs + now[0] - before[0], seconds + now[1] - before[1] if timed else None)
        before = now
    return [(what, runs, seconds) for what, (runs, seconds) in spent.items() if runs > 0]


def measured_points(result):
    """[{"depth": mm, "F_c": (value, error), ...}] per measured cut, of several rakes those of the first."""
    points = []
    for cut in _first_rake(result):
        point = {"depth": cut["depth_mm"]}
        for key in OBSERVABLES:
            entry = cut.get(key)
            if isinstance(entry, dict) and finite(entry.get("measured")):
                point[key] = (entry["measured"], entry.get("se") or 0.0)
        points.append(point)
    return points


def _first_rake(result):
    cuts = planed(result)
    return [cut for cut in cuts if cut.get("rake_deg") == cuts[0].get("rake_deg")]


def simulated_curve(result):
    """The calibrated simulation through the measured depths, as a curve to draw."""
    cuts = sorted((cut for cut in _first_rake(result) if cut.get("usable", True)), key=lambda cut: cut["depth_mm"])
    curve = {"label": "simulation, calibrated", "family": "simulation", "depth": [cut["depth_mm"] for cut in cuts]}
    for key in OBSERVABLES:
        if any(isinstance(cut.get(key), dict) for cut in cuts):
            curve[key] = [(cut.get(key) or {}).get("fitted") for cut in cuts]
    return curve


METHOD_LABELS = {
    "shear_minimised": "minimised shear plane", "shear_minimised_coulomb": "…, Coulomb friction only",
    "shear_minimised_edge": "…, edge force", "shear_minimised_edge_no_drag": "…, edge without drag",
    "shear_minimised_edge_free_drag": "…, edge with free drag",
    "shear_minimised_edge_chip_ratio": "…, edge and chip ratio",
    "chip_force": "chip-force balance", "plastic_bending": "plastic bending", "atkins": "energy balance",
    "intercept_linear": "linear intercept", "intercept_quadratic": "quadratic intercept",
    "intercept_exponential": "exponential intercept", "intercept_model": "square-root-aware intercept",
}


def label_of(method):
    return METHOD_LABELS.get(method, method.replace("_", " "))


def with_labels(text):
    """A sentence about methods, with their names as the figures write them."""
    for name in sorted(METHOD_LABELS, key=len, reverse=True):
        text = re.sub(rf"\b{name}\b", METHOD_LABELS[name].replace("…", "minimised shear plane"), text)
    return text


def family_of(method):
    return "intercept" if method.startswith("intercept") else "closed form"


def method_curves(reduction):
    """Fitted curves of the simple methods; of curves at several rakes, the first rake's."""
    curves = []
    for name, method in ((reduction or {}).get("methods") or {}).items():
        drawn = (method or {}).get("curve")
        if not drawn or not drawn.get("depth_mm"):
            continue
        first = [k for k, rake in enumerate(drawn["rake_deg"]) if rake == drawn["rake_deg"][0]]
        curve = {"label": label_of(name), "family": family_of(name), "depth": [drawn["depth_mm"][k] for k in first]}
        for key in ("F_c", "F_t"):
            column = drawn.get(f"{key}_N_per_m")
            if column:
                curve[key] = [column[k] for k in first]
        curves.append(curve)
    return curves


DISBELIEVED = ("rejected", "out of range", "not converged")  # what `kerf reduce` says of a fit


def toughness_rows(calibration):
    """Toughness by every method, the simulation first, for the comparison of intercepts."""
    rows = []
    for name, parameter in calibration.result["parameters"].items():
        if parameter["unit"] != "J/m^2":
            continue
        label = "simulation" if name == "toughness" else f"simulation: {name.replace('_', ' ')}"
        row = {"label": label, "family": "simulation", "value": parameter["value"],
               "interval": parameter.get("interval"), "unit": parameter["unit"]}
        rows.append(row)
        if parameter.get("interval_over_assumptions"):
            rows.append(row | {"label": label + ", whatever the edge",
                               "interval": parameter["interval_over_assumptions"]})
    for name, method in ((calibration.reduction or {}).get("methods") or {}).items():
        parameter = ((method or {}).get("parameters") or {}).get("toughness")
        if parameter and finite(parameter.get("value")):
            rows.append({"label": label_of(name), "family": family_of(name), "value": parameter["value"],
                         "interval": parameter.get("interval"), "unit": parameter["unit"],
                         "rejected": (method.get("verdict") or {}).get("fit") in DISBELIEVED})
    return rows
