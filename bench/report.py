#!/usr/bin/python3
"""Put run time against error: one page with tables, plots, difference images and heat maps.

usage: report.py [--build DIR] [--require-better-than NAME]

Reads what `make bench` measured in DIR (default: build): figures/configurations.json, picture_similarity.json,
plane_error.json, bench/format_error.csv and bench/pictures; and figures/netlist.json of `make netlist`, without which
costs of hardware are missing. Writes DIR/bench/report.html, which needs no other file, DIR/bench/pareto.png, and
DIR/figures/cost.json with the hardware's costs by configuration.

--require-better-than  exits 1 unless some configuration is better than this one in errors, clocks and LUT

Runs on Debian's Python: python3-matplotlib, python3-pil.
"""
import argparse
import base64
import collections
import html
import io
import json
import pathlib
import sys

import matplotlib
import numpy
from PIL import Image

import plot_format_error
from common import DOUBLE, ROOT, configurations, scenes_of, write_json

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402 (after the choice of the backend)

ERRORS = (("rays wrong, %", "misclassified_percent"), ("RMSE, levels", "rmse"), ("PSNR, dB", "psnr"),
          ("1 - SSIM", "dissimilarity"), ("pixels that differ, %", "pixels_percent"))
SCENE_ERRORS = ERRORS + (("camera: missed, %", "camera_missed_percent"), ("false, %", "camera_false_percent"),
                         ("other triangle, %", "camera_other_percent"), ("shadow: missed, %", "shadow_missed_percent"),
                         ("false, %", "shadow_false_percent"), ("t: median, ulp", "t_ulp_median"),
                         ("99 %, ulp", "t_ulp_99"), ("largest, ulp", "t_ulp_largest"),
                         ("median, relative", "t_relative_median"), ("largest, relative", "t_relative_largest"))
COSTS = (("clocks a ray", "clocks_per_ray"), ("LUT", "lut"), ("DSP48", "dsp48"), ("RAMB16", "block_ram"),
         ("time of double", "time"))
SCENE_COSTS = (("clocks a ray: camera", "camera_clocks_per_ray"), ("shadow", "shadow_clocks_per_ray"),
               ("all", "clocks_per_ray"), ("time of double: camera", "camera_time"), ("shadow", "shadow_time"),
               ("all", "time"), ("ns a ray, this machine", "nanoseconds_per_ray"))
AMPLIFIED = 16  # difference images
HARDWARE_COLOUR, SOFTWARE_COLOUR = "#2b6cb0", "#c98b00"
STYLE = """body{font:15px/1.5 sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:1em 0}td,th{padding:2px 9px;border-bottom:1px solid #ddd;text-align:right}
td:first-child,th:first-child{text-align:left}img{max-width:100%}figure{display:inline-block;margin:4px;width:256px}
figure img{width:256px;image-rendering:pixelated}figcaption{font-size:12px;color:#555}.table{overflow-x:auto}"""


class Figures:
    """Values by name; None for what was not measured."""

    def __init__(self, folder):
        self.all = {}
        for name in ("configurations", "picture_similarity", "plane_error", "netlist", "cost"):
            path = folder / f"{name}.json"
            if path.exists():
                self.all.update(json.loads(path.read_text()))

    def __call__(self, name):
        return self.all.get(name, {}).get("value")

    def title(self, configuration):
        return self(f"configuration.{configuration}.title")


def hardware_costs(figures):
    """Figures cost.<configuration>.lut, .dsp48 and .block_ram, of the netlist of each unit."""
    costs = {}
    for name in configurations(figures.all):
        unit = figures(f"configuration.{name}.netlist")
        if not unit or figures(f"lut.{unit}") is None:
            continue
        lut = figures(f"lut.{unit}") + figures(f"lut_ram.{unit}")
        for key, value, of in (("lut", lut, "LUT4"), ("dsp48", figures(f"dsp48.{unit}"), "DSP48"),
                               ("block_ram", figures(f"block_ram.{unit}"), "RAMB16")):
            costs[f"cost.{name}.{key}"] = {"value": value, "unit": of, "command": "make netlist bench"}
    return costs


def shown(value):
    if value is None:
        return "-"
    return f"{value:,}" if isinstance(value, int) else f"{value:,.0f}" if value >= 1000 else f"{value:.3g}"


