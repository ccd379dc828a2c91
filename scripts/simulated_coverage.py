#!/usr/bin/env python3
"""Do the 95 % intervals of whole calibrations by simulation hold the truth?

The twin of scripts/optimisers.py (3 rakes x 3 depths, F_c and F_t, yield stress, toughness and friction from a far
start) on coarse cuts: every trial adds its own 2 % noise (seeded) and is calibrated by kerf. All trials draw on one
folder of runs, so that the start and its differences are simulated once.

    scripts/simulated_coverage.py -o DIR [--trials 24] [--cells 3]

DIR keeps every trial and every run: begun again, the script goes on where it was stopped, also with more trials.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys

from optimisers import JOB, is_finished, measure

TRUTH = {"yield_stress": 25, "toughness": 2000, "friction": 0.2}  # MPa, J/m^2, 1: those of the scene
# By hand, instead of a noise audit for every trial.
OPTIMISER = '[optimiser]\nmethod = "gauss_newton"\nstep = 0.1\nnoise = 0.001\n'


def calibrate(kerf, folder, cells, trial, parallel):
    """The result of one trial, from its folder if it is finished."""
    place = folder / f"trial_{trial}"
    if not is_finished(place / "out"):
        place.mkdir(exist_ok=True)
        if not (place / "measured.json").exists():
            measure(kerf, place, cells, trial)
        curves = json.loads((place / "measured.json").read_text())["curves"]
        (place / "job.toml").write_text(JOB.format(curves=curves, max_runs=400) + OPTIMISER)
        command = [kerf, "resume", place / "out"] if (place / "out").exists() else [
            kerf, "calibrate", place / "job.toml", "-o", place / "out"]
        with open(place / "log", "a") as log:
            code = subprocess.run([*command, "--runs", folder / "runs", "--parallel", str(parallel)],
                                  stdout=subprocess.DEVNULL, stderr=log).returncode
        if code not in (0, 4, 6):
            sys.exit(f"trial {trial} ended with code {code}; see {place / 'log'}")
    return json.loads((place / "out/result.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--kerf", default=str(pathlib.Path(__file__).parent.parent / "build/release/kerf"))
    parser.add_argument("--trials", type=int, default=24)
    parser.add_argument("--cells", type=int, default=3, help="through the chip")
    parser.add_argument("--parallel", type=int, default=2, help="simulations at a time")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    held, converged = dict.fromkeys(TRUTH, 0), 0
    errors, values = {name: [] for name in TRUTH}, {name: [] for name in TRUTH}  # over the truth
    for trial in range(1, options.trials + 1):
        result = calibrate(options.kerf, options.output, options.cells, trial, options.parallel)
        converged += result["converged"]
        for name, truth in TRUTH.items():
            found = result["parameters"][name]
            lower, upper = found["interval"]
            held[name] += lower <= truth <= upper
            errors[name].append(found["se"] / truth)
            values[name].append(found["value"] / truth)
        print(f"trial {trial}: {result['runs']} cuts, chi2 {result['chi2']:.1f}", *(
            f"{name} {p['value']:.4g} [{p['interval'][0]:.4g}, {p['interval'][1]:.4g}]"
            for name, p in result["parameters"].items()), file=sys.stderr, flush=True)
    print(f"{converged} of {options.trials} converged; 95 % intervals that hold the truth:")
    for name, count in held.items():
        print(f"{name:15}{count:4} of {options.trials}   standard error {statistics.mean(errors[name]):.2%} in the mean, "
              f"scatter of the estimates {statistics.pstdev(values[name]):.2%}, their mean off by "
              f"{statistics.mean(values[name]) - 1:+.2%}")


if __name__ == "__main__":
    main()
