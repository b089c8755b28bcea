#!/usr/bin/env python3
"""Measure whether the regression notices faults: the mutation score of every unit.

usage: mutation.py [--unit B ...] [--mutants N] [--check] [--no-proof] [--survivors] [--jobs N] [--build DIR]

B is a bench of formal/mutants.py's list (without --unit all of them). Its program DIR/tb/B.mutants is built: the
bench as the regression runs it, on the synthesized netlist that holds all mutants. It runs once without
a mutant, when it must pass, and once with each. Then:
  killed      a test of the bench failed. Not ending within SECONDS counts too, for control units only.
  equivalent  it survived, and equivalence.py proved that no input can tell it from the unit
  survivor    all others, crashes and undecided proofs too
  score       killed / (mutants - equivalent), against the least score of its kind: LEAST

Results are kept in DIR/mutation/B.json; a mutant is run again when program or netlist changed, a proof when
the netlist changed. A run of all writes DIR/figures/mutation.json.

--mutants    only the first N of each; no proofs, no figures
--check      exit 1 when a score is too low (always 1 when the unit itself fails or nothing is killed)
--no-proof   leaves survivors undecided
--survivors  prints where each survivor is, in netlist and Verilog
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

import equivalence
from common import ROOT, Progress, write_json
from mutants import ARITHMETIC, CONTROL, UNITS, site_of

SECONDS = 60  # a bench takes a few
AUDITED = 5
LEAST = {ARITHMETIC: 0.95, CONTROL: 0.90}
KILLED, LATE, SURVIVED, CRASHED = "killed", "late", "survived", "crashed"
FAILURE = re.compile(r"\[  FAILED  \] (\w+\.\w+)")


def fail(message):
    sys.exit(f"mutation: {message}")


def sha(*parts):
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


def build(benches, folder):
    if not (folder / "build.ninja").exists():
        fail(f"{folder} is not configured: make configure")
    done = subprocess.run(["ninja", "-C", folder, "-j2", *(f"{bench}.mutants" for bench in benches)],
                          capture_output=True, text=True)
    if done.returncode:
        fail(f"the build failed:\n{done.stdout[-3000:]}")


def run(program, number):
    """(verdict, the test that failed) of the bench on mutant `number`."""
    environment = dict(os.environ, RAPLAS_MUTANT=str(number), GTEST_FAIL_FAST="1", GTEST_BRIEF="0")
    try:
        done = subprocess.run([program], capture_output=True, text=True, errors="replace", timeout=SECONDS,
                              env=environment)
    except subprocess.TimeoutExpired:
        return LATE, ""
    if done.returncode == 0:
        return SURVIVED, ""
    failure = FAILURE.search(done.stdout)
    if done.returncode == 1 and failure:
        return KILLED, failure[1]
    return CRASHED, done.stderr.strip()[-200:]


def each(pool, items, function, text):
    """{item: function(item)}"""
    progress, results = Progress(len(items), text), {}
    futures = {pool.submit(function, item): item for item in items}
    for future in concurrent.futures.as_completed(futures):
        results[futures[future]] = future.result()
        progress.step("")
    return results


def read(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError):
        return {}


def measure(bench, args, pool):
    """A row for each of the bench's mutants: number, command, run, lives, proof."""
    folder = args.build / "tb" / f"{bench}.mutation"
    program = args.build / "tb" / f"{bench}.mutants"
    commands = (folder / "mutants.txt").read_text().splitlines()
    netlist = (folder / "netlist.il").read_bytes()
    kept_path = args.build / "mutation" / f"{bench}.json"
    kept = read(kept_path)
    run_key = sha(program.read_bytes())
    proof_key = sha(netlist, str(equivalence.VERSION).encode())
    runs = kept.get("runs", {}) if kept.get("run_key") == run_key else {}
    proofs = kept.get("proofs", {}) if kept.get("proof_key") == proof_key else {}

    if not runs and (control := run(program, 0))[0] != SURVIVED:
        fail(f"{bench}: the bench fails without a mutant: {' '.join(control)}")
    numbers = range(1, min(len(commands), args.mutants or len(commands)) + 1)
    wanted = [k for k in numbers if str(k) not in runs]
    found = each(pool, wanted, lambda k: run(program, k), f"{bench}: mutants")
    runs |= {str(k): verdict for k, verdict in found.items()}

    def lives(k):
        verdict = runs[str(k)][0]
        return verdict in (SURVIVED, CRASHED) or (verdict == LATE and UNITS[bench].kind == ARITHMETIC)

    living = [k for k in numbers if lives(k)]
    if not (args.no_proof or args.mutants):
        wanted = [k for k in living if commands[k - 1] not in proofs]
        prover = equivalence.Prover(UNITS[bench], folder, args.build / "mutation" / bench)
        # the proofs themselves on trial: a mutant that a test told from the unit is not equivalent
        audited = [k for k in numbers if k not in living][:AUDITED] if wanted else []
        audit = each(pool, audited, prover.decide, f"{bench}: killed ones to the proof")
        if wrong := [k for k, verdict in audit.items() if verdict[0] == equivalence.EQUIVALENT]:
            fail(f"{bench}: killed, and proved equivalent: mutants {wrong}")
        found = each(pool, wanted, prover.decide, f"{bench}: proofs")
        proofs |= {commands[k - 1]: verdict for k, verdict in found.items()}
    write_json(kept_path, {"run_key": run_key, "proof_key": proof_key, "runs": runs, "proofs": proofs})
    return [{"number": k, "command": commands[k - 1], "run": runs[str(k)], "lives": k in living,
             "proof": proofs.get(commands[k - 1], ["undecided", ""]) if k in living else None} for k in numbers]


