"""What one simulated cut looked like: its file, and the figures drawn from it."""

import json
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from matplotlib.patches import Polygon
from matplotlib.tri import Triangulation

from .page import finite, large_unit, with_error
from .style import (ACCENT, ACCENT_LIGHT, ACCENT_PALE, INK, QUIET, SAND, STRAIN, WARM, WARM_LIGHT, figure,
                    light_grid, svg)

# In the file forces are N/mm and energies N mm/mm; the page speaks N/m and J/m.
N_PER_M = 1000.0

LEDGER = [("fracture", "fracture", ACCENT), ("plastic", "plastic flow", ACCENT_LIGHT), ("friction", "friction", WARM),
          ("damping", "damping", WARM_LIGHT), ("elastic", "elastic", SAND), ("kinetic", "kinetic", "#8f9c9f")]


@dataclass
class Cut:
    path: Path
    title: str
    code_version: str
    scene: str
    result: dict
    history: dict
    ledger: dict
    particles: dict
    faces: dict
    tool: dict


class Unreadable(Exception):
    """A file that is not what it should be; the message begins with its name."""


def read_cut(path):
    """Raises Unreadable when `path` is not a file of `kerf simulate -o`."""
    def columns(group):
        return {name: item[...] for name, item in group.items() if isinstance(item, h5py.Dataset)}

    try:
        with h5py.File(path, "r") as file:
            return Cut(path=Path(path), title=str(file.attrs["title"]), code_version=str(file.attrs["code_version"]),
                       scene=str(file.attrs["scene"]), result=json.loads(file.attrs["result"]),
                       history=columns(file["history"]), ledger=columns(file["history/ledger"]),
                       particles=columns(file["particles"]), faces=columns(file["faces"]),
                       tool={name: float(values[0]) for name, values in columns(file["tool"]).items()})
    except (OSError, KeyError, ValueError) as error:
        raise Unreadable(f"{path}: not a cut that `kerf simulate -o` wrote ({error})") from error


def force_history(cut):
    """F_c and F_t against tool travel; the steady part shaded, its mean and standard error drawn."""
    travel = cut.history["travel"]
    factor, unit = large_unit("N/m", list(cut.history["F_c"] * N_PER_M))
    start = cut.result["steady_from"] if cut.result["steady"] and cut.result["steady_from"] < travel[-1] else None
    fig, axes = figure(860, 330)
    light_grid(axes)
    axes.axhline(0, color=QUIET, linewidth=0.8)
    for key, label, colour in [("F_c", "F_c", ACCENT), ("F_t", "F_t", WARM)]:
        axes.plot(travel, cut.history[key] * N_PER_M * factor, color=colour, linewidth=1.6)
        value, error = cut.result[key]["value"], cut.result[key]["se"]
        if value is None:
            continue
        value, error = value * factor, error * factor if error is not None else None
        if start is not None:
            axes.plot([start, travel[-1]], [value, value], color=INK, linewidth=0.9, linestyle=(0, (4, 3)))
            if error:
                axes.fill_between([start, travel[-1]], value - 2 * error, value + 2 * error, color=colour, alpha=0.25,
                                  linewidth=0)
        axes.annotate(f"{label} = {with_error(value, error, unit)}", (travel[-1], value), xytext=(10, 0),
                      textcoords="offset points", va="center", color=colour,
                      annotation_clip=False)
    if start is not None:
        axes.axvspan(start, travel[-1], color=ACCENT_PALE, zorder=0, linewidth=0)
        axes.text(start, 1.0, " steady", transform=axes.get_xaxis_transform(), va="top",
                  color=ACCENT, fontsize=11)
    axes.set_xlim(0, travel[-1])
    axes.set_xlabel("tool travel, mm")
    axes.set_ylabel(f"force per width, {unit}")
    return svg(fig, "cutting and transverse force against tool travel")


