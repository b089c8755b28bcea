#!/usr/bin/env python3
"""Test of raplas_trace_compare. usage: compare_test.py PATH-OF-raplas_trace_compare"""
import pathlib
import subprocess
import sys
import tempfile

HEADER = "# unit toy clock a_i:8@0 q_o:8@2\n"
EXPECTED = HEADER + "0 a_i=01 q_o=xx\n1 a_i=02 q_o=1x\n2 a_i=03 q_o=03\n"
CASES = {  # name: (what was seen, exit code, what is said)
    "equal": (HEADER + "0 a_i=01 q_o=77\n1 a_i=02 q_o=1f\n2 a_i=03 q_o=03\n", 0, "equal: 3 clocks, 2 fields"),
    "value": (EXPECTED.replace("1x", "2f"), 1, "clock 1, stage 2, field q_o: expected 1x, seen 2f"),
    "unknown": (EXPECTED.replace("q_o=03", "q_o=0x"), 1, "clock 2, stage 2, field q_o: expected 03, seen 0x"),
    "short": (EXPECTED[:-len("2 a_i=03 q_o=03\n")], 1, "clock 2, stage -, field (line)"),
    "long": (EXPECTED + "3 a_i=04 q_o=04\n", 1, "clock 3, stage -, field (line)"),
    "field": (EXPECTED.replace("q_o", "r_o"), 1, "field q_o: expected xx, seen (no such field)"),
    "width": (EXPECTED.replace("a_i=02", "a_i=002"), 1, "clock 1, stage 0, field a_i: expected 02, seen 002"),
    "reordered": ("# unit toy clock q_o:8@2 a_i:8@0\n0 q_o=77 a_i=01\n1 q_o=1f a_i=02\n2 q_o=03 a_i=03\n", 0,
                  "equal"),
}


def main():
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        expected, seen = pathlib.Path(folder, "expected"), pathlib.Path(folder, "seen")
        expected.write_text(EXPECTED)
        for name, (text, code, said) in CASES.items():
            seen.write_text(text)
            run = subprocess.run([sys.argv[1], expected, seen], capture_output=True, text=True)
            ok = run.returncode == code and said in run.stdout
            wrong += not ok
            print(f"{'ok' if ok else 'WRONG'}: {name}: {run.stdout.strip()}")
    print(f"{len(CASES) - wrong} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
