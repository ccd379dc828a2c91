"""Figures that compare measurement, simulation and the simple methods, and the way to the fit."""

import math

import numpy as np
from matplotlib.ticker import MaxNLocator

from .page import finite, interval_text, large_unit, number, pretty_unit
from .style import (ACCENT, ACCENT_LIGHT, ACCENT_PALE, INK, QUIET, RULE, SAND, WARM, WARM_LIGHT, figure, light_grid,
                    svg)

OBSERVABLES = {"F_c": ("cutting force F_c", "N/m"), "F_t": ("transverse force F_t", "N/m"),
               "chip_ratio": ("chip thickness / depth", "1"), "chip_curvature": ("chip curvature", "1/mm"),
               "G_R": ("resistance G_R", "J/m^2")}
DEPTH, EXTENSION = ("depth_mm", "depth of cut"), ("extension_mm", "crack extension")  # what a point is drawn against

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


MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", ">"]
SHADES = [ACCENT, WARM, INK, "#c2922e", "#4a78b5", "#8a5a83", "#7d8b2f", "#8d9aa0", "#3c4f76"]


def data_and_bands(groups, observables, scale, quantile, along=DEPTH):
    """Measured values, the simulated curve through them and its 95 % bands: a row per curve, a panel per observable.

    groups: [(label, [cut, ...] by depth)] as calibration.curve_groups gives them; scale: error_scale of the fit;
    quantile: half width of a 95 % interval in standard errors.
    """
    place, axis = along
    deepest = max(cut[place] for _, cuts in groups for cut in cuts)
    length, depth_unit = (1e3, "µm") if deepest < 0.5 else (1, "mm")
    rows, columns = len(groups), len(observables)
    height = 280 if rows == 1 else 195
    fig, axes = figure(860 if columns > 1 else 600, height * rows + 45, rows + 1, columns, squeeze=False,
                       height_ratios=[height] * rows + [30])
    handles = {}
    for line, (row, (label, cuts)) in enumerate(zip(axes, groups)):
        for ax, key in zip(row, observables):
            light_grid(ax)
            factor, unit = large_unit(OBSERVABLES[key][1], [entry[key].get("measured") for _, all_cuts in groups
                                                            for entry in all_cuts if isinstance(entry.get(key), dict)])
            _band(ax, cuts, key, place, length, factor, scale, quantile, handles)
            seen = [c for c in cuts if isinstance(c.get(key), dict) and finite(c[key].get("measured"))]
            x = [c[place] * length for c in seen]
            y = [c[key]["measured"] * factor for c in seen]
            handles["measured (± standard error)"] = ax.errorbar(
                x, y, yerr=[(c[key].get("se") or 0) * factor for c in seen], fmt="s", color=INK, markersize=5.5,
                capsize=3.5, elinewidth=1.2, zorder=4)
            ax.xaxis.set_major_locator(MaxNLocator(5))
            ax.yaxis.set_major_locator(MaxNLocator(5))
            ax.margins(x=0.08)
            if line == 0:
                ax.set_title(OBSERVABLES[key][0] + (f", {pretty_unit(unit)}" if unit != "1" else ""))
            if line == rows - 1:
                ax.set_xlabel(f"{axis}, {depth_unit}")
        if rows > 1:
            row[0].set_ylabel(label)
    for ax in axes[rows]:
        ax.axis("off")
    axes[rows][0].legend(handles.values(), handles.keys(), loc="upper left", ncols=4, columnspacing=1.6,
                         borderaxespad=0).set_in_layout(False)
    return svg(fig, "measured values, simulated curves and their 95 percent bands")


