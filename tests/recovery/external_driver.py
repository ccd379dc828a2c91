#!/usr/bin/env python3
"""An external driver as Dakota is one: it knows `kerf evaluate` and nothing else, and finds the parameters of a twin."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).parent
SCENE = (here / "twin.toml").read_text()
[JOB] = re.findall(r'R"\((.*?)\)"', (here / "twin_scene.hpp").read_text(), re.S)
TRUTH = {"yield_stress": 25.0, "friction": 0.2}


def parameters(form, values, functions):
    if form == "aprepro":
        lines = [f"{{ DAKOTA_VARS = {len(values)} }}"] + [f"{{ {name} = {v:.15e} }}" for name, v in values.items()]
        return "\n".join(lines + [f"{{ DAKOTA_FNS = {functions} }}"] +
                         [f"{{ ASV_{i + 1}:r{i + 1} = 1 }}" for i in range(functions)]) + "\n"
    lines = [f"{len(values)} variables"] + [f"{v:.15e} {name}" for name, v in values.items()]
    return "\n".join(lines + [f"{functions} functions"] + [f"1 ASV_{i + 1}:r{i + 1}" for i in range(functions)]) + "\n"


def main(kerf):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "scene.toml").write_text(SCENE)
        truth = subprocess.run([kerf, "simulate", folder / "scene.toml", "--json"], capture_output=True, check=True)
        F_c, F_t = (json.loads(truth.stdout)[force]["value"] / 1000 for force in ("F_c", "F_t"))
        error = 0.01 * F_c
        (folder / "curve.csv").write_text("#: rake = 30 deg\ndepth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm]\n"
                                          f"0.5,{F_c},{error},{F_t},{error}\n")
        (folder / "job.toml").write_text(JOB)

        def evaluate(values, functions=2, form="standard", **more):
            (folder / "params.in").write_text(parameters(form, values, functions))
            (folder / "results.out").unlink(missing_ok=True)
            done = subprocess.run([kerf, "evaluate", folder / "params.in", folder / "results.out", "--job",
                                   folder / "job.toml"], capture_output=True, text=True, **more)
            out = folder / "results.out"
            return done, out.read_text() if out.exists() else None

        def residuals(values, functions=2, form="standard"):
            done, text = evaluate(dict(zip(TRUTH, values)), functions, form)
            assert done.returncode == 0, done.stderr
            rows = [line.split() for line in text.splitlines()]
            assert [name for _, name in rows] == [f"r{i + 1}" for i in range(functions)], text
            return [float(value) for value, _ in rows]

        x = [28.0, 0.17]
        for _ in range(4):  # Newton's method with differences, by Cramer's rule
            r = residuals(x)
            (a, c), (b, d) = ([(moved - here) / (0.03 * x[j]) for moved, here in zip(residuals(
                [v * (1.03 if i == j else 1) for i, v in enumerate(x)]), r)] for j in (0, 1))
            determinant = a * d - b * c
            x = [x[0] - (d * r[0] - b * r[1]) / determinant, x[1] - (a * r[1] - c * r[0]) / determinant]
        for value, (name, true) in zip(x, TRUTH.items()):
            assert abs(value / true - 1) < 0.01, (name, value, true)
        at_end = residuals(x)
        assert residuals(x, form="aprepro") == at_end
        chi2 = residuals(x, functions=1)[0]
        assert abs(chi2 - sum(r**2 for r in at_end)) <= 1e-12 * chi2

        broken = folder / "broken"
        broken.write_text("#!/bin/sh\nexit 1\n")
        broken.chmod(0o755)
        done, text = evaluate(dict(zip(TRUTH, x)), env={"KERF_TEST_RUN_COMMAND": str(broken)})
        assert (done.returncode, text) == (5, "FAIL\n"), (done, text)
        for values, functions, said in (({"yield_stres": 20, "friction": 0.2}, 2, 'did you mean "yield_stress"'),
                                        ({"friction": 0.2}, 2, 'no value for "yield_stress"'),
                                        ({"yield_stress": 700, "friction": 0.2}, 2, "is outside 15 ... 60"),
                                        ({"yield_stress": 20, "friction": 0.2}, 7, "asks for 7 functions")):
            done, text = evaluate(values, functions)
            assert done.returncode == 3 and text is None and said in done.stderr, (values, done, text)
        print(f"found {x} for {list(TRUTH.values())}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
