#!/usr/bin/env python3
"""Collect measured figures, and fill the tables of README.md and of pages in docs/ with them.

usage: figures.py [--require NAME ...] [--check] [--build DIR] [--page FILE ...]

Merges DIR/figures/*.json (DIR: build) into DIR/figures.json, {"name": {"value", "unit", "command"}},
sorted. A figure may come from several files when all give the same value and unit. In each FILE (default: all
pages) the lines between "<!-- figures:TABLE -->" and "<!-- /figures -->"
become the table TABLE of TABLES below. A figure that was not measured shows as a dash.

--require  exits 1 when one of these figures is missing; "dsp48.*" asks for at least one
--check    writes nothing in FILE and exits 1 when a table in it is stale
"""
import argparse
import fnmatch
import json
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MARK = re.compile(r"(?ms)^(<!-- figures:(\w+) -->\n)(.*?)^(<!-- /figures -->)$")
DASH = "-"
PAGES = tuple(ROOT / page for page in ("README.md", "docs/benchmarks.md", "docs/exact.md", "docs/numerics.md",
                                       "docs/skipping.md", "docs/stress.md"))

# What the paper reports for the XC4VSX35 with ISE 8.2.
PAPER = {
    "paper.slices.plane_sphere_subunit": 8248,
    "paper.dsp48.plane_sphere_subunit": 96,
    "paper.slices.ray_triangle": 5282,
    "paper.dsp48.ray_triangle": 70,
}

# A table has columns (heading, kind) and rows (text, key): a cell shows the figure kind.key, or, of a kind with a *,
# the figure that has the key in its place; rows may be such a kind too: all keys that there are. The kinds
# "value", "unit" and "command" show that part of the figure `key` itself; optional rows vanish without it.
UNITS = ("fp_add", "fp_mul", "plane_sphere_tester", "plane_sphere_subunit", "nearest_hit", "ray_triangle",
         "intersection_unit", "intersection_unit_paper", "intersection_unit_2x2", "fixed_testers",
         "ray_solver_fabric", "hit_queue_fabric", "raplas_unit")
EXACT_SCENES = (("Cornell box", "cornell"), ("Cornell box with teapot", "cornell_teapot"), ("bunny, floor", "bunny_69k"),
                ("dragon, floor", "dragon_871k"))
SKIP_SCENES = (("Cornell box", "cornell"), ("Cornell box with teapot", "teapot"), ("bunny, floor", "bunny_floor"),
               ("dragon, floor", "dragon_floor"))
SKIP_MESHES = ("teapot_1k", "bunny_3k", "dragon_11k", "dragon_47k", "bunny_69k", "dragon_202k", "dragon_871k")
SKIP_STEPS = (("brute force", "brute"), ("conventional, ray by ray", "conventional"), ("paper: flat list, 4x4", "paper"),
              ("flat list, 16x16", "flat"), ("+ tree", "tree"), ("+ inherited masks", "inherited"),
              ("+ behind", "behind"), ("+ nearest first", "nearest"), ("+ hidden", "hidden"),
              ("+ rectangles", "rectangles"), ("+ scan lines", "scan_lines"), ("+ ended", "ended"), ("the clocked unit", "clocked"))
TESTS = (("spheres", "sphere_tests_per_ray"), ("vertices", "vertex_tests_per_ray"), ("pairs", "pairs_per_ray"))
BENCH_SCENES = (("Cornell", "cornell"), ("teapot", "cornell_teapot"), ("bunny", "bunny_69k"),
                ("dragon", "dragon_871k"))
CONFIGURATIONS = tuple((f"`{name}`", name) for name in (
    "paper", "paper_guarded", "paper_tree", "tree_2x2", "raplas", "exact", "double", "float", "embree",
    "embree_robust"))
PLANE_WORDS = (("`fp24_paper`", "fp24_paper"), ("`fp24`", "fp24"),
               *((f"{width} bits", f"w{width}") for width in range(10, 25)))
