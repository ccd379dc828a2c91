#!/usr/bin/python3
"""Draws the README's figures of the virtual experiments from the tables of sweeps and studies.

Usage: scripts/figures.py RESULTS OUTPUT     RESULTS/NAME as scripts/virtual_experiments.sh leaves them
"""

import csv
import json
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import numpy as np  # noqa: E402
from figures_of_bodies import bodies, bodies_precision, contact, layers  # noqa: E402
from matplotlib.patches import Circle, Polygon  # noqa: E402
from PIL import Image  # noqa: E402
from report.cut import fill_between_particles, read_cut, tool_outlines  # noqa: E402
from report.study import draw_estimates, draw_work_precision, legend_of, read_study  # noqa: E402
from report.style import ACCENT, INK, QUIET, SAND, STRAIN, WARM, figure, light_grid  # noqa: E402

# What the paper prints (Nairn 2016): forces in J/m^2 against depth in mm for a chip breaker and a mouth of 1.2 mm.
PAPER_EXPONENTIAL = (233.0, 6.72)
POLYMER = ["yield_stress=25MPa", "toughness=2000J/m^2"]


def table(results, name):
    """The rows of a sweep, numbers as numbers, units off the column names; empty when the sweep was not run."""
    file = results / name / "sweep.csv"
    if not file.exists():
        return []
    with open(file, newline="") as stream:
        return [{key.split("[")[0]: _number(value) for key, value in row.items()} for row in csv.DictReader(stream)]


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text


def predict(model, *keys):
    """F_c of a closed form in N/m; None where the model says it does not hold."""
    done = subprocess.run([ROOT / "build/release/kerf", "predict", model, "--json", *keys], capture_output=True, text=True)
    if done.returncode:
        return None
    answer = json.loads(done.stdout)
    return answer["F_c"]["value"] if answer["valid"] else None


def points(axes, rows, x, colour, label, y="F_c", scale=1e-3):
    """Accepted runs filled (bending: diamonds), refused ones open; joined by a thin line."""
    kept = [row for row in rows if isinstance(row[y], float)]
    axes.plot([row[x] for row in kept if row["verdict"] == "accepted"],
              [row[y] * scale for row in kept if row["verdict"] == "accepted"], color=colour, linewidth=1, alpha=0.6)
    for row in kept:
        axes.errorbar(row[x], row[y] * scale, 2 * row[y + "_se"] * scale if y + "_se" in row else None,
                      fmt="D" if row["branch"] == "bending" else "o", markersize=6, color=colour, ecolor=colour,
                      markerfacecolor=colour if row["verdict"] == "accepted" else "white", zorder=3)
    axes.plot([], [], "o-", color=colour, label=label)


def curve(axes, xs, values, colour, style):
    pairs = [(x, value * 1e-3) for x, value in zip(xs, values) if value is not None]
    if pairs:
        axes.plot(*zip(*pairs), color=colour, linestyle=style, linewidth=1.3)


def talk(results):
    fig, axes = figure(900, 400, 1, 2, sharey=True)
    depths = np.linspace(0.05, 2, 30)
    for ax, name, title, hardening in zip(axes, ("talk", "talk_hardening"), ("perfectly plastic", "linear hardening"),
                                          (0, 0.05)):
        light_grid(ax)
        rows = table(results, name)
        for rake, colour in ((15, WARM), (30, SAND), (45, ACCENT)):
            mine = [row for row in rows if row["tool.rake"] == rake]
            points(ax, mine, "cut.depth", colour, f"rake {rake}°")
            if not hardening:
                curve(ax, depths, [predict("shear_minimised", f"depth={h}mm", f"rake={rake}deg", "toughness=2000J/m^2",
                                           f"yield_stress={25 * 2 / 3**0.5}MPa") for h in depths], colour, "--")
            curve(ax, depths, [predict("plastic_bending", f"depth={h}mm", f"rake={rake}deg", *POLYMER,
                                       "elastic_modulus=1000MPa", f"hardening_ratio={hardening}") for h in depths],
                  colour, ":")
            deep = np.linspace(0.1, 2, 11)
            curve(ax, deep, [predict("cohesive_beam", f"depth={h}mm", f"rake={rake}deg", *POLYMER, "strength=40MPa",
                                     "elastic_modulus=1000MPa", f"hardening_ratio={hardening}") for h in deep],
                  colour, "-.")
        ax.set_xlabel("depth of cut, mm")
        ax.set_title(title)
        ax.set_ylim(0, 32)
        ax.set_xlim(0, 2.1)
    axes[0].set_ylabel("F_c, N/mm")
    axes[0].plot([], [], color=QUIET, linestyle="--", linewidth=1.3, label="shear plane, (4)")
    axes[1].plot([], [], color=QUIET, linestyle=":", linewidth=1.3, label="plastic bending, (5–6)")
    axes[1].plot([], [], color=QUIET, linestyle="-.", linewidth=1.3, label="beam on its cohesive foundation")
    axes[1].plot([], [], "D", color=QUIET, label="crack ahead of the tool")
    axes[0].legend(loc="upper left")
    axes[1].legend(loc="upper left")
    return fig


