#!/usr/bin/python3
"""The report of made-up figures: what it says, that it needs no other file, and what it refuses."""
import json
import pathlib
import re
import subprocess
import tempfile
import unittest

import numpy
from PIL import Image

import report

FOLDER = pathlib.Path(report.__file__).parent
RMSE = {"double": 0.0, "paper": 4.0, "small": 2.0, "fast": 3.0}
CLOCKS = {"paper": 100.0, "small": 50.0, "fast": 5.0}
LUT = {"paper": 1000, "small": 900, "fast": 2000}


def figure(value):
    return {"value": value, "unit": "", "command": ""}


def made_up():
    figures = {}
    for name, rmse in RMSE.items():
        figures[f"configuration.{name}.title"] = figure(f"title of {name}")
        figures[f"configuration.{name}.netlist"] = figure(f"unit_{name}" if name in LUT else "")
        for prefix in (f"error.{name}", f"error.box.{name}"):
            figures[f"{prefix}.rmse"] = figure(rmse)
            figures[f"{prefix}.misclassified_percent"] = figure(rmse / 100)
        if name in CLOCKS:
            figures[f"cost.{name}.clocks_per_ray"] = figure(CLOCKS[name])
    return figures


def netlist():
    return {f"{kind}.unit_{name}": figure(lut if kind == "lut" else 0)
            for name, lut in LUT.items() for kind in ("lut", "lut_ram", "dsp48", "block_ram")}


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name)
        (self.build / "figures").mkdir()
        pictures = self.build / "bench/pictures"
        pictures.mkdir(parents=True)
        for name, rmse in RMSE.items():
            pixels = numpy.full((16, 16, 3), 100 + rmse, dtype=numpy.uint8)
            Image.fromarray(pixels).save(pictures / f"box.{name}.png")
        self.write("configurations", made_up())
        self.write("netlist", netlist())

    def write(self, name, figures):
        (self.build / f"figures/{name}.json").write_text(json.dumps(figures))

    def run_script(self, script, *options):
        return subprocess.run([str(FOLDER / script), "--build", str(self.build), *options], capture_output=True,
                              text=True)

    def test_is_one_file_that_names_the_best_at_each_budget(self):
        run = self.run_script("report.py", "--require-better-than", "paper")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"From 900 LUT on, small .* is fastest and has the fewest errors")
        self.assertRegex(run.stdout, r"From 2,000 LUT on, fast .* is fastest, small .* has the fewest errors")
        self.assertRegex(run.stdout, r"small is better than paper in all")
        self.assertNotIn("fast is better than paper", run.stdout)
        page = (self.build / "bench/report.html").read_text()
        self.assertEqual(len(re.findall(r'src="data:', page)), 5, "the plots, the picture, three differences")
        self.assertEqual(re.findall(r'(?:src|href)="(?!data:)[^"]*"', page), [])
        costs = json.loads((self.build / "figures/cost.json").read_text())
        self.assertEqual(costs["cost.fast.lut"]["value"], 2000)

    def test_fails_when_nothing_is_better(self):
        run = self.run_script("report.py", "--require-better-than", "small")
        self.assertEqual(run.returncode, 1)
        self.assertIn("no configuration is better than small", run.stderr)

    def test_similarity_is_of_the_pictures_that_were_reported(self):
        run = self.run_script("picture_similarity.py")
        self.assertEqual(run.returncode, 0, run.stderr)
        similar = json.loads((self.build / "figures/picture_similarity.json").read_text())
        self.assertEqual(similar["error.box.double.ssim"]["value"], 1)
        self.assertLess(similar["error.box.paper.ssim"]["value"], 1)
        Image.new("RGB", (16, 16)).save(self.build / "bench/pictures/box.paper.png")
        run = self.run_script("picture_similarity.py")
        self.assertEqual(run.returncode, 1)
        self.assertIn("box.paper.png: RMSE", run.stderr)


class ParetoFront(unittest.TestCase):
    def test_holds_what_nothing_is_left_of_and_below(self):
        self.assertEqual(report.pareto_front([(3, 1), (1, 3), (2, 4), (2, 2), (4, 1)]), [(1, 3), (2, 2), (3, 1)])


if __name__ == "__main__":
    unittest.main()
