"""Equivalence of the arithmetic units with their definitions: arithmetic/*.sv.

Each theorem is a miter whose output `bad` says that the unit and the definition differ. Yosys turns it into an
AIG with registers; abc unrolls it over the unit's latency from an arbitrary state, so that whatever is in the
pipeline before and after the operands is free, puts in the constants of the case, and decides by SAT whether `bad`
can be 1.
"""
import pathlib
import re

from common import FORMAL, PROVED, REFUTED, UNDECIDED, Case, Once, Result, export, run

SECONDS = 120  # for one case
SOURCES = FORMAL / "arithmetic"


class Miter:
    """A unit beside its definition, prepared when first asked for."""

    def __init__(self, theorem, folder, rtl, unit, latency, prim="generic", generics=(), parameters=(), stubs=(),
                 source=None, products="mul_rows"):
        self.theorem, self.folder, self.latency = theorem, folder / theorem, latency
        self._arguments = unit, prim, generics, parameters, stubs, SOURCES / f"{source or unit}.sv", rtl
        self._products = SOURCES / f"{products}.v"
        self._aig = Once(self._prepare)

    def _prepare(self):
        unit, prim, generics, parameters, stubs, source, rtl = self._arguments
        verilog = export(unit, self.folder, generics, prim, rtl)
        text = verilog.read_text()
        for stub in stubs:  # the name of a module with generics ends in their values
            name = rf"{stub}(_\w*[0-9a-f]{{40}}|_\d+)?"
            text = re.sub(rf"(?ms)^module {name}\n.*?^endmodule\n", "", text)
            text = re.sub(rf"\b{name} (\w+) \(", rf"{stub} \2 (", text)
        cut = self.folder / f"{unit}.cut.v"
        cut.write_text(text)
        commands = [f"read_verilog {cut} {self.folder / 'unisim.v'}", f"read_verilog -sv -I{SOURCES} {source}"]
        commands += [f"chparam -set {name} {value} miter" for name, value in parameters]
        # the registers lose their initial values: the pipeline may hold anything
        commands += ["hierarchy -check -top miter", "proc", "flatten", "setattr -unset init w:*", "opt -full",
                     f"techmap -map {self._products}", "opt -full", "techmap", "opt -fast", "dffunmap",
                     "aigmap", "opt_clean", f"write_aiger -symbols {self.folder / 'sequential.aig'}"]
        run("yosys", "-q", "-p", "; ".join(commands))
        abc(f"read_aiger {self.folder / 'sequential.aig'}; frames -F {self.latency + 1}; comb; "
            f"cone -O {self.latency}; strash; write_aiger -s {self.folder / 'unrolled.aig'}")
        return self.folder / "unrolled.aig"

    def case(self, name, quick=False, **constants):
        """A case: the miter's inputs `constants` (name -> (value, bits)), and `now`, fixed in the first clock."""
        def decide():
            aig, cex = self._aig(), self.folder / f"{name}.cex"
            cex.unlink(missing_ok=True)
            bits = [("now_", 1)]
            for word, (value, width) in constants.items():
                bits += [(f"{word}[{k}]_" if width > 1 else f"{word}_", value >> k & 1) for k in range(width)]
            frame = "0" * len(str(self.latency)) if self.latency > 9 else "00"
            said = abc(f"read_aiger {aig}; logic; " + "; ".join(f"cof {bit}{frame} {value}" for bit, value in bits)
                       + f"; strash; fraig; iprove; write_cex -n {cex}")
            if "UNSATISFIABLE" in said:
                return Result(PROVED)
            if "SATISFIABLE" in said and cex.exists():
                return Result(REFUTED, counterexample(cex, constants))
            return Result(UNDECIDED, said[-300:])
        return Case(self.theorem, name, decide, quick)


def abc(script):
    return run("berkeley-abc", "-q", script, seconds=SECONDS)


def counterexample(path, constants):
    """The operands, in hexadecimal, and other words that matter in later clocks."""
    words = {}  # (clock, name) -> value
    for name, bit, clock, value in re.findall(r"(\w+?)(?:\[(\d+)\])?_(\d+)(?:@0)?=([01])", path.read_text()):
        words[int(clock), name] = words.get((int(clock), name), 0) | int(value) << int(bit or 0)
    first = {name: value for (clock, name), value in words.items() if clock == 0}
    first.update((name, value) for name, (value, _) in constants.items())
    if {"larger", "smaller", "exponent", "distance"} <= first.keys():  # those of arithmetic/operands.svh
        def word(field, exponent):
            return (first[field] >> 16) << 23 | exponent % 128 << 16 | first[field] & 0xFFFF
        x, y = word("larger", first["exponent"]), word("smaller", first["exponent"] - first["distance"])
        a, b = (y, x) if first["swap"] else (x, y)
        text = [f"a_i = {a:06x}, b_i = {b:06x}"]
    else:
        text = [f"{name} = {value:x}" for name, value in first.items() if name != "now"]
    later = [f"{name} = {value:x} {clock} clocks later" for (clock, name), value in sorted(words.items())
             if clock and value and name not in constants]
    return ", ".join(text + later)


