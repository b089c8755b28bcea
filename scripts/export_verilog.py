#!/usr/bin/env python3
"""Export one VHDL unit as Verilog, and refuse what GHDL 2.0.0 exports wrongly.

usage: export_verilog.py --unit U [--generic NAME=VALUE ...] [--prim generic|xc4v]
                         --sources rtl/sources.txt [--extra FILE ...] --out DIR
       export_verilog.py --check-latch FILE.v [--unit U]

Writes into DIR (a file is left alone when its text would not change):
  U.v           the unit and everything below it; vendor cells stay black boxes
  unisim.v      models of those cells, cut out of the cell library that Yosys ships (for Verilator)
  ports.txt     one port a line: name width in|out scalar|vector
  generics.txt  the overridden generics: name type value

Refused, exit 1 (the text is kept as DIR/U.rejected.v), because GHDL exports them silently wrong:
  a case without default   "when others" arms are dropped (ghdl issue 2041)
  a quoted wide constant   constants over 32 bits become ASCII strings (ghdl issue 2002)
  $signed(a) >> n          shift_right of a signed value fills with zeros
  $fatal                   an assert in synthesised code, which Yosys cannot read
--check-latch runs Yosys: any latch in the exported unit is refused too.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
COMPONENTS = ROOT / "tb/sim/vcomponents.vhd"
LATCHES = "t:$dlatch* t:$adlatch* t:$_DLATCH* t:LD*"
WIDE = re.compile(r'"[01xXzZ]{33,}"')
LOGICAL = re.compile(r"\$signed\([^()]*\) >> ")


def fail(message):
    sys.exit(f"export_verilog: {message}")


def read_sources(path, prim):
    """The files of a source list in analysis order, @PRIM@ replaced."""
    lines = [line.split("#")[0].strip() for line in path.read_text().splitlines()]
    return [path.parent / line.replace("@PRIM@", prim) for line in lines if line]


def write_if_changed(path, text):
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def synth(args, form):
    command = ["ghdl", "--synth", "--std=93", "-Wno-binding", f"--out={form}"]
    command += [f"-g{g}" for g in args.generic] + ["--work=unisim", str(COMPONENTS), "--work=raplas"]
    command += [str(f) for f in read_sources(args.sources, args.prim) + args.extra]
    run = subprocess.run(command + ["-e", args.unit], capture_output=True, text=True)
    if run.returncode:
        fail(f"{args.unit}: ghdl --synth failed:\n{run.stderr}")
    return run.stdout


def cut_black_boxes(verilog):
    """(text without the empty modules that stand for vendor cells, names of those cells)."""
    cells = []

    def cut(match):
        cells.append(match[1])
        return ""

    text = re.sub(r"(?m)^module (\w+)\n[^;]*;\nendmodule\n\n?", cut, verilog)
    return text, sorted(set(cells))


def yosys_share():
    yosys = shutil.which("yosys") or fail("yosys is not installed")
    return pathlib.Path(yosys).resolve().parent.parent / "share/yosys"


def cell_models(cells):
    """The Verilog models of the vendor cells, from Yosys' own library."""
    if not cells:
        return "// no vendor cells\n"
    library = (yosys_share() / "xilinx/cells_sim.v").read_text()
    text = "/* verilator lint_off COMBDLY */\n"
    for cell in cells:
        model = re.search(rf"(?ms)^module {cell} *\(.*?^endmodule\n", library)
        text += model[0] if model else fail(f"no model of {cell} in Yosys' cells_sim.v")
    return text


