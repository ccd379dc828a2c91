"""Figures that compare measurement, simulation and the simple methods, and say what the data can tell."""

import math

import numpy as np
from matplotlib.ticker import MaxNLocator

from .page import finite, interval_text, large_unit, number, pretty_unit
from .style import (ACCENT, ACCENT_LIGHT, ACCENT_PALE, BALANCE, INK, QUIET, RULE, SAND, WARM, WARM_LIGHT, figure,
                    light_grid, svg)

OBSERVABLES = {"F_c": ("cutting force F_c", "N/m"), "F_t": ("transverse force F_t", "N/m"),
               "chip_ratio": ("chip thickness / depth", "1"), "chip_curvature": ("chip curvature", "1/mm")}

# Three families of methods, each with its own hand: the simulation is the one to look at.
LOOK = {
    "simulation": [dict(color=ACCENT, linewidth=2.4)],
    "closed form": [dict(color=colour, linewidth=1.3, linestyle=dashes) for colour in (INK, "#8d9aa0")
                    for dashes in ((0, (5, 2)), (0, (1, 1.6)), (0, (5, 2, 1, 2)), "solid")],
    "intercept": [dict(color=WARM, linewidth=1.3), dict(color=WARM, linewidth=1.3, linestyle=(0, (5, 2))),
                  dict(color=WARM_LIGHT, linewidth=1.6), dict(color=SAND, linewidth=1.6, linestyle=(0, (5, 2)))],
}


def measured_and_fitted(points, curves):
    """One panel per observable: dots with ± one standard error, and a curve per method; both against depth.

    points: [{"depth": mm, "F_c": (value, error), ...}]; curves: [{"label", "family", "depth": [mm], "F_c": [...]}].
    """
    shown = [key for key in OBSERVABLES if any(key in point for point in points)]
    if not shown:
        return None
    deepest = max(point["depth"] for point in points)
    length, unit = (1e3, "µm") if deepest < 0.5 else (1, "mm")
    legend_rows = math.ceil((len(curves) + 1) / 3)
    fig, axes = figure(860, 320 + 22 * legend_rows, 2, len(shown), squeeze=False,
                       width_ratios=[1.5] + [1] * (len(shown) - 1), height_ratios=[300, 22 * legend_rows])
    handles = {}
    for ax, key in zip(axes[0], shown):
        name, base = OBSERVABLES[key]
        factor, shown_unit = large_unit(base, [p[key][0] for p in points if key in p])
        light_grid(ax)
        taken = {family: 0 for family in LOOK}
        for curve in curves:
            look = LOOK[curve["family"]][taken[curve["family"]] % len(LOOK[curve["family"]])]
            taken[curve["family"]] += 1
            if key not in curve:
                continue
            x = np.array(curve["depth"]) * length
            y = np.array([np.nan if v is None else v for v in curve[key]], dtype=float) * factor
            marker = dict(marker="o", markersize=4.5) if curve["family"] == "simulation" else {}
            handles.setdefault(curve["label"], ax.plot(x, y, zorder=3 if marker else 2, **look, **marker)[0])
        values = [(p["depth"] * length, p[key][0] * factor, (p[key][1] or 0) * factor) for p in points if key in p]
        x, y, error = np.array(values).T
        handles["measured (± standard error)"] = ax.errorbar(x, y, yerr=error, fmt="s", color=INK, markersize=6,
                                                             capsize=4, elinewidth=1.2, zorder=4)
        ax.set_xlim(0, deepest * length * 1.08)
        _around_data(ax, y, error, from_zero=key == "F_c")
        ax.set_xlabel(f"depth of cut, {unit}")
        ax.set_title(name + (f", {pretty_unit(shown_unit)}" if shown_unit != "1" else ""))
        ax.xaxis.set_major_locator(MaxNLocator(5))
    for ax in axes[1]:
        ax.axis("off")
    legend = axes[1][0].legend(handles.values(), handles.keys(), loc="upper left", ncols=3, columnspacing=2.2,
                               borderaxespad=0)
    legend.set_in_layout(False)  # it may reach under all panels
    return svg(fig, "measured and fitted forces against depth of cut")


def _around_data(ax, y, error, from_zero):
    """A method that runs away must not squeeze the measurements."""
    low, high = (y - error).min(), (y + error).max()
    room = 0.18 * (high - low) if high > low else 0.2 * abs(high)
    ax.set_ylim(0 if from_zero else low - room, high + room)


