#!/usr/bin/env python3
"""All optimisers on one twin problem: what does it cost to reach a misfit within the noise?

A curve of 3 rakes x 3 depths is simulated with known yield stress, toughness and friction, F_c and F_t get 2 % noise
(seeded), and every optimiser starts from the same far point. Printed per optimiser, once until chi^2 is within 1 of the
smallest that any found (one standard error of one parameter) and once until it stops by itself or its budget ends:
simulated fine and coarse cuts, fine-curve equivalents (core-seconds over those of one fine curve) and core-seconds.

    scripts/optimisers.py -o DIR [--fine 6] [--coarse 3] [--seed 1] [--curves 60] [--methods NAME ...]

DIR keeps the jobs; what is there is not run again. Takes some fifty minutes on two cores, the global searches most of them.
"""
import argparse
import json
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = (ROOT / "tests/recovery/twin.toml").read_text()

JOB = """title = "twin, 3 rakes x 3 depths"
scene = "scene.toml"
observables = ["F_c", "F_t"]
{curves}
[[free]]
path = "material.yield_stress"
lower = "10 MPa"
upper = "60 MPa"
start = "34 MPa"
[[free]]
path = "cohesive.mode_I.toughness"
lower = "800 J/m^2"
upper = "5 kJ/m^2"
start = "1300 J/m^2"
[[free]]
path = "friction.coefficient"
lower = 0.05
upper = 0.5
start = 0.3
[[tie]]
path = "cohesive.mode_II.toughness"
equals = 1
of = "cohesive.mode_I.toughness"
[budget]
max_runs = {max_runs}
"""

RAKES, DEPTHS, NOISE = (15, 30, 45), (0.2, 0.35, 0.6), 0.02

# name: ([optimiser] and further blocks, what it is)
METHODS = {
    "multi_fidelity": ('[optimiser]\nmethod = "multi_fidelity"\n[coarse]\n'
                       'changes = ["resolution.cells_through_chip={coarse}"]\n', "coarse runs, noise audit"),
    "closed_form": ('[optimiser]\nmethod = "multi_fidelity"\n[coarse]\nmodel = "closed_form"\n',
                    "multi_fidelity on Williams' form, audit"),
    "surrogate": ('[optimiser]\nmethod = "surrogate"\n', "multistart on a quadratic, noise audit"),
    "gauss_newton": ('[optimiser]\nmethod = "gauss_newton"\n', "noise audit"),
    "gauss_newton_fixed": ('[optimiser]\nmethod = "gauss_newton"\nstep = 0.04\nnoise = 0.001\n', "no audit"),
    "ceres_central": ('[optimiser]\nmethod = "levenberg_marquardt"\nstep = 0.1\nnoise = 0.001\ncentral = true\n',
                      "Ceres, hand-set central differences of 0.1"),
    "ceres_default": ('[optimiser]\nmethod = "levenberg_marquardt"\nstep = 1e-6\nnoise = 0.001\n',
                      "Ceres, its default step of 1e-6"),
    "bobyqa": ('[optimiser]\nmethod = "bobyqa"\naudit = false\n', "NLopt"),
    "sbplx": ('[optimiser]\nmethod = "sbplx"\naudit = false\n', "NLopt"),
    "crs2": ('[optimiser]\nmethod = "crs2"\naudit = false\n', "NLopt, global"),
    "mlsl": ('[optimiser]\nmethod = "mlsl"\naudit = false\n', "NLopt, global, BOBYQA inside"),
}


def run(command, log=None):
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=log or subprocess.PIPE, text=True)
    if process.returncode not in (0, 4, 6):
        sys.exit(f"{' '.join(map(str, command))} failed with {process.returncode}: {process.stderr}")
    return process.stdout


def with_values(text, **values):
    """The text with `key = value` in the place of every key's line."""
    for key, value in values.items():
        text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        assert count == 1, f"{key} stands {count} times"
    return text


