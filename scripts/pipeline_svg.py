#!/usr/bin/env python3
"""Draw the figures of docs/: pipelines with their stages as columns, and the block diagram.

usage: pipeline_svg.py [--check] [--out docs/img]

Writes <unit>.svg for each entry of FIGURES. --check writes nothing and exits 1 when a file differs.

A pipeline has columns between marks: "@k" is the register line k clocks after the inputs, "" no register.
A box is (kind, row, first column, columns, text lines): it may span columns and take half rows.
A block diagram has boxes (kind, x, y, width, height, text lines) and wires through the points named.
Kinds: dsp (a DSP48 does it), logic, delay (registers only), memory, port (text without a frame).
"""
import argparse
import pathlib
import sys
from xml.sax.saxutils import escape

ROOT = pathlib.Path(__file__).resolve().parent.parent
KINDS = {  # fill, line, legend
    "dsp": ("#ffd9a0", "#a86400", "with DSP48"),
    "logic": ("#dce9f8", "#40699a", "logic"),
    "delay": ("#eeeeee", "#888888", "registers only"),
    "memory": ("#d9efd6", "#437f3c", "memory or queue"),
    "port": ("none", "none", ""),
}
CHARACTER, LINE, PAD = 6.9, 16, 10   # widest estimate of a character, line height, margin in a box
GAP, ROW, TOP, LEFT = 22, 66, 44, 20  # between column edge and box; row height; page margins
PITCH = 6                            # between wires in one gap


class Svg:
    def __init__(self):
        self.parts, self.kinds, self.right, self.bottom = [], [], 0, 0

    def reach(self, x, y):
        self.right, self.bottom = max(self.right, x), max(self.bottom, y)

    def text(self, x, y, words, anchor="middle", colour="#111111", weight=""):
        self.parts.append(f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" fill="{colour}"{weight}>'
                          f'{escape(words)}</text>')

    def box(self, name, kind, x, y, width, height, lines):
        widest = max(len(line) for line in lines) * CHARACTER
        if kind != "port" and (widest > width - 4 or len(lines) * LINE > height):
            sys.exit(f"pipeline_svg: the text of box {name} needs {widest + 4:g} x {len(lines) * LINE}")
        fill, line, _ = KINDS[kind]
        if kind not in self.kinds and kind != "port":
            self.kinds.append(kind)
        if kind != "port":
            self.parts.append(f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="4" '
                              f'fill="{fill}" stroke="{line}" stroke-width="1.2"/>')
        first = y + height / 2 - (len(lines) - 1) * LINE / 2 + 4
        for k, words in enumerate(lines):
            self.text(x + width / 2, first + k * LINE, words)
        self.reach(x + width, y + height)

    def wire(self, points):
        path = "M" + " L".join(f"{x:g},{y:g}" for x, y in points)
        self.parts.append(f'<path d="{path}" fill="none" stroke="#333333" stroke-width="1.2" '
                          f'marker-end="url(#tip)"/>')
        for x, y in points:
            self.reach(x, y)

    def finish(self, title):
        y, x = self.bottom + 22, LEFT
        for kind in KINDS:
            if kind in self.kinds:
                fill, line, words = KINDS[kind]
                self.parts.append(f'<rect x="{x}" y="{y}" width="16" height="12" rx="2" fill="{fill}" '
                                  f'stroke="{line}"/>')
                self.text(x + 22, y + 10, words, "start")
                x += 22 + len(words) * CHARACTER + 24
        width, height = round(max(self.right, x) + LEFT), round(y + 30)
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                f'height="{height}" font-family="DejaVu Sans, Verdana, Helvetica, sans-serif" '
                f'font-size="12">\n<title>{escape(title)}</title>\n'
                '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" '
                'markerHeight="7" orient="auto"><path d="M0,0 L8,4 L0,8 z" fill="#333333"/></marker></defs>\n'
                f'<rect width="{width}" height="{height}" fill="#ffffff"/>\n')
        return head + "\n".join(self.parts) + "\n</svg>\n"