ONE_FIGURE = (("value", "value"), ("unit", "unit"), ("command", "command"))
TABLES = {
    "hardware": {
        "head": "unit",
        "columns": (("clocks", "stages"), ("DSP48", "dsp48"), ("LUT", "lut"), ("FF", "ff"),
                    ("RAMB16", "block_ram"), ("slices, estimated", "slices_estimated"),
                    ("paper: slices (ISE)", "paper.slices"), ("paper: DSP48", "paper.dsp48")),
        "rows": tuple((f"`{unit}`", unit) for unit in UNITS),
        "optional": (),
    },
    "render": {
        "head": "model against RTL",
        "columns": ONE_FIGURE,
        "rows": (
            ("bits that differ in the hits", "render.differing_bits"),
            ("event counters that differ", "render.differing_counters"),
            ("hits compared", "render.hits_compared"),
            ("pixels of the picture", "render.pixels"),
            ("pixels that differ from double precision", "render.pixels_off_reference"),
            ("... by more than 2 of 255 levels", "render.pixels_off_reference_over_2_levels"),
            ("cycles", "render.cycles"),
            ("rays", "render.rays"),
            ("rays a cycle", "render.rays_per_cycle"),
            ("simulation speed", "sim.cycles_per_second"),
        ),
        "optional": ("render.hits_compared",),
    },
    "radius": {
        "head": "stored radius",
        "columns": ONE_FIGURE,
        "rows": (
            ("adversarial cases", "radius.cases"),
            ("true hits lost", "radius.lost_hits"),
            ("true hits lost without the enlargement", "radius.lost_hits_unenlarged"),
            ("price: extra hits of planes, bundled scene", "radius.extra_false_hits_percent"),
            ("price: extra hits of planes, Stanford bunny", "radius.extra_false_hits_percent.bunny_69k"),
            ("price: extra spheres traversed, bundled scene", "radius.extra_false_spheres_percent"),
            ("price: extra spheres traversed, Stanford bunny", "radius.extra_false_spheres_percent.bunny_69k"),
        ),
        "optional": ("radius.extra_false_hits_percent.bunny_69k", "radius.extra_false_spheres_percent.bunny_69k"),
    },
    "proof": {
        "head": "proofs and exhaustive checks",
        "columns": ONE_FIGURE,
        "rows": (
            ("cases proved or decided", "proof.cases"),
            ("cases refuted, undecided or missing", "proof.undecided"),
            ("broken designs", "proof.broken"),
            ("broken designs refuted", "proof.broken_refuted"),
            ("model: pairs of fractions multiplied, all there are", "model.mul_fraction_pairs"),
            ("model: pairs of words added", "model.add_pairs"),
            ("model: pairs of small formats, all there are", "model.small_format_pairs"),
            ("model: results that differ from exact integers", "model.mismatches"),
        ),
        "optional": (),
    },
    "bounds": {
        "head": "absolute error, normalised scene",
        "columns": (("proven", "bound.*.proven"), ("worst seen", "bound.*.worst_seen"),
                    ("seen / proven", "bound.*.ratio"), ("0 guard bits: worst seen", "bound.*_paper.worst_seen"),
                    ("seen / proven", "bound.*_paper.ratio")),
        "rows": (("`n.c + p` (plane and sphere)", "distance"), ("`N.D`", "nd"), ("`t'`", "t"), ("`u'`", "u"),
                 ("`v'`", "v"), ("`u' + v'`", "uv")),
        "optional": (),
    },
    "skip": {
        "head": "scene, pencils",
        "columns": (("rays/clock", "skip.*.rays_per_clock"), ("spheres/ray", "skip.*.sphere_tests_per_ray"),
                    ("vertices/ray", "skip.*.vertex_tests_per_ray"), ("pairs/ray", "skip.*.pairs_per_ray"),
                    ("busy, %", "skip.*.busy_percent"), ("paper: rays/clock", "skip_paper.*.rays_per_clock"),
                    ("paper: spheres/ray", "skip_paper.*.sphere_tests_per_ray"),
                    ("paper: pairs/ray", "skip_paper.*.pairs_per_ray"), ("hits changed", "skip.*.different")),
        "rows": tuple((f"{text}, {kind}", f"{key}.{kind}") for text, key in SKIP_SCENES
                      for kind in ("camera", "shadow")),
        "optional": (),
    },
    "skip_busy": {
        "head": "scene, pencils",
        "columns": (("either, %", "skip.*.busy_percent"), ("plane testers, %", "skip.*.testers_busy_percent"),
                    ("ray-triangle unit, %", "skip.*.pairs_busy_percent"),
                    ("paper: either, %", "skip_paper.*.busy_percent"),
                    ("paper: plane testers, %", "skip_paper.*.testers_busy_percent"),
                    ("paper: ray-triangle unit, %", "skip_paper.*.pairs_busy_percent"),
                    ("pencils not sent, %", "skip.*.not_sent_percent")),
        "rows": tuple((f"{text}, {kind}", f"{key}.{kind}") for text, key in SKIP_SCENES
                      for kind in ("camera", "shadow")),
        "optional": (),
    },
    "exact": {
        "head": "scene, rays",
        "columns": (("rays", "exact.*rays"), ("differing hits", "exact.*differing_hits"),
                    ("24 bit wrong, %", "exact.*plain_wrong_percent"), ("rivals, %", "exact.*rivals_percent"),
                    ("traced, %", "exact.*retested_percent"), ("clocks a ray", "exact.*plain_clocks"),
                    ("exact", "exact.*clocks"), ("host, %", "exact.*host_time_percent")),
        "rows": (*((f"{text}, {kind}", f"{key}.{kind}.") for text, key in EXACT_SCENES
                   for kind in ("camera", "shadow", "hemisphere")), ("all", "")),
        "optional": (),
    },
    "exact_total": {
        "head": "`--exact` on four scenes",
        "columns": ONE_FIGURE,
        "rows": (
            ("camera, shadow and hemisphere rays", "exact.rays"),
            ("... whose hits are not those of double precision, bit by bit", "exact.differing_hits"),
            ("... that the host traced in double precision", "exact.retested_percent"),
            ("... for which it tested two triangles", "exact.rivals_percent"),
            ("clocks a ray of the plain unit", "exact.plain_clocks"),
            ("... of the exact one", "exact.clocks"),
        ),
        "optional": (),
    },
    "skip_compared": {
        "head": "scene",
        "columns": (("triangles", "skip.*.triangles"),
                    *((f"{kind}: {text}", f"skip.*.{kind}.{key}") for kind in ("camera", "shadow")
                      for text, key in (("pencils", "pencils"), ("walked", "walked"), ("results compared", "compared"),
                                        ("different", "different")))),
        "rows": (*((f"{text}, 1024x1024", key) for text, key in SKIP_SCENES),
                 *((f"`{mesh}`, 512x512", mesh) for mesh in ("cornell_box", *SKIP_MESHES))),
        "optional": (),
    },
    "skip_rtl": {
        "head": "model against RTL, bunny, floor",
        "columns": ONE_FIGURE,
        "rows": (
            ("pencils in one stream, camera and shadow in turn", "skip.rtl.pencils_checked"),
            ("rays", "skip.rtl.rays_checked"),
            ("clocks", "skip.rtl.clocks_checked"),
            ("rays, counters and clocks that differ", "skip.rtl.differences"),
        ),
        "optional": (),
    },
    "growth": {
        "head": "mesh, 512x512",
        "columns": (("triangles", "skip.*.triangles"),
                    *((f"{kind}: {text}", f"skip.*.{kind}.{key}") for kind in ("camera", "shadow")
                      for text, key in (("rays/clock", "rays_per_clock"), *TESTS))),
        "rows": tuple((f"`{mesh}`", mesh) for mesh in SKIP_MESHES),
        "optional": (),
    },
    **{f"skip_{scene}": {
        "head": "tests and clocks for each ray",
        "columns": tuple((f"{kind}: {text}", f"skip_step.{scene}.{kind}.*.{key}") for kind in ("camera", "shadow")
                         for text, key in (*TESTS, ("clocks", "clocks_per_ray"))),
        "rows": SKIP_STEPS,
        "optional": (),
    } for _, scene in SKIP_SCENES},
    "configurations": {
        "head": "mean of four scenes",
        "columns": (("rays wrong, %", "error.*.misclassified_percent"), ("RMSE, levels", "error.*.rmse"),
                    ("PSNR, dB", "error.*.psnr"), ("1 - SSIM", "error.*.dissimilarity"),
                    ("pixels, %", "error.*.pixels_percent"), ("clocks/ray", "cost.*.clocks_per_ray"),
                    ("LUT", "cost.*.lut"), ("DSP48", "cost.*.dsp48"), ("RAMB16", "cost.*.block_ram"),
                    ("time of `double`", "cost.*.time")),
        "rows": CONFIGURATIONS,
        "optional": (),
    },
    "configuration_scenes": {
        "head": "by scene",
        "columns": tuple((f"{text}: {what}", f"{kind}.{scene}.*.{key}") for text, scene in BENCH_SCENES
                         for what, kind, key in (("rays wrong, %", "error", "misclassified_percent"),
                                                 ("RMSE", "error", "rmse"), ("clocks/ray", "cost", "clocks_per_ray"))),
        "rows": CONFIGURATIONS,
        "optional": (),
    },
    "planes": {
        "head": "words",
        "columns": (("DSP48 a test", "planes.*.dsp48"), ("lost, %", "planes.*.lost_percent"),
                    ("found too much, %", "planes.*.false_percent"),
                    ("without slack: lost, %", "planes.*.bare_lost_percent"),
                    ("too much, %", "planes.*.bare_false_percent")),
        "rows": PLANE_WORDS,
        "optional": (),
    },
    "holes": {
        "head": "closed meshes",
        "columns": ONE_FIGURE,
        "rows": (
            ("rays exactly through edges and vertices, and between", "holes.rays"),
            ("... that escape: double precision", "holes.reference"),
            ("... profile paper", "holes.paper"),
            ("... profile raplas", "holes.raplas"),
            ("... profile raplas, exact", "holes.exact"),
        ),
        "optional": (),
    },
    "stress": {
        "head": "case",
        "columns": tuple((f"{device}: {text}", f"stress.*.{device}.{key}")
                         for device in ("reference", "paper", "raplas", "exact")
                         for text, key in (("differ, %", "differing_percent"), ("break it", "broken"))),
        "rows": "stress.*.raplas.differing_percent",
        "optional": (),
    },
    "soak": {
        "head": "decided, and none wrong",
        "columns": ONE_FIGURE,
        "rows": (
            ("ray and triangle, profile paper", "soak.triangles_paper"),
            ("... profile raplas", "soak.triangles_raplas"),
            ("... certified", "soak.triangles_certified"),
            ("plane and sphere, profile paper", "soak.spheres_paper"),
            ("ray and sphere by its planes, profile raplas", "soak.spheres_raplas"),
            ("all", "soak.decisions"),
            ("wrong", "soak.wrong"),
        ),
        "optional": (),
    },
    "stress_total": {
        "head": "catalogue",
        "columns": ONE_FIGURE,
        "rows": (
            ("cases", "stress.cases"),
            ("promised properties that failed, over all cases and devices", "stress.failed_properties"),
        ),
        "optional": (),
    },
    "mutation": {
        "head": "unit",
        "columns": (("mutants", "mutation.*.mutants"), ("killed", "mutation.*.killed"),
                    ("proved equivalent", "mutation.*.equivalent"), ("score", "mutation.*.score")),
        "rows": "mutation.*.score",
        "optional": (),
    },
}