def intercept_comparison(rows):
    """Toughness by every method with its 95 % interval, on one axis.

    rows: [{"label", "family", "value", "interval": (lo, hi) or None, "unit", "rejected"}] in the order to be shown.
    """
    rows = [row for row in rows if finite(row["value"])]
    if not rows:
        return None
    ends = [v for row in rows for v in [row["value"], *(row["interval"] or ())] if finite(v)]
    factor, unit = large_unit(rows[0]["unit"], ends)
    # A single hopeless interval must not flatten the others: the axis follows the estimates, arrows tell the rest.
    estimates = np.array([row["value"] for row in rows]) * factor
    reach = max(estimates.max() - min(estimates.min(), 0), 1e-12)
    low = max(min(v for v in ends) * factor, min(estimates.min(), 0) - 0.6 * reach)
    high = min(max(v for v in ends) * factor, estimates.max() + 0.9 * reach)
    margin = 0.04 * (high - low)
    low, high = low - margin, high + margin
    fig, ax = figure(860, 62 + 38 * len(rows))
    colours = {"simulation": ACCENT, "closed form": INK, "intercept": WARM}
    for line, row in enumerate(rows):
        y, colour = -line, colours[row["family"]]
        ax.axhline(y, color=RULE, linewidth=0.6, zorder=0)
        if row["interval"]:
            lo, hi = [v * factor if finite(v) else (np.inf if k else -np.inf) for k, v in enumerate(row["interval"])]
            ax.plot([max(lo, low), min(hi, high)], [y, y], color=colour, linewidth=5, alpha=0.3, solid_capstyle="butt")
            for end, cut_off, mark in [(low, lo < low, "<"), (high, hi > high, ">")]:
                if cut_off:
                    ax.plot([end], [y], marker=mark, color=colour, markersize=7, clip_on=False)
        ax.plot([row["value"] * factor], [y], "o", color=colour, markersize=8 if row["family"] == "simulation" else 6.5,
                markerfacecolor="white" if row.get("rejected") else colour)
        text = number(row["value"] * factor)
        if row["interval"]:
            text += f"  [{interval_text(row['interval'], factor, 2)}]"
        ax.annotate(text, (1, y), xycoords=("axes fraction", "data"), xytext=(14, 0), textcoords="offset points",
                    va="center", color=colour, fontsize=11.5, annotation_clip=False)
    if low < 0:
        ax.axvline(0, color=QUIET, linewidth=0.8)
    ax.set_yticks([-line for line in range(len(rows))], [row["label"] for row in rows])
    for label, row in zip(ax.get_yticklabels(), rows):
        label.set_color(colours[row["family"]])
    ax.tick_params(axis="y", length=0, pad=10)
    ax.spines["left"].set_visible(False)
    ax.set_xlim(low, high)
    ax.set_ylim(-len(rows) + 0.4, 0.6)
    ax.set_xlabel(f"toughness G_c, {pretty_unit(unit)}")
    return svg(fig, "toughness by every method with its 95 percent interval")


def residuals(points):
    """(measured − fitted)/standard deviation for every observable.

    points: [{"depth", "weighted": {"F_c": r, ...}}].
    """
    shown = [key for key in OBSERVABLES if any(finite(p["weighted"].get(key)) for p in points)]
    if not shown:
        return None
    deepest = max(point["depth"] for point in points)
    length, unit = (1e3, "µm") if deepest < 0.5 else (1, "mm")
    fig, axes = figure(860, 235, 1, len(shown), squeeze=False, sharey=True)
    largest = max(abs(p["weighted"][key]) for p in points for key in shown if finite(p["weighted"].get(key)))
    for ax, key in zip(axes[0], shown):
        light_grid(ax)
        ax.axhspan(-2, 2, color=ACCENT_PALE, linewidth=0, zorder=0)
        ax.axhline(0, color=QUIET, linewidth=0.8)
        for p in points:
            r = p["weighted"].get(key)
            if not finite(r):
                continue
            x, colour = p["depth"] * length, ACCENT if abs(r) <= 2 else WARM
            ax.plot([x, x], [0, r], color=colour, linewidth=1.4)
            ax.plot([x], [r], "o", color=colour, markersize=6.5)
        ax.set_xlim(0, deepest * length * 1.1)
        ax.set_ylim(-max(3, 1.2 * largest), max(3, 1.2 * largest))
        ax.set_title(OBSERVABLES[key][0])
        ax.set_xlabel(f"depth of cut, {unit}")
        ax.xaxis.set_major_locator(MaxNLocator(5))
    axes[0][0].set_ylabel("residual / its sd")
    return svg(fig, "weighted residuals of every observable")