def pipeline(title, columns, marks, boxes, wires):
    """columns: their widths; marks: len(columns) + 1 texts; wires: 'source target' names, in any order."""
    svg = Svg()
    edges = [LEFT]
    for width in columns:
        edges.append(edges[-1] + width)
    place = {}
    for name, (kind, row, column, span, *lines) in boxes.items():
        height = max(len(lines) * LINE + PAD, 34)
        x, right = edges[column] + GAP, edges[column + span] - GAP
        if kind == "port":
            x, right = x - GAP + 2, right + GAP - 2
        y = TOP + 20 + row * ROW + (ROW - height) / 2
        place[name] = (x, y, right - x, height, kind, lines)
    bottom = max(y + height for _, y, _, height, _, _ in place.values()) + 14
    for x, mark in zip(edges, marks):
        if mark:
            svg.parts.append(f'<path d="M{x:g},{TOP - 6} V{bottom:g}" stroke="#9a9a9a" '
                             f'stroke-dasharray="3 4"/>')
            svg.text(x, TOP - 14, mark, weight=' font-weight="bold"')
    pairs = [tuple(wire.split()) for wire in wires]

    def middle(name):
        return place[name][1] + place[name][3] / 2

    def spread(name, mates, other):  # where the wires meet a box's side: in the order of their other ends
        _, y, _, height, _, _ = place[name]
        order = sorted(mates, key=middle)
        return y + height * (order.index(other) + 1) / (len(order) + 1)

    into, gaps = {}, {}
    for source, target in pairs:
        into.setdefault(target, []).append(source)
    for source, target in pairs:  # the vertical part of a wire lies in the gap before its target
        gaps.setdefault(place[target][0], [])
        if source not in gaps[place[target][0]]:
            gaps[place[target][0]].append(source)
    for x, sources in gaps.items():
        sources.sort(key=middle)
    for source, target in pairs:
        x, y, width, height, kind, lines = place[source]
        start = x + width if kind != "port" else x + width / 2 + max(map(len, lines)) * CHARACTER / 2 + 4
        end_x, end_y = place[target][0], spread(target, into[target], source)
        if place[target][4] == "port":
            text = max(map(len, place[target][5])) * CHARACTER
            end_x = place[target][0] + place[target][2] / 2 - text / 2 - 4
        if abs(end_y - middle(source)) < 0.1 * place[target][3] and len(into[target]) == 1:
            end_y = middle(source)
        slots = gaps[place[target][0]]
        bend = place[target][0] - 9 - PITCH * (len(slots) - 1 - slots.index(source)) / max(1, len(slots) / 4)
        points = [(start, middle(source)), (end_x, end_y)]
        if middle(source) != end_y:
            points[1:1] = [(bend, middle(source)), (bend, end_y)]
        svg.wire(points)
    for name, (x, y, width, height, kind, lines) in place.items():
        svg.box(name, kind, x, y, width, height, lines)
    svg.reach(edges[-1], bottom)
    return svg.finish(title)


def blocks(title, boxes, wires, labels):
    """wires: lists of points (x, y). labels: (x, y, anchor, text)."""
    svg = Svg()
    for points in wires:
        svg.wire(points)
    for name, (kind, x, y, width, height, *lines) in boxes.items():
        svg.box(name, kind, x, y, width, height, lines)
    for x, y, anchor, words in labels:
        svg.text(x, y, words, anchor, "#444444")
    return svg.finish(title)


