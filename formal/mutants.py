#!/usr/bin/env python3
"""Make the mutants of a unit: its synthesized netlist with faults that an input port switches on.

usage: mutants.py --bench B --export DIR --out DIR

The build calls it (cmake/RaplasBench.cmake). DIR of --export holds the unit's Verilog as the benches run it
(prim generic). Yosys synthesizes it; `mutate -list` names the mutants of B's row in UNITS, and `mutate -ctrl`
puts all of them into one netlist, mutant k active when the new port mutant_i is k. 0 is the unit itself.
Written into DIR of --out:
  netlist.il    the synthesized unit, without mutants
  mutants.txt   one `mutate` command a line; line k is mutant k
  U.v           the netlist with all mutants; unisim.v (empty) and ports.txt are what scripts/bridge.py reads

Gates: everything is mapped to AND, OR, XOR, NOT, MUX and flip-flops with reset and enable, optimised by ABC.
Two kinds of cells stay whole, as they are one block in the FPGA: memories and the multiplications (DSP48);
their ports are mutated like those of gates. In dsp_mul the multiplication is made of gates too.
Words: the large units, made of units that are mutated as gates too, stay at the level of adders,
multiplexers and registers of words.
Parts: instances of a row's `parts` stay modules, and their inside is left alone: it is the business of their
own rows. What connects them is mutated like everything else, their ports included.
A mutant inverts one bit of one port of one cell, or holds it at 0 or at 1, or (words only) inverts it
when another bit of the port is 0, or 1. Clocks, and pins tied to a constant, are left alone.
"""
import argparse
import dataclasses
import json
import pathlib
import re
import sys

from common import run

ARITHMETIC, CONTROL = "arithmetic", "control"
SEED = 1
PORT = "mutant_i"
CLOCKS = {"C", "CLK", "RD_CLK", "WR_CLK"}
GATES, WORDS = "gates", "words"


@dataclasses.dataclass(frozen=True)
class Bench:
    """A row: the raplas_bench whose unit is mutated."""

    unit: str
    kind: str
    mutants: int = 250
    level: str = GATES
    multiplier: bool = False  # the multiplication becomes gates too
    parts: tuple = ()  # entities inside it that have rows of their own


UNITS = {
    "dsp_mul": Bench("dsp_mul", ARITHMETIC, multiplier=True),
    "dsp_addsub_11": Bench("dsp_addsub", ARITHMETIC),
    "fp_mul": Bench("fp_mul", ARITHMETIC),
    "fp_add": Bench("fp_add", ARITHMETIC),
    "fp_add_paper": Bench("fp_add", ARITHMETIC),
    "plane_sphere_tester": Bench("plane_sphere_tester", ARITHMETIC),
    "plane_sphere_subunit": Bench("plane_sphere_subunit", ARITHMETIC, level=WORDS),
    "dsp_plane_test_0": Bench("dsp_plane_test", ARITHMETIC),
    "dsp_multiply_add": Bench("dsp_multiply_add", ARITHMETIC),
    "depth_code": Bench("depth_code", ARITHMETIC),
    "fixed_testers": Bench("fixed_testers", ARITHMETIC, level=WORDS, parts=("dsp_plane_test", "depth_code")),
    "nearest_hit": Bench("nearest_hit", ARITHMETIC),
    "depth_quotient": Bench("depth_quotient", ARITHMETIC),
    "vertex_grid": Bench("vertex_grid", ARITHMETIC, parts=("dsp_multiply_add",)),
    "ray_solver": Bench("ray_solver", ARITHMETIC, level=WORDS),
    "ray_triangle": Bench("ray_triangle", ARITHMETIC, level=WORDS),
    "fifo": Bench("fifo", CONTROL),
    "block_fifo": Bench("block_fifo", CONTROL),
    "hit_queue": Bench("hit_queue", CONTROL, parts=("fifo", "pair_issue", "nearest_hit")),
    "plane_sphere_decoder": Bench("plane_sphere_decoder", CONTROL),
    "traversal": Bench("traversal", CONTROL),
    "tree_walk": Bench("tree_walk", CONTROL),
    "selector": Bench("selector", CONTROL),
    "pair_issue": Bench("pair_issue", CONTROL),
    "result_memory": Bench("result_memory", CONTROL),
    "triangle_lines": Bench("triangle_lines", CONTROL),
    "ray_bounds": Bench("ray_bounds", CONTROL),
    "edge_setup": Bench("edge_setup", ARITHMETIC, parts=("dsp_multiply_add",)),
    "row_interval": Bench("row_interval", ARITHMETIC, parts=("dsp_multiply_add",)),
    "row_selector": Bench("row_selector", CONTROL, parts=("row_interval",)),
    "column_selector": Bench("column_selector", CONTROL),
    "pencil_control": Bench("pencil_control", CONTROL, parts=("fifo",)),
    "unit_counters_12": Bench("unit_counters", CONTROL),
    "intersection_unit": Bench("intersection_unit", CONTROL, level=WORDS, parts=(
        "plane_sphere_subunit", "plane_sphere_decoder", "traversal", "selector", "pair_issue", "ray_triangle", "fifo",
        "result_memory")),
    "raplas_unit": Bench("raplas_unit", CONTROL, level=WORDS, parts=(
        "pencil_control", "unit_counters", "tree_walk", "fixed_testers", "triangle_lines", "fifo", "row_selector",
        "column_selector", "ray_bounds", "ray_solver", "depth_quotient", "hit_queue", "result_memory")),
}

