"""Figures of what an estimate is worth: profiles, directions, correlation, error budget."""

import math

import numpy as np
from matplotlib.ticker import MaxNLocator

from .page import finite, large_unit, number, pretty_unit
from .style import (ACCENT, ACCENT_LIGHT, ACCENT_PALE, BALANCE, INK, QUIET, SAND, WARM, WARM_LIGHT, figure, light_grid,
                    svg)

COLUMNS = 3  # panels side by side


def profiles(estimates, chi2, allowed):
    """The least misfit with one quantity held, above the misfit of the fit: a panel per quantity.

    estimates: [{"label", "unit", "value", "se", "interval", "profile": {"value", "chi2"}, "ends": [{"chi2_simulated"}],
    "measured": bool}]; allowed: the rise of chi^2 that ends a 95 % interval.
    """
    shown = [e for e in estimates if len((e.get("profile") or {}).get("value") or []) > 2]
    if not shown:
        return None
    columns = min(COLUMNS, len(shown)) if len(shown) != 4 else 2
    rows = math.ceil(len(shown) / columns)
    fig, axes = figure(860 if columns > 1 else 480, 225 * rows, rows, columns, squeeze=False, sharey=True)
    for ax in axes.flat[len(shown):]:
        ax.axis("off")
    for ax, e in zip(axes.flat, shown):
        factor, unit = large_unit(e["unit"], [e["value"]])
        x = np.array(e["profile"]["value"], dtype=float) * factor
        y = np.array([np.nan if v is None else v - chi2 for v in e["profile"]["chi2"]])
        colour = ACCENT if e["measured"] else WARM
        light_grid(ax)
        ends = [v * factor for v in e["interval"] or () if finite(v)]
        if len(ends) == 2:
            ax.axvspan(*ends, color=ACCENT_PALE, linewidth=0, zorder=0)
        ax.axhline(allowed, color=QUIET, linewidth=0.9)
        if finite(e.get("se")) and e["se"] > 0:
            fine = np.linspace(x[0], x[-1], 200)
            # Standard errors contain error_scale, as `allowed` does: the parabola meets the line at quantile * se.
            parabola = e["rise_per_se2"] * ((fine / factor - e["value"]) / e["se"]) ** 2
            ax.plot(fine, parabola, color=QUIET, linewidth=1.1, linestyle=(0, (4, 3)))
        ax.plot(x, y, color=colour)
        ax.plot([e["value"] * factor], [0], "o", color=colour, markersize=7, clip_on=False, zorder=4)
        for end, at in zip(e.get("ends") or (), e["interval"] or ()):
            if end and finite(end.get("chi2_simulated")) and finite(at):
                ax.plot([at * factor], [end["chi2_simulated"] - chi2], "s", color=colour, markersize=6.5,
                        markerfacecolor="white", zorder=4)
        ax.set_xlim(x[0], x[-1])
        ax.set_ylim(0, 2.2 * allowed)
        ax.set_title(e["label"] + (f", {pretty_unit(unit)}" if unit != "1" else ""))
        ax.xaxis.set_major_locator(MaxNLocator(5))
        ax.yaxis.set_major_locator(MaxNLocator(5))
    for ax in axes[:, 0]:
        ax.set_ylabel("rise of χ²")
    for row in range(rows):
        last = axes[row][min(columns, len(shown) - row * columns) - 1]
        last.annotate("95 %", (1, allowed), xycoords=("axes fraction", "data"), xytext=(4, 0),
                      textcoords="offset points", va="center", fontsize=11, color=QUIET, annotation_clip=False)
    return svg(fig, "rise of the misfit with each quantity held at a value")


