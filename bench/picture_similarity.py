#!/usr/bin/python3
"""Measure the structural similarity of the configurations' pictures to that of double precision.

usage: picture_similarity.py [--build DIR]

Reads DIR/figures/configurations.json and the pictures in DIR/bench/pictures that `configurations` wrote (DIR: build),
and writes DIR/figures/picture_similarity.json: error.<scene>.<configuration>.ssim and error.<configuration>.ssim, the
mean over the scenes; .dissimilarity is 1 - SSIM. SSIM is scikit-image's with the window of Wang et al. 2004. The
pictures' RMSE is computed again from the files; exit code 1 if it is not the one that was reported. Runs on Debian's
Python: python3-skimage, python3-pil.
"""
import argparse
import json
import pathlib
import sys

import numpy
from PIL import Image
from skimage.metrics import structural_similarity

from common import ROOT, configurations, scenes_of, write_json

COMMAND = "make bench"


def fail(message):
    sys.exit(f"picture_similarity: {message}")


def read(path):
    try:
        return numpy.asarray(Image.open(path).convert("RGB"), dtype=float)
    except OSError as error:
        fail(f"{path}: {error}")


def similarity(expected, found):
    return float(structural_similarity(expected, found, channel_axis=2, data_range=255, gaussian_weights=True,
                                       sigma=1.5, use_sample_covariance=False))


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    args = parser.parse_args()
    figures = json.loads((args.build / "figures/configurations.json").read_text())
    pictures = args.build / "bench/pictures"
    out = {}

    def add(name, value):
        out[f"error.{name}.ssim"] = {"value": value, "unit": "SSIM", "command": COMMAND}
        out[f"error.{name}.dissimilarity"] = {"value": 1 - value, "unit": "1 - SSIM", "command": COMMAND}

    scenes = scenes_of(figures)
    for configuration in configurations(figures):
        values = []
        for scene in scenes:
            expected = read(pictures / f"{scene}.double.png")
            found = read(pictures / f"{scene}.{configuration}.png")
            rmse = float(numpy.sqrt(numpy.mean((found - expected) ** 2)))
            reported = figures[f"error.{scene}.{configuration}.rmse"]["value"]
            if abs(rmse - reported) > 1e-9:
                fail(f"{scene}.{configuration}.png: RMSE {rmse}, reported {reported}")
            values.append(similarity(expected, found))
            add(f"{scene}.{configuration}", values[-1])
        add(configuration, sum(values) / len(values))
    path = args.build / "figures/picture_similarity.json"
    write_json(path, out)
    print(f"{path}: {len(out)} figures")


if __name__ == "__main__":
    main()