DISTANCES = [(distance, swap) for distance in range(128) for swap in (0, 1) if distance or not swap]  # all 255
QUICK_DISTANCES = (0, 1, 2, 17, 18, 19, 127)


def adder(work, rtl, guard, subtract, prim):
    name = f"fp_{'subtract' if subtract else 'add'}.guard{guard}.{prim}"
    miter = Miter(name, work, rtl, "fp_add", 4, prim, (f"GUARD_BITS={guard}", f"SUBTRACT={str(subtract).lower()}"),
                  (("GUARD_BITS", guard), ("SUBTRACT", int(subtract))))
    quick = prim == "generic" and not subtract and guard != 1
    return [case(miter, distance, swap, quick and distance in QUICK_DISTANCES) for distance, swap in DISTANCES]


def case(miter, distance, swap, quick=False):
    return miter.case(f"distance_{distance:03}{'_swapped' if swap else ''}", quick, distance=(distance, 7),
                      swap=(swap, 1))


ADDERS = [(guard, subtract, prim) for guard in (2, 1, 0) for subtract in (False, True) for prim in ("generic", "xc4v")]
MODES = (0, 1, 2)  # of dsp_plane_test


def cases(work, rtl):
    work = pathlib.Path(work) / "arithmetic"
    found = []
    for variant in ADDERS:
        found += adder(work, rtl, *variant)
    for prim in ("generic", "xc4v"):
        found.append(Miter(f"fp_mul.{prim}", work, rtl, "fp_mul", 3, prim).case("all", prim == "generic"))
        found.append(Miter(f"fp_product.{prim}", work, rtl, "fp_product", 2, prim).case("all", prim == "generic"))
        found.append(Miter(f"dsp_multiply_add.{prim}", work, rtl, "dsp_multiply_add", 3, prim,
                           products="mul_pair").case("all", True))
        for mode in MODES:
            found.append(Miter(f"dsp_plane_test.mode{mode}.{prim}", work, rtl, "dsp_plane_test", 6, prim,
                               (f"MODE={mode}",), (("MODE", mode),), products="mul_pair").case("all", mode == 0))
    found.append(Miter("depth_code", work, rtl, "depth_code", 2).case("all", True))
    found.append(Miter("fp_add.cases_are_all", work, rtl, "fp_add", 0, source="fp_add_cases").case("all", True))
    cut = Miter("fp_add.cut", work, rtl, "fp_add", 0, source="fp_add_cut")
    found += [case(cut, distance, swap) for distance, swap in DISTANCES]
    nearest = Miter("nearest_hit", work, rtl, "nearest_hit", 3, stubs=("fp_product",))
    found += [nearest.case(f"difference_{k:+04}", k in (-252, -1, 0, 1, 2), difference=(k & 1023, 10))
              for k in range(-252, 253)]
    found.append(Miter("plane_sphere_tester.compare", work, rtl, "plane_sphere_tester", 12,
                       stubs=("fp_mul", "fp_add")).case("all", True))
    found.append(Miter("ray_solver.hit_rule", work, rtl, "ray_solver", 26,
                       stubs=("fp_add", "fp_cross", "fp_dot3")).case("all", True))
    found.append(Miter("ray_triangle.hit_rule", work, rtl, "ray_triangle", 29,
                       stubs=("fp_add", "fp_cross", "fp_dot3", "nearest_hit")).case("all", True))
    return found


EXPECTED = {
    **{f"fp_{'subtract' if subtract else 'add'}.guard{guard}.{prim}": 255 for guard, subtract, prim in ADDERS},
    "fp_add.cases_are_all": 1,
    "fp_add.cut": 255,
    **{f"{unit}.{prim}": 1 for unit in ("fp_mul", "fp_product", "dsp_multiply_add") for prim in ("generic", "xc4v")},
    **{f"dsp_plane_test.mode{mode}.{prim}": 1 for mode in MODES for prim in ("generic", "xc4v")},
    "depth_code": 1,
    "nearest_hit": 505,
    "plane_sphere_tester.compare": 1,
    "ray_solver.hit_rule": 1,
    "ray_triangle.hit_rule": 1,
}