def directions(names, singular_values, vectors):
    """Directions of logarithmic parameter space from best to worst known, and what each is made of."""
    count = len(singular_values)
    fig, axes = figure(860, 70 + 40 * count, 1, 2, width_ratios=[1, 2.4])
    rows = -np.arange(count)
    values = np.array([v if finite(v) else 0 for v in singular_values], dtype=float)
    left, right = axes
    seen = values[values > 0]
    # An axis in decades ends where its bars can still be compared.
    lowest = max(min(0.5, seen.min() / 2), values.max() * 1e-6) if seen.size else 0.5
    left.barh(rows, np.maximum(values, lowest), color=[ACCENT if v > 2 else WARM for v in values], height=0.5)
    left.set_xscale("log")
    left.set_xlim(lowest, values.max() * 40)
    for y, v in zip(rows, values):
        left.annotate(f"{number(v, digits=2)}: {known_to(v)}", (max(v, lowest), y), xytext=(6, 0),
                      textcoords="offset points", va="center", fontsize=11)
    left.set_yticks(rows, [f"{k + 1}" for k in range(count)])
    left.tick_params(axis="y", length=0)
    left.set_ylabel("direction")
    left.set_title("singular value: known to")
    left.set_ylim(rows[-1] - 0.6, 0.6)

    right.set_ylim(rows[-1] - 0.6, 0.6)
    for j, name in enumerate(names):
        right.axvline(j, color=QUIET, linewidth=0.7)
        for y, vector in zip(rows, vectors):
            share = vector[j] if finite(vector[j]) else 0
            right.barh([y], [0.46 * share], left=j, height=0.5, color=ACCENT if share >= 0 else WARM_LIGHT)
            if abs(share) >= 0.1:
                right.annotate(f"{share:+.2f}".replace("-", "−"), (j - 0.02 * np.sign(share), y), fontsize=10,
                               va="center", ha="right" if share > 0 else "left", color=INK)
    right.set_xlim(-0.6, len(names) - 0.4)
    right.set_xticks(range(len(names)), names)
    right.xaxis.tick_top()
    right.tick_params(length=0, labelsize=12, labelcolor=INK)
    right.set_yticks([])
    for side in ("left", "bottom"):
        right.spines[side].set_visible(False)
    return svg(fig, "singular values and singular vectors of the weighted Jacobian")


def known_to(singular_value):
    """The standard error along a direction of logarithms, in words."""
    if not finite(singular_value) or singular_value <= 0:
        return "not seen"
    error = 1 / singular_value
    return f"{number(100 * error, digits=2)} %" if error <= 0.5 else f"a factor {number(math.exp(error), digits=2)}" \
        if error < 5 else "not seen"


def correlation(names, matrix):
    """Numbers in cells, below the diagonal; an estimate that is not seen has none."""
    values = np.array([[v if finite(v) else np.nan for v in row] for row in matrix], dtype=float)
    size = len(values)
    if size < 2:
        return None
    below = np.where(np.tri(size, k=-1, dtype=bool), values, np.nan)[1:, :-1]
    height = 46 if size < 8 else 36
    width = max(1.35 * height, 8 * max(map(len, names[:-1])) + 12)
    fig, ax = figure(40 + 8 * max(map(len, names[1:])) + width * (size - 1), 50 + height * (size - 1))
    ax.imshow(below, cmap=BALANCE, vmin=-1, vmax=1, aspect="auto")
    for i in range(size - 1):
        for j in range(i + 1):
            r = below[i][j]
            ax.text(j, i, f"{r:.2f}".replace("-", "−") if np.isfinite(r) else "–", ha="center", va="center",
                    fontsize=11.5 if size < 8 else 10, color="white" if abs(r) > 0.7 else INK)
    ax.set_xticks(range(size - 1), names[:-1])
    ax.set_yticks(range(size - 1), names[1:])
    ax.tick_params(length=0, labelsize=12, labelcolor=INK)
    for spine in ax.spines.values():
        spine.set_visible(False)
    return svg(fig, "correlation of the estimates")