def r_curve(cut):
    """Resistance against crack extension of a specimen, read at the grips and at the notch."""
    curve = cut.result["r_curve"]
    fig, axes = figure(700, 300)
    light_grid(axes)
    notch = [a + b if finite(a) and finite(b) else np.nan for a, b in zip(curve["notch_I"], curve["notch_II"])]
    axes.plot(curve["extension"], notch, color=WARM, linewidth=1.6, linestyle=(0, (5, 2)), label="at the notch")
    axes.plot(curve["extension"], [np.nan if v is None else v for v in curve["G_R"]], color=ACCENT, linewidth=2,
              label="at the grips")
    axes.set_xlabel("crack extension, mm")
    axes.set_ylabel("resistance G_R, J/m²")
    axes.set_ylim(bottom=0)
    axes.legend()
    return svg(fig, "resistance of a specimen against the extension of its crack")


def chip_picture(cut, field="plastic_strain", label="equivalent plastic strain"):
    """Particles coloured by a field, the tool's outline and the crack's faces."""
    position = cut.particles["position"]
    if len(position) == 0:
        return None
    x, y = position[:, 0], position[:, 1]
    values = cut.particles[field]
    tool, depth = cut.tool, cut.tool["depth"]
    specimen = "r_curve" in cut.result
    left, right = tool["tip_x"] - 3.2 * depth, tool["tip_x"] + 4.8 * depth
    if specimen:
        left, right = x.min() - 0.3 * depth, x.max() + 0.3 * depth
    inside = (x > left) & (x < right)
    bottom = y.min() - 0.3 * depth if specimen else max(y.min(), tool["tip_y"] - 1.9 * depth)
    top = y[inside].max() + 0.35 * depth if inside.any() else y.max()
    width = 860
    fig, axes = figure(width, max(260, (width - 120) * (top - bottom) / (right - left) + 60))
    axes.set_aspect("equal")
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    points_per_mm = (width - 130) / (right - left)
    lowest = 0 if field == "plastic_strain" else values.min()
    highest = lowest + _readable_maximum(values[inside] - lowest)
    colours = dict(cmap=STRAIN, vmin=lowest, vmax=highest, rasterized=True)
    spacing = tool["particle_spacing"]
    for side in (1, -1):
        chosen = inside & (cut.particles["side"] == side)
        fill_between_particles(axes, position[chosen], values[chosen], 3.2 * spacing, colours)
    dots = axes.scatter(x[inside], y[inside], c=values[inside], s=(1.15 * spacing * points_per_mm) ** 2, marker="s",
                        linewidths=0, **colours)
    for points in cut.faces.values():
        shown = (points[:, 0] > left) & (points[:, 0] < right) & (points[:, 1] < y.max())  # not past the chip's end
        line = np.where(shown[:, None], points, np.nan)
        gaps = np.linalg.norm(np.diff(points, axis=0), axis=1) > 4 * spacing  # where markers have left the window
        line[1:][gaps] = np.nan
        axes.plot(line[:, 0], line[:, 1], color=WARM, linewidth=1.2)
    if not specimen:
        for outline in tool_outlines(tool, left, right, top, bottom):
            axes.add_patch(Polygon(outline, closed=True, facecolor="#f4f1ea", edgecolor=INK, linewidth=1.2, zorder=0.5))
        inward = sum(_tool_faces(tool))  # half-way between the rake face and the clearance face
        axes.text(*(np.array([tool["tip_x"], tool["tip_y"]]) + 1.7 * depth * inward / np.linalg.norm(inward)), "tool",
                  color=QUIET, ha="center", va="center", zorder=0.6, clip_on=True)
    axes.set_xlabel("x, mm")
    axes.set_ylabel("y, mm")
    bar = fig.colorbar(dots, ax=axes, shrink=0.85, aspect=24, pad=0.015)
    bar.outline.set_visible(False)
    bar.set_label(label)
    return svg(fig, f"the chip at the end of the cut, coloured by {label}")


def fill_between_particles(axes, position, strain, reach, colours):
    """Where the chip has stretched, rows of particles stand apart though the material does not: join neighbours."""
    if len(position) < 3:
        return
    mesh = Triangulation(position[:, 0], position[:, 1])
    corners = position[mesh.triangles]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    mesh.set_mask(edges.max(axis=1) > reach)
    axes.tripcolor(mesh, strain, shading="gouraud", **colours)


def _readable_maximum(strain):
    """The few particles beside the crack strain most; they must not wash out the rest."""
    return max(float(np.percentile(strain, 98.5)), 1e-6) if len(strain) else 1.0


