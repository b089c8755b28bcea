#!/usr/bin/env python3
"""The gate of errors must fail for what is worse, missing or unknown.

usage: error_gate_test.py PROGRAMS
"""
import pathlib
import subprocess
import sys
import unittest

import error_gate

GATE = pathlib.Path(error_gate.__file__)


class Compare(unittest.TestCase):
    STORED = {"error.s.paper.rmse": 0.5, "error.s.paper.pixels_percent": 0.0}

    def test_equal_figures_pass(self):
        self.assertEqual(error_gate.compare(self.STORED, dict(self.STORED)), ([], []))

    def test_any_increase_is_worse(self):
        for name in self.STORED:
            worse, better = error_gate.compare(self.STORED, {**self.STORED, name: self.STORED[name] + 1e-6})
            self.assertEqual((len(worse), better), (1, []))
            self.assertIn(name, worse[0])

    def test_a_decrease_is_better_and_no_failure(self):
        worse, better = error_gate.compare(self.STORED, {**self.STORED, "error.s.paper.rmse": 0.4})
        self.assertEqual((worse, len(better)), ([], 1))

    def test_missing_and_unknown_figures_fail(self):
        self.assertEqual(len(error_gate.compare(self.STORED, {"error.s.paper.rmse": 0.5})[0]), 1)
        self.assertEqual(len(error_gate.compare(self.STORED, {**self.STORED, "error.s.paper.new": 0})[0]), 1)


class Gate(unittest.TestCase):
    programs = ""

    def test_worse_formats_in_the_place_of_raplas_and_of_18_bits_fail(self):
        run = subprocess.run([sys.executable, str(GATE), self.programs, "--instead", "raplas=paper", "--instead",
                              "w18=w12"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        for name in ("error.cornell_teapot.raplas.", "planes.teapot.w18.false_percent"):
            self.assertIn(f"worse: {name}", run.stderr)


if __name__ == "__main__":
    Gate.programs = sys.argv.pop(1)
    unittest.main()
