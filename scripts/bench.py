#!/usr/bin/env python3
"""Runs the benchmarks (tests/bench) several times over and forms their ratios, each from one pass, so that what is
compared was measured side by side. Rates are of CPU time; only two simulations at once are compared by the clock.

Usage: scripts/bench.py KERF_BENCH [--json FILE] [--repeats N] [--readme]"""

import argparse
import datetime
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

standard = "16384"

# Doubles that a step reads and writes per particle: stress pass 8 and 5, advance 5 and 4 (nodes stay in L1).
bytes_per_particle_step = 8 * (8 + 5 + 5 + 4)

# name, format, meaning
table = [
    ("j2.particle_steps_per_s", ".3g", "bare kernel, all yield, 16 k particles, one core"),
    ("j2.below_yield_per_s", ".3g", "... none yields"),
    ("elastic.particle_steps_per_s", ".3g", "... yield stress out of reach"),
    ("hencky.particle_steps_per_s", ".3g", "bare kernel, hyperelastic, all yield"),
    ("hencky.below_yield_per_s", ".3g", "... none yields"),
    ("hencky.overhead", ".2f", "time over that of a J2 step, all yield, minus 1"),
    ("hill.particle_steps_per_s", ".3g", "bare kernel, Hill, all yield"),
    ("hill.below_yield_per_s", ".3g", "... none yields"),
    ("hill.overhead", ".2f", "time over that of a J2 step, all yield, minus 1"),
    ("scalar.particle_steps_per_s", ".3g", "the same step written plainly, not vectorised"),
    ("j2.ratio_to_scalar", ".2f", "J2 kernel over that"),
    ("j2.flops_per_particle_step", ".0f", "+ - * / sqrt in the plain code, counted"),
    ("j2.fraction_of_peak", ".3f", "of what multiply-adds in registers reach"),
    ("j2.fraction_of_l2", ".3f", "of the bytes one core can read from L2"),
    ("peak.flops", ".3g", "measured, f64"),
    ("peak.l2_bytes_per_s", ".3g", "measured"),
    ("cut.particle_steps_per_s", ".3g", "a whole cut: verification_45, 2 depths"),
    ("cut.fraction_of_kernel", ".2f", "of the bare J2 kernel's rate"),
    ("cut.wood_particle_steps_per_s", ".3g", "a whole cut: wood_rl, 2 depths"),
    ("cut.wood_fraction_of_kernel", ".2f", "of the bare Hill kernel's rate below yield"),
    ("concurrency.two_over_one", ".2f", "particle-steps per time, two cuts at once over one"),
    ("scaling.exponent", ".3f", "of time per step against particles, 4 k to 1 M"),
]


def one_pass(program):
    run = subprocess.run([program, "--benchmark_format=json", "--benchmark_min_time=0.15"], stdout=subprocess.PIPE,
                         check=True)
    report = json.loads(run.stdout)
    for bench in report["benchmarks"]:
        if bench.get("error_occurred"):
            sys.exit(f"bench.py: {bench['name']}: {bench['error_message']}")
    return report["context"], {bench["name"]: bench for bench in report["benchmarks"]}


def exponent(points):
    """Slope of the straight line through the logarithms."""
    x, y = [math.log(p[0]) for p in points], [math.log(p[1]) for p in points]
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    return (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x))


def quantities(benches):
    def rate(name):
        return benches[name]["items_per_second"]

    j2, hencky, hill = (rate(f"kernel/{law}/{standard}") for law in ("j2", "hencky", "hill"))
    hill_below = rate(f"kernel/hill_below_yield/{standard}")
    peak, l2 = rate("fma_peak"), benches["l2_read"]["bytes_per_second"]
    flops = benches["scalar"]["flops_per_particle_step"]
    cut, wood = rate("cut/verification_45/iterations:1"), rate("cut/wood_rl/iterations:1")
    one, two = (rate(f"cut/side_by_side/iterations:1/real_time/threads:{n}") for n in (1, 2))
    sizes = [b for name, b in benches.items() if name.startswith("kernel/scaling/")]
    return {
        "j2.particle_steps_per_s": j2,
        "j2.below_yield_per_s": rate(f"kernel/j2_below_yield/{standard}"),
        "j2.ratio_to_scalar": j2 / rate("scalar"),
        "j2.flops_per_particle_step": flops,
        "j2.fraction_of_peak": flops * j2 / peak,
        "j2.fraction_of_l2": bytes_per_particle_step * j2 / l2,
        "elastic.particle_steps_per_s": rate(f"kernel/elastic/{standard}"),
        "hencky.particle_steps_per_s": hencky,
        "hencky.below_yield_per_s": rate(f"kernel/hencky_below_yield/{standard}"),
        "hencky.overhead": j2 / hencky - 1,
        "hill.particle_steps_per_s": hill,
        "hill.below_yield_per_s": hill_below,
        "hill.overhead": j2 / hill - 1,
        "scalar.particle_steps_per_s": rate("scalar"),
        "peak.flops": peak,
        "peak.l2_bytes_per_s": l2,
        "cut.particle_steps_per_s": cut,
        "cut.fraction_of_kernel": cut / j2,
        "cut.wood_particle_steps_per_s": wood,
        "cut.wood_fraction_of_kernel": wood / hill_below,
        "concurrency.two_over_one": two / one,
        "scaling.exponent": exponent([(b["particles"], b["particles"] / b["items_per_second"]) for b in sizes]),
    }


def machine(context):
    models = [line.split(":", 1)[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
              if line.startswith("model name")]
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], stdout=subprocess.PIPE, text=True, check=False)
    return {
        "cpu": models[0] if models else "unknown",
        "cores": context["num_cpus"],
        "mhz": context["mhz_per_cpu"],
        "load": os.getloadavg()[0],
        "compiler": context["compiler"],
        "flags": context["flags"].strip(),
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "code": commit.stdout.strip(),
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--json", metavar="FILE", help="write what was measured here")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--readme", action="store_true", help="put the table in README.md")
    options = parser.parse_args()

    passes = []
    for k in range(options.repeats):
        print(f"\rpass {k + 1} of {options.repeats}", end="", file=sys.stderr, flush=True)
        context, benches = one_pass(options.program)
        passes.append(quantities(benches))
    print("\r\033[K", end="", file=sys.stderr)

    result = {"machine": machine(context), "repeats": options.repeats}
    lines = ["{cpu}, {cores} cores, {compiler} {flags}".format(**result["machine"]),
             f"{'':<38}{'median':>9}{'min':>9}{'max':>9}"]
    for name, form, meaning in table:
        values = [one[name] for one in passes]
        spread = {"min": min(values), "median": statistics.median(values), "max": max(values), "values": values}
        group, key = name.split(".")
        result.setdefault(group, {})[key] = spread
        lines.append(f"{name:<38}" + "".join(f"{spread[k]:>9{form}}" for k in ("median", "min", "max")) + f"  {meaning}")
    print("\n".join(lines))
    if options.readme:
        readme = pathlib.Path("README.md")
        before, rest = readme.read_text().split("<!-- bench -->\n```\n")
        readme.write_text(before + "<!-- bench -->\n```\n" + "\n".join(lines) + "\n" + rest[rest.index("```"):])
    if options.json:
        partial = pathlib.Path(options.json + ".partial")
        partial.write_text(json.dumps(result, indent=2) + "\n")
        partial.rename(options.json)


if __name__ == "__main__":
    main()
