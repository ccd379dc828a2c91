"""What a sweep left in its directory (sweep.json), and the figures drawn from it."""

import itertools
import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator

from .cut import Unreadable
from .page import finite, integer, large_unit, number, pretty_unit
from .style import ACCENT, ACCENT_LIGHT, INK, QUIET, SAND, STRAIN, WARM, WARM_LIGHT, figure, light_grid, svg

NAMES = {"cut.depth": "depth of cut h", "tool.rake": "rake angle α", "friction.coefficient": "friction μ",
         "material.yield_stress": "yield stress σ_y", "cohesive.mode_I.strength": "cohesive strength σ_c",
         "cohesive.mode_II.strength": "cohesive shear strength", "cohesive.mode_I.toughness": "toughness G_c",
         "cohesive.mode_II.toughness": "mode II toughness", "cut.speed": "speed", "tool.radius": "tool radius"}
SYMBOLS = {"cut.depth": "h", "tool.rake": "α", "friction.coefficient": "μ", "material.yield_stress": "σ_y",
           "cohesive.mode_I.strength": "σ_c", "cohesive.mode_I.toughness": "G_c"}

# What is drawn: where it stands in a result, its name, its unit.
FORCES = [("F_c", "cutting force F_c", "N/m"), ("F_t", "transverse force F_t", "N/m")]
CHIP = [("ratio", "F_t / F_c", "1"), ("chip_ratio", "chip thickness / depth", "1"),
        ("mode_I_fraction", "mode I share of the separation", "1"), ("crack_lead", "crack tip ahead of the tool", "mm")]

INTERCEPTS = [("intercept_linear", "straight line", WARM), ("intercept_quadratic", "parabola", "#9a8648"),
              ("intercept_exponential", "exponential", "#8d9aa0"), ("intercept_model", "square-root-aware", ACCENT)]

MARKERS = {"touching": "o", "bending": "D"}
MOST_ROWS = 6  # of panels: a third and fourth axis


@dataclass
class Sweep:
    directory: Path
    result: dict

    @property
    def axes(self):
        return self.result["axes"]

    @property
    def runs(self):
        return self.result["runs"]


def read_sweep(directory):
    """Raises Unreadable without a usable sweep.json."""
    file = Path(directory) / "sweep.json"
    try:
        result = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Unreadable(f"{file}: not there; the sweep is not finished, continue it with "
                         f"`kerf resume {directory}`") from None
    except (ValueError, OSError) as error:
        raise Unreadable(f"{file}: cannot be read ({error})") from error
    if not isinstance(result, dict) or not result.get("axes") or not isinstance(result.get("runs"), list):
        raise Unreadable(f"{file}: is not the result of a sweep")
    return Sweep(Path(directory), result)


def name_of(axis):
    return NAMES.get(axis["paths"][0], axis["name"].replace("_", " "))


def with_unit(axis):
    return name_of(axis) + (f", {pretty_unit(axis['unit'])}" if axis["unit"] != "1" else "")


def short_with_unit(axis):
    return axis["name"].replace("_", " ") + (f", {pretty_unit(axis['unit'])}" if axis["unit"] != "1" else "")


def value_text(axis, value):
    if value is None:
        return "none"
    if not finite(value):
        return str(value)
    unit = "" if axis["unit"] == "1" else "°" if axis["unit"] == "deg" else f" {pretty_unit(axis['unit'])}"
    return f"{value:g}".replace("-", "−") + unit


def setting_text(axis, value):
    """α = 30°; no friction; bridging tool: cuts."""
    if value is None:
        return f"no {axis['name'].replace('_', ' ')}"
    name = SYMBOLS.get(axis["paths"][0], axis["name"].replace("_", " "))
    return f"{name} = {value_text(axis, value)}" if axis["numeric"] else f"{name}: {value}"


def varied(sweep):
    """Indices of the axes with more than one value; the first of them is drawn along x."""
    several = [k for k, axis in enumerate(sweep.axes) if len(axis["values"]) > 1]
    return several or [0]


def found_by_bodies(sweep):
    """Names of all that runs of bodies found; none of cuts."""
    return list(dict.fromkeys(name for run in sweep.runs for name in (run.get("result") or {}).get("results") or {}))


