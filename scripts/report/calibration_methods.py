"""The paragraph on methods that a paper needs, from what the result and the manifest say. A fact that they do not hold
costs its sentence, not the paragraph."""

import math
import tomllib

from .calibration import compared_observables, curve_groups, planed, pulled
from .page import finite, integer, interval_text, large_unit, number, pretty_unit, with_error

LAWS = {"j2": "von Mises plasticity with the Jaumann rate (J2)",
        "hencky": "hyperelastic von Mises plasticity in the logarithmic strain",
        "hill": "orthotropic elasticity with Hill's yield surface"}
OPTIMISERS = {"gauss_newton": "bounded Gauss-Newton steps in a trust region, with slopes and curvatures by "
                              "regression through all simulations (Gaussian priors)",
              "multi_fidelity": "Gauss-Newton steps on coarse simulations corrected to fine ones, the last of them on fine "
                                "simulations alone",
              "surrogate": "quadratic surrogates from many starts, then bounded Gauss-Newton steps",
              "levenberg_marquardt": "Levenberg-Marquardt steps (Ceres) with finite differences",
              "bobyqa": "BOBYQA (NLopt)", "sbplx": "Subplex (NLopt)", "crs2": "controlled random search (NLopt)",
              "mlsl": "multi-level single linkage with BOBYQA (NLopt)"}
OBSERVABLE_NAMES = {"F_c": "the cutting force", "F_t": "the transverse force", "chip_ratio": "the chip thickness",
                    "chip_curvature": "the chip's curvature"}
DAMPING = {"pic_damping": "PIC damping", "xpic_damping": "XPIC damping", "thermostat": "a thermostat"}


def methods_paragraph(calibration):
    result, manifest = calibration.result, calibration.manifest or {}
    scene, job = _toml(manifest.get("scene")), _toml(manifest.get("job"))
    sentences = [_software(manifest), *_simulation(result, scene, job), *_data(result, job), *_misfit(result, job),
                 *_search(result), *_intervals(result), *_found(result)]
    return " ".join(sentence for sentence in sentences if sentence)


def _toml(text):
    try:
        return tomllib.loads(text or "")
    except tomllib.TOMLDecodeError:
        return {}


def _software(manifest):
    version = manifest.get("version") or manifest.get("code_version")
    code = str(manifest.get("executable_sha256") or "")[:12]
    return ("Parameters were found by inverse simulation with Kerf" + (f" {version}" if version else "") +
            (f" (executable SHA-256 {code}…)" if code else "") + ".")


def _simulation(result, scene, job):
    if not scene:
        return []
    free = {p.get("path") for p in result["parameters"].values()} | {p.get("path") for p in _tables(job.get("free"))}
    tied = {tie["path"]: tie for tie in _tables(job.get("tie"))}
    yield (f"Every measured cut was simulated by an explicit material point method in plane strain, in which a cohesive "
           f"crack parts the chip from the work (scene: {scene.get('title', 'untitled')}).")
    for block in ("material", "cohesive"):
        described = [text for path, table in _laws(block, scene.get(block))
                     if (text := _law(path, table, free, tied))]
        if described:
            yield f"{'Material' if block == 'material' else 'Separation'}: {'; '.join(described)}."
    tool = {key: value for key, value in scene.get("tool", {}).items() if key != "rake"}
    parts = [f"{_words(key)} {_value(value)}" for key, value in tool.items()]
    if "friction" in scene:
        parts.append("Coulomb friction of " + ("a free coefficient" if "friction.coefficient" in free else
                                               f"{_value(scene['friction'].get('coefficient', '?'))}"))
    known = {"title", "preset", "material", "cohesive", "cut", "tool", "friction", "resolution", "window", "steady_state",
             *DAMPING}
    parts += [f"{_words(name)} ({_keys(table)})" for name, table in scene.items()
              if name not in known and isinstance(table, dict)]
    if parts:
        yield f"Tool and surroundings: {'; '.join(parts)}."
    resolution = scene.get("resolution", {})
    cut = scene.get("cut", {})
    numerics = [f"{_value(resolution['cells_through_chip'])} cells through the depth of cut"
                if "cells_through_chip" in resolution else "",
                f"cells {_value(resolution['cell_stretch'])} times as long as high" if "cell_stretch" in resolution else "",
                f"Courant number {_value(resolution['courant_number'])}" if "courant_number" in resolution else "",
                f"tool speed {_value(cut['speed'])}" if "speed" in cut else "",
                f"{_value(cut['travel'])} depths of travel" if "travel" in cut else "",
                *(f"{DAMPING[name]} ({_keys(scene[name])})" for name in DAMPING if name in scene)]
    numerics = [text for text in numerics if text]
    if not any(name in scene for name in DAMPING):
        numerics.append("no damping")
    preset = job.get("preset")
    yield "Numerics: " + ", ".join(numerics) + (f"; preset {preset}" if preset else "") + "."