SHARED = ("hierarchy -check -top {unit}; proc; {keep}flatten; opt; wreduce; peepopt; opt_clean; opt -full; "
          "memory -nomap; opt_clean")
MAPPED = "opt -fast -full; opt -undriven -fine; {techmap}; opt -fast; abc -g simple; opt -fast; opt_clean"


def yosys(script):
    return run("yosys", "-q", "-Q", "-T", "-p", script)


def modules(bench):
    """The modules of its parts: GHDL appends the generics to the name of the entity."""
    return " ".join(f"{part} {part}_*" for part in bench.parts)


def synthesis(bench):
    """The passes that make the netlist."""
    keep = f"setattr -mod -set keep_hierarchy 1 {modules(bench)}; " if bench.parts else ""
    if bench.level == WORDS:
        return SHARED.format(unit=bench.unit, keep=keep)
    whole = "t:$mem_v2 %d" + ("" if bench.multiplier else " t:$mul %d")
    # a pass maps the selected cells only, not what they become: adders to carries to gates takes several
    techmap = "; ".join([f"techmap t:* {whole}"] * 6)
    return "; ".join((SHARED, MAPPED)).format(unit=bench.unit, keep=keep, techmap=techmap)


def sites(netlist, unit):
    """(cell, port, bit) of all pins that a mutant may change."""
    module = json.loads(netlist.read_text())["modules"][unit]
    clocks = {bit for name, port in module["ports"].items() if name == "clk_i" for bit in port["bits"]}
    found = set()
    for name, cell in module["cells"].items():
        for port, bits in cell["connections"].items():
            found |= {(name, port, k) for k, bit in enumerate(bits)
                      if isinstance(bit, int) and bit not in clocks and port not in CLOCKS}
    return found


def site_of(command):
    cell, port, bit = (re.search(rf" -{option} (\S+)", command)[1] for option in ("cell", "port", "portbit"))
    return cell.removeprefix("\\"), port.removeprefix("\\"), int(bit)


def with_port(command, number, width):
    return command.replace("mutate ", f"mutate -ctrl {PORT} {width} {number} ", 1)


def make(bench, export, out):
    out.mkdir(parents=True, exist_ok=True)
    netlist, everything, raw = out / "netlist.il", out / "netlist.json", out / "list.txt"
    yosys(f"read_verilog {export / bench.unit}.v; {synthesis(bench)}; rename -enumerate -pattern g%; "
          f"write_ilang {netlist}; write_json {everything}")
    allowed = sites(everything, bench.unit)
    # Yosys 0.23 does not end when asked for more than there are: each site has at least three mutants
    number = min(4 * bench.mutants, len(allowed) * 2)
    yosys(f"read_ilang {netlist}; mutate -list {number} -seed {SEED} -o {raw} {bench.unit}")
    commands = [line for line in raw.read_text().splitlines() if site_of(line) in allowed][:bench.mutants]
    width = len(commands).bit_length()
    script = out / "mutants.ys"
    script.write_text("".join(with_port(c, k, width) + "\n" for k, c in enumerate(commands, 1)))
    verilog = out / f"{bench.unit}.v"
    yosys(f"read_ilang {netlist}; script {script}; opt_clean; write_verilog -noattr {verilog}")
    (out / "mutants.txt").write_text("".join(f"{command}\n" for command in commands))
    (out / "ports.txt").write_text((export / "ports.txt").read_text() + f"{PORT} {width} in vector\n")
    (out / "generics.txt").write_text("")
    (out / "unisim.v").write_text("// no vendor cells\n")
    raw.unlink()
    print(f"mutants: {bench.unit}: {len(commands)} mutants at {len(allowed)} pins")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--bench", required=True, choices=UNITS)
    parser.add_argument("--export", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    args = parser.parse_args()
    try:
        make(UNITS[args.bench], args.export, args.out)
    except RuntimeError as error:
        sys.exit(f"mutants: {error}")


if __name__ == "__main__":
    main()