def _amount(run, key):
    """(value, standard error) of a drawn quantity; None when the run has none."""
    result = run.get("result") or {}
    result = result.get("results") or result
    if key == "ratio":
        force, transverse = _amount(run, "F_c"), _amount(run, "F_t")
        if not force or not transverse or force[0] == 0:
            return None
        ratio = transverse[0] / force[0]
        return ratio, abs(ratio) * math.hypot(force[1] / force[0], transverse[1] / transverse[0] if transverse[0] else 0)
    entry = result.get(key)
    if isinstance(entry, dict):
        return (entry["value"], entry.get("se") or 0.0) if finite(entry.get("value")) else None
    return (entry, result.get(key + "_se") or 0.0) if finite(entry) else None


class _Abscissa:
    """Where the values of an axis stand: on a scale when all are numbers, else side by side."""

    def __init__(self, axis):
        self.axis = axis
        self.values = axis["values"]
        self.scaled = all(finite(value) for value in self.values)
        numbers = [value for value in self.values if finite(value)]
        self.logarithmic = self.scaled and min(numbers) > 0 and max(numbers) >= 20 * min(numbers)

    def place(self, choice):
        return self.values[choice] if self.scaled else choice

    def dress(self, axes, label=True):
        if self.logarithmic:
            axes.set_xscale("log")
        if not self.scaled:
            axes.set_xticks(range(len(self.values)), [value_text(self.axis | {"unit": "1"}, v) for v in self.values])
            axes.set_xlim(-0.4, len(self.values) - 0.6)
        elif self.logarithmic or len(self.values) <= 6:
            axes.xaxis.set_major_locator(FixedLocator(sorted(self.values)))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("-", "−")))
            axes.xaxis.set_minor_locator(NullLocator())
        else:
            axes.xaxis.set_major_locator(MaxNLocator(6))
        if label:
            axes.set_xlabel(with_unit(self.axis))


def _colours(axis):
    """A ramp for numbers, distinct hands for words."""
    count = len(axis["values"]) if axis else 1
    if count == 1:
        return [ACCENT]
    if count == 2:
        return [ACCENT, WARM]
    if axis["numeric"] and all(finite(value) for value in axis["values"]):
        rank = np.argsort(np.argsort(axis["values"]))
        return [STRAIN(0.3 + 0.6 * k / (count - 1)) for k in rank]
    shades = itertools.cycle([ACCENT, WARM, INK, ACCENT_LIGHT, SAND, WARM_LIGHT])
    return list(itertools.islice(shades, count))


def _panels(sweep):
    """[(title, runs)]: one row of panels for each combination of the third and further axes."""
    further = [] if sweep.result["zip"] else varied(sweep)[2:]
    rows = {}
    for run in sweep.runs:
        rows.setdefault(tuple(run["choice"][k] for k in further), []).append(run)
    titles = [", ".join(setting_text(sweep.axes[k], sweep.axes[k]["values"][c]) for k, c in zip(further, choice))
              for choice in rows]
    return list(zip(titles, rows.values()))[:MOST_ROWS]


def forces(sweep):
    """Of bodies: what they found; what is about an error alone where there are many."""
    names = found_by_bodies(sweep)
    if names:
        errors = [name for name in names if name.endswith("_error")]
        drawn = (errors if len(names) > 4 and errors else names)[:6]
        return _against_first_axis(sweep, [(name, name.replace("_", " "), "1") for name in drawn],
                                   "what was found against the swept values", 300, columns=min(2, len(drawn)))
    return _against_first_axis(sweep, FORCES, "cutting and transverse force against the swept values", 330)


def chip(sweep):
    return _against_first_axis(sweep, CHIP, "force ratio, chip and crack against the swept values", 250, columns=2)