def effects(results):
    fig, axes = figure(900, 520, 2, 2)
    for ax, name, x, label in ((axes[0, 0], "talk_strength", "cohesive.mode_I.strength+cohesive.mode_II.strength",
                                "cohesive strength, MPa"),
                               (axes[0, 1], "talk_toughness", "cohesive.mode_I.toughness+cohesive.mode_II.toughness",
                                "toughness, kJ/m²"),
                               (axes[1, 0], "talk_rake", "tool.rake", "rake angle, deg"),
                               (axes[1, 1], "talk_friction", "friction.coefficient", "coefficient of friction")):
        light_grid(ax)
        points(ax, table(results, name), x, ACCENT, "simulated")
        ax.set_xlabel(label)
        ax.set_ylabel("F_c, N/mm")
        ax.set_ylim(0, None)
    curve(axes[0, 1], G := np.linspace(0.2, 4, 20),
          [predict("shear_minimised", "depth=0.5mm", "rake=45deg", f"toughness={g}kJ/m^2", "yield_stress=28.87MPa")
           for g in G], QUIET, "--")
    curve(axes[1, 0], R := np.linspace(5, 60, 23),
          [predict("shear_minimised", "depth=0.5mm", f"rake={r}deg", "toughness=2kJ/m^2", "yield_stress=28.87MPa")
           for r in R], QUIET, "--")
    curve(axes[1, 1], M := np.linspace(0, 0.6, 13),
          [predict("shear_minimised", "depth=0.5mm", "rake=45deg", "toughness=2kJ/m^2", "yield_stress=28.87MPa",
                   f"friction={m}") for m in M], QUIET, "--")
    axes[0, 1].plot([], [], color=QUIET, linestyle="--", linewidth=1.3, label="shear plane, (4)")
    axes[0, 1].legend(loc="upper left")
    return fig


def bottom(results):
    """F_t against F_c with and without the force on the tool's bottom; Eq. (1) with the simulated bottom force."""
    fig, ax = figure(520, 400)
    light_grid(ax)
    sharp = [row for row in table(results, "talk") if row["tool.rake"] == 45]
    worn = table(results, "talk_edge")
    sets = [(sharp, ACCENT, "sharp edge")] + [
        ([row for row in worn if row["edge_contact.press_in"] == press_in], colour, f"edge pressed in {press_in:g} h")
        for press_in, colour in ((0.005, SAND), (0.01, WARM), (0.02, INK))]
    for rows, colour, label in sets:
        rows = [row for row in rows if row["verdict"] == "accepted" and row["branch"] == "touching"]
        if not rows:
            continue
        force = np.array([row["F_c"] for row in rows]) * 1e-3
        ax.plot(force, [row["F_t"] * 1e-3 for row in rows], "o", color=colour, label=label)
        edge = np.array([row["faces.bottom_normal"] for row in rows]) * 1e-3
        order = np.argsort(force)
        ax.plot(force[order], (-force + edge)[order], color=colour, linewidth=1.2, linestyle="--")
    ax.plot([], [], color=QUIET, linestyle="--", linewidth=1.2, label="F_t = Z F_c + (1 − μZ) F_b")
    ax.set_xlabel("F_c, N/mm")
    ax.set_ylabel("F_t, N/mm")
    ax.legend(loc="lower left")
    return fig


