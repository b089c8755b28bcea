#!/usr/bin/env python3
"""Show that scripts/export_verilog.py refuses what GHDL 2.0.0 exports wrongly.

usage: run.py
Exports each unit of this folder and expects the message below; good.vhd must pass.
latch_netlist.v is checked as it is, since GHDL refuses to export a latch.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SCRIPT = HERE.parent.parent.parent / "scripts/export_verilog.py"
EXPECTED = {
    "good": "",
    "latch": "latch infered",  # GHDL's own spelling
    "latch_netlist": "latches: latch_netlist/",
    "dropped_others": "case without default",
    "wide_constant": "constant over 32 bits in quotes",
    "signed_shift": "signed shift that fills with zeros",
}


def messages(unit, folder):
    """What the export and the latch check say of one unit; '' when both pass."""
    if (netlist := HERE / f"{unit}.v").exists():
        shutil.copy(netlist, folder)
        checks = []
    else:
        checks = [export_arguments(unit, folder)]
    checks.append([SCRIPT, "--check-latch", folder / f"{unit}.v"])
    for arguments in checks:
        run = subprocess.run([sys.executable, *arguments], capture_output=True, text=True)
        if run.returncode:
            return run.stderr
    return ""


def export_arguments(unit, folder):
    sources = folder / "sources.txt"
    sources.write_text(f"{HERE / unit}.vhd\n")
    return [SCRIPT, "--unit", unit, "--sources", sources, "--out", folder]


def main():
    wrong = 0
    for unit, expected in EXPECTED.items():
        with tempfile.TemporaryDirectory() as folder:
            said = messages(unit, pathlib.Path(folder)).strip()
        caught = expected in said if expected else not said
        wrong += not caught
        print(f"{'ok' if caught else 'WRONG'}: {unit}: {said or 'passes'}")
    print(f"{len(EXPECTED) - wrong} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
