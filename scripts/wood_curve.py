#!/usr/bin/env python3
"""Makes the synthetic curves of data/sets/wood_tl_synthetic: simulated cuts of the scene wood_tl_draft, or a pull on the
specimen dcb_rcurve, with known toughnesses and seeded noise. Nobody measured them; they ask whether a calibration finds
what went in.

    scripts/wood_curve.py [--initiation 215] [--bridging 405] [--tool cuts] [--preset standard] [--seed 7] [--noise 0.02] > CURVE.csv
    scripts/wood_curve.py --r-curve [--noise 0.03] > R_CURVE.csv
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEPTHS = (0.1, 0.15, 0.2, 0.3, 0.4, 0.5)  # mm
EXTENSIONS = (0.5, 1, 1.5, 2, 3, 4, 5.5, 7, 8.5, 10, 12, 14, 16, 18, 20)  # mm


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--initiation", default="215", help="J/m^2")
    parser.add_argument("--bridging", default="405", help="J/m^2")
    parser.add_argument("--tool", default="cuts", choices=["cuts", "ignores"])
    parser.add_argument("--preset", help="of the cuts; without one, what the scene says")
    parser.add_argument("--r-curve", action="store_true", help="of the specimen, instead of a planing curve")
    parser.add_argument("--noise", type=float, default=0.02)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--kerf", default=ROOT / "build/release/kerf")
    options = parser.parse_args()
    (r_curve if options.r_curve else planing_curve)(options)


def simulate(options, scene, *settings):
    command = [options.kerf, "simulate", ROOT / "data/scenes" / scene, "--json"]
    if options.preset:
        command += ["--preset", options.preset]
    for setting in (*settings, f"cohesive.mode_I.initiation_toughness={options.initiation} J/m^2",
                    f"cohesive.mode_I.bridging_toughness={options.bridging} J/m^2"):
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{scene}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def planing_curve(options):
    noise_c, noise_t = random.Random(options.seed), random.Random(options.seed + 1)
    print("#: rake = 45 deg\ndepth[mm],Fc[N/m],Fc_sd[N/m],Ft[N/m],Ft_sd[N/m]")
    for depth in DEPTHS:
        cut = simulate(options, "wood_tl_draft.toml", f"cut.depth={depth} mm", f"bridging.tool={options.tool}")
        F_c = cut["F_c"]["value"]
        error = options.noise * F_c
        F_c_measured = F_c + noise_c.gauss(0, error)
        F_t_measured = cut["F_t"]["value"] + noise_t.gauss(0, error)
        print(f"{depth},{F_c_measured:.5g},{error:.4g},{F_t_measured:.4g},{error:.4g}")
        print(f"depth {depth} mm: {F_c:.1f} N/m, {cut['cost']['processor_s']:.1f} core-s, {cut['branch']}", file=sys.stderr)


def r_curve(options):
    noise = random.Random(options.seed)
    curve = simulate(options, "dcb_rcurve.toml")["r_curve"]
    print("crack_extension[mm],G[J/m^2],G_sd[J/m^2]")
    for extension in EXTENSIONS:
        k = next(i for i, grown in enumerate(curve["extension"]) if grown > extension)
        share = (extension - curve["extension"][k - 1]) / (curve["extension"][k] - curve["extension"][k - 1])
        G = curve["G_R"][k - 1] + share * (curve["G_R"][k] - curve["G_R"][k - 1])
        print(f"{extension},{G + noise.gauss(0, options.noise * G):.4g},{options.noise * G:.3g}")


if __name__ == "__main__":
    main()
