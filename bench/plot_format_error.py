#!/usr/bin/python3
"""Draw what format_error measured: errors against fraction bits, a panel for each scene, a line for each adder.

usage: plot_format_error.py FILE.csv ... -o PICTURE.png [--value COLUMN]

FILE.csv: written by `format_error --csv`. --value is a column of it, misclassified_percent if not given. Formats of
7 exponent bits are drawn; values of 0 have no place on a logarithmic axis and are left out. Needs matplotlib.
"""
import argparse
import collections
import csv
import math
import sys

EXPONENT_BITS = 7
HARDWARE_FRACTION = 16
# (guard, rounding): legend, colour, marker
ADDERS = {
    ("none", "truncate"): ("no guard bit, truncated (the paper)", "#b5432a", "o"),
    ("one", "truncate"): ("one guard bit, truncated", "#c98b00", "s"),
    ("exact", "truncate"): ("exact sum, truncated", "#2b6cb0", "^"),
    ("exact", "nearest"): ("exact sum, to nearest even", "#3a8f4d", "D"),
}
LABELS = {
    "misclassified_percent": "ray-triangle pairs decided wrongly, %",
    "rays_wrong_percent": "rays with another nearest hit than in double precision, %",
    "t_relative_median": "median relative error of t",
    "t_relative_99": "relative error of t, 99 % are below",
}


def read(files, value):
    """By scene: its head line, and by adder the (fraction bits, value), NaN for values that are 0 or missing."""
    scenes = {}
    for name in files:
        try:
            with open(name, newline="") as file:
                rows = list(csv.DictReader(file))
        except OSError as error:
            sys.exit(f"plot_format_error: {name}: {error.strerror}")
        if not rows or value not in rows[0] or "fraction_bits" not in rows[0]:
            sys.exit(f"plot_format_error: {name}: no lines of format_error --csv with a column {value}")
        for row in rows:
            head = f"{row['scene']}: {int(row['rays']):,} rays, {int(row['pairs']):,} pairs"
            _, lines = scenes.setdefault(row["scene"], (head, collections.defaultdict(list)))
            if int(row["exponent_bits"]) == EXPONENT_BITS:
                number = float(row[value] or 0) or math.nan
                lines[row["guard"], row["rounding"]].append((int(row["fraction_bits"]), number))
    return scenes


def draw(scenes, value, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(scenes), figsize=(1 + 4.2 * len(scenes), 5.2), sharey=True, squeeze=False)
    for axis, (head, lines) in zip(axes[0], scenes.values()):
        for adder, (label, colour, marker) in ADDERS.items():
            points = sorted(lines[adder])
            axis.plot([x for x, _ in points], [y for _, y in points], color=colour, marker=marker, markersize=4,
                      linewidth=1.2, label=label)
        axis.axvline(HARDWARE_FRACTION, color="#888888", linewidth=1, linestyle=":")
        axis.annotate("fp24", (HARDWARE_FRACTION, 0.97), xycoords=("data", "axes fraction"), xytext=(3, 0),
                      textcoords="offset points", va="top", color="#666666", fontsize=9)
        axis.set_yscale("log")
        axis.set_title(head, fontsize=10)
        axis.set_xlabel("fraction bits")
        axis.set_xticks(range(8, 24, 3))
        axis.set_xlim(7.4, 23.6)
        axis.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes[0][0].set_ylabel(LABELS.get(value, value))
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=2, frameon=False, fontsize=9)
    figure.suptitle(f"Ray-triangle test in 1 + {EXPONENT_BITS} + f bits against double precision", fontsize=12)
    figure.text(0.995, 0.005, "values of 0 are not drawn", ha="right", fontsize=8, color="#666666")
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    try:
        figure.savefig(picture, dpi=130)
    except (OSError, ValueError) as error:
        sys.exit(f"plot_format_error: {picture}: {error}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", metavar="FILE.csv")
    parser.add_argument("-o", "--output", required=True, metavar="PICTURE.png")
    parser.add_argument("--value", default="misclassified_percent", metavar="COLUMN")
    options = parser.parse_args()
    draw(read(options.files, options.value), options.value, options.output)


if __name__ == "__main__":
    main()
