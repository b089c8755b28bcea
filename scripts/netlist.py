#!/usr/bin/env python3
"""Synthesise the units for Virtex-4 with Yosys and count what they take.

usage: netlist.py [--unit U ...] [--count] [--check] [--build DIR] [--fresh]

Each unit is exported with prim xc4v and default generics (or those of VARIANTS) into
DIR/netlist/U/ (DIR: build), and synthesised by yosys synth_xilinx -family xc4v. The figures go into
DIR/figures/netlist.json:
  dsp48.U             DSP48 cells: the ones instantiated in rtl/prim/xc4v
  lut.U               LUT1 to LUT4, and INV, Yosys' name for an inverting LUT1
  lut_ram.U           LUTs used as memory
  ff.U                flip-flops outside DSP48 and block RAM
  block_ram.U         RAMB16
  slices_estimated.U  max((lut + lut_ram) / 2, ff / 2): ideal packing, to be compared with estimates
                      only; what ISE's MAP reports is higher
Yosys infers no SRL16 for this family, so every delay counts in flip-flops.

--unit    only these; without it all; intersection_unit and raplas_unit take Yosys some minutes
--count   flattens only: DSP48 and latches of all units in seconds, no figures written
--check   exits 1 unless the DSP48 counts are those of the documents
--fresh   ignores the results kept for an unchanged export
A latch, a multiplication outside rtl/prim or a cell that Yosys could not map always exits 1.
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

from figures import write_json

ROOT = pathlib.Path(__file__).resolve().parent.parent
DSP48 = {
    "fp_add": 2,
    "fp_mul": 2,
    "plane_sphere_tester": 12,
    "plane_sphere_subunit": 96,
    "fixed_testers": 144,
    "nearest_hit": 4,
    "depth_quotient": 1,
    "vertex_grid": 2,
    "edge_setup": 2,
    "row_interval": 3,
    "ray_solver": 68,
    "ray_triangle": 70,
    "hit_queue": 4,
    "fp_add_fabric": 1,
    "fp_mul_fabric": 1,
    "ray_solver_fabric": 34,
    "hit_queue_fabric": 2,
    "intersection_unit": 166,
    "intersection_unit_paper": 166,
    "intersection_unit_2x2": 118,
    "raplas_unit": 188,
}
FABRIC = ("EXPONENT_DSP=false",)  # exponents in fabric
VARIANTS = {f"{unit}_fabric": (unit, FABRIC) for unit in ("fp_add", "fp_mul", "ray_solver", "hit_queue")}
VARIANTS["intersection_unit_paper"] = ("intersection_unit", ("GUARD_BITS=0",))  # as the paper has it
VARIANTS["intersection_unit_2x2"] = ("intersection_unit", ("NUM_ROWS=2", "NUM_COLUMNS=2"))  # testers
PAPER = {  # slices and DSP48 that ISE 8.2 reported
    "plane_sphere_subunit": (8248, 96),
    "ray_triangle": (5282, 70),
}
KINDS = ("dsp48", "lut", "lut_ram", "ff", "block_ram", "slices_estimated")
UNIT_OF = {"dsp48": "DSP48", "lut": "LUT4", "lut_ram": "LUT4", "ff": "flip-flops", "block_ram": "RAMB16",
           "slices_estimated": "slices"}
LUT = re.compile(r"LUT[1-4]|INV")
LUT_RAM = re.compile(r"RAM(\d+)X(\d)([SD])(_1)?")
FLIP_FLOP = re.compile(r"FD[A-Z]*(_1)?")
LATCH = re.compile(r"\$a?dlatch.*|\$_A?DLATCH.*|\$_SR_.*|\$sr|LD[A-Z]*(_1)?")
FREE = re.compile(r"DSP48|RAMB16|MUXCY|XORCY|MUXF[5-8]|VCC|GND")
SYNTHESIS = "synth_xilinx -family xc4v -top {unit} -noiopad -noclkbuf -flatten -nowidelut"
FLATTENING = "hierarchy -check -top {unit}; proc; flatten"
CELL_TYPES = "read_verilog -lib +/xilinx/cells_sim.v; "


def fail(message):
    sys.exit(f"netlist: {message}")


def export(unit, folder, generics):
    """The unit's Verilog, with DSP48 as black boxes."""
    command = [sys.executable, str(ROOT / "scripts/export_verilog.py"), "--unit", unit, "--prim", "xc4v"]
    command += ["--sources", str(ROOT / "rtl/sources.txt"), "--out", str(folder)]
    command += [f"--generic={generic}" for generic in generics]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        fail(f"{unit}: the export failed:\n{run.stdout}{run.stderr}")
    return folder / f"{unit}.v"


