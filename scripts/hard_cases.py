#!/usr/bin/env python3
"""Runs the hard cases (tests/verification/hard_cases.csv) and prints a table: verdict, force, ledger, cost.

Usage: scripts/hard_cases.py [--jobs N] [WORD...]     only cases whose name holds one of the words
"""

import argparse
import csv
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
KERF = ROOT / "build/release/kerf"


def simulate(case):
    """The result of one case as `kerf simulate --json` prints it."""
    settings = [word for change in case["settings"].split() for word in ("--set", change)]
    scene = ROOT / "data/scenes" / f"{case['scene']}.toml"
    done = subprocess.run([KERF, "simulate", scene, "--json", *settings], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        sys.exit(f"{case['case']}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def line(case, result):
    force, ledger = result["F_c"], result["ledger"]
    verdict = "accepted, " + result["branch"] if result["accepted"] else "refused: " + result["refusals"][0]
    return (f"{case['case']:<36}{force['value']:>8.0f} ±{force['se'] or float('nan'):>4.0f}"
            f"{100 * ledger['residue'] / ledger['tool_work']:>9.2f}"
            f"{result['fracture_energy_ratio']:>8.3f}{result['mode_I_fraction']:>8.2f}{result['cost']['processor_s']:>8.1f}   {verdict}")


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("words", nargs="*", help="only cases whose name holds one of these")
    arguments.add_argument("--jobs", type=int, default=os.cpu_count())
    options = arguments.parse_args()
    with open(ROOT / "tests/verification/hard_cases.csv", newline="") as file:
        cases = [case for case in csv.DictReader(file)
                 if not options.words or any(word in case["case"] for word in options.words)]
    print(f"{'case':<36}{'F_c, N/m':>14}{'residue, %':>11}{'G/G_c':>7}{'mode I':>8}{'core-s':>8}   verdict")
    with ThreadPoolExecutor(options.jobs) as pool:
        for case, result in zip(cases, pool.map(simulate, cases)):
            print(line(case, result), flush=True)


if __name__ == "__main__":
    main()
