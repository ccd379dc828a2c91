"""Figures of experiments on bodies."""

import numpy as np
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from report.bodies import draw_pressed, draw_velocity, read_bodies
from report.study import draw_error_against_cell, draw_work_precision, legend_of, read_study
from report.style import ACCENT, INK, QUIET, WARM, figure, light_grid


def experiment(results, name):
    """Results, history and closed forms of a scene of bodies, columns as arrays."""
    kept = read_bodies(results / f"{name}.json")
    return kept.results, kept.history, kept.closed_forms


def bodies(results):
    """Engine, metal, rubber band and glued bar."""
    fig, axes = figure(900, 700, 2, 2)
    _, gas, _ = experiment(results, "carnot_gas")
    colours = [WARM, INK, ACCENT, QUIET]
    for panel, x, y in ((axes[0, 0], gas["length"] / gas["length"][0], -gas["stress_xx"] * gas["length"][0] / gas["length"]),
                        (axes[0, 1], gas["entropy"] * 1e3, gas["temperature"])):
        for stroke in range(1, 5):
            part = np.flatnonzero(gas["stroke"] == stroke)
            part = part if part[0] == 0 else np.r_[part[0] - 1, part]
            panel.plot(x[part], y[part], color=colours[stroke - 1], linewidth=2,
                       label=f"{'isothermal' if stroke % 2 else 'adiabatic'} {'out' if stroke < 3 else 'back'}")
    axes[0, 0].set(title="ideal gas, Carnot cycle", xlabel="volume / first volume", ylabel="pressure, MPa")
    axes[0, 0].set_xscale("log")
    axes[0, 0].set_yscale("log")
    for axis, ticks in ((axes[0, 0].xaxis, (1, 2, 5, 10)), (axes[0, 0].yaxis, (0.05, 0.1, 0.2, 0.5, 1))):
        axis.set_major_locator(FixedLocator(ticks))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes[0, 0].legend(frameon=False)
    axes[0, 1].set(title="the same cycle", xlabel="entropy, µJ/(mm K)", ylabel="temperature, K")

    _, rubber, expected = experiment(results, "rubber_gough")
    stretch = rubber["length"] / rubber["length"][0]
    fast, slow = rubber["stroke"] == 3, rubber["stroke"] == 1
    axes[1, 0].plot(stretch[fast], rubber["temperature"][fast] - 293, color=WARM, linewidth=2, label="pulled fast")
    axes[1, 0].plot(stretch[slow], rubber["temperature"][slow] - 293, color=ACCENT, linewidth=2, label="pulled in a bath")
    axes[1, 0].plot(stretch[fast], expected["temperature"][fast] - 293, color=INK, linestyle=":", label="closed form")
    axes[1, 0].set(title="ideal rubber", xlabel="stretch", ylabel="temperature rise, K", xlim=(0.97, 3.03))
    axes[1, 0].legend(frameon=False)

    glue = [experiment(results, file.stem)[0] for file in results.glob("interface_bar_*.json")]
    glue.sort(key=lambda bar: bar["interface_stiffness"])
    D = np.array([bar["interface_stiffness"] for bar in glue])
    axes[1, 1].semilogx(D, [bar["effective_modulus"] for bar in glue], "o", color=WARM, label="simulated")
    ds = np.logspace(np.log10(D[0]), np.log10(D[-1]), 200)
    axes[1, 1].semilogx(ds, 1 / (1e-3 + 1 / (100 * ds)), color=INK, linestyle=":", label="bars and glue in series")
    axes[1, 1].set(title="bar with an imperfect interface", xlabel="stiffness D, MPa/mm", ylabel="effective modulus, MPa")
    axes[1, 1].legend(frameon=False)
    for panel in axes.flat:
        light_grid(panel)
    return fig


def large_number(value):
    exponent = int(np.floor(np.log10(value)))
    return f"{value:g}" if exponent < 4 else f"{value / 10**exponent:g}·10$^{exponent}$"


def layers(results):
    """A laminate at every angle, and Carnot's cycle of a metal that yields beside one that does not."""
    fig, axes = figure(980, 360, 1, 2)
    found = [experiment(results, file.stem)[0] for file in results.glob("laminate_*.json")]
    for D, colour in zip(sorted({one["interface_stiffness"] for one in found}), [WARM, ACCENT, INK]):
        mine = [one for one in found if one["interface_stiffness"] == D]
        angles = [one["interface_angle"] for one in mine]
        axes[0].plot(angles, [one["effective_modulus"] for one in mine], "o", color=colour,
                     label=f"D = {large_number(D)} MPa/mm")
        axes[0].plot(angles, [one["closed_form_modulus"] for one in mine], "_", color=colour, markersize=22,
                     markeredgewidth=1.5)
    axes[0].set(title="laminate pulled askew (dashes: closed form)", xlabel="angle from the layers' normal to the pull, deg",
                ylabel="effective modulus, MPa", xticks=range(0, 91, 15))
    axes[0].set_ylim(0, None)
    axes[0].legend(frameon=False)
    for name, colour, label in (("carnot_tungsten", ACCENT, "elastic"), ("carnot_tungsten_plastic", WARM, "yields")):
        _, metal, _ = experiment(results, name)
        axes[1].plot((metal["length"] / metal["length"][0] - 1) * 100, metal["stress_xx"], color=colour, linewidth=2,
                     label=label)
    axes[1].set(title="tungsten, Carnot cycle", xlabel="stretch, %", ylabel="stress along the piston's way, MPa")
    axes[1].legend(frameon=False)
    for panel in axes:
        light_grid(panel)
    return fig


def contact(results):
    """A block on an incline and a cylinder on a flat."""
    fig, axes = figure(980, 330, 1, 2)
    for ax, name, title, draw in [(axes[0], "incline", "block on an incline", draw_velocity),
                                  (axes[1], "hertz", "cylinder on a flat", draw_pressed)]:
        draw(ax, read_bodies(results / f"{name}.json"))
        ax.set_title(title)
    return fig


def bodies_precision(results):
    """Error of a bar's frequency against cost, one knob at a time, and against the cell."""
    study = read_study(results / "study_bar")
    fig, axes = figure(1010, 400, 1, 2, width_ratios=[3, 2])
    draw_work_precision(axes[0], study)
    axes[0].set(title="a vibrating bar", ylabel="frequency off by, %")
    axes[0].legend(handles=legend_of([study]), loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0, fontsize=9.5)
    draw_error_against_cell(axes[1], study)
    axes[1].set(title="cells alone")
    return fig