def wood(results):
    fig, (left, right) = figure(900, 400, 1, 2)
    rl = table(results, "wood_rl")
    light_grid(left)
    points(left, rl, "cut.depth", ACCENT, "simulated", scale=1)
    keys = ["rake=45deg", "elastic_modulus=14500MPa", "plane=stress", "yield_stress=100MPa", "root_rotation=1.586",
            "poisson_ratio=0.37", "toughness=158J/m^2"]
    depths = np.linspace(0.05, 0.5, 19)
    for a, colour in ((0, QUIET), (0.3, SAND)):
        values = [predict("plastic_bending", f"depth={d}mm", *keys, f"hardening_ratio={a}") for d in depths]
        pairs = [(d, v) for d, v in zip(depths, values) if v is not None]
        if pairs:
            left.plot(*zip(*pairs), color=colour, linestyle=":", label=f"plastic bending (5–6), a = {a}")
    beam = ["rake=45deg", "elastic_modulus=14500MPa", "modulus_across=960MPa", "shear_modulus=830MPa", "plane=stress",
            "poisson_ratio=0.087", "yield_stress=100MPa", "shape=sawtooth", "strength=4MPa", "toughness=158J/m^2",
            "peak=0.1", "shear_shape=sawtooth", "shear_strength=6.24MPa", "shear_toughness=474J/m^2", "shear_peak=0.1"]
    depths = np.linspace(0.1, 0.5, 9)
    values = [predict("cohesive_beam", f"depth={d}mm", *beam) for d in depths]
    pairs = [(d, v) for d, v in zip(depths, values) if v is not None]
    if pairs:
        left.plot(*zip(*pairs), color=WARM, linestyle="--", label="beam on its cohesive foundation")
    for row in rl:
        left.annotate(f"{100 * row['mode_I_fraction']:.0f} %", (row["cut.depth"], row["F_c"]), xytext=(0, -18),
                      textcoords="offset points", ha="center", fontsize=10, color=QUIET)
    left.set_title("RL, no bridging (share of mode I below the points)")
    tl = table(results, "wood_tl")
    light_grid(right)
    for what, colour, level, name in (("cuts", ACCENT, 215, "G_init"), ("ignores", WARM, 620, "G_total")):
        rows = [row for row in tl if row["bridging.tool"] == what]
        points(right, rows, "cut.depth", colour, f"the edge {what} bridging fibres", scale=1)
        right.axhline(level, color=colour, linewidth=0.8, alpha=0.7)
        right.text(0.5, level + 12, name, ha="right", color=colour, fontsize=10.5)
        if len(rows) >= 3:
            fit = np.polyfit([row["cut.depth"] for row in rows], [row["F_c"] for row in rows], 2)
            d = np.linspace(0, rows[0]["cut.depth"], 20)
            right.plot(d, np.polyval(fit, d), color=colour, linestyle="--", linewidth=1.2)
    right.set_title("TL, quadratic extrapolation to zero depth")
    for ax in (left, right):
        ax.set_xlabel("depth of cut, mm")
        ax.set_ylim(0, None)
        ax.set_xlim(0, 0.53)
        ax.legend(loc="upper left" if ax is right else "lower right", fontsize=10)
    left.set_ylabel("F_c, N/m")
    return fig


def plane(results):
    fig, (left, right) = figure(900, 400, 1, 2)
    light_grid(left)
    points(left, table(results, "plane_m12"), "cut.depth", ACCENT, "mouth 1.2 mm", scale=1)
    m4 = table(results, "plane_m4")
    for friction, colour, label in (("", WARM, "mouth 4 d"), (0.3, INK, "mouth 4 d, μ = 0.3")):
        points(left, [row for row in m4 if row["friction.coefficient"] == friction], "cut.depth", colour, label, scale=1)
    d = np.linspace(0.05, 0.5, 40)
    left.plot(d, PAPER_EXPONENTIAL[0] * np.exp(PAPER_EXPONENTIAL[1] * d), color=QUIET, linestyle="--", linewidth=1.2,
              label="published fit, 233 exp(6.72 d)")
    left.set_xlabel("depth of cut, mm")
    left.set_ylabel("F_c, N/m")
    left.set_ylim(0, 9000)
    left.legend(loc="upper left", fontsize=10)
    light_grid(right)
    tip = [row for row in table(results, "plane_tip") if isinstance(row["F_c"], float)]
    points(right, tip, "tool.tip_radius", ACCENT, "F_c", scale=1)
    points(right, tip, "tool.tip_radius", WARM, "F_t", y="F_t", scale=1)
    right.axhline(0, color=QUIET, linewidth=0.8)
    right.set_xlabel("edge radius, mm")
    right.set_ylabel("force per width, N/m")
    right.legend(loc="center right")
    return fig