def identifiability(names, singular_values, vectors, correlation):
    """Left: directions in parameter space from best to worst known. Right: correlation of the estimates."""
    count = len(singular_values)
    has_correlation = correlation is not None
    fig, axes = figure(860, max(250, 60 + 58 * count), 1, 3 if has_correlation else 2, squeeze=False,
                       width_ratios=[1, 1.7, 1.5] if has_correlation else [1, 1.7])
    left, middle = axes[0][0], axes[0][1]
    rows = -np.arange(count)
    values = np.nan_to_num(np.array(singular_values, dtype=float))
    vectors = np.array(vectors, dtype=float)
    left.barh(rows, values, color=[ACCENT if v > 2 else WARM for v in values], height=0.5)
    left.set_xscale("log")
    left.set_xlim(min(0.5, values[values > 0].min() / 2 if (values > 0).any() else 0.5), values.max() * 6)
    for y, v in zip(rows, values):
        left.annotate(number(v, digits=2), (max(v, left.get_xlim()[0]), y), xytext=(6, 0), textcoords="offset points",
                      va="center", fontsize=11.5)
    left.set_yticks(rows, [f"{k + 1}" for k in range(count)])
    left.tick_params(axis="y", length=0)
    left.set_title("singular value")
    left.set_ylabel("direction")

    middle.set_title("what that direction is made of")
    width = 1.0 / (len(names) + 1)
    shades = [ACCENT, WARM, ACCENT_LIGHT, SAND, INK, WARM_LIGHT]
    for j, name in enumerate(names):
        offset = (0.5 * (len(names) - 1) - j) * width
        middle.barh(rows + offset, [vectors[k][j] for k in range(count)], height=width * 0.9, label=name,
                    color=shades[j % len(shades)])
    middle.axvline(0, color=QUIET, linewidth=0.8)
    middle.set_xlim(-1.05, 1.05)
    middle.set_xticks([-1, -0.5, 0, 0.5, 1])
    middle.set_yticks([])
    middle.spines["left"].set_visible(False)
    middle.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=2, handlelength=1, columnspacing=1.2)

    if has_correlation:
        right = axes[0][2]
        matrix = np.array(correlation, dtype=float)
        size = len(matrix)
        below = np.where(np.tri(size, k=-1, dtype=bool), matrix, np.nan)[1:, :-1]
        right.imshow(below, cmap=BALANCE, vmin=-1, vmax=1)
        for (i, j), r in np.ndenumerate(below):
            if np.isfinite(r):
                right.text(j, i, f"{r:.2f}".replace("-", "−"), ha="center", va="center", fontsize=11,
                           color="white" if abs(r) > 0.7 else INK)
        right.set_title("correlation of the estimates")
        right.set_xticks(range(size - 1), names[:-1])
        right.set_yticks(range(size - 1), names[1:])
        right.tick_params(length=0)
        for spine in right.spines.values():
            spine.set_visible(False)
    return svg(fig, "singular values, singular vectors and correlation of the estimates")


def trace(entries, names):
    """Misfit against simulations spent, and the parameters relative to where they ended."""
    runs = np.array([entry["runs"] for entry in entries], dtype=float)
    chi2 = np.array([entry["chi2"] if finite(entry["chi2"]) else np.nan for entry in entries])
    fig, (left, right) = figure(860, 290, 1, 2)
    light_grid(left)
    best = np.fmin.accumulate(chi2)
    left.plot(runs, chi2, "o", color=ACCENT_LIGHT, markersize=5, label="tried")
    left.step(runs, best, where="post", color=ACCENT, label="best so far")
    if np.nanmax(chi2) > 30 * np.nanmin(chi2):
        left.set_yscale("log")
    left.set_title("misfit χ²")
    left.set_xlabel("simulations")
    left.legend()

    light_grid(right)
    shades = [ACCENT, WARM, ACCENT_LIGHT, SAND, INK, WARM_LIGHT]
    end = entries[int(np.nanargmin(chi2))]["parameters"]
    for j, name in enumerate(names):
        path = [entry["parameters"].get(name) for entry in entries]
        if not all(map(finite, path)) or not finite(end.get(name)) or end[name] == 0:
            continue
        right.plot(runs, np.array(path) / end[name], "-o", markersize=3.5, linewidth=1.5, color=shades[j % len(shades)],
                   label=name)
    right.axhline(1, color=QUIET, linewidth=0.8)
    right.set_title("parameters, relative to the best point")
    right.set_xlabel("simulations")
    right.legend(ncols=2)
    return svg(fig, "misfit and parameters along the search")