def fail(message):
    sys.exit(f"figures: {message}")


def write_json(path, value):
    """Replaces a file in one step, so that a reader never sees half of it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}")
    part.write_text(json.dumps(value, indent=2) + "\n")
    part.replace(path)


def read(path):
    """The figures of one file, each with exactly a value, a unit and a command."""
    def pairs(items):
        names = [name for name, _ in items]
        if twice := {name for name in names if names.count(name) > 1}:
            fail(f"{path}: {', '.join(sorted(twice))}: given twice")
        return dict(items)

    try:
        figures = json.loads(path.read_text(), object_pairs_hook=pairs)
    except ValueError as error:
        fail(f"{path}: broken JSON: {error}")
    if not isinstance(figures, dict):
        fail(f"{path}: not an object of figures")
    for name, figure in figures.items():
        if not isinstance(figure, dict) or set(figure) != {"value", "unit", "command"}:
            fail(f"{path}: {name}: a figure has value, unit and command, and nothing else")
        if isinstance(figure["value"], bool) or not isinstance(figure["value"], (int, float, str)):
            fail(f"{path}: {name}: the value is no number and no text")
    return figures


def collect(folder):
    """All figures of a folder; two files may give the same one, but not different ones."""
    figures, source = {}, {}
    for path in sorted(folder.glob("*.json")):
        for name, figure in read(path).items():
            if name in figures and any(figures[name][k] != figure[k] for k in ("value", "unit")):
                fail(f"{name}: {figures[name]['value']} {figures[name]['unit']} in {source[name]}, "
                     f"{figure['value']} {figure['unit']} in {path}")
            figures.setdefault(name, figure)
            source.setdefault(name, path)
    return dict(sorted(figures.items()))


def shown(value):
    """A number for the reader: thousands separated, large or fractional ones to three digits."""
    if isinstance(value, float):
        if value != 0 and abs(value) < 1000:
            return f"{value:.3g}"
        value = round(value)
    return f"{value:,}" if isinstance(value, int) else value


def cell(figures, kind, key):
    if kind in ("value", "unit", "command"):
        part = figures.get(key, {}).get(kind)
        return f"`{part}`" if kind == "command" and part else DASH if part is None else shown(part)
    name = kind.replace("*", key) if "*" in kind else f"{kind}.{key}"
    if name in PAPER:
        return shown(PAPER[name])
    if kind.startswith("paper."):
        return ""
    return shown(figures[name]["value"]) if name in figures else DASH


def table(name, figures):
    """The Markdown lines of a table."""
    if name not in TABLES:
        fail(f"no table {name}, but: {', '.join(TABLES)}")
    spec = TABLES[name]
    lines = [f"| {spec['head']} | " + " | ".join(heading for heading, _ in spec["columns"]) + " |"]
    right = ["---" if kind in ("unit", "command") else "---:" for _, kind in spec["columns"]]
    lines.append("| --- | " + " | ".join(right) + " |")
    rows = spec["rows"]
    if isinstance(rows, str):
        before, after = rows.split("*")
        keys = [name.removeprefix(before).removesuffix(after) for name in fnmatch.filter(figures, rows)]
        rows = [(f"`{key}`", key) for key in keys]
    for text, key in rows:
        if key in spec["optional"] and key not in figures:
            continue
        lines.append(f"| {text} | " + " | ".join(cell(figures, kind, key) for _, kind in spec["columns"]) + " |")
    return "\n".join(lines) + "\n"


def fill(text, figures):
    """(text with its tables filled, names of those that changed)."""
    changed, found = [], []

    def replace(match):
        found.append(match[2])
        new = table(match[2], figures)
        if new != match[3]:
            changed.append(match[2])
        return match[1] + new + match[4]

    filled = MARK.sub(replace, text)
    opened = re.findall(r"<!-- figures:(\w+) -->", text)
    if opened != found or text.count("<!-- /figures -->") != len(found):
        fail(f"the marks of a table don't pair, or aren't alone on their lines: {', '.join(opened)}")
    return filled, changed


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--require", nargs="+", default=[], metavar="NAME")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--page", type=pathlib.Path, action="append")
    args = parser.parse_args()
    figures = collect(args.build / "figures")
    out = args.build / "figures.json"
    write_json(out, figures)
    print(f"{out}: {len(figures)} figures")
    if missing := [name for name in args.require if not fnmatch.filter(figures, name)]:
        fail(f"missing: {', '.join(missing)}")
    for page in args.page or PAGES:
        text = page.read_text()
        filled, changed = fill(text, figures)
        if changed and args.check:
            fail(f"{page}: stale: {', '.join(changed)} (scripts/figures.py writes them)")
        if changed:
            page.write_text(filled)
        print(f"{page}: {', '.join(changed) + ' written' if changed else 'tables up to date'}")


if __name__ == "__main__":
    main()
