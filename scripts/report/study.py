"""What a study left in its directory (study.json), and the figures drawn from it."""

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

from .cut import Unreadable
from .page import finite, large_unit, pretty_unit
from .style import ACCENT, INK, QUIET, SAND, WARM, figure, light_grid, svg

NAMES = {"resolution.cells_through_chip": "cells through the chip", "cut.speed": "speed of the tool",
         "resolution.courant_number": "time step (CFL)", "pic_damping.rate": "PIC damping", "window.ahead": "window",
         "resolution.cell_stretch": "cell stretch", "resolution.particles_per_cell_side": "particles per cell side",
         "steady_state.tolerance": "tolerance of F_c", "steady_state.not_before": "least travel",
         "resolution.single_particle_below": "one particle a cell below",
         "preset": "preset", "box.cell": "cell", "box.particles_per_cell_side": "particles per cell side",
         "box.courant_number": "time step (CFL)", "numerics.shape": "shape functions", "numerics.transfer": "transfer",
         "numerics.stress_update": "stress update"}
COLOURS = [ACCENT, WARM, "#4a78b5", "#8a5a83", "#7d8b2f", "#c2922e", "#7fb3b3", "#e0a884", "#8d9aa0", "#3c4f76"]
PRESET = "preset"


@dataclass
class Study:
    directory: Path
    result: dict

    @property
    def of_job(self):
        return "presets" in self.result

    @property
    def looked_at(self):
        """Of bodies: the number that is looked at; None of cuts."""
        return (self.result.get("bodies") or {}).get("result")

    @property
    def knobs(self):
        return self.result["knobs"]

    @property
    def runs(self):
        return self.result["runs"]

    def of_knob(self, knob):
        return [run for run in self.runs if run["knob"] == knob]

    @property
    def as_it_is(self):
        return next(run for run in self.runs if run["role"] == "as it is")

    @property
    def reference(self):
        return next(run for run in self.runs if run["role"] == "reference")


def read_study(directory):
    """Raises Unreadable without a usable study.json."""
    file = Path(directory) / "study.json"
    try:
        result = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Unreadable(f"{file}: not there; the study is not finished, continue it with "
                         f"`kerf resume {directory}`") from None
    except (ValueError, OSError) as error:
        raise Unreadable(f"{file}: cannot be read ({error})") from error
    if not isinstance(result, dict) or {"study": "runs", "job study": "presets"}.get(result.get("kind")) not in result:
        raise Unreadable(f"{file}: is not the result of a study")
    return Study(Path(directory), result)


def name_of(knob):
    if len(knob["paths"]) > 1:
        return knob["name"].replace("_", " ")
    return NAMES.get(knob["paths"][0], knob["name"].replace("_", " "))


def core_seconds(run):
    value = ((run.get("result") or {}).get("cost") or {}).get("processor_s")
    return value if finite(value) and value > 0 else None


def _error(run):
    """(what is drawn, lower end, upper end, told from the reference or not) in per cent."""
    error = run.get("error")
    if not error or not finite(error["larger"].get("value")):
        return None
    value, spread = error["larger"]["value"], error["larger"]["se"]
    return value, max(value - spread, 0.3 * value), value + spread, error["resolved"]


def work_precision(study):
    if not any(_error(run) and core_seconds(run) for run in study.runs):
        return None
    fig, ax = figure(860, 520)
    draw_work_precision(ax, study)
    ax.set_ylabel("error of the force, % of F_c" if study.looked_at is None else
                  f"{study.looked_at.removesuffix('_error').replace('_', ' ')}: off by, %")
    ax.legend(handles=legend_of([study]), loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0)
    return svg(fig, "error against core-seconds for every value of every knob")


def draw_work_precision(ax, study):
    """One colour per knob, its values joined through the scene as it is; the front is the pale stair."""
    light_grid(ax)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.margins(x=0.1)
    ax.set_xlabel("core-seconds")
    _draw_front(ax, study)
    base = study.as_it_is
    for knob, what in enumerate(study.knobs):
        colour, preset = colour_of(study, knob), what["paths"] == [PRESET]
        runs = study.of_knob(knob)
        numbered = [run for run in runs + [base] if finite(run["number"]) or run is base]
        places = [(run["number"] if run is not base else None, core_seconds(run), _error(run)) for run in numbered]
        places = [(cost, error[0]) for _, cost, error in places if cost and error]
        if not preset and len(places) > 1:
            ax.plot(*np.array(sorted(places)).T, color=colour, linewidth=1, alpha=0.55, zorder=2)
        for run in runs:
            _draw_run(ax, run, colour, "D" if preset else "o")
            _label(ax, run, run["value"].replace("x ", "×"), colour, below=preset,
                   turned=not finite(run["number"]) and not preset)
    if study.looked_at is not None:
        _draw_run(ax, study.reference, INK, "D")  # held against a closed form, it is a run like others
    if cost := core_seconds(study.reference):
        ax.axvline(cost, color=QUIET, linewidth=0.9, linestyle=(0, (2, 2)), zorder=1)
        ax.annotate("reference run", (cost, 0), xycoords=("data", "axes fraction"), xytext=(-4, 6), rotation=90,
                    textcoords="offset points", ha="right", fontsize=9, color=QUIET)
    _draw_run(ax, base, INK, "s")
    _label(ax, base, "as it is", INK, below=study.looked_at is not None)
    number = FuncFormatter(lambda value, _: f"{value:g}")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(number)
        axis.set_minor_formatter(NullFormatter())
    for axis, low, high in ((ax.xaxis, *ax.get_xlim()), (ax.yaxis, *ax.get_ylim())):
        if high / low < 100:  # at most two powers of ten on the axis
            axis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}" if f"{value:e}"[0] in "25" else ""))
    ax.tick_params(which="minor", labelsize=11.5, length=0, labelcolor=QUIET)