def chips(results):
    """The steady chips behind a chip breaker for four mouths, coloured by plastic strain."""
    openings = [row["sole.opening_in_depths"] for row in table(results, "plane_mouth")]
    fig, axes = figure(900, 260, 1, max(len(openings), 1), sharey=True)
    for number, (ax, opening) in enumerate(zip(np.atleast_1d(axes), openings), 1):
        cut = read_cut(results / "plane_mouth" / "cuts" / f"{number:03}.h5")
        tool, position = cut.tool, cut.particles["position"]
        left, right, bottom, top = tool["tip_x"] - 1.9, tool["tip_x"] + 1.6, -0.3, 2.2
        for outline in tool_outlines(tool, left, right, top, bottom):
            ax.add_patch(Polygon(outline, closed=True, facecolor="#f4f1ea", edgecolor=INK, linewidth=1))
        ax.scatter(position[:, 0], position[:, 1], c=cut.particles["plastic_strain"], s=14, marker="s", linewidths=0,
                   cmap=STRAIN, vmin=0, vmax=0.3)
        ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=[], yticks=[],
               title=f"m = {opening:g} d, F_c = {cut.result['F_c']['value']:.0f} N/m")
        for spine in ax.spines.values():
            spine.set_visible(False)
    return fig


def laws(results):
    """Plastic strain and equivalent stress of one cut under both elastic laws."""
    titles = {"j2": "hypoelastic, Jaumann rate (j2)", "hencky": "hyperelastic, logarithmic strain (hencky)"}
    maps = [("plastic_strain", "equivalent plastic strain", 0.6), ("equivalent_stress", "equivalent stress, MPa", 25)]
    fig, axes = figure(900, 690, 2, 2, sharex=True, sharey=True)
    for column, row in enumerate(table(results, "laws")):
        cut = read_cut(results / "laws" / "cuts" / f"{column + 1:03}.h5")
        tool, position, side = cut.tool, cut.particles["position"], cut.particles["side"]
        left, right, bottom, top = -1.05, 1.15, -0.45, 1.45
        shown = (np.abs(position[:, 0] - tool["tip_x"]) < 2) & (position[:, 1] < top + 0.2)
        for ax, (field, label, most) in zip(axes[:, column], maps):
            colours = dict(cmap=STRAIN, vmin=0, vmax=most, rasterized=True)
            for one in (1, -1):
                chosen = shown & (side == one)
                fill_between_particles(ax, position[chosen] - [tool["tip_x"], 0], cut.particles[field][chosen],
                                       3.2 * tool["particle_spacing"], colours)
            for outline in tool_outlines(tool | {"tip_x": 0.0}, left, right, top, bottom):
                ax.add_patch(Polygon(outline, closed=True, facecolor="#f4f1ea", edgecolor=INK, linewidth=1))
            ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=(-1, -0.5, 0, 0.5, 1),
                   yticks=(0, 0.5, 1))
            if column == 1:
                bar = fig.colorbar(ax.collections[0], ax=axes[maps.index((field, label, most))], shrink=0.85, aspect=24,
                                   pad=0.015, extend="max" if field == "plastic_strain" else "neither")
                bar.outline.set_visible(False)
                bar.set_label(label)
        axes[0, column].set_title(f"{titles[row['material.law']]}\nF_c = {row['F_c']:.0f} ± {row['F_c_se']:.0f} N/m")
        axes[1, column].set_xlabel("x from the edge, mm")
    for ax in axes[:, 0]:
        ax.set_ylabel("y, mm")
    return fig