def _band(ax, cuts, key, place, length, factor, scale, quantile, handles):
    """The fitted curve; dark what the parameters leave open, paler what a measurement there may scatter."""
    known = {}
    for cut in cuts:  # repeats at one depth are one simulation; the least scatter of them is kept
        entry = cut.get(key)
        if not cut.get("usable", True) or not isinstance(entry, dict) or not finite(entry.get("fitted")):
            continue
        scatter = entry.get("residual_sd")
        x = cut[place] * length
        known[x] = (entry["fitted"], entry.get("fitted_se"),
                    min(filter(finite, (scatter, known.get(x, (0, 0, None))[2])), default=None))
    if not known:
        return
    x = np.array(sorted(known))
    value, own, scatter = (np.array([np.nan if known[d][k] is None else known[d][k] for d in sorted(known)], dtype=float)
                           * factor for k in range(3))
    if len(x) == 1:  # a depth alone shows its band as a bar
        x, value, own, scatter = x[0] * np.array([0.97, 1.03]), *(np.repeat(v, 2) for v in (value, own, scatter))
    inner, outer = quantile * own, quantile * np.hypot(own, scale * scatter)
    if np.isfinite(outer).any():
        handles["95 % of measurements"] = ax.fill_between(x, value - outer, value + outer, color=ACCENT_PALE,
                                                          linewidth=0, zorder=1)
    if np.isfinite(inner).any():
        handles["95 % of the curve"] = ax.fill_between(x, value - inner, value + inner, color=ACCENT_LIGHT, alpha=0.75,
                                                       linewidth=0, zorder=2)
    handles["simulation"] = ax.plot(x, value, "-o", color=ACCENT, markersize=4, linewidth=2, zorder=3)[0]


def residuals(groups, observables, along=DEPTH):
    """(measured − fitted)/standard deviation against depth, and against rake where there are several.

    groups: [(label, [cut, ...])], told apart by their markers.
    """
    cuts = [cut for _, all_cuts in groups for cut in all_cuts]
    place, axis = along
    deepest = max(cut[place] for cut in cuts)
    length, unit = (1e3, "µm") if deepest < 0.5 else (1, "mm")
    against = [(f"{axis}, {unit}", lambda cut: cut[place] * length)]
    if len({round(cut.get("rake_deg") or 0, 3) for cut in cuts}) > 1:
        against.append(("rake angle, degrees", lambda cut: cut.get("rake_deg")))
    rows, several = len(against), len(groups) > 1
    legend_rows = math.ceil(len(groups) / 4) if several else 0
    fig, axes = figure(860 if len(observables) > 1 else 480, 215 * rows + 24 * legend_rows, rows + several,
                       len(observables), squeeze=False, sharey="row",
                       height_ratios=[215] * rows + [24 * legend_rows] * several)
    found = [cut[key]["weighted_residual"] for cut in cuts for key in observables
             if isinstance(cut.get(key), dict) and finite(cut[key].get("weighted_residual"))]
    reach = max(3, 1.2 * max(map(abs, found)))
    handles = {}
    for line, (row, (name, position)) in enumerate(zip(axes, against)):
        for ax, key in zip(row, observables):
            light_grid(ax)
            ax.axhspan(-2, 2, color=ACCENT_PALE, linewidth=0, zorder=0)
            for at in (-2, 0, 2):
                ax.axhline(at, color=QUIET, linewidth=0.8, linestyle="-" if at == 0 else (0, (4, 3)))
            for k, (label, mine) in enumerate(groups):
                pairs = [(position(cut), cut[key]["weighted_residual"]) for cut in mine
                         if isinstance(cut.get(key), dict) and finite(cut[key].get("weighted_residual"))]
                if not pairs:
                    continue
                x, r = zip(*pairs)
                colour = SHADES[k % len(SHADES)]
                ax.vlines(x, 0, r, color=colour, linewidth=1, alpha=0.6)
                handles[label] = ax.plot(x, r, MARKERS[k % len(MARKERS)], color=colour, markersize=6.5)[0]
            ax.set_ylim(-reach, reach)
            ax.margins(x=0.08)
            ax.set_xlabel(name)
            if name.startswith("rake"):
                ax.set_xticks(sorted({cut["rake_deg"] for cut in cuts})[:12])
                ax.xaxis.set_major_formatter("{x:g}")
            else:
                ax.xaxis.set_major_locator(MaxNLocator(5))
            if line == 0:
                ax.set_title(OBSERVABLES[key][0])
        row[0].set_ylabel("residual / its sd")
    if several:
        for ax in axes[rows]:
            ax.axis("off")
        axes[rows][0].legend(handles.values(), handles.keys(), loc="upper left", ncols=4, columnspacing=1.6,
                             handlelength=1, borderaxespad=0).set_in_layout(False)
    return svg(fig, "normalised residuals against depth and rake")