def colour_of(study, knob):
    """The usual knobs have the same colour in every study."""
    path, usual = study.knobs[knob]["paths"][0], list(NAMES)
    place = usual.index(path) if path in usual else len(usual) + knob
    return INK if path == PRESET else COLOURS[place % len(COLOURS)]


def _draw_run(ax, run, colour, marker):
    cost, error = core_seconds(run), _error(run)
    if not cost or not error:
        if cost and run["verdict"] == "refused":
            ax.plot([cost], [0], "x", color=colour, markersize=7, clip_on=False, transform=ax.get_xaxis_transform(),
                    zorder=4)
        return
    value, low, high, resolved = error
    ax.errorbar([cost], [value], yerr=[[value - low if resolved else 0], [high - value]], fmt=marker, color=colour,
                markersize=8 if marker != "o" else 6, markerfacecolor=colour if resolved else "white",
                markeredgewidth=1.4, elinewidth=0.9, capsize=0, alpha=1, zorder=5 if marker != "o" else 3)


def _label(ax, run, text, colour, below=False, turned=False):
    """Above to the right, words turned out of each other's way; presets, in bold, below to the left."""
    cost, error = core_seconds(run), _error(run)
    if cost and error:
        ax.annotate(text, (cost, error[0]), xytext=(-5, -15) if below else (6, 4), textcoords="offset points",
                    ha="right" if below else "left", color=colour, fontsize=10.5 if below else 9.5,
                    fontweight="bold" if below else "normal", zorder=6, rotation=50 if turned else 0,
                    rotation_mode="anchor",
                    path_effects=[withStroke(linewidth=2.5, foreground="white", alpha=0.8)])


def _draw_front(ax, study):
    front = sorted((core_seconds(run), run["error"]["larger"]["value"]) for run in study.runs
                   if run.get("error") and run["error"]["front"] and core_seconds(run))
    if len(front) > 1:
        ax.plot(*np.array(front).T, color=SAND, linewidth=7, alpha=0.45, drawstyle="steps-post",
                solid_capstyle="round", zorder=1)


def legend_of(studies):
    """All knobs of these studies, each once."""
    handles = {}
    refused = False
    for study in studies:
        refused = refused or any(run["verdict"] == "refused" and core_seconds(run) for run in study.runs)
        for knob, what in enumerate(study.knobs):
            marker = "D" if what["paths"] == [PRESET] else "o"
            handles.setdefault(name_of(what), Line2D([], [], color=colour_of(study, knob), marker=marker, linewidth=1,
                                                     linestyle="none" if marker == "D" else "-", markersize=6,
                                                     label=name_of(what)))
    rest = [Line2D([], [], color=INK, marker="s", linestyle="none", markersize=7, label="the scene as it is"),
            Line2D([], [], color=SAND, alpha=0.6, linewidth=6, label="front"),
            Line2D([], [], color=QUIET, marker="o", markerfacecolor="white", linestyle="none", markersize=6,
                   markeredgewidth=1.4, label="error below its noise")]
    if refused:
        rest.append(Line2D([], [], color=QUIET, marker="x", linestyle="none", markersize=7, label="refused"))
    return list(handles.values()) + rest