def posterior(estimates):
    """Draws of every pair below the diagonal, of every estimate on it, with both 95 % intervals.

    estimates: [{"label", "unit", "draws", "interval" (of the profile), "credible" (of the draws)}].
    """
    size = len(estimates)
    if size < 1:
        return None
    side = max(110, min(220, 860 / size))
    fig, axes = figure(side * size + 30, side * size + 20, size, size, squeeze=False, sharex="col")
    columns = []
    for e in estimates:
        factor, unit = large_unit(e["unit"], e["draws"])
        columns.append((np.array(e["draws"], dtype=float) * factor, factor,
                        e["label"] + (f", {pretty_unit(unit)}" if unit != "1" else "")))
    for i in range(size):
        for j in range(size):
            ax = axes[i][j]
            if j > i:
                ax.axis("off")
                continue
            x, factor, label = columns[j]
            if i == j:
                ax.hist(x, bins=24, color=ACCENT_LIGHT)
                for limits, style in ((estimates[i]["interval"], "-"), (estimates[i]["credible"], (0, (4, 3)))):
                    for end in limits or ():
                        if finite(end):
                            ax.axvline(end * factor, color=ACCENT if style == "-" else WARM, linestyle=style, linewidth=1.2)
                ax.set_yticks([])
                ax.spines["left"].set_visible(False)
            else:
                ax.plot(x, columns[i][0], ".", color=ACCENT, markersize=3, alpha=0.45)
                ax.yaxis.set_major_locator(MaxNLocator(3))
                if j == 0:
                    ax.set_ylabel(columns[i][2])
                else:
                    ax.tick_params(labelleft=False)
            ax.xaxis.set_major_locator(MaxNLocator(3))
            if i == size - 1:
                ax.set_xlabel(label)
    return svg(fig, "draws from the posterior density of the estimates")


SOURCES = {"measurement": ("scatter of measurements", ACCENT, "white"),
           "specimen": ("error a specimen shares", ACCENT_LIGHT, INK),
           "simulation": ("noise of the simulation", WARM, "white"),
           "discrepancy": ("stated error of the model", SAND, INK),
           "prior": ("prior knowledge", INK, "white"),
           "unexplained": ("misfit beyond all of these", "#aab6ba", INK)}


def error_budget(rows):
    """Shares of each variance by source. rows: [(label, {source: share})]."""
    present = [source for source in SOURCES if any((shares.get(source) or 0) > 5e-4 for _, shares in rows)]
    fig, axes = figure(860, 48 + 38 * len(rows) + 24 * math.ceil(len(present) / 3), 2, 1, squeeze=False,
                       height_ratios=[30 + 38 * len(rows), 24 * math.ceil(len(present) / 3)])
    ax, below = axes[0][0], axes[1][0]
    for line, (_, shares) in enumerate(rows):
        start = 0
        for source in present:
            share = shares.get(source) or 0
            _, colour, ink = SOURCES[source]
            ax.barh([-line], [share], left=start, height=0.62, color=colour, edgecolor="white", linewidth=0.8)
            if share > 0.035:
                ax.text(start + share / 2, -line, f"{100 * share:.0f}", ha="center", va="center", fontsize=11, color=ink)
            start += share
    ax.set_yticks([-line for line in range(len(rows))], [label for label, _ in rows])
    ax.tick_params(axis="y", length=0, labelsize=12, labelcolor=INK)
    ax.set_xlim(0, 1)
    ax.set_ylim(-len(rows) + 0.45, 0.55)
    ax.set_xticks([0, 0.25, 0.5, 0.75, 1], ["0", "25", "50", "75", "100 %"])
    ax.spines["left"].set_visible(False)
    below.axis("off")
    handles = [below.barh([0], [0], color=SOURCES[source][1]) for source in present]
    below.legend(handles, [SOURCES[source][0] for source in present], loc="upper left", ncols=3, handlelength=1,
                 columnspacing=2, borderaxespad=0).set_in_layout(False)
    return svg(fig, "share of the variance of each estimate by source")