def trace(entries, names):
    """Misfit against what was spent, and the parameters relative to where they ended.

    entries: [{"spent", "chi2", "kind", "fidelity", "parameters"}] with kind "accepted", "refused" or "differences" and
    fidelity "fine", "coarse" or "other" (another edge assumption); names: [(name, how it is written)].
    """
    fig, (left, right) = figure(860, 300, 1, 2)
    looks = {"fine": (ACCENT, "o", ""), "coarse": (ACCENT_LIGHT, "s", "coarse, "), "other": (SAND, "D", "other edge, ")}
    main = [e for e in entries if e["fidelity"] != "other"]
    light_grid(left)
    for fidelity, (colour, marker, prefix) in looks.items():
        mine = [e for e in entries if e["fidelity"] == fidelity]
        taken = [e for e in mine if e["kind"] == "accepted"]
        refused = [e for e in mine if e["kind"] == "refused"]
        if taken:
            left.step([e["spent"] for e in taken] + [mine[-1]["spent"]], [e["chi2"] for e in taken] + [taken[-1]["chi2"]],
                      where="post", color=colour, linewidth=1.5)
            left.plot([e["spent"] for e in taken], [e["chi2"] for e in taken], marker, color=colour, markersize=6,
                      label=prefix + "accepted")
        if refused:
            left.plot([e["spent"] for e in refused], [e["chi2"] for e in refused], marker, color=colour, markersize=6,
                      markerfacecolor="white", label=prefix + "not taken")
    values = [e["chi2"] for e in entries]
    if max(values) > 10 * min(values) > 0:
        left.set_yscale("log")
    differenced = [e["spent"] for e in entries if e["kind"] == "differences"]
    if differenced:
        left.plot(differenced, [0.02] * len(differenced), "|", color=QUIET, markersize=9, label="differences taken",
                  transform=left.get_xaxis_transform())
    left.set_title("misfit χ²")
    left.legend(fontsize=10.5)

    light_grid(right)
    path = [e for e in main if e["kind"] == "accepted"]
    end = path[-1]["parameters"] if path else {}
    for j, (name, written) in enumerate(names):
        if not finite(end.get(name)) or end[name] == 0 or not all(finite(e["parameters"].get(name)) for e in main):
            continue
        colour = SHADES[j % len(SHADES)]
        right.step([e["spent"] for e in path] + [main[-1]["spent"]],
                   [e["parameters"][name] / end[name] for e in path] + [1], where="post", linewidth=1.5, color=colour)
        right.plot([e["spent"] for e in path], [e["parameters"][name] / end[name] for e in path],
                   MARKERS[j % len(MARKERS)], color=colour, markersize=5, label=written)
        refused = [e for e in main if e["kind"] == "refused"]
        right.plot([e["spent"] for e in refused], [e["parameters"][name] / end[name] for e in refused],
                   MARKERS[j % len(MARKERS)], color=colour, markersize=5, markerfacecolor="white")
    right.axhline(1, color=QUIET, linewidth=0.8, zorder=0)
    right.set_title("parameters, relative to where they ended")
    right.legend(ncols=2, fontsize=10.5)
    for ax in (left, right):
        ax.set_xlabel(entries[0]["unit"])
        ax.set_xlim(left=0)
    return svg(fig, "misfit and parameters along the search")