def table(head, rows):
    lines = ["<tr>" + "".join(f"<th>{html.escape(cell)}</th>" for cell in head) + "</tr>"]
    lines += ["<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows]
    return f'<div class="table"><table>{"".join(lines)}</table></div>'


def is_better(figures, one, other, keys=("error.{}.misclassified_percent", "error.{}.rmse", "cost.{}.clocks_per_ray",
                                         "cost.{}.lut")):
    """Better in every one of these figures."""
    pairs = [(figures(key.format(one)), figures(key.format(other))) for key in keys]
    return all(a is not None and b is not None and a < b for a, b in pairs)


def hardware(figures):
    """Configurations with a known number of LUT, the smallest first."""
    names = [name for name in configurations(figures.all) if figures(f"cost.{name}.lut") is not None]
    return sorted(names, key=lambda name: figures(f"cost.{name}.lut"))


def best_at_budgets(figures):
    """One sentence for each budget of LUT at which the choice changes."""
    sentences, last = [], None
    names = hardware(figures)
    for k, name in enumerate(names):
        fitting = names[:k + 1]
        fastest = min(fitting, key=lambda n: figures(f"cost.{n}.clocks_per_ray"))
        exactest = min(fitting, key=lambda n: figures(f"error.{n}.misclassified_percent"))
        if (fastest, exactest) != last:
            def of(n):
                return (f"{n} ({shown(figures(f'cost.{n}.clocks_per_ray'))} clocks a ray, "
                        f"{shown(figures(f'error.{n}.misclassified_percent'))} % of rays wrong)")
            best = f"{of(fastest)} is fastest and has the fewest errors" if fastest == exactest else \
                f"{of(fastest)} is fastest, {of(exactest)} has the fewest errors"
            sentences.append(f"From {shown(figures(f'cost.{name}.lut'))} LUT on, {best}.")
        last = (fastest, exactest)
    return sentences


def better_sentences(figures, than):
    """(configurations that are better than this one in all, a sentence for each)."""
    names = [name for name in hardware(figures) if is_better(figures, name, than)]
    parts = (("error.{}.misclassified_percent", "% of rays wrong"), ("error.{}.rmse", "levels RMSE"),
             ("cost.{}.clocks_per_ray", "clocks a ray"), ("cost.{}.lut", "LUT"))
    return names, [f"{name} is better than {than} in all: " + "; ".join(
        f"{shown(figures(key.format(name)))} for {shown(figures(key.format(than)))} {unit}"
        for key, unit in parts) + "." for name in names]


def data_uri(data, kind):
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def plot_uri(figure):
    out = io.BytesIO()
    figure.savefig(out, format="svg")
    pyplot.close(figure)
    return data_uri(out.getvalue(), "svg+xml")


def image(uri, text):
    return f'<img src="{uri}" alt="{html.escape(text)}">'


def captioned(uri, text):
    return f'<figure>{image(uri, text)}<figcaption>{html.escape(text)}</figcaption></figure>'


def pareto_front(points):
    """Points (x, y) that no other is left of and below, from left to right."""
    front = []
    for x, y in sorted(points):
        if not front or y < front[-1][1]:
            front.append((x, y))
    return front


def pareto_panel(axis, figures, names, x_axis, y_axis, colour):
    """Configurations by two figures, each (text, name with {} for the configuration); smaller is better."""
    points = collections.defaultdict(list)
    for name in names:
        x, y = (figures(key.format(name)) for _, key in (x_axis, y_axis))
        if x is not None and (y or y == 0 and axis.get_yscale() == "linear"):
            points[float(f"{x:.3g}"), float(f"{y:.3g}")].append(name)
    for k, point in enumerate(sorted(points)):  # labels above and below in turn
        axis.plot(*point, "o", color=colour, markersize=6)
        axis.annotate(",\n".join(points[point]), point, xytext=(4, 5 if k % 2 == 0 else -5),
                      va="bottom" if k % 2 == 0 else "top", textcoords="offset points", fontsize=8)
    front = pareto_front(points)
    axis.step([x for x, _ in front], [y for _, y in front], where="post", color=colour, linewidth=1, alpha=0.6)
    axis.set_xlabel(x_axis[0])
    axis.set_ylabel(y_axis[0])
    axis.grid(True, color="#dddddd", linewidth=0.6)
    axis.margins(0.3)
    if not points:
        axis.text(0.5, 0.5, "all errors are 0", transform=axis.transAxes, ha="center")
        return
    if axis.get_yscale() == "linear" and max(y for _, y in points) > 0:
        axis.set_ylim(0, 1.25 * max(y for _, y in points))
    if axis.get_xscale() == "linear":
        axis.set_xlim(0, 1.3 * max(x for x, _ in points))


def axis_of(text, kind, key):
    return text, f"{kind}.{{}}.{key}"


def pareto(figures, errors=ERRORS[:2]):
    """A panel for each cost and error; the lines join what nothing else is better than."""
    names = configurations(figures.all)
    devices = hardware(figures) or [n for n in names if figures(f"cost.{n}.clocks_per_ray") is not None]
    software = [name for name in names if figures(f"cost.{name}.time") is not None]
    columns = [(COSTS[0], devices), (COSTS[1], devices), (COSTS[2], devices)]
    if software:
        columns.append((COSTS[4], software))
    figure, axes = pyplot.subplots(len(errors), len(columns), figsize=(4 * len(columns), 3.6 * len(errors)),
                                   squeeze=False)
    for row, error in zip(axes, errors):
        for axis, (cost, members) in zip(row, columns):
            colour = SOFTWARE_COLOUR if members is software else HARDWARE_COLOUR
            if cost[1] == "clocks_per_ray":
                axis.set_xscale("log")
            pareto_panel(axis, figures, members, axis_of(cost[0], "cost", cost[1]),
                         axis_of(error[0], "error", error[1]), colour)
    figure.tight_layout()
    return figure


def pareto_picture(figures):
    """The main plot: errors against clocks, and clocks against LUT."""
    figure, axes = pyplot.subplots(1, 2, figsize=(10, 4.2))
    clocks = axis_of("clocks a ray, geometric mean of the scenes", "cost", "clocks_per_ray")
    lut = axis_of("LUT of the whole unit, estimated by Yosys", "cost", "lut")
    wrong = axis_of("rays wrong, %, mean of the scenes", "error", "misclassified_percent")
    axes[0].set_xscale("log")
    axes[1].set_yscale("log")
    pareto_panel(axes[0], figures, hardware(figures), clocks, wrong, HARDWARE_COLOUR)
    pareto_panel(axes[1], figures, hardware(figures), lut, clocks, HARDWARE_COLOUR)
    figure.suptitle("Better is left and below; lines join what nothing else is better than", fontsize=10)
    figure.tight_layout()
    return figure


def planes_plot(figures, scenes):
    widths = [w for w in range(8, 40) if figures(f"planes.w{w}.false_percent") is not None]
    figure, axes = pyplot.subplots(1, len(scenes), figsize=(4 * len(scenes), 4), sharey=True, squeeze=False)
    for axis, scene in zip(axes[0], scenes):
        def values(key, scene=scene):
            return [figures(f"planes.{scene}.w{w}.{key}") or numpy.nan for w in widths]
        axis.plot(widths, values("false_percent"), "o-", color=HARDWARE_COLOUR, label="found too much, with slack")
        axis.plot(widths, values("bare_lost_percent"), "s-", color="#b5432a", label="lost without slack")
        for key, colour, label in (("false_percent", "#3a8f4d", "fp24_paper: found too much"),
                                   ("bare_lost_percent", "#c98b00", "fp24_paper: lost with the plain radius")):
            axis.axhline(figures(f"planes.{scene}.fp24_paper.{key}") or numpy.nan, color=colour, linewidth=1,
                         linestyle="--", label=label)
        axis.axvline(18, color="#888888", linewidth=1, linestyle=":")
        axis.set_yscale("log")
        axis.set_xlim(widths[0] - 0.5, widths[-1] + 0.5)
        axis.set_title(scene, fontsize=10)
        axis.set_xlabel("bits of a word")
        axis.grid(True, color="#dddddd", linewidth=0.6)
    axes[0][0].set_ylabel("% of the meets that there are")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=2, frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.12, 1, 1))
    return figure