def measure(kerf, folder, cells, seed):
    """Simulates the truth with fine cells and writes one noisy curve per rake; core-seconds of all of it."""
    noise = random.Random(seed)
    core_seconds, blocks = 0.0, ""
    for rake in RAKES:
        rows = [f"#: rake = {rake} deg", "depth[mm],Fc[N/m],Fc_sd[N/m],Ft[N/m],Ft_sd[N/m]"]
        for depth in DEPTHS:
            (folder / "truth.toml").write_text(with_values(SCENE, cells_through_chip=cells, depth=f'"{depth} mm"',
                                                           rake=f'"{rake} deg"'))
            cut = json.loads(run([kerf, "simulate", folder / "truth.toml", "-o", folder / "truth.h5", "--json"]))
            core_seconds += cut["cost"]["processor_s"]
            error = NOISE * cut["F_c"]["value"]
            F_c, F_t = (cut[name]["value"] + noise.gauss(0, error) for name in ("F_c", "F_t"))
            rows.append(f"{depth},{F_c:.6g},{error:.6g},{F_t:.6g},{error:.6g}")
        (folder / f"rake_{rake}.csv").write_text("\n".join(rows) + "\n")
        blocks += f'[[curve]]\nfile = "rake_{rake}.csv"\n'
    (folder / "scene.toml").write_text(with_values(SCENE, cells_through_chip=cells))
    (folder / "measured.json").write_text(json.dumps({"core_s_per_curve": core_seconds, "curves": blocks}))


def is_finished(folder):
    """Whether a calibration ended by itself: one that was stopped leaves a partial result."""
    result = folder / "result.json"
    return result.exists() and not json.loads(result.read_text()).get("partial")


class Search:
    """A finished calibration: its journal in order, and chi^2 after so many runs."""

    def __init__(self, folder):
        self.result = json.loads((folder / "result.json").read_text())
        lines = [json.loads(line) for line in (folder / "journal.jsonl").read_text().splitlines()]
        self.runs = [(line["label"].startswith("coarse"), line["run"]["result"]["cost"]["processor_s"])
                     for line in lines if "run" in line]

    def fine_trace(self):
        """What was reached with every cut: chi^2 of fewer cuts is smaller, of none zero."""
        return [entry for entry in self.result["trace"] if not entry["step"].startswith("coarse")
                and entry["chi2"] is not None and not entry["failed_cuts"]]

    def best(self):
        return min(entry["chi2"] for entry in self.fine_trace())

    def cost(self, runs):
        spent = self.runs[:runs]
        coarse = sum(1 for is_coarse, _ in spent if is_coarse)
        return len(spent) - coarse, coarse, sum(seconds or 0 for _, seconds in spent)

    def reach(self, chi2):
        for entry in self.fine_trace():
            if entry["chi2"] <= chi2:
                return entry["runs"]
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--kerf", default=str(pathlib.Path(__file__).parent.parent / "build/release/kerf"))
    parser.add_argument("--fine", type=int, default=6)
    parser.add_argument("--coarse", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--curves", type=int, default=60, help="budget of a search in curves")
    parser.add_argument("--methods", nargs="+", default=list(METHODS), choices=list(METHODS))
    options = parser.parse_args()
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "measured.json").exists():
        measure(options.kerf, folder, options.fine, options.seed)
    measured = json.loads((folder / "measured.json").read_text())

    searches = {}
    for name in options.methods:
        if not is_finished(folder / name):
            job = JOB.format(curves=measured["curves"], max_runs=options.curves * len(RAKES) * len(DEPTHS))
            (folder / f"{name}.toml").write_text(job + METHODS[name][0].replace("{coarse}", str(options.coarse)))
            print(f"{name} ...", file=sys.stderr, flush=True)
            command = ["resume", folder / name] if (folder / name).exists() else [
                "calibrate", folder / f"{name}.toml", "-o", folder / name]
            with open(folder / f"{name}.log", "a") as log:
                run([options.kerf, *command], log)
        searches[name] = Search(folder / name)

    least = min(search.best() for search in searches.values())
    curve = measured["core_s_per_curve"]
    print(f"smallest chi2 {least:.2f}; one fine curve costs {curve:.2f} core-s")
    print(f"{'':20}{'--- until chi2 < least + 1':>32}{'--- until it stops':>32}{'chi2':>8}  ends")
    print(f"{'':20}" + 2 * f"{'fine':>7}{'coarse':>7}{'curves':>8}{'core-s':>10}")
    for name, search in searches.items():
        row = f"{name:20}"
        for runs in (search.reach(least + 1), search.result["runs"]):
            if runs is None:
                row += f"{'never':>32}"
                continue
            fine, coarse, seconds = search.cost(runs)
            row += f"{fine:7}{coarse:7}{seconds / curve:8.1f}{seconds:10.1f}"
        print(row + f"{search.best():8.2f}  {METHODS[name][1]}: {search.result['reason']}")


if __name__ == "__main__":
    main()