def veneer(results):
    """The log after half a turn, and the ribbon at the knife, coloured by plastic strain."""
    cut = read_cut(results / "veneer.h5")
    scene = tomllib.loads(cut.scene)
    bar_lead, bar_radius, compression = (float(scene["nose_bar"][key].split()[0])  # mm
                                         for key in ("lead", "radius", "compression"))
    x, y = cut.particles["position"].T
    strain, tip, depth, spacing = cut.particles["plastic_strain"], cut.tool, cut.tool["depth"], cut.tool["particle_spacing"]
    x = x - tip["tip_x"]
    fig, axes = figure(980, 430, 1, 2, width_ratios=(1, 1.5))
    for ax, (left, right, bottom, top) in zip(axes, [(-8.6, 8.6, -16.4, 1.9), (-2.2, 1.6, -1.1, 1.6)]):
        ax.set_xlim(left, right)
        ax.set_ylim(bottom, top)
        ax.set_aspect("equal")
        ax.set_xlabel("x, mm")
        inside = (x > left) & (x < right) & (y > bottom) & (y < top)
        per_mm = ax.get_window_extent().width * 72 / fig.dpi / (right - left)
        dots = ax.scatter(x[inside], y[inside], c=strain[inside], s=(1.3 * spacing * per_mm) ** 2, marker="s",
                          linewidths=0, cmap=STRAIN, vmin=0, vmax=0.12, rasterized=True)
        for face in cut.faces.values():
            ax.plot(face[:, 0] - tip["tip_x"], face[:, 1], ",", color=WARM)
        moved = dict(tip, tip_x=0.0)
        for outline in tool_outlines(moved, left, right, top, bottom):
            ax.add_patch(Polygon(outline, closed=True, facecolor="#f4f1ea", edgecolor=INK, linewidth=1.2, zorder=0.5))
        centre = (bar_lead, depth - compression + bar_radius)
        ax.add_patch(Circle(centre, bar_radius, facecolor="#f4f1ea", edgecolor=INK, linewidth=1.2, zorder=0.5))
    axes[0].set_ylabel("y, mm")
    bar = fig.colorbar(dots, ax=axes[1], shrink=0.85, aspect=24, pad=0.02)
    bar.outline.set_visible(False)
    bar.set_label("equivalent plastic strain")
    return fig


def work_precision(results):
    """Error against cost, one knob at a time, of the studies that were run."""
    titles = {"study_polymer": "polymer, verification_45", "study_wood": "wood, wood_rl"}
    studies = {name: read_study(results / name) for name in titles if (results / name / "study.json").exists()}
    fig, axes = figure(140 + 420 * max(len(studies), 1.4), 430, 1, len(studies), sharey=True, squeeze=False)
    for ax, (name, study) in zip(axes[0], studies.items()):
        draw_work_precision(ax, study)
        ax.set_title(titles[name])
    axes[0][0].set_ylabel("error of the force, % of F_c")
    axes[0][-1].legend(handles=legend_of(studies.values()), loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0,
                       fontsize=10.5)
    return fig


def job_precision(results):
    """What a calibration finds at every preset, against core-seconds."""
    return draw_estimates(read_study(results / "study_job"))


# A figure and the result without which it cannot be drawn.
FIGURES = {"plane_chips": (chips, "plane_mouth"), "talk_forces": (talk, "talk"), "talk_effects": (effects, "talk_rake"),
           "bottom_force": (bottom, "talk_edge"), "wood_forces": (wood, "wood_rl"), "plane_forces": (plane, "plane_m12"),
           "laws": (laws, "laws"), "work_precision": (work_precision, "study_polymer"),
           "job_precision": (job_precision, "study_job/study.json"),
           "veneer": (veneer, "veneer.h5"), "contact": (contact, "hertz.json"),
           "bodies_precision": (bodies_precision, "study_bar"), "bodies": (bodies, "carnot_gas.json"),
           "layers": (layers, "laminate_45_30.json")}


def main():
    results, output = Path(sys.argv[1]), Path(sys.argv[2])
    for name, (draw, needed) in FIGURES.items():
        if not (results / needed).exists():
            print(f"{name}: left as it is, there is no {results / needed}", file=sys.stderr)
            continue
        try:
            fig = draw(results)
        except FileNotFoundError as error:
            print(f"{name}: left as it is, there is no {error.filename}", file=sys.stderr)
            continue
        file = output / f"{name}.png"
        fig.savefig(file, dpi=110, facecolor="white")
        with Image.open(file) as picture:  # a palette takes a third of the room
            picture.convert("RGB").quantize(128).save(file, optimize=True)
        print(file)


if __name__ == "__main__":
    main()
