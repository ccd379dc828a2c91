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
    if not isinstance(result.get("parameters"), dict) or not result["parameters"]:
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


def measured_points(result):
    """[{"depth": mm, "curve", "F_c": (value, error), ..., "weighted": {"F_c": residual / its sd}}] per measured cut."""
    points = []
    for cut in result.get("cuts", []):
        point = {"depth": cut["depth_mm"], "rake": cut.get("rake_deg"), "curve": cut.get("curve", ""), "weighted": {}}
        for key in OBSERVABLES:
            entry = cut.get(key)
            if isinstance(entry, dict) and finite(entry.get("measured")):
                point[key] = (entry["measured"], entry.get("se") or 0.0)
                point["weighted"][key] = entry.get("weighted_residual")
        points.append(point)
    return points


def simulated_curve(result):
    """The calibrated simulation through the measured depths, as a curve to draw."""
    cuts = sorted((cut for cut in result.get("cuts", []) if cut.get("usable", True)), key=lambda cut: cut["depth_mm"])
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
