#!/usr/bin/env python3
"""Write the generated files from raplas.toml, or check them.

usage: constants.py [--check]
--check writes nothing and exits 1 when a file differs from what raplas.toml says.
"""
import pathlib
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = tomllib.loads((ROOT / "raplas.toml").read_text())
CONSTANTS = {c["name"]: c["value"] for c in SOURCE["constant"]}
NOTE = "Generated from raplas.toml by scripts/constants.py: change it there."


def width(kind):
    """Width in bits of a field's kind: fp24, a constant's name or a number."""
    if kind == "fp24":
        return CONSTANTS["FP_BITS"]
    return CONSTANTS[kind] if isinstance(kind, str) else kind


def layout(word):
    """(field, least significant bit, width) of each field, most significant first."""
    lsb = sum(width(kind) for _, kind in word["fields"])
    result = []
    for field, kind in word["fields"]:
        lsb -= width(kind)
        result.append((field, lsb, width(kind)))
    return result


def word_bits(word):
    return sum(width(kind) for _, kind in word["fields"])


def camel(name):
    return "".join(part.capitalize() for part in name.lower().split("_"))


def vhdl():
    out = [
        "-- " + "=" * 76,
        "-- raplas_constants - format widths, stage counts, word layouts, counters",
        "-- " + "-" * 76,
        f"-- {NOTE}",
        "-- model: cmodel/include/raplas/constants.hpp",
        "-- " + "=" * 76,
        "library ieee;",
        "use ieee.std_logic_1164.all;",
        "",
        "package raplas_constants is",
        "",
    ]
    for c in SOURCE["constant"]:
        out += [f"  -- {c['doc']}", f"  constant {c['name']} : natural := {c['value']};"]
    out += ["", "  subtype fp24_t is std_ulogic_vector(FP_BITS - 1 downto 0);"]
    for w in SOURCE["word"]:
        n = w["name"]
        out += ["", f"  -- {w['doc']}", f"  constant {n.upper()}_BITS : natural := {word_bits(w)};",
                f"  subtype {n}_word_t is std_ulogic_vector({word_bits(w) - 1} downto 0);",
                f"  type {n}_t is record"]
        for field, _, bits in layout(w):
            kind = "fp24_t" if dict(w["fields"])[field] == "fp24" else (
                "std_ulogic" if bits == 1 else f"std_ulogic_vector({bits - 1} downto 0)")
            out.append(f"    {field} : {kind};")
        out += ["  end record;",
                f"  function unpack_{n}(word : {n}_word_t) return {n}_t;",
                f"  function pack_{n}(fields : {n}_t) return {n}_word_t;"]
    out += ["", "  -- codes of the host's write targets"]
    for i, t in enumerate(SOURCE["target"]):
        out.append(f"  constant TARGET_{t['name'].upper()} : natural := {i};")
    out += ["", "  -- places of the counters in the counter bus, COUNTER_BITS each"]
    for i, c in enumerate(SOURCE["counter"]):
        out.append(f"  constant COUNTER_{c['name'].upper()} : natural := {i};")
    out += [f"  constant NUM_COUNTERS : natural := {len(SOURCE['counter'])};", "",
            "end package raplas_constants;", "", "package body raplas_constants is"]
    for w in SOURCE["word"]:
        n = w["name"]
        out += ["", f"  function unpack_{n}(word : {n}_word_t) return {n}_t is",
                f"    variable fields_v : {n}_t;", "  begin"]
        for field, lsb, bits in layout(w):
            source = f"word({lsb})" if bits == 1 else f"word({lsb + bits - 1} downto {lsb})"
            out.append(f"    fields_v.{field} := {source};")
        out += ["    return fields_v;", f"  end function unpack_{n};", "",
                f"  function pack_{n}(fields : {n}_t) return {n}_word_t is", "  begin"]
        names = [f"fields.{field}" for field, _, _ in layout(w)]
        lines = [" & ".join(names[i:i + 4]) for i in range(0, len(names), 4)]
        out.append("    return " + "\n      & ".join(lines) + ";")
        out += [f"  end function pack_{n};"]
    out += ["", "end package body raplas_constants;", ""]
    return "\n".join(out)