def figures(bench, rows):
    equivalent = sum(row["lives"] and row["proof"][0] == equivalence.EQUIVALENT for row in rows)
    killed = sum(not row["lives"] for row in rows)
    judged = len(rows) - equivalent
    return {"mutants": len(rows), "killed": killed, "equivalent": equivalent,
            "survivors": judged - killed, "score": round(killed / judged, 4) if judged else 0.0}


def print_survivors(bench, rows):
    for row in rows:
        if row["lives"] and row["proof"][0] != equivalence.EQUIVALENT:
            cell, port, bit = site_of(row["command"])
            mode = re.search(r"-mode (\S+)", row["command"])[1]
            wire = re.search(r"-wire (\S+) -wirebit (\d+)", row["command"])
            where = f" {wire[1]}[{wire[2]}]" if wire else ""
            lines = "".join(f" {line}" for line in re.findall(r"-src \S*/([^/ ]+)", row["command"]))
            print(f"  {bench} mutant {row['number']}: {row['run'][0]} {row['run'][1]}, {row['proof'][0]}: "
                  f"{mode} {cell}.{port}[{bit}]{where}{lines} {row['proof'][1]}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--unit", action="append", choices=UNITS)
    parser.add_argument("--mutants", type=int)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--no-proof", action="store_true")
    parser.add_argument("--survivors", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    args = parser.parse_args()
    args.build = args.build.resolve()
    benches = args.unit or list(UNITS)
    start = time.monotonic()
    build(benches, args.build)
    print(f"built in {time.monotonic() - start:.0f} s", flush=True)
    print(f"{'unit':22} {'mutants':>8} {'killed':>8} {'equivalent':>11} {'survivors':>10} {'score':>8} {'seconds':>8}",
          flush=True)
    table, low = {}, []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for bench in benches:
            begin = time.monotonic()
            rows = measure(bench, args, pool)
            f = table[bench] = figures(bench, rows)
            too_low = f["score"] < LEAST[UNITS[bench].kind]
            if f["killed"] == 0 or (too_low and args.check):
                low.append(bench)
            print(f"{bench:22} {f['mutants']:8} {f['killed']:8} {f['equivalent']:11} {f['survivors']:10} "
                  f"{100 * f['score']:7.1f}% {time.monotonic() - begin:8.1f}", flush=True)
            if args.survivors:
                print_survivors(bench, rows)
    print(f"{time.monotonic() - start:.0f} s")
    if not (args.unit or args.mutants or args.no_proof):
        units = {"score": "of the mutants that can be noticed"}
        write_json(args.build / "figures/mutation.json", {
            f"mutation.{bench}.{kind}":
                {"value": f[kind], "unit": units.get(kind, "mutants"), "command": "make mutation"}
            for bench, f in table.items() for kind in ("mutants", "killed", "equivalent", "score")})
    if low:
        fail(f"too many survivors: {', '.join(low)}")


if __name__ == "__main__":
    main()