FIGURES = {
    "fp_add": lambda: pipeline(
        "fp_add: sum or difference in four stages",
        [60, 200, 250, 230, 220, 60], ["", "@0", "@1", "@2", "@3", "@4", ""],
        {
            "a": ("port", 0.5, 0, 1, "a"),
            "b": ("port", 1.5, 0, 1, "b"),
            "difference": ("dsp", 0, 1, 1, "exponent a - b", "P register"),
            "compare": ("logic", 1, 1, 1, "|a| < |b| ?"),
            "ab": ("delay", 2, 1, 1, "a, b"),
            "align": ("logic", 0.5, 2, 1, "smaller significand", "shifted right,", "lost bits: sticky"),
            "larger": ("logic", 2, 2, 1, "larger operand:", "sign, exponent, significand"),
            "sum": ("dsp", 0.5, 3, 1, "larger +- smaller", "A:B and SUBTRACT", "registers, P register"),
            "side": ("delay", 2, 3, 1, "sign, exponent"),
            "normalise": ("logic", 1.25, 4, 1, "zeros counted,", "shifted left,", "saturate or flush"),
            "q": ("port", 1.25, 5, 1, "sum"),
        },
        ["a difference", "b difference", "a compare", "b compare", "a ab", "b ab", "difference align",
         "compare align", "ab align", "compare larger", "ab larger", "align sum", "larger sum", "larger side",
         "sum normalise", "side normalise", "normalise q"]),
    "fp_mul": lambda: pipeline(
        "fp_mul: product in three stages; fp_product is all but the last one",
        [60, 210, 210, 220, 90], ["", "@0", "@1", "@2", "@3", ""],
        {
            "a": ("port", 0.5, 0, 1, "a"),
            "b": ("port", 1.5, 0, 1, "b"),
            "multiply": ("dsp", 0, 1, 1, "17 x 17 bits", "M register"),
            "product": ("dsp", 0, 2, 1, "P register"),
            "exponents": ("dsp", 1, 1, 1, "exponents: A:B", "and C registers"),
            "bias": ("dsp", 1, 2, 1, "a + (b - 64) + 1", "P register"),
            "sign": ("delay", 2, 1, 2, "sign a xor sign b"),
            "normalise": ("logic", 1, 3, 1, "shift by one bit,", "saturate or flush,", "pack"),
            "q": ("port", 1, 4, 1, "product"),
        },
        ["a multiply", "b multiply", "a exponents", "b exponents", "a sign", "b sign", "multiply product",
         "exponents bias", "product normalise", "bias normalise", "sign normalise", "normalise q"]),
    "plane_sphere_tester": lambda: pipeline(
        "plane_sphere_tester: |n.c + p| <= r in twelve stages",
        [80, 160, 190, 180, 180, 80], ["", "@0", "@3", "@7", "@11", "@12", ""],
        {
            "x": ("port", 0, 0, 1, "nx, cx"),
            "y": ("port", 1, 0, 1, "ny, cy"),
            "z": ("port", 2, 0, 1, "nz, cz"),
            "p": ("port", 3, 0, 1, "p"),
            "r": ("port", 4, 0, 1, "r"),
            "xx": ("dsp", 0, 1, 1, "nx * cx"),
            "yy": ("dsp", 1, 1, 1, "ny * cy"),
            "zz": ("dsp", 2, 1, 1, "nz * cz"),
            "pp": ("delay", 3, 1, 1, "p"),
            "xy": ("dsp", 0.5, 2, 1, "nx*cx + ny*cy"),
            "zp": ("dsp", 2.5, 2, 1, "nz*cz + p"),
            "d": ("dsp", 1.5, 3, 1, "distance"),
            "rr": ("delay", 4, 1, 3, "r"),
            "meets": ("logic", 2.5, 4, 1, "|distance|", "<= r ?"),
            "q": ("port", 2.5, 5, 1, "meets"),
        },
        ["x xx", "y yy", "z zz", "p pp", "r rr", "xx xy", "yy xy", "zz zp", "pp zp", "xy d", "zp d", "d meets",
         "rr meets", "meets q"]),
    "ray_triangle": lambda: pipeline(
        "ray_triangle: 35 operations in 29 stages",
        [80, 150, 170, 120, 140, 170, 200, 190, 100],
        ["", "@0", "@4", "@11", "@15", "@22", "", "@26", "@29", ""],
        {
            "nd0": ("port", 0, 0, 1, "N, D"),
            "vo": ("port", 1, 0, 1, "V0, O"),
            "d0": ("port", 2, 0, 1, "D, N"),
            "e0": ("port", 3, 0, 1, "E1, E2"),
            "nd": ("dsp", 0, 1, 2, "N.D   (5 operations)"),
            "ndd": ("delay", 0, 3, 2, "N.D"),
            "t": ("dsp", 1, 1, 1, "T = V0 - O", "(3)"),
            "nt": ("dsp", 1, 2, 2, "N.T   (5)"),
            "ntd": ("delay", 1, 4, 1, "N.T"),
            "d": ("delay", 2, 1, 1, "D, N"),
            "cross": ("dsp", 2, 2, 1, "D x T   (9)"),
            "e": ("delay", 3, 1, 2, "E1, E2"),
            "e2": ("dsp", 2, 3, 2, "(D x T).E2   (5)"),
            "e1": ("dsp", 3, 3, 2, "(D x T).E1   (5)"),
            "sign": ("logic", 1.5, 5, 1, "sign rule:", "t' d u' v'"),
            "sol": ("delay", 1, 6, 1, "t' d u' v'"),
            "sum": ("dsp", 2, 6, 1, "u' + v'   (1)"),
            "best": ("memory", 0, 6, 1, "best hit of the ray", "(asked for @24)"),
            "near": ("dsp", 0.5, 7, 1, "nearer? exact", "products   (2)"),
            "hit": ("logic", 1.75, 7, 1, "hit?", "(then delayed)"),
            "q": ("port", 1, 8, 1, "hit, write,", "result"),
        },
        ["nd0 nd", "vo t", "d0 d", "e0 e", "nd ndd", "t nt", "t cross", "d nt", "d cross", "nt ntd", "cross e2",
         "cross e1", "e e2", "e e1", "ndd sign", "ntd sign", "e2 sign", "e1 sign", "sign sol", "sign sum",
         "sol near", "best near", "sol hit", "sum hit", "near q", "hit q"]),
    "intersection_unit": lambda: blocks(
        "intersection_unit: the way of the data",
        {
            "traversal": ("logic", 40, 150, 120, 60, "traversal", "stack of ranges"),
            "sphere": ("memory", 230, 110, 150, 44, "Sphere Memory"),
            "plane": ("memory", 230, 206, 150, 44, "Plane Memory", "2 banks"),
            "subunit": ("dsp", 450, 140, 170, 80, "plane_sphere_subunit", "4 + 4 testers", "96 DSP48"),
            "decoder": ("logic", 690, 150, 130, 60, "decoder", "row, column masks"),
            "leaves": ("memory", 690, 330, 130, 44, "leaf queue (32)"),
            "selector": ("logic", 540, 330, 100, 44, "selector"),
            "pairs": ("memory", 360, 330, 130, 44, "pair queue (16)"),
            "issue": ("logic", 210, 330, 100, 44, "pair_issue"),
            "ray": ("memory", 40, 420, 150, 44, "Ray Memory", "2 banks"),
            "triangle": ("memory", 40, 484, 150, 44, "Triangle Memory"),
            "solver": ("dsp", 260, 430, 170, 80, "ray_triangle", "35 operations", "70 DSP48"),
            "result": ("memory", 540, 448, 150, 44, "Result Memory", "2 banks"),
            "counters": ("logic", 540, 40, 130, 44, "event_counters"),
            "figures": ("port", 725, 40, 95, 44, "host reads", "counters"),
            "control": ("logic", 40, 40, 120, 44, "start, busy,", "pencil, scene"),
            "write": ("port", 230, 40, 170, 44, "host writes registers,", "and all four memories"),
            "out": ("port", 750, 448, 70, 44, "host reads", "results"),
        },
        [[(100, 84), (100, 150)],
         [(236, 62), (160, 62)],
         [(670, 62), (728, 62)],
         [(160, 180), (195, 180), (195, 132), (230, 132)],
         [(160, 180), (195, 180), (195, 228), (230, 228)],
         [(380, 132), (415, 132), (415, 165), (450, 165)],
         [(380, 228), (415, 228), (415, 195), (450, 195)],
         [(620, 180), (690, 180)],
         [(755, 210), (755, 330)],
         [(690, 198), (655, 198), (655, 282), (100, 282), (100, 210)],
         [(690, 352), (640, 352)],
         [(540, 352), (490, 352)],
         [(360, 352), (310, 352)],
         [(210, 352), (22, 352), (22, 442), (40, 442)],
         [(22, 442), (22, 506), (40, 506)],
         [(190, 442), (225, 442), (225, 458), (260, 458)],
         [(190, 506), (225, 506), (225, 484), (260, 484)],
         [(430, 482), (540, 482)],
         [(540, 458), (430, 458)],
         [(690, 470), (748, 470)]],
        [(380, 276, "middle", "child ranges of inner nodes that are met"),
         (765, 270, "start", "leaves"),
         (485, 450, "middle", "best hit @26"),
         (485, 498, "middle", "hit @29"),
         (188, 122, "end", "sphere, set"),
         (655, 172, "middle", "flags"),
         (120, 344, "middle", "(ray, triangle)")]),
    "raplas_unit": lambda: blocks(
        "raplas_unit: the way of the data",
        {
            "control": ("logic", 30, 40, 150, 50, "pencil_control", "one after the other"),
            "write": ("port", 230, 43, 190, 44, "host writes registers,", "and all memories"),
            "walk": ("logic", 30, 140, 150, 60, "tree_walk", "stack, nearest first"),
            "sphere": ("memory", 230, 120, 150, 44, "Sphere Memory"),
            "vertex": ("memory", 230, 180, 150, 44, "Vertex Memory"),
            "plane": ("memory", 450, 43, 170, 44, "Plane Memory", "4 banks"),
            "testers": ("dsp", 450, 132, 170, 80, "fixed_testers", "18 + 18 planes", "144 DSP48"),
            "lines": ("logic", 690, 102, 130, 50, "triangle_lines", "rows, columns, z"),
            "grid": ("dsp", 690, 186, 130, 60, "vertex_grid", "3 places", "2 DSP48"),
            "triangles": ("memory", 880, 150, 145, 44, "triangle queue (64)"),
            "edges": ("dsp", 880, 312, 145, 60, "edge_setup", "3 edges", "2 DSP48"),
            "cuts": ("memory", 700, 313, 130, 58, "queue of cut", "triangles (32)"),
            "rows": ("dsp", 530, 312, 120, 60, "row_selector", "+ row_interval", "3 DSP48"),
            "rowq": ("memory", 375, 320, 125, 44, "row queue (16)"),
            "columns": ("logic", 210, 320, 125, 44, "column_selector"),
            "ray": ("memory", 40, 430, 150, 44, "Ray Memory", "4 banks"),
            "triangle": ("memory", 40, 494, 150, 44, "Triangle Memory"),
            "solver": ("dsp", 250, 440, 160, 80, "ray_solver", "34 operations", "34 DSP48"),
            "quotient": ("dsp", 250, 550, 160, 44, "depth_quotient", "1 DSP48"),
            "hits": ("dsp", 470, 440, 140, 80, "hit_queue", "nearest hit", "2 DSP48"),
            "result": ("memory", 680, 458, 140, 44, "Result Memory", "4 banks"),
            "bounds": ("memory", 480, 240, 130, 44, "ray_bounds", "rays and rows"),
            "out": ("port", 715, 550, 70, 44, "host reads", "results"),
        },
        [[(105, 90), (105, 140)],
         [(230, 65), (180, 65)],
         [(180, 170), (205, 170), (205, 142), (230, 142)],
         [(205, 170), (205, 202), (230, 202)],
         [(380, 142), (415, 142), (415, 160), (450, 160)],
         [(380, 202), (415, 202), (415, 184), (450, 184)],
         [(535, 87), (535, 132)],
         [(620, 160), (655, 160), (655, 127), (690, 127)],
         [(620, 184), (655, 184), (655, 216), (690, 216)],
         [(820, 127), (850, 127), (850, 164), (880, 164)],
         [(820, 216), (850, 216), (850, 180), (880, 180)],
         [(952, 194), (952, 312)],
         [(600, 212), (600, 230), (105, 230), (105, 200)],
         [(880, 342), (830, 342)],
         [(700, 342), (650, 342)],
         [(530, 342), (500, 342)],
         [(375, 342), (335, 342)],
         [(210, 342), (22, 342), (22, 452), (40, 452)],
         [(22, 452), (22, 516), (40, 516)],
         [(190, 452), (220, 452), (220, 466), (250, 466)],
         [(190, 516), (220, 516), (220, 494), (250, 494)],
         [(330, 520), (330, 550)],
         [(410, 572), (440, 572), (440, 500), (470, 500)],
         [(410, 470), (470, 470)],
         [(610, 490), (680, 490)],
         [(680, 468), (610, 468)],
         [(750, 502), (750, 550)],
         [(540, 440), (540, 400), (665, 400), (665, 262), (610, 262)],
         [(595, 284), (595, 312)],
         [(610, 274), (905, 274), (905, 312)],
         [(480, 262), (60, 262), (60, 200)]],
        [(300, 246, "middle", "child ranges of spheres that are met"),
         (960, 250, "start", "triangles"),
         (785, 268, "middle", "bounds of the rows"),
         (120, 334, "middle", "(ray, triangle)"),
         (300, 278, "middle", "bounds of the rows"),
         (604, 302, "start", "of rays"),
         (672, 396, "start", "new bounds"),
         (645, 460, "middle", "best"),
         (645, 506, "middle", "hit")]),
}


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/img")
    args = parser.parse_args()
    differ = 0
    for unit, draw in FIGURES.items():
        path, text = args.out / f"{unit}.svg", draw()
        if path.exists() and path.read_text() == text:
            continue
        if args.check:
            print(f"pipeline_svg: {path} differs: run scripts/pipeline_svg.py", file=sys.stderr)
            differ = 1
        else:
            args.out.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
    sys.exit(differ)


if __name__ == "__main__":
    main()