def planes_table(figures):
    keys = ("dsp48", "lost_percent", "false_percent", "bare_lost_percent", "bare_false_percent")
    testers = ["fp24_paper", "fp24"] + [f"w{w}" for w in range(8, 40)]
    rows = [[t, *(shown(figures(f"planes.{t}.{key}")) for key in keys)] for t in testers
            if figures(f"planes.{t}.dsp48") is not None]
    return table(("words", "DSP48 a test", "lost, %", "found too much, %", "without slack: lost, %", "too much, %"),
                 rows)


def sweep_plots(csv):
    parts = []
    for value in ("misclassified_percent", "rays_wrong_percent", "t_relative_median"):
        out = io.BytesIO()
        plot_format_error.draw(plot_format_error.read([str(csv)], value), value, out)
        parts.append(image(data_uri(out.getvalue(), "png"), value))
    return "\n".join(parts)


def png(pixels):
    out = io.BytesIO()
    Image.fromarray(pixels.astype(numpy.uint8)).save(out, format="PNG")
    return data_uri(out.getvalue(), "png")


def scene_pictures(figures, scene, pictures):
    def read(name):
        return numpy.asarray(Image.open(pictures / f"{scene}.{name}.png").convert("RGB"), dtype=float)
    reference = read(DOUBLE)
    parts = [captioned(png(reference), "double precision")]
    heat_map = pictures / f"{scene}.clocks.png"
    if heat_map.exists():
        parts.append(captioned(data_uri(heat_map.read_bytes(), "png"),
                               "clocks of raplas for each camera pencil: black 0, white most"))
    for name in configurations(figures.all):
        if name == DOUBLE:
            continue
        difference = numpy.minimum(255, AMPLIFIED * numpy.abs(read(name) - reference))
        parts.append(captioned(png(difference), f"{name}: difference from double, {AMPLIFIED} times"))
    return "\n".join(parts)


