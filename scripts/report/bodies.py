"""An experiment on bodies as `kerf simulate -o NAME.json` keeps it, and its pictures."""

import json
from dataclasses import dataclass

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from .cut import Unreadable, svg
from .style import ACCENT, INK, QUIET, SAND, WARM, figure, light_grid

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
    closed_forms: dict  # columns of the history by theory, nan where it says nothing
    cost: dict
    pressed: dict


def read_bodies(file):
    try:
        kept = json.loads(file.read_text(encoding="utf-8"))
        history, closed_forms = ({key: np.array(values, dtype=float) for key, values in columns.items()}
                                 for columns in (kept["history"], kept.get("closed_forms", {})))
        return Bodies(kept["title"], kept["scene"], kept["code_version"], kept["accepted"], kept["refusals"],
                      kept["results"] or {}, history, closed_forms, kept["cost"], kept.get("pressed", {}))
    except (ValueError, KeyError, TypeError) as error:
        raise Unreadable(f"{file}: not what `kerf simulate -o` keeps of bodies ({error})") from error


def _strokes(history):
    """Indices of each stroke's readings, begun where the one before ended."""
    for stroke in np.unique(history["stroke"]).astype(int):
        part = np.flatnonzero(history["stroke"] == stroke)
        yield stroke, part if part[0] == 0 else np.r_[part[0] - 1, part]


def _draw_closed_form(axes, x, y):
    axes.plot(x, y, color=SAND, linewidth=6, solid_capstyle="round", label="closed form")


def _stretch(history):
    """Of the box and its name: in per cent where it is small."""
    stretch = history["length"] / history["length"][0]
    if np.ptp(stretch) > 0.1:
        return stretch, "length / first length"
    return 100 * (stretch - 1), "stretch, %"


def _draw_strokes(axes, bodies, x, y, closed_form=None):
    """A line per stroke in its colour, on the broad pale one that theory says."""
    if closed_form is not None:
        _draw_closed_form(axes, x[1:], closed_form[1:])
    for stroke, part in _strokes(bodies.history):
        part = part[part > 0]  # nothing has pushed before the first step
        axes.plot(x[part], y[part], color=STROKE_COLOURS[(stroke - 1) % 4], linewidth=1.6, label=f"stroke {stroke}")
    light_grid(axes)
    axes.legend(frameon=False)


def force_picture(bodies):
    """Piston force, one colour per stroke: against time where a closed form gives it, else against stretch."""
    h = bodies.history
    fig, axes = figure(860, 360)
    closed_form = bodies.closed_forms.get("force")
    x, name = _stretch(h) if closed_form is None else (h["time"] * 1e3, "time, ms")
    _draw_strokes(axes, bodies, x, h["force"], closed_form)
    axes.set(xlabel=name, ylabel="force of the piston, N/mm")
    return svg(fig, "force of the piston on the bodies")


def pressure_picture(bodies):
    """Pressure against volume of a gas; None of other bodies."""
    if "stress_xx" not in bodies.closed_forms:
        return None
    h = bodies.history
    volume = h["length"] / h["length"][0]
    fig, axes = figure(860, 360)
    _draw_strokes(axes, bodies, volume, -h["stress_xx"] / volume, -bodies.closed_forms["stress_xx"] / volume)
    axes.set(xscale="log", yscale="log", xlabel="volume / first volume", ylabel="pressure, MPa")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    return svg(fig, "pressure against volume, logarithmic")


def temperature_picture(bodies):
    """Temperature against stretch where theory has something to say of it; None elsewhere."""
    if "temperature" not in bodies.closed_forms:
        return None
    h = bodies.history
    fig, axes = figure(860, 360)
    stretch, name = _stretch(h)
    _draw_strokes(axes, bodies, stretch, h["temperature"], bodies.closed_forms["temperature"])
    axes.set(xlabel=name, ylabel="mean temperature, K")
    return svg(fig, "mean temperature against the stretch of the box")


def vibration_picture(bodies):
    """Kinetic energy of a standing wave over its last periods; None of what does not vibrate."""
    if "kinetic" not in bodies.closed_forms:
        return None
    h = bodies.history
    last = h["time"] >= h["time"][-1] - 4 / bodies.results["closed_form_frequency"]
    fig, axes = figure(860, 360)
    _draw_closed_form(axes, h["time"][last] * 1e3, bodies.closed_forms["kinetic"][last])
    axes.plot(h["time"][last] * 1e3, h["kinetic"][last], color=ACCENT, linewidth=1.6, label="simulated")
    light_grid(axes)
    axes.set(xlabel="time, ms", ylabel="kinetic energy, N mm/mm")
    axes.legend(frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1, 1))
    return svg(fig, "kinetic energy against time")


def heat_picture(bodies):
    """Temperature against entropy; None of bodies without heat."""
    h = bodies.history
    if not np.any(h["temperature"]):
        return None
    fig, axes = figure(860, 360)
    _draw_strokes(axes, bodies, h["entropy"] * 1e3, h["temperature"])
    axes.set(xlabel="entropy of the bodies, µJ/(mm K)", ylabel="mean temperature, K")
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
    lines += [("internal", "internal energy", INK), ("kinetic", "kinetic energy", SAND), ("residue", "residue", QUIET)]
    for key, label, colour in lines:
        if np.any(h[key]):
            axes.plot(h["time"] * 1e3, h[key], color=colour, linewidth=1.6, label=label)
    light_grid(axes)
    axes.set(xlabel="time, ms", ylabel="energy per width, N mm/mm")
    axes.legend(frameon=False, ncols=5, loc="lower right", bbox_to_anchor=(1, 1), fontsize=10)
    return svg(fig, "energies against time")