def _laws(path, table):
    """(path, table) of every table with a law in a block, the block itself first."""
    if not isinstance(table, dict):
        return
    if "law" in table:
        yield path, table
    for key, inner in table.items():
        if isinstance(inner, dict):
            yield from _laws(f"{path}.{key}", inner)


def _law(path, table, free, tied):
    numbers = []
    for key, value in table.items():
        if key == "law" or isinstance(value, dict):
            continue
        full = f"{path}.{key}"
        if full in free:
            numbers.append(f"{_words(key)} free")
        elif full in tied:
            tie = tied[full]
            numbers.append(f"{_words(key)} " + (f"{tie['equals']:g} times " if tie["equals"] != 1 else
                                                "equal to ") + f"the {_words(tie['of'])}")
        else:
            numbers.append(f"{_words(key)} {_value(value)}")
    where = "" if path == "material" else f"{_mode(path)}: "
    law = LAWS.get(table["law"], f"{_words(table['law'])} law")
    return f"{where}{law} ({', '.join(numbers)})"


def _mode(path):
    return path.split(".")[-1].replace("_", " ")


def _words(path):
    """"cohesive.mode_I.toughness" as "mode I toughness"; a single key as its words."""
    parts = path.split(".")
    kept = parts[-2:] if len(parts) > 2 or parts[-1] == "coefficient" else parts[-1:]
    return " ".join(kept).replace("_", " ").replace("poisson", "Poisson")


def _value(value):
    if isinstance(value, float):
        return f"{value:g}"
    return pretty_unit(str(value))


def _keys(table):
    return ", ".join(f"{_words(key)} {_value(value)}" for key, value in table.items() if not isinstance(value, dict))


def _tables(value):
    return [entry for entry in value or [] if isinstance(entry, dict) and "path" in entry]


def _listed(texts):
    texts = list(texts)
    return texts[0] if len(texts) == 1 else ", ".join(texts[:-1]) + " and " + texts[-1]


def _span(values, unit):
    low, high = min(values), max(values)
    return f"{low:.4g} {unit}" if math.isclose(low, high) else f"{low:.4g} to {high:.4g} {unit}"


def _data(result, job):
    cuts, observables = planed(result), compared_observables(result)
    specimens = pulled(result)
    if specimens:
        points = sum(len(points) for _, points in specimens)
        yield (f"The data hold {points} points of {'an R-curve' if len(specimens) == 1 else f'{len(specimens)} R-curves'}, "
               "compared with the resistance of one simulated specimen each.")
    if not cuts or not observables:
        return
    specimens = {cut.get("specimen") for cut in cuts if cut.get("specimen")}
    curves = len(curve_groups(result))
    text = f"The data are {len(cuts)} cuts" + (f" in {curves} curves" if curves > 1 else "")
    if len(specimens) > 1:
        text += f" on {len(specimens)} specimens"
    text += f" (depth {_span([cut['depth_mm'] for cut in cuts], 'mm')}"
    rakes = [cut["rake_deg"] for cut in cuts if finite(cut.get("rake_deg"))]
    text += f", rake {_span(rakes, 'degrees')})" if rakes else ")"
    yield text + f", compared by {_listed(OBSERVABLE_NAMES[key] for key in observables)}."
    unusable = sum(not cut.get("usable", True) for cut in cuts)
    if unusable:
        yield f"{unusable} of them did not count because their simulations were refused."
    free = [f"{_words(p['path'])} ({_value(p.get('lower', '?'))} to {_value(p.get('upper', '?'))})"
            for p in _tables(job.get("free"))]
    if free:
        yield f"{len(free)} parameter{'s were' if len(free) > 1 else ' was'} free within bounds: {_listed(free)}."
    if result.get("cutting_share"):
        yield ("A force per width on the tool's edge was fitted besides; of it " +
               ("its Coulomb friction" if result["cutting_share"] == "friction" else "nothing") +
               " was taken to act in the cutting direction.")