def convergence(study):
    """Force against cell size, the fitted power law and its limit for vanishing cells."""
    if study.looked_at is not None:
        return _error_against_cell(study)
    found = study.result["convergence"]
    if len(found["resolutions"]) < 2:
        return None
    runs = {run["run"]: run for run in study.runs}
    fig, grid = figure(860, 330, 1, 2)
    length = 1e3 if max(entry["cell"] for entry in found["resolutions"]) < 0.5 else 1
    for ax, key, title in zip(grid, ("F_c", "F_t"), ("cutting force F_c", "transverse force F_t")):
        light_grid(ax)
        cells = np.array([entry["cell"] for entry in found["resolutions"]]) * length
        forces = [runs[entry["run"]]["result"][key] for entry in found["resolutions"]]
        factor, unit = large_unit("N/m", [force["value"] for force in forces])
        ax.errorbar(cells, [force["value"] * factor for force in forces],
                    yerr=[(force["se"] or 0) * factor for force in forces], fmt="o", color=ACCENT, markersize=6.5,
                    capsize=3, elinewidth=1.2, zorder=3)
        law = found[key]
        if "limit" in law and finite(law["limit"]["value"]):
            value = law["limit"]["value"] * factor
            low, high = (end * factor if finite(end) else value for end in law["limit"]["interval"])
            ax.errorbar([0], [value], yerr=[[value - low], [high - value]], fmt="D", color=WARM, markersize=7, capsize=4,
                        markerfacecolor=WARM if law["resolved"] else "white", zorder=4)
            x = np.linspace(0, cells.max(), 80)
            rise = law["amplitude"]["value"] * factor * (x / cells.max())**law["order"]["value"] if "order" in law else 0 * x
            ax.plot(x, value + rise, color=WARM, linewidth=1.2, linestyle="-" if law["resolved"] else "--", zorder=2)
        ax.set_xlim(-0.03 * cells.max(), 1.06 * cells.max())
        ax.set_xlabel("height of a cell, " + ("µm" if length > 1 else "mm"))
        ax.set_title(f"{title}, {pretty_unit(unit)}")
        # What an unresolved limit allows must not squeeze the forces.
        values = [force["value"] * factor for force in forces] + ([value] if law["resolved"] else [])
        reach = max(0.6 * (max(values) - min(values)), 3 * factor * max(force["se"] or 0 for force in forces))
        ax.set_ylim(min(values) - reach, max(values) + reach)
        ax.yaxis.set_major_locator(MaxNLocator(6))
    return svg(fig, "force against cell size with its limit")


def _error_against_cell(study):
    found = study.result["convergence"]
    if len(found["resolutions"]) < 2:
        return None
    fig, ax = figure(430, 330)
    draw_error_against_cell(ax, study)
    return svg(fig, "error against cell size")


def draw_error_against_cell(ax, study):
    """Of a study of bodies."""
    found = study.result["convergence"]
    light_grid(ax)
    cells = np.array([entry["cell"] for entry in found["resolutions"]])
    errors = np.array([entry["error"] for entry in found["resolutions"]])
    ax.loglog(cells, errors, "o", color=ACCENT, markersize=6.5, zorder=3)
    middle = np.exp(np.mean(np.log(errors / cells**found["order"])))
    ax.loglog(cells, middle * cells**found["order"], color=WARM, linewidth=1.2, zorder=2,
              label=f"order {found['order']:.2f}")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    ax.set_xticks(cells, [f"{cell:g}" for cell in cells])
    ax.set_xlabel("cell, mm")
    ax.set_ylabel("off by, %")
    ax.legend(frameon=False)


def estimates(study):
    """None of a job that found nothing."""
    fig = draw_estimates(study)
    return fig and svg(fig, "estimate of every free parameter against core-seconds")


def draw_estimates(study):
    """Of a job: every free parameter's estimate at each preset, with its interval, against core-seconds."""
    presets = [preset for preset in study.result["presets"] if finite(preset.get("core_s")) and preset["core_s"] > 0]
    names = list(dict.fromkeys(name for preset in presets for name in preset["parameters"]))
    if not names:
        return None
    columns = min(len(names), 3)
    rows = math.ceil(len(names) / columns)
    fig, grid = figure(860, 300 * rows, rows, columns, squeeze=False)
    for ax in grid.flat[len(names):]:
        ax.axis("off")
    for ax, name in zip(grid.flat, names):
        light_grid(ax)
        ax.set_xscale("log")
        known = [(preset["preset"], preset["core_s"], preset["parameters"][name]) for preset in presets
                 if name in preset["parameters"] and finite(preset["parameters"][name]["value"])]
        for preset, cost, p in known:
            ends = [end if finite(end) else p["value"] for end in p["interval"]]
            ax.errorbar([cost], [p["value"]], yerr=[[p["value"] - ends[0]], [ends[1] - p["value"]]], fmt="D",
                        color=INK if preset == "reference" else ACCENT, markersize=7, capsize=4, elinewidth=1.3)
            ax.annotate(preset, (cost, p["value"]), xytext=(8, 5), textcoords="offset points", fontsize=10.5,
                        color=QUIET)
        if known:
            unit = pretty_unit(known[0][2]["unit"])
            ax.set_title(name.replace("_", " ") + (f", {unit}" if unit else ""))
            ax.set_xlim(0.7 * min(cost for _, cost, _ in known), 2.2 * max(cost for _, cost, _ in known))
        ax.set_xlabel("core-seconds")
        ax.set_xticks([cost for _, cost, _ in known], [f"{cost:.3g}" for _, cost, _ in known])
        ax.set_xticks([], minor=True)
    return fig