def _against_first_axis(sweep, quantities, description, height, columns=None):
    """One panel per quantity: a line per value of the second axis. Refused runs are open and join no line."""
    axes_of_sweep, several = sweep.axes, varied(sweep)
    along = several[0]
    beside = several[1] if len(several) > 1 and not sweep.result["zip"] else None
    abscissa = _Abscissa(axes_of_sweep[along])
    colours = _colours(axes_of_sweep[beside] if beside is not None else None)
    if not any(_amount(run, key) for run in sweep.runs for key, _, _ in quantities):
        return None
    columns = columns or len(quantities)
    rows_each = math.ceil(len(quantities) / columns)
    panels = _panels(sweep)
    fig, grid = figure(860, height * rows_each * len(panels) + 42, rows_each * len(panels) + 1, columns, squeeze=False,
                       height_ratios=[height] * rows_each * len(panels) + [42])
    fig.get_layout_engine().set(h_pad=0.1)
    units = {unit: large_unit(unit, [a[0] for run in sweep.runs for key, _, of in quantities if of == unit
                                     if run["verdict"] == "accepted" and (a := _amount(run, key))])
             for _, _, unit in quantities}
    marks = set()
    for place, (title, runs) in enumerate(panels):
        for k, (key, name, unit) in enumerate(quantities):
            ax = grid[place * rows_each + k // columns][k % columns]
            factor, shown_unit = units[unit]
            marks |= _draw_quantity(ax, runs, key, factor, along, beside, abscissa, colours)
            shown = f", {pretty_unit(shown_unit)}" if unit != "1" else ""
            ax.set_title(name + shown + (f"   ({title})" if title and k == 0 else ""))
            abscissa.dress(ax, label=place * rows_each + k // columns == rows_each * len(panels) - 1)
    for ax in grid[-1]:
        ax.axis("off")
    _legend(grid[-1][0], sweep, beside, colours, marks)
    return svg(fig, description)


def _draw_quantity(ax, runs, key, factor, along, beside, abscissa, colours):
    """Returns which marks were used."""
    light_grid(ax)
    marks = set()
    lines = {}
    for run in runs:
        lines.setdefault(run["choice"][beside] if beside is not None else 0, []).append(run)
    amounts = [(a, run["verdict"]) for run in runs if (a := _amount(run, key))]
    low, high = _limits([a for a, verdict in amounts if verdict == "accepted"], [a for a, _ in amounts])
    for choice, line in lines.items():
        colour = colours[choice]
        points = []
        for run in line:
            amount, x = _amount(run, key), abscissa.place(run["choice"][along])
            accepted = run["verdict"] == "accepted"
            if not amount:
                if run["verdict"] == "refused":
                    marks.add("no force")
                    ax.plot([x], [0], "x", color=colour, markersize=7, clip_on=False,
                            transform=ax.get_xaxis_transform())
                continue
            value, error = amount[0] * factor, amount[1] * factor
            marker = MARKERS.get((run.get("result") or {}).get("branch"), "o")
            marks.add((marker, accepted))
            inside = low * factor <= value <= high * factor
            if not inside:  # a refused run that went astray must not squeeze the others
                marks.add("outside")
                up = value > high * factor
                ax.plot([x], [1 if up else 0], "^" if up else "v", color=colour, markersize=7, clip_on=False,
                        markerfacecolor="white", transform=ax.get_xaxis_transform())
                continue
            ax.errorbar([x], [value], yerr=[error], fmt=marker, color=colour, markersize=6.5 if marker == "o" else 5.8,
                        markerfacecolor=colour if accepted else "white", markeredgewidth=1.4, capsize=3.5,
                        elinewidth=1.2, zorder=3 if accepted else 4)
            if accepted:
                points.append((x, value))
        if len(points) > 1:
            ax.plot(*np.array(sorted(points)).T, color=colour, linewidth=1.4, zorder=2)
    ax.set_ylim(low * factor, high * factor)
    if low < 0 < high:
        ax.axhline(0, color=QUIET, linewidth=0.8, zorder=1)
    ax.yaxis.set_major_locator(MaxNLocator(6))
    return marks


def _limits(accepted, everything):
    """From zero when the values span a large part of the way to it. A refused run widens the axis a little at most."""
    if not everything:
        return 0, 1
    accepted = accepted or everything
    low, high = min(v - e for v, e in accepted), max(v + e for v, e in accepted)
    reach = max(high - low, 0.5 * max(abs(low), abs(high)))
    inside = [v for v, _ in everything if low - reach <= v <= high + reach]
    low, high = min([low, *inside]), max([high, *inside])
    room = 0.12 * (high - low) if high > low else 0.1 * abs(high) or 1.0
    if low >= 0 and low < 0.55 * high:
        return 0, high + room
    if high <= 0 and high > 0.55 * low:
        return low - room, 0
    return low - room, high + room


def _legend(ax, sweep, beside, colours, marks):
    handles = []
    if beside is not None:
        axis = sweep.axes[beside]
        handles += [Line2D([], [], color=colour, linewidth=2, label=setting_text(axis, value))
                    for value, colour in zip(axis["values"], colours)]
    neutral = QUIET if beside is not None else ACCENT
    symbols = [(("o", True), "accepted" if sweep.result.get("bodies") else "touching the crack tip", dict(marker="o")),
               (("D", True), "bending clear of it", dict(marker="D", markersize=5.8)),
               (("o", False), "refused", dict(marker="o", markerfacecolor="white")),
               (("D", False), "refused, bending", dict(marker="D", markersize=5.8, markerfacecolor="white")),
               ("outside", "refused, beyond the axis", dict(marker="^", markerfacecolor="white")),
               ("no force", "refused before it ran", dict(marker="x"))]
    handles += [Line2D([], [], color=neutral, linestyle="none", markeredgewidth=1.4, **({"markersize": 6.5} | look),
                       label=label) for mark, label, look in symbols if mark in marks]
    legend = ax.legend(handles=handles, loc="upper left", ncols=min(4, max(1, len(handles))), columnspacing=1.8,
                       borderaxespad=0, handletextpad=0.7)
    legend.set_in_layout(False)  # it may reach under all panels


def extrapolations(sweep):
    """A panel per line along the depth: the fits, dashed below the least depth, and what they say at zero depth."""
    lines = [line for line in sweep.result.get("intercepts", []) if not line.get("not_applied")]
    if not lines:
        return None
    columns = min(len(lines), 3 if len(lines) != 4 else 2)
    rows = math.ceil(len(lines) / columns)
    fig, grid = figure(860, 330 * rows + 26, rows + 1, columns, squeeze=False, height_ratios=[330] * rows + [26],
                       sharey="row" if rows == 1 else False)
    fig.get_layout_engine().set(h_pad=0.1)
    factor, unit = large_unit("N/m", [v for line in lines for v in line["reduction"]["measured"]["F_c_N_per_m"]])
    handles = {}
    for place, (ax, line) in enumerate(itertools.zip_longest(grid[:-1].flat, lines)):
        if line is None:
            ax.axis("off")
            continue
        _draw_extrapolation(ax, line, handles, factor, shared=rows == 1 and place > 0)
        ax.set_title(held_text(sweep, line))
    for place, ax in enumerate(grid[:-1].flat):
        if place < len(lines) and place % columns == 0:
            ax.set_ylabel(f"cutting force, {pretty_unit(unit)}")
    for ax in grid[-1]:
        ax.axis("off")
    grid[-1][0].legend(handles.values(), handles.keys(), loc="upper left", ncols=6, columnspacing=1.5, borderaxespad=0,
                       handlelength=1.8).set_in_layout(False)
    return svg(fig, "cutting force extrapolated to zero depth of cut")


def held_text(sweep, line):
    """What all runs of a line along the depth have in common."""
    if sweep.result["zip"]:
        return ""
    choice = sweep.runs[line["line"][0] - 1]["choice"]
    return ", ".join(setting_text(axis, axis["values"][c]) for axis, c in zip(sweep.axes, choice)
                     if len(axis["values"]) > 1 and "cut.depth" not in axis["paths"])


def toughness_span(line):
    """What was put into the scene, J/m²: the two modes may differ."""
    modes = line["toughness"]["mode_I"], line["toughness"]["mode_II"]
    return min(modes), max(modes)


def _draw_extrapolation(ax, line, handles, factor, shared):
    light_grid(ax)
    measured = line["reduction"]["measured"]
    depth, force = np.array(measured["depth_mm"]), np.array(measured["F_c_N_per_m"])
    deepest, least = depth.max(), depth.min()
    length, unit = (1e3, "µm") if deepest < 0.5 else (1, "mm")
    top = 1.12 * force.max()
    ax.axvline(0, color=QUIET, linewidth=0.8, zorder=1)
    bottom = 0.0
    for k, (method, label, colour) in enumerate(INTERCEPTS):
        fit = line["reduction"]["methods"].get(method) or {}
        drawn, found = fit.get("curve"), (fit.get("parameters") or {}).get("toughness")
        if not drawn or not found or not finite(found.get("value")):
            continue
        x = np.array(drawn["depth_mm"])
        y = np.array([np.nan if v is None else v for v in drawn["F_c_N_per_m"]], dtype=float) * factor
        ax.plot(x[x >= least] * length, y[x >= least], color=colour, linewidth=1.1, zorder=2)
        beyond = x <= max(least, x[x >= least].min() if (x >= least).any() else least)
        handles[label] = ax.plot(x[beyond] * length, y[beyond], color=colour, linewidth=1.5, linestyle=(0, (4, 2.4)),
                                 zorder=2)[0]
        # The answers stand side by side left of zero, each with its 95 % interval.
        place = -(k + 1) * 0.035 * deepest * length
        ends = [v * factor if finite(v) else otherwise
                for v, otherwise in zip(found.get("interval") or [None, None], (-np.inf, np.inf))]
        if finite(found.get("se")):
            ax.plot([place, place], np.clip(ends, -0.12 * top * factor, top * factor), color=colour, linewidth=3.5,
                    alpha=0.35, solid_capstyle="butt", zorder=2)
        ax.plot([place], [found["value"] * factor], "o", color=colour, markersize=5, zorder=3)
        bottom = min(bottom, found["value"] * factor)
    low, high = (v * factor for v in toughness_span(line))
    reach = -(len(INTERCEPTS) + 0.8) * 0.035 * deepest * length
    ax.fill_between([reach, 0], low, high, color=INK, alpha=0.2, linewidth=0)
    handles["G_c in the scene"] = ax.plot([reach, 0], [(low + high) / 2] * 2, color=INK, linewidth=1.8, zorder=4)[0]
    handles["simulated"] = ax.plot(depth * length, force * factor, "s", color=INK, markersize=5.5, linestyle="none",
                                   zorder=5)[0]
    ax.set_xlim(reach, 1.06 * deepest * length)
    before = ax.get_ylim() if shared else (0, 0)
    ax.set_ylim(min(before[0], 0, bottom * 1.2), max(before[1], top * factor))
    ax.xaxis.set_major_locator(MaxNLocator(4))
    ax.set_xlabel(f"depth of cut, {unit}")


def intercept_rows(line):
    """[(label, value, se, interval, deviation from the scene's toughness or None, what the fit says)] per method."""
    low, high = toughness_span(line)
    rows = []
    for method, label, _ in INTERCEPTS:
        fit = line["reduction"]["methods"].get(method) or {}
        found = (fit.get("parameters") or {}).get("toughness")
        verdict = fit.get("verdict") or {}
        says = "" if verdict.get("fit") == "not tested" else verdict.get("statement", "")
        if not found or not finite(found.get("value")):
            rows.append((label, None, None, None, None, says))
            continue
        value = found["value"]
        near = min(max(value, low), high)
        rows.append((label, value, found.get("se"), found.get("interval"), value / near - 1 if near else None, says))
    return rows


def range_text(axis):
    """"0.25, 0.5, 1 mm", shortened in the middle."""
    texts = [value_text(axis | {"unit": "1"}, value) for value in axis["values"]]
    if len(texts) > 7:
        texts = texts[:3] + ["…"] + texts[-2:]
    return ", ".join(texts) + (f" {pretty_unit(axis['unit'])}" if axis["unit"] != "1" else "")


def amount_text(run, key, error=True):
    amount = _amount(run, key)
    if not amount:
        return "–"
    value, spread = amount
    if not error:
        return f"{value:.3f}".replace("-", "−")
    return f"{integer(value)} ± {number(spread, digits=1) if spread < 1 else integer(spread)}"