def yosys_version():
    try:
        return subprocess.run(["yosys", "-V"], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        fail("yosys is not installed")


def cells_of(unit, verilog, passes, kept, fresh, version):
    """({cell type: number}, seconds); taken from the file `kept` when nothing has changed since."""
    script = f"read_verilog {{verilog}}; {passes.format(unit=unit)}; tee -q -o {{out}} stat -json"
    text = re.sub(r"/\*.*?\*/", "", verilog.read_text())  # comments: places in the VHDL
    key = hashlib.sha256("\0".join([text, script, version]).encode()).hexdigest()
    if not fresh and kept.exists():
        try:
            stored = json.loads(kept.read_text())
            if stored["key"] == key:
                return stored["cells"], stored["seconds"]
        except (ValueError, KeyError, TypeError):
            pass  # half a file: made again
    out = kept.with_suffix(f".{os.getpid()}.stat")
    start = time.monotonic()
    run = subprocess.run(["yosys", "-Q", "-T", "-p", script.format(verilog=verilog, out=out)],
                         capture_output=True, text=True)
    seconds = round(time.monotonic() - start, 1)
    if run.returncode:
        fail(f"{unit}: yosys failed:\n{run.stdout[-2000:]}{run.stderr}")
    cells = json.loads(out.read_text())["design"]["num_cells_by_type"]
    out.unlink()
    write_json(kept, {"key": key, "seconds": seconds, "cells": cells})
    return cells, seconds


def lut_ram(cell):
    """LUTs of a distributed memory cell: 16 bits each, twice for a second port."""
    depth, width, ports, _ = LUT_RAM.fullmatch(cell).groups()
    return (int(depth) + 15) // 16 * int(width) * (2 if ports == "D" else 1)


def total(cells, pattern, weight=lambda cell: 1):
    return sum(number * weight(cell) for cell, number in cells.items() if pattern.fullmatch(cell))


def figures_of(unit, cells):
    """The figures of a mapped netlist; refuses cells that are none of Virtex-4's."""
    known = (LUT, LUT_RAM, FLIP_FLOP, FREE)
    if unknown := [cell for cell in cells if not any(pattern.fullmatch(cell) for pattern in known)]:
        fail(f"{unit}: cells that were not mapped: {', '.join(unknown)}")
    luts, memory, flip_flops = total(cells, LUT), total(cells, LUT_RAM, lut_ram), total(cells, FLIP_FLOP)
    return {"dsp48": cells.get("DSP48", 0), "lut": luts, "lut_ram": memory, "ff": flip_flops,
            "block_ram": cells.get("RAMB16", 0),
            "slices_estimated": (max(luts + memory, flip_flops) + 1) // 2}


def refuse(unit, cells):
    """Latches, and multiplications that synthesis would put into DSP48 outside rtl/prim."""
    if latches := [cell for cell in cells if LATCH.fullmatch(cell)]:
        fail(f"{unit}: latches: {', '.join(latches)}")
    if "$mul" in cells:
        fail(f"{unit}: {cells['$mul']} multiplications outside rtl/prim")


def print_table(results):
    head = ["unit", "DSP48", "LUT", "LUT-RAM", "FF", "RAMB16", "slices est.", "paper: slices", "DSP48"]
    rows = [[unit, *(str(f[kind]) for kind in KINDS), *(str(x) for x in PAPER.get(unit, ("", "")))]
            for unit, f in results.items()]
    widths = [max(len(row[k]) for row in [head] + rows) for k in range(len(head))]
    for row in [head] + rows:
        print("  ".join(x.ljust(w) if k == 0 else x.rjust(w) for k, (x, w) in enumerate(zip(row, widths))))


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--unit", action="append", choices=DSP48)
    parser.add_argument("--count", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    args = parser.parse_args()
    version = yosys_version()
    counts, results = {}, {}
    for unit in args.unit or DSP48:
        folder = args.build / "netlist" / unit
        top, generics = VARIANTS.get(unit, (unit, ()))
        verilog = export(top, folder, generics)
        name, passes = ("count", CELL_TYPES + FLATTENING) if args.count else ("synthesis", SYNTHESIS)
        start = time.monotonic()
        print(f"{unit}: ", end="", flush=True)
        cells, seconds = cells_of(top, verilog, passes, folder / f"{name}.json", args.fresh, version)
        refuse(unit, cells)
        counts[unit] = cells.get("DSP48", 0)
        if not args.count:
            results[unit] = figures_of(unit, cells)
        kept = " (kept)" if time.monotonic() - start < 0.5 * seconds else ""
        print(f"{counts[unit]} DSP48, no latch, {seconds} s{kept}", flush=True)
    if results:
        print()
        print_table(results)
        write_figures(args.build / "figures/netlist.json", results)
    wrong = [f"{u}: {n} DSP48, {DSP48[u]} documented" for u, n in counts.items() if n != DSP48[u]]
    for line in wrong:
        print(f"netlist: {line}", file=sys.stderr)
    return 1 if args.check and wrong else 0


def write_figures(path, results):
    """Adds to the file's figures of other units: a run with --unit loses none."""
    figures = {}
    if path.exists():
        try:
            figures = json.loads(path.read_text())
        except ValueError:
            pass
    for unit, values in results.items():
        for kind in KINDS:
            figures[f"{kind}.{unit}"] = {"value": values[kind], "unit": UNIT_OF[kind], "command": "make netlist"}
    write_json(path, dict(sorted(figures.items())))
    print(f"\n{path}: {len(figures)} figures")


if __name__ == "__main__":
    sys.exit(main())
