#!/usr/bin/python3
"""Writes the report page of a calibration, a sweep or a study (a directory), of one simulated cut
(an .h5 file) or of an experiment on bodies (a .json file).

Of a sweep also its figures, sweep.svg and sweep_intercepts.svg, beside the page; of a study study.svg.

Exit codes are Kerf's: 0 written, 1 this Python lacks a module, 2 usage, 3 the input is missing or broken.
"""

import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

PACKAGES = {"matplotlib": "python3-matplotlib", "h5py": "python3-h5py", "jinja2": "python3-jinja2"}


def require_modules():
    from importlib.util import find_spec
    absent = [package for module, package in PACKAGES.items() if find_spec(module) is None]
    if absent:
        print(f"{sys.executable} lacks modules that the report is drawn with; `apt-get install {' '.join(absent)}`, or "
              f"set KERF_PYTHON to a Python that has them", file=sys.stderr)
        sys.exit(1)


def write_atomically(file, text):
    handle, partial = tempfile.mkstemp(dir=file.parent, prefix=file.name + ".")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(partial, 0o644)
        os.replace(partial, file)
    except BaseException:
        os.unlink(partial)
        raise


def kind_of(directory):
    """"sweep" or "study"; None for a calibration."""
    if not (directory / "request.json").exists():
        return "study" if (directory / "study.json").exists() else None
    try:
        return json.loads((directory / "request.json").read_text(encoding="utf-8")).get("kind")
    except ValueError:
        return "sweep"


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("target", type=Path)
    arguments.add_argument("--output", type=Path)
    options = arguments.parse_args()
    require_modules()
    from report.bodies import read_bodies
    from report.bodies_page import page_of_bodies
    from report.calibration import read_calibration
    from report.calibration_page import page_of_calibration
    from report.cut import Unreadable, read_cut
    from report.cut_page import page_of_cut
    from report.study import estimates, read_study, work_precision
    from report.study_page import page_of_study
    from report.sweep import extrapolations, forces, read_sweep
    from report.sweep_page import page_of_sweep
    try:
        if options.target.is_dir() and (kind := kind_of(options.target)):
            output = options.output or options.target / "report.html"
            if kind == "study":
                study = read_study(options.target)
                picture = estimates(study) if study.of_job else work_precision(study)
                page, pictures = page_of_study(study), [("study.svg", picture)]
            else:
                sweep = read_sweep(options.target)
                page = page_of_sweep(sweep)
                pictures = [("sweep.svg", forces(sweep)), ("sweep_intercepts.svg", extrapolations(sweep))]
            for name, picture in pictures:
                if picture:
                    write_atomically(output.parent / name, picture + "\n")
        elif options.target.is_dir():
            page = page_of_calibration(read_calibration(options.target))
            output = options.output or options.target / "report.html"
        elif options.target.suffix == ".json":
            page = page_of_bodies(read_bodies(options.target))
            output = options.output or options.target.with_suffix(".html")
        else:
            page = page_of_cut(read_cut(options.target))
            output = options.output or options.target.with_suffix(".html")
        write_atomically(output, page.html())
    except Unreadable as error:
        print(error, file=sys.stderr)
        return 3
    except OSError as error:
        print(f"{error.filename or options.target}: {error.strerror}", file=sys.stderr)
        return 3
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