def cpp():
    out = [
        f"// {NOTE}",
        "// Format widths, stage counts, memory word layouts and counter names shared with the RTL.",
        "// clang-format off",
        "#pragma once",
        "",
        "#include <array>",
        "#include <string_view>",
        "",
        "namespace raplas {",
        "",
    ]
    for c in SOURCE["constant"]:
        out += [f"/// {c['doc']}", f"inline constexpr int k{camel(c['name'])} = {c['value']};"]
    out += ["", "/// Place of a field in a memory word.", "struct Field {", "  int lsb;", "  int width;", "};"]
    for w in SOURCE["word"]:
        out += ["", f"/// {w['doc']}", f"struct {camel(w['name'])}Layout {{",
                f"  static constexpr int kBits = {word_bits(w)};"]
        for field, lsb, bits in layout(w):
            out.append(f"  static constexpr Field {field}{{{lsb}, {bits}}};")
        out.append("};")
    out += ["", "/// Targets of the host's write port.", "enum class Target : int {"]
    out += [f"  {t['name']} = {i}," for i, t in enumerate(SOURCE["target"])]
    out += ["};", "", "/// Event counters, in the order of the RTL's counter bus.", "enum class Counter : int {"]
    for i, c in enumerate(SOURCE["counter"]):
        out.append(f"  {c['name']} = {i},  ///< {c['doc']}")
    names = [c["name"] for c in SOURCE["counter"]]
    out += ["};", f"inline constexpr int kNumCounters = {len(names)};",
            "inline constexpr std::array<std::string_view, kNumCounters> kCounterNames{"]
    out += [f'    "{n}",' for n in names]
    out += ["};", "", "}  // namespace raplas", ""]
    return "\n".join(out)


def markdown():
    out = ["# Constants and memory words", "", f"{NOTE}", "", "| constant | value | meaning |", "|---|---|---|"]
    out += [f"| `{c['name']}` | {c['value']} | {c['doc']} |" for c in SOURCE["constant"]]
    out += ["", "## Memory words and registers", "", "Most significant field first.", "",
            "| word | bits | fields | meaning |", "|---|---|---|---|"]
    for w in SOURCE["word"]:
        fields = " ".join(f"`{f}[{lsb + b - 1}:{lsb}]`" for f, lsb, b in layout(w))
        out.append(f"| {w['name']} | {word_bits(w)} | {fields} | {w['doc']} |")
    out += ["", "## Counters", "", "| counter | meaning |", "|---|---|"]
    out += [f"| `{c['name']}` | {c['doc']} |" for c in SOURCE["counter"]]
    return "\n".join(out) + "\n"


def check():
    """Relations that the RTL relies on."""
    c = CONSTANTS
    rules = (
        ("MAX_ROWS = MAX_COLUMNS = 2^LINE_BITS", c["MAX_ROWS"] == c["MAX_COLUMNS"] == 2 ** c["LINE_BITS"]),
        ("FP_BITS = 1 + EXPONENT_BITS + FRACTION_BITS",
         c["FP_BITS"] == 1 + c["EXPONENT_BITS"] + c["FRACTION_BITS"]),
        ("EXPONENT_BIAS = 2^(EXPONENT_BITS - 1) - 1", c["EXPONENT_BIAS"] == 2 ** (c["EXPONENT_BITS"] - 1) - 1),
        ("MAX_ROWS = AXIS_PLANE = GRID_PLANE - 1 = SIDE_PLANES - 2",
         c["MAX_ROWS"] == c["AXIS_PLANE"] == c["GRID_PLANE"] - 1 == c["SIDE_PLANES"] - 2),
        ("SIDE_PLANES <= 2^PLANE_INDEX_BITS", c["SIDE_PLANES"] <= 2 ** c["PLANE_INDEX_BITS"]),
        ("EDGE_SETUP_STAGES = 7 + 2 MULTIPLY_ADD_STAGES",
         c["EDGE_SETUP_STAGES"] == 7 + 2 * c["MULTIPLY_ADD_STAGES"]),
    ) + tuple((f"{d} = 2^{d}_LOG2", c[d] == 2 ** c[d + "_LOG2"])
              for d in ("STACK_DEPTH", "LEAF_FIFO_DEPTH", "PAIR_FIFO_DEPTH"))
    for rule, holds in rules:
        if not holds:
            sys.exit(f"constants: raplas.toml breaks {rule}")


def main():
    check()
    only_check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not only_check:
        sys.exit(__doc__)
    stale = []
    for path, text in (("rtl/common/raplas_constants.vhd", vhdl()),
                       ("cmodel/include/raplas/constants.hpp", cpp()),
                       ("docs/constants.md", markdown())):
        file = ROOT / path
        if file.exists() and file.read_text() == text:
            continue
        stale.append(path)
        if not only_check:
            file.write_text(text)
            print(f"wrote {path}")
    if only_check and stale:
        sys.exit(f"constants: {', '.join(stale)} differ from raplas.toml: run scripts/constants.py")


if __name__ == "__main__":
    main()
