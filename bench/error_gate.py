#!/usr/bin/env python3
"""Measure the errors of a small fixed set again, and fail when one is larger than it was.

usage: error_gate.py PROGRAMS [--update] [--baseline FILE] [--instead KEY=OTHER ...]

PROGRAMS: the folder of the programs configurations and plane_error. Measured are profiles paper and raplas, the paper's
plane test and that of 18 bits, on bundled scenes; error_baseline.json beside this script holds what they gave. Exit
code 1 if a figure is larger than there, is missing or is not known. A figure that has become smaller is named, and
--update, which writes the file, is what to do then.

--instead  takes the figures of OTHER for those of KEY: with a worse format the gate must fail
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ("scenes/cornell_teapot.json", "scenes/teapot.bpt")
SIZE = ("--width", "64", "--height", "64", "--quiet")
PLANES = ("fp24_paper", "w18")
KEYS = ("paper", "raplas", *PLANES)
LARGER_IS_WORSE = ("_percent", "rmse", "_median", "_99", "_largest")
TOLERANCE = 1e-9  # of the last digits that a compiler may change; a single ray or pixel is far more


def fail(message):
    sys.exit(f"error_gate: {message}")


def measure(programs, instead):
    """The figures of the fixed set by name."""
    others = tuple(instead.values())
    runs = (("configurations", "--repetitions", "0", "--only", "paper", "raplas"), ("plane_error",))
    figures = {}
    with tempfile.TemporaryDirectory() as folder:
        for program, *options in runs:
            out = pathlib.Path(folder) / f"{program}.json"
            command = [str(programs / program), *SCENES, *SIZE, "--json", str(out), *options]
            run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
            if run.returncode:
                fail(f"{' '.join(command)}: {run.stderr.strip()}")
            figures.update({name: figure["value"] for name, figure in json.loads(out.read_text()).items()})
    measured = {}
    for name, value in figures.items():
        parts = name.split(".")
        if parts[0] not in ("error", "planes") or len(parts) != 4 or not name.endswith(LARGER_IS_WORSE):
            continue
        for key in KEYS:
            if parts[2] == instead.get(key, key):
                measured[".".join((*parts[:2], key, parts[3]))] = value
    if not measured or any(other not in {name.split(".")[2] for name in figures if name.count(".") == 3}
                           for other in others):
        fail("nothing measured under such a name")
    return measured


def compare(stored, measured):
    """(figures that are worse, missing or new, as lines; figures that are better)."""
    worse = [f"{name}: {measured[name]:.6g}, was {value:.6g}" for name, value in stored.items()
             if name in measured and measured[name] > value * (1 + TOLERANCE)]
    worse += [f"{name}: not measured" for name in stored if name not in measured]
    worse += [f"{name}: not in the baseline" for name in measured if name not in stored]
    better = [f"{name}: {measured[name]:.6g}, was {value:.6g}" for name, value in stored.items()
              if name in measured and measured[name] < value * (1 - TOLERANCE)]
    return worse, better


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("--baseline", type=pathlib.Path, default=ROOT / "bench/error_baseline.json")
    parser.add_argument("--instead", action="append", default=[], metavar="KEY=OTHER")
    args = parser.parse_args()
    measured = measure(args.programs.resolve(), dict(pair.split("=", 1) for pair in args.instead))
    if args.update:
        args.baseline.write_text(json.dumps(dict(sorted(measured.items())), indent=2) + "\n")
        print(f"{args.baseline}: {len(measured)} figures")
        return 0
    worse, better = compare(json.loads(args.baseline.read_text()), measured)
    for line in better:
        print(f"better: {line}")
    if better:
        print("error_gate: errors have become smaller: keep that by bench/error_gate.py --update")
    for line in worse:
        print(f"worse: {line}", file=sys.stderr)
    print(f"error_gate: {len(measured)} errors checked, {len(worse)} worse")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