def _tool_faces(tool):
    """Unit vectors from the tip up the rake face and back along the clearance face."""
    clearance = tool.get("clearance", np.radians(12))
    return (np.array([-np.sin(tool["rake"]), np.cos(tool["rake"])]),
            np.array([-np.cos(clearance), np.sin(clearance)]))


def tool_outlines(tool, left, right, top, bottom):
    """The parts of the tool as polygons: blade (its tip sharp or round), chip breaker, sole."""
    apex = np.array([tool["tip_x"], tool["tip_y"]])
    rake_face, clearance_face = _tool_faces(tool)
    far = (top - bottom + right - left) * 2
    radius = tool.get("tip_radius", 0.0)
    tip = [apex]
    if radius > 0:
        centre = apex + np.array([-radius * (1 + np.sin(tool["rake"])) / np.cos(tool["rake"]), radius])
        clearance = tool.get("clearance", np.radians(12))
        angles = np.linspace(tool["rake"], -np.pi / 2 - clearance, 40)
        tip = list(centre + radius * np.column_stack([np.cos(angles), np.sin(angles)]))
    up, back = tip[0] + rake_face * far, tip[-1] + clearance_face * far
    blade = [up, *tip, back, [min(up[0], back[0]), max(up[1], back[1])]]
    outlines = [blade]
    if "breaker_distance" in tool:
        foot = apex + tool["breaker_distance"] * rake_face
        face = np.array([-np.sin(tool["breaker_angle"]), np.cos(tool["breaker_angle"])])
        end = foot + tool["breaker_land"] * face
        behind = np.array([-np.cos(tool["breaker_angle"]), -np.sin(tool["breaker_angle"])])
        outlines.append([foot, end, end + behind * far, foot + behind * far])
    if "mouth" in tool:
        wall, low = tool["tip_x"] + tool["mouth"], tool["depth"]
        radius = tool["mouth_radius"]
        angles = np.linspace(np.pi, 1.5 * np.pi, 20)
        corner = np.array([wall + radius, low + radius]) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
        outlines.append([[wall, top + far], *corner, [right + far, low], [right + far, top + far]])
    return outlines


def energy_ledger(cut):
    """Where the tool's work went: final shares as one bar, and their growth along the cut."""
    total = cut.ledger["tool_work"]
    if len(total) == 0 or not total[-1] > 0:
        return None
    fig, (bar, growth) = figure(860, 330, 2, 1, height_ratios=[1, 3.2])
    shares = [(label, colour, cut.ledger[key][-1] / total[-1]) for key, label, colour in LEDGER]
    residue = cut.ledger["residue"][-1] / total[-1]
    start = 0.0
    for label, colour, share in shares:
        if share <= 0:
            continue
        bar.barh(0, share, left=start, color=colour, edgecolor="white", linewidth=1, height=0.8)
        if share > 0.07:
            dark = colour in (ACCENT, WARM)
            bar.text(start + share / 2, 0, f"{label} {100 * share:.1f} %", ha="center", va="center",
                     color="white" if dark else INK, fontsize=11)
        start += share
    if residue > 0.002:
        bar.barh(0, residue, left=start, facecolor="white", edgecolor=WARM, linewidth=1, height=0.78)
    bar.set_xlim(0, max(1.0, start))
    bar.axis("off")
    bar.set_title(f"share of the tool’s work at the end of the cut; unexplained residue {100 * residue:+.2f} %")

    travel = cut.history["travel"]
    light_grid(growth)
    growth.stackplot(travel, *[np.maximum(cut.ledger[key], 0) for key, _, _ in LEDGER],
                     colors=[colour for _, _, colour in LEDGER], labels=[label for _, label, _ in LEDGER], linewidth=0)
    growth.plot(travel, total, color=INK, linewidth=1.4, label="tool work")
    growth.set_xlim(0, travel[-1])
    growth.set_ylim(0, None)
    growth.set_xlabel("tool travel, mm")
    growth.set_ylabel("energy per width, J/m")
    handles, labels = growth.get_legend_handles_labels()
    growth.legend(handles[::-1], labels[::-1], loc="upper left")
    return svg(fig, "energy ledger of the cut")
