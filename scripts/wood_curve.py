#!/usr/bin/env python3
"""Makes the synthetic planing curves of data/sets/wood_tl_synthetic: simulated cuts of the scene wood_tl_draft with known
toughnesses, and 2 % seeded noise on F_c. Nobody measured them; they ask whether a calibration finds what went in.

    scripts/wood_curve.py [--initiation 215] [--bridging 405] [--tool cuts] [--seed 7] [--noise 0.02] > CURVE.csv
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEPTHS = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--initiation", default="215", help="J/m^2")
    parser.add_argument("--bridging", default="405", help="J/m^2")
    parser.add_argument("--tool", default="cuts", choices=["cuts", "ignores"])
    parser.add_argument("--noise", type=float, default=0.02)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--kerf", default=ROOT / "build/release/kerf")
    options = parser.parse_args()
    noise_c, noise_t = random.Random(options.seed), random.Random(options.seed + 1)
    print("#: rake = 45 deg\ndepth[mm],Fc[N/m],Fc_sd[N/m],Ft[N/m],Ft_sd[N/m]")
    for depth in DEPTHS:
        settings = [f"cut.depth={depth} mm", f"bridging.tool={options.tool}",
                    f"cohesive.mode_I.initiation_toughness={options.initiation} J/m^2",
                    f"cohesive.mode_I.bridging_toughness={options.bridging} J/m^2"]
        command = [options.kerf, "simulate", ROOT / "data/scenes/wood_tl_draft.toml", "--json"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"depth {depth} mm: {done.stderr.strip()}")
        cut = json.loads(done.stdout)
        F_c = cut["F_c"]["value"]
        error = options.noise * F_c
        F_c_measured = F_c + noise_c.gauss(0, error)
        F_t_measured = cut["F_t"]["value"] + noise_t.gauss(0, error)
        print(f"{depth},{F_c_measured:.5g},{error:.4g},{F_t_measured:.4g},{error:.4g}")
        print(f"depth {depth} mm: {F_c:.1f} N/m, {cut['cost']['processor_s']:.1f} core-s, {cut['branch']}", file=sys.stderr)


if __name__ == "__main__":
    main()