def _misfit(result, job):
    if not finite(result.get("chi2")):
        return
    discrepancy = (job.get("discrepancy") or {}).get("relative")
    text = ("The misfit is the sum of squared residuals over their variances: of the measured means, of the simulated "
            "values")
    if discrepancy:
        text += f", and {100 * discrepancy:.3g} % for what the model itself may be off by"
    yield text + "."
    if any("specimen_error" in curve for curve in job.get("curve") or [] if isinstance(curve, dict)):
        yield "An error common to all cuts of a specimen enters as a full covariance."
    for p in job.get("free") or []:
        if isinstance(p, dict) and "prior" in p:
            yield f"Prior: {_words(p['path'])} {_value(p['prior'])} with a standard deviation of " \
                  f"{_value(p.get('prior_error', '?'))}."


def _search(result):
    method = result.get("method")
    if method:
        text = f"It was minimised by {OPTIMISERS.get(method, method)}, in {integer(result.get('runs'))} simulated cuts"
        text += f" ({integer(result.get('failed_runs') or 0)} refused"
        text += f"; {integer(result['core_s'])} core-seconds)" if finite(result.get("core_s")) else ")"
        yield text + ("." if result.get("converged", True) else f", and did not converge: {result.get('reason', '')}.")
    audit = result.get("noise_audit")
    if audit:
        yield (f"A noise audit beforehand ({integer(audit['runs'])} runs: a difference table and shifted replicates) found "
               f"simulated forces rough by {number(100 * audit['noise'], digits=2)} %; differences took steps of "
               f"{number(audit['used_step'], digits=2)} in logarithms.")


def _intervals(result):
    if not any(p.get("interval") for p in result["parameters"].values()):
        return
    quantile = (result.get("identifiability") or {}).get("interval_half_width_in_se")
    scale = result.get("error_scale")
    yield ("Standard errors follow from the weighted Jacobian; a 95 % interval holds the values at which the profile of "
           "the misfit, with all other parameters refitted on quadratics fitted to the simulations, rises by less than " +
           (number((quantile * (scale or 1)) ** 2) if finite(quantile) else "its 95 % quantile") + ".")
    if finite(scale) and scale > 1:
        yield (f"Errors are widened by {number(scale)} = √(χ²/degrees of freedom), with Student's t, because the misfit "
               f"exceeds its expectation.")
    if result.get("alternatives"):
        yield "Intervals cover both assumptions about the edge force's part in the cutting force."


def _found(result):
    values = []
    for name, p in {**result["parameters"], **(result.get("derived") or {})}.items():
        if not finite(p.get("value")):
            continue
        factor, unit = large_unit(p["unit"], [p["value"]])
        error = p.get("se")
        text = f"{name.replace('_', ' ')} " + with_error(p["value"] * factor, error * factor if finite(error) else None,
                                                        unit)
        interval = p.get("interval_over_assumptions") or p.get("interval")
        if interval:
            text += f" (95 %: {interval_text(interval, factor)}; {p.get('verdict', 'not judged')})"
        values.append(text)
    if values:
        yield "Found: " + "; ".join(values) + "."
    if finite(result.get("chi2")) and values:
        yield f"χ² = {number(result['chi2'])} on {result.get('degrees_of_freedom', '?')} degrees of freedom."
