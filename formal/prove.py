#!/usr/bin/env python3
"""Prove the theorems of docs/numerics.md.

usage: prove.py [--quick] [--theorem PATTERN ...] [--case PATTERN ...] [--broken-only] [--no-broken]
                [--jobs N] [--work DIR] [--build DIR]

Runs every case of every theorem and prints a table: cases, proved, seconds. Then each design of
broken.toml, a copy of rtl/ with one change, must be refuted; its counterexample is printed.
Exit 1 if a case is refuted, undecided or missing, or if a broken design is not refuted.
Writes DIR/figures/proof.json (a whole run only).

--quick      the short subset that `make sim` runs
--theorem    only these (shell pattern), --case only these cases of them
"""
import argparse
import concurrent.futures
import fnmatch
import pathlib
import shutil
import subprocess
import sys
import time
import tomllib

import arithmetic
import bounds
import control
from common import FORMAL, PROVED, REFUTED, ROOT, UNDECIDED, Progress, Result, patched_rtl, write_json

FAMILIES = (arithmetic, control, bounds)  # cases(work, rtl) and EXPECTED: theorem -> number of cases
TOOLS = ("ghdl", "yosys", "berkeley-abc", "gappa")


def decide(case):
    start = time.monotonic()
    try:
        result = case.decide()
    except subprocess.TimeoutExpired as late:
        result = Result(UNDECIDED, f"not decided within {late.timeout} s")
    except Exception as error:  # an error of a tool is no verdict; the other cases go on
        result = Result(UNDECIDED, f"{type(error).__name__}: {error}")
    return result, time.monotonic() - start


def wanted(text, patterns):
    return not patterns or any(fnmatch.fnmatch(text, pattern) for pattern in patterns)


def prove(cases, jobs):
    """{theorem: [(case, result, seconds)]}"""
    results = {}
    progress = Progress(len(cases))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = {pool.submit(decide, case): case for case in cases}
        for future in concurrent.futures.as_completed(futures):
            case = futures[future]
            results.setdefault(case.theorem, []).append((case, *future.result()))
            progress.step(f"{case.theorem}.{case.name}")
    return results


def print_table(results):
    print(f"{'theorem':44} {'cases':>6} {'proved':>7} {'seconds':>8} {'longest':>8}")
    for theorem in dict.fromkeys(results):
        rows = results[theorem]
        seconds = [s for _, _, s in rows]
        proved = sum(r.verdict == PROVED for _, r, _ in rows)
        print(f"{theorem:44} {len(rows):6} {proved:7} {sum(seconds):8.1f} {max(seconds):8.1f}")


def report(results):
    """Prints what is not proved; its number."""
    bad = [(case, result) for rows in results.values() for case, result, _ in rows if result.verdict != PROVED]
    for case, result in bad:
        print(f"{result.verdict.upper()}: {case.theorem}.{case.name}\n{result.detail}")
    return len(bad)


def check_complete(cases):
    """Every theorem has the number of cases that its module states, no name twice."""
    wrong = 0
    expected = {theorem: number for family in FAMILIES for theorem, number in family.EXPECTED.items()}
    found = {}
    for case in cases:
        found.setdefault(case.theorem, []).append(case.name)
    for theorem in sorted(expected.keys() | found.keys()):
        names = found.get(theorem, [])
        if len(set(names)) != expected.get(theorem) or len(set(names)) != len(names):
            print(f"MISSING: {theorem}: {len(set(names))} cases, {expected.get(theorem)} expected")
            wrong += 1
    return wrong


def all_cases(work, rtl):
    return [case for family in FAMILIES for case in family.cases(work, rtl)]


def refute(design, work):
    """True if one of the design's cases is refuted; undecided is no refutation."""
    folder = work / "broken" / design["name"]
    shutil.rmtree(folder, ignore_errors=True)
    rtl = patched_rtl(folder / "rtl", design)
    cases = [case for case in all_cases(folder, rtl)
             if wanted(f"{case.theorem}.{case.name}", design["cases"])]
    start = time.monotonic()
    details = []
    for case in cases:
        result, _ = decide(case)
        if result.verdict == REFUTED:
            print(f"ok: {design['name']}: {case.theorem}.{case.name} refuted, {time.monotonic() - start:.1f} s\n"
                  f"    {result.detail}", flush=True)
            return True
        details.append(f"{case.name}: {result.verdict} {result.detail[:300]}")
    print(f"WRONG: {design['name']}: not refuted by {len(cases)} cases {'; '.join(details)[:600]}", flush=True)
    return False


def write_figures(path, results, cases_bad, refuted, broken):
    def figure(value, unit):
        return {"value": value, "unit": unit, "command": "make prove"}

    figures = {
        "proof.cases": figure(sum(map(len, results.values())), "cases"),
        "proof.undecided": figure(cases_bad, "cases"),
        "proof.broken": figure(broken, "broken designs"),
        "proof.broken_refuted": figure(refuted, "broken designs"),
    }
    for theorem, rows in results.items():
        figures[f"proof.{theorem}.cases"] = figure(len(rows), "cases")
        figures[f"proof.{theorem}.seconds"] = figure(round(sum(s for _, _, s in rows), 1), "s")
    write_json(path, figures)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--theorem", action="append", default=[])
    parser.add_argument("--case", action="append", default=[])
    parser.add_argument("--broken-only", action="store_true")
    parser.add_argument("--no-broken", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--work", type=pathlib.Path)
    args = parser.parse_args()
    if missing := [tool for tool in TOOLS if not shutil.which(tool)]:
        sys.exit(f"prove: not installed: {', '.join(missing)}; scripts/setup.sh installs them")
    work = (args.work or args.build / "formal").resolve()
    work.mkdir(parents=True, exist_ok=True)

    cases = all_cases(work, ROOT / "rtl")
    wrong = check_complete(cases)
    whole = not (args.quick or args.theorem or args.case or args.broken_only or args.no_broken)
    chosen = [case for case in cases if wanted(case.theorem, args.theorem) and wanted(case.name, args.case)
              and (case.quick or not args.quick)]
    results = {}
    if not args.broken_only:
        results = prove(chosen, args.jobs)
        if not results:
            sys.exit("prove: no case has that name")
        print_table(results)
        wrong += report(results)
        print(f"{sum(map(len, results.values()))} cases, {wrong} refuted, undecided or missing", flush=True)

    refuted, designs = 0, []
    if not args.no_broken:
        designs = tomllib.loads((FORMAL / "broken.toml").read_text())["design"]
        designs = [design for design in designs if (design.get("quick") or not args.quick)
                   and wanted(design["theorem"], args.theorem)]
        with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
            refuted = sum(pool.map(lambda design: refute(design, work), designs))
        print(f"{refuted} of {len(designs)} broken designs refuted")
    if whole:
        write_figures(args.build / "figures/proof.json", results, wrong, refuted, len(designs))
    return 1 if wrong or refuted != len(designs) else 0


if __name__ == "__main__":
    sys.exit(main())
