"""An experiment on bodies as `kerf simulate -o NAME.json` keeps it, and its pictures."""

import json
from dataclasses import dataclass

import numpy as np

from .cut import Unreadable, svg
from .style import ACCENT, INK, QUIET, WARM, figure, light_grid

STROKE_COLOURS = [WARM, INK, ACCENT, QUIET]


@dataclass
class Bodies:
    title: str
    scene: str
    code_version: str
    accepted: bool
    refusals: list
    results: dict
    history: dict
    cost: dict
    pressed: dict


def read_bodies(file):
    try:
        kept = json.loads(file.read_text(encoding="utf-8"))
        history = {key: np.array(values, dtype=float) for key, values in kept["history"].items()}
        return Bodies(kept["title"], kept["scene"], kept["code_version"], kept["accepted"], kept["refusals"],
                      kept["results"] or {}, history, kept["cost"], kept.get("pressed", {}))
    except (ValueError, KeyError, TypeError) as error:
        raise Unreadable(f"{file}: not what `kerf simulate -o` keeps of bodies ({error})") from error


def _strokes(history):
    """Indices of each stroke's readings, begun where the one before ended."""
    for stroke in np.unique(history["stroke"]).astype(int):
        part = np.flatnonzero(history["stroke"] == stroke)
        yield stroke, part if part[0] == 0 else np.r_[part[0] - 1, part]


def force_picture(bodies):
    """Piston force against stretch, one colour per stroke."""
    h = bodies.history
    fig, axes = figure(860, 360)
    for stroke, part in _strokes(h):
        part = part[part > 0]  # nothing has pushed before the first step
        axes.plot(h["length"][part] / h["length"][0], h["force"][part],
                  color=STROKE_COLOURS[(stroke - 1) % 4], linewidth=1.8, label=f"stroke {stroke}")
    light_grid(axes)
    axes.set(xlabel="length / first length", ylabel="force of the piston, N/mm")
    axes.legend(frameon=False)
    return svg(fig, "force of the piston against the stretch of the box")


def heat_picture(bodies):
    """Temperature against entropy; None of bodies without heat."""
    h = bodies.history
    if not np.any(h["temperature"]):
        return None
    fig, axes = figure(860, 360)
    for stroke, part in _strokes(h):
        axes.plot(h["entropy"][part] * 1e3, h["temperature"][part],
                  color=STROKE_COLOURS[(stroke - 1) % 4], linewidth=1.8, label=f"stroke {stroke}")
    light_grid(axes)
    axes.set(xlabel="entropy of the bodies, µJ/(mm K)", ylabel="mean temperature, K")
    axes.legend(frameon=False)
    return svg(fig, "mean temperature against entropy")


def draw_pressed(axes, bodies):
    """Nodal contact forces, as pressure along x, with Hertz's ellipse if it was measured; False where nothing touches."""
    if not bodies.pressed:
        return False
    columns = {}
    for x, force in zip(bodies.pressed["x"], bodies.pressed["force"]):
        columns[x] = columns.get(x, 0.0) + force
    x = np.array(sorted(columns))
    if len(x) < 2:
        return False
    pressure = np.array([columns[at] for at in x]) / np.min(np.diff(x))
    axes.plot(x, pressure, "o", color=INK, markersize=4, label="nodes")
    if "closed_form_half_width" in bodies.results:
        half, peak = bodies.results["closed_form_half_width"], bodies.results["closed_form_peak_pressure"]
        along = np.linspace(0, half, 200)
        axes.plot(along, peak * np.sqrt(1 - (along / half) ** 2), color=WARM, linewidth=1.6, label="Hertz")
    light_grid(axes)
    axes.set(xlabel="x, mm", ylabel="contact force over length along x, MPa")
    axes.legend(frameon=False)
    return True


def pressed_picture(bodies):
    """None where nothing touches."""
    fig, axes = figure(860, 360)
    return svg(fig, "pressure between the bodies") if draw_pressed(axes, bodies) else None


def draw_velocity(axes, bodies):
    """Speed of the bodies' centre of mass; False of scenes without contact."""
    h = bodies.history
    if "velocity_x" not in h:
        return False
    axes.plot(h["time"] * 1e3, np.hypot(h["velocity_x"], h["velocity_y"]) / 1e3, color=INK, linewidth=1.6,
              label="simulated")
    if "closed_form_acceleration" in bodies.results:
        axes.plot(h["time"] * 1e3, abs(bodies.results["closed_form_acceleration"]) * h["time"], color=WARM,
                  linewidth=1.6, linestyle="--", label="closed form")
    light_grid(axes)
    axes.set(xlabel="time, ms", ylabel="speed of the centre of mass, m/s")
    axes.legend(frameon=False)
    return True


def velocity_picture(bodies):
    """None of scenes without contact."""
    fig, axes = figure(860, 360)
    return svg(fig, "speed of the bodies against time") if draw_velocity(axes, bodies) else None


def energy_picture(bodies):
    """The ledger against time."""
    h = bodies.history
    fig, axes = figure(860, 360)
    lines = [("piston_work", "work of the piston", WARM), ("heat", "heat taken in", ACCENT)]
    if "rigid_work" in h:
        h["pushed"] = h["rigid_work"] + h["gravity_work"]
        lines = [("pushed", "work of rigid bodies and gravity", WARM), ("friction_heat", "heat of friction", ACCENT)]
    for key, label, colour in lines + [("internal", "internal energy", INK), ("residue", "residue", QUIET)]:
        axes.plot(h["time"] * 1e3, h[key], color=colour, linewidth=1.6, label=label)
    light_grid(axes)
    axes.set(xlabel="time, ms", ylabel="energy per width, N mm/mm")
    axes.legend(frameon=False)
    return svg(fig, "energies against time")