def configuration_rows(figures, names, keys):
    return [[name, *(shown(figures(key.format(name))) for key in keys)] for name in names]


def page(figures, build, sentences):
    names, scenes = configurations(figures.all), scenes_of(figures.all)
    mean_keys = [f"error.{{}}.{key}" for _, key in ERRORS] + [f"cost.{{}}.{key}" for _, key in COSTS]
    parts = ["<h1>Run time against error</h1>", "".join(f"<p>{html.escape(s)}</p>" for s in sentences),
             "<p>What each column is: docs/benchmarks.md. LUT, DSP48 and RAMB16 are Yosys' estimates for the whole "
             "unit.</p>",
             "<h2>All configurations</h2><ul>",
             *(f"<li><b>{name}</b>: {html.escape(figures.title(name))}</li>" for name in names), "</ul>",
             table(("mean of the scenes", *(text for text, _ in ERRORS), *(text for text, _ in COSTS)),
                   configuration_rows(figures, names, mean_keys)),
             "<h2>Pareto plots</h2><p>Left and below is better; lines join what nothing else is better than. Errors "
             "of 0 have no place on a logarithmic axis.</p>", image(plot_uri(pareto(figures)), "Pareto plots")]
    if (build / "figures/plane_error.json").exists():
        plot = image(plot_uri(planes_plot(figures, scenes)), "plane tests")
        parts += ["<h2>Plane tests</h2>", planes_table(figures), plot]
    csv = build / "bench/format_error.csv"
    if csv.exists():
        parts += ["<h2>Number formats of the ray-triangle test</h2>", sweep_plots(csv)]
    for scene in scenes:
        error_keys = [f"error.{scene}.{{}}.{key}" for _, key in SCENE_ERRORS]
        cost_keys = [f"cost.{scene}.{{}}.{key}" for _, key in SCENE_COSTS]
        parts += [f"<h2>{html.escape(scene)}</h2>",
                  table(("errors", *(text for text, _ in SCENE_ERRORS)),
                        configuration_rows(figures, names, error_keys)),
                  table(("costs", *(text for text, _ in SCENE_COSTS)), configuration_rows(figures, names, cost_keys)),
                  scene_pictures(figures, scene, build / "bench/pictures")]
    return (f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Run time against error</title>'
            f"<style>{STYLE}</style></head><body>{chr(10).join(parts)}</body></html>\n")


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--require-better-than", metavar="NAME")
    args = parser.parse_args()
    figures = Figures(args.build / "figures")
    if not configurations(figures.all):
        sys.exit(f"report: {args.build}/figures/configurations.json is missing: make bench")
    costs = hardware_costs(figures)
    figures.all.update(costs)
    write_json(args.build / "figures/cost.json", costs)
    if not costs:
        print("report: no costs of hardware: make netlist measures them", file=sys.stderr)
    sentences = best_at_budgets(figures)
    better, explained = better_sentences(figures, args.require_better_than or "paper")
    (args.build / "bench").mkdir(parents=True, exist_ok=True)
    picture = pareto_picture(figures)
    picture.savefig(args.build / "bench/pareto.png", dpi=100)
    pyplot.close(picture)
    report = args.build / "bench/report.html"
    report.write_text(page(figures, args.build, sentences + explained))
    print("\n".join(sentences + explained))
    print(f"report: {report}")
    if costs and args.require_better_than and not better:
        print(f"report: no configuration is better than {args.require_better_than} in errors, clocks and LUT",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