def broken_constructs(text):
    """Yields (line number, construct, VHDL position) of whatever GHDL 2.0.0 exports wrongly."""
    position, case_line, has_default = "", 0, False
    for number, line in enumerate(text.splitlines(), 1):
        if mark := re.match(r"\s*/\* (\S+:\d+:\d+)  \*/", line):
            position = mark[1]
        if re.match(r"\s*case\w* \(", line):
            case_line, has_default = number, False
        has_default |= bool(re.match(r"\s*default\s*:", line))
        if re.match(r"\s*endcase", line) and not has_default:
            yield case_line, "case without default", position
        if WIDE.search(line):
            yield number, "constant over 32 bits in quotes", position
        if LOGICAL.search(line):
            yield number, "signed shift that fills with zeros", position
        if "$fatal" in line:
            yield number, "assert ($fatal)", position


def entity_text(vhdl, unit):
    match = re.search(rf"(?ms)^entity {unit} is\n(.*?)^end\b", vhdl)
    return match[1] if match else fail(f"no entity {unit} in GHDL's VHDL netlist")


def ports(verilog, vhdl, unit):
    """Lines of ports.txt: widths from the Verilog header, scalar or vector from the VHDL one."""
    header = re.search(rf"(?ms)^module {unit}\s*\((.*?)\);", verilog) or fail(f"no module {unit}")
    entity = entity_text(vhdl, unit)
    lines = []
    for declaration in header[1].split(","):
        match = re.fullmatch(r"\s*(input|output) +(?:\[(\d+):0\] *)?(\w+)\s*", declaration)
        direction, left, name = match.groups() if match else fail(f"port '{declaration.strip()}' of {unit}")
        kind = re.search(rf"(?mi)^ *{name} *: *(?:in|out)\s+(\w+)", entity)[1].lower()
        scalar = "scalar" if kind in ("std_ulogic", "std_logic") else "vector"
        lines.append(f"{name} {int(left or 0) + 1} {direction[:-3]} {scalar}\n")
    return "".join(lines)


def generics(vhdl, args):
    entity = entity_text(vhdl, args.unit)
    lines = []
    for name, value in (g.split("=", 1) for g in args.generic):
        kind = re.search(rf"(?mi)^ *{name} *: *(\w+)", entity) or fail(f"{args.unit} has no generic {name}")
        lines.append(f"{name} {kind[1]} {value}\n")
    return "".join(lines)


def export(args):
    args.out.mkdir(parents=True, exist_ok=True)
    target, rejected = args.out / f"{args.unit}.v", args.out / f"{args.unit}.rejected.v"
    vhdl = synth(args, "vhdl")
    verilog, cells = cut_black_boxes(synth(args, "verilog"))
    for line, construct, position in broken_constructs(verilog):
        rejected.write_text(verilog)
        target.unlink(missing_ok=True)
        fail(f"{rejected}:{line}: {construct} (VHDL: {position})")
    rejected.unlink(missing_ok=True)
    write_if_changed(args.out / "ports.txt", ports(verilog, vhdl, args.unit))
    write_if_changed(args.out / "generics.txt", generics(vhdl, args))
    write_if_changed(args.out / "unisim.v", cell_models(cells))
    write_if_changed(target, verilog)


def check_latch(path, unit):
    script = f"read_verilog {path}; hierarchy -top {unit}; proc; tee -o /dev/stderr select -list {LATCHES}"
    run = subprocess.run(["yosys", "-Q", "-T", "-p", script], capture_output=True, text=True)
    if run.returncode:
        fail(f"{path}: yosys failed:\n{run.stdout}{run.stderr}")
    if latches := run.stderr.split():
        fail(f"{path}: latches: {' '.join(latches)}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--unit")
    parser.add_argument("--generic", action="append", default=[])
    parser.add_argument("--prim", choices=("generic", "xc4v"), default="generic")
    parser.add_argument("--sources", type=pathlib.Path)
    parser.add_argument("--extra", type=pathlib.Path, action="append", default=[])
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--check-latch", type=pathlib.Path)
    args = parser.parse_args()
    if args.check_latch:
        check_latch(args.check_latch, args.unit or args.check_latch.stem)
    else:
        export(args)


if __name__ == "__main__":
    main()
