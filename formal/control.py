"""Control theorems: queues, selectors, pair_issue, walks, pencils, decoder, result memory, counters.

The properties of formal/control/NAME.sv are put inside the exported unit, before its endmodule, as a
SystemVerilog bind would do: they see its ports and, for the invariants, its registers. Yosys' `sat`
(MiniSat) then proves the assertions for all inputs and for any number of clocks by induction: they hold
in the first clock, and if they hold in any state, reachable or not, they hold in the next. The first
clock is the reset; all registers are free before it.

If the induction fails, a counterexample is sought in the first DEPTH clocks. Each `cover` is a case of
its own: a trace must reach it, so the assumptions are not contradictory. ": assert " and ": cover ", each
with a label, stand for nothing else in those files.
"""
import dataclasses
import re
import shutil

from common import FORMAL, PROVED, REFUTED, UNDECIDED, Case, Once, Result, export, run

SECONDS = 600  # of one run of the solver
REFUTATION = "model found for base case"


@dataclasses.dataclass(frozen=True)
class Model:
    """A unit with its properties."""

    theorem: str
    name: str
    unit: str
    generics: dict = dataclasses.field(default_factory=dict)
    constants: dict = dataclasses.field(default_factory=dict)  # other values in raplas_constants.vhd
    properties: tuple = ()  # file names, if not the unit's
    unseen: tuple = ()      # outputs that the properties don't look at: what only they need is cut off
    depth: int = 12         # clocks in search of a counterexample
    cover: int = 0          # clocks in which every cover is reached; 0: no such cases
    quick: bool = False     # its assertions; covers never are


SMALL = {"STACK_DEPTH": 8, "STACK_DEPTH_LOG2": 3, "STACK_WATERMARK": 2, "LEAF_FIFO_DEPTH": 2,
         "LEAF_FIFO_DEPTH_LOG2": 1, "ID_BITS": 5, "COUNT_BITS": 3}
SMALL_STACK = {name: SMALL[name] for name in ("STACK_DEPTH", "STACK_DEPTH_LOG2", "STACK_WATERMARK")}
FEW_RAYS = {"LINE_BITS": 2, "MAX_ROWS": 4, "MAX_COLUMNS": 4}
WALK = {"unit": "traversal", "properties": ("traversal",)}
STACK = {"unit": "traversal", "properties": ("traversal", "traversal_stack")}
RANGE = {"unit": "traversal", "properties": ("traversal", "traversal_range")}
TREE_SMALL = {"STACK_DEPTH": 8, "STACK_DEPTH_LOG2": 3, "STACK_WATERMARK": 2, "TRIANGLE_FIFO_DEPTH_LOG2": 1,
              "ID_BITS": 5, "COUNT_BITS": 3, "MAX_ROWS": 2, "MAX_COLUMNS": 5, "LINE_BITS": 1, "DEPTH_BITS": 2}
TREE_WALK = {"unit": "tree_walk", "properties": ("tree_walk",)}
TREE_STACK = {"unit": "tree_walk", "properties": ("tree_walk", "tree_walk_stack")}
TREE_RANGE = {"unit": "tree_walk", "properties": ("tree_walk", "tree_walk_range")}
HITS = {"unit": "result_memory", "unseen": ("best_o", "host_data_o")}


def fifo(width, depth_log2, unit="fifo"):
    return {"unit": unit, "generics": {"WIDTH": width, "DEPTH_LOG2": depth_log2}, "properties": ("queue", unit)}


def decoder(rows, columns):
    return {"unit": "plane_sphere_decoder", "generics": {"NUM_ROWS": rows, "NUM_COLUMNS": columns}}


MODELS = (
    Model("control.fifo", "depth2", **fifo(2, 1), quick=True),
    Model("control.fifo", "depth4", **fifo(2, 2), quick=True, cover=8),
    Model("control.fifo", "depth8", **fifo(2, 3)),
    Model("control.fifo", "pairs", **fifo(28, 4)),
    Model("control.fifo", "leaves", **fifo(59, 5)),
    Model("control.block_fifo", "depth4", **fifo(2, 2, "block_fifo"), quick=True, cover=8),
    Model("control.block_fifo", "depth8", **fifo(2, 3, "block_fifo")),
    Model("control.block_fifo", "depth64", **fifo(2, 6, "block_fifo")),
    Model("control.selector", "all", "selector", quick=True, cover=10),
    Model("control.pair_issue", "all", "pair_issue", quick=True, cover=10),
    Model("control.decoder", "1x1", **decoder(1, 1), cover=6),
    Model("control.decoder", "4x4", **decoder(4, 4), quick=True),
    Model("control.decoder", "2x16", **decoder(2, 16)),
    Model("control.walk", "small", **WALK, constants=SMALL, quick=True, cover=12),
    Model("control.walk", "real", **WALK),
    Model("control.stack", "small", **STACK, constants=SMALL, quick=True, cover=14),
    Model("control.stack", "real", **STACK),
    Model("control.range", "small", **RANGE, constants=SMALL, quick=True, cover=14),
    Model("control.range", "real", **RANGE),
    Model("control.tree_walk", "small", **TREE_WALK, constants=TREE_SMALL, quick=True, cover=12),
    Model("control.tree_walk", "real", **TREE_WALK),
    Model("control.tree_stack", "small", **TREE_STACK, constants=TREE_SMALL, quick=True, cover=16),
    Model("control.tree_stack", "real", **TREE_STACK, unseen=("address_o",)),
    Model("control.tree_range", "small", **TREE_RANGE, constants=TREE_SMALL, quick=True, cover=12),
    Model("control.ram", "8x2", "ram", {"WIDTH": 2, "ADDRESS_BITS": 3}, quick=True, cover=6),
    Model("control.result_memory", "small", **HITS, constants=FEW_RAYS, quick=True, cover=12),
    Model("control.result_memory", "real", **HITS),
    Model("control.event_counters", "all", "event_counters", cover=3),
    Model("control.unit_counters", "all", "unit_counters", {"BITS": 32}, cover=3),
    Model("control.pencil_control", "all", "pencil_control", quick=True, cover=20),
    Model("control.column_selector", "all", "column_selector", quick=True, cover=10),
    Model("control.row_queue", "small", "row_selector", properties=("row_queue",), constants={"ROW_FIFO_DEPTH_LOG2": 3},
          depth=18, cover=18, quick=True),
    Model("control.row_queue", "real", "row_selector", properties=("row_queue",)),
    Model("control.triangle_room", "all", "tree_walk", properties=("triangle_room",), constants=SMALL_STACK,
          unseen=("address_o", "rows_o", "columns_o", "last_o", "stack_level_o")),
    Model("control.hit_room", "all", "hit_queue", properties=("hit_room",), unseen=(
        "best_bank_o", "best_ray_o", "write_o", "write_bank_o", "ray_o", "result_o", "first_o", "bounds_o", "bound_o",
        "done_o", "done_bank_o")),
)


def with_constants(rtl, constants, folder):
    """A copy of rtl/ in which raplas_constants.vhd has other values."""
    shutil.copytree(rtl, folder, dirs_exist_ok=True)
    path = folder / "common/raplas_constants.vhd"
    text = path.read_text()
    for name, value in constants.items():
        text, count = re.subn(rf"(constant {name} : natural := )\d+;", rf"\g<1>{value};", text)
        if count != 1:
            raise RuntimeError(f"constant {name} occurs {count} times in raplas_constants.vhd")
    path.write_text(text)
    return folder


def constants_of(rtl):
    text = (rtl / "common/raplas_constants.vhd").read_text()
    return dict(re.findall(r"constant (\w+) : natural := (\d+);", text))


def build(model, folder, rtl, cover=None):
    """The unit with its properties as a netlist; with `cover`, its negation is the only assertion."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if model.constants:
        rtl = with_constants(rtl, model.constants, folder / "rtl")
    text = properties(model)
    if cover:
        text = text.replace(": assert ", ": cover ")
        text = re.sub(rf"\b{cover}: cover \((.*)\);", rf"{cover}: assert (!(\1));", text)
    generics = [f"{name}={value}" for name, value in model.generics.items()]
    body, end = export(model.unit, folder, generics, rtl=rtl).read_text().rsplit("endmodule", 1)
    parameters = {**constants_of(rtl), **model.generics}
    used = sorted(set(re.findall(r"\b[A-Z][A-Z0-9_]+\b", text)) & parameters.keys())
    bound = folder / "bound.sv"
    bound.write_text(body + "".join(f"localparam {name} = {parameters[name]};\n" for name in used)
                     + f"{text}endmodule{end}")
    netlist = folder / "model.il"
    unseen = "".join(f"delete -output {model.unit}/{name}; " for name in model.unseen)
    yosys(f"read_verilog -formal -sv {bound}; prep -flatten -nordff -top {model.unit}; {unseen}opt_clean; "
          f"chformal -cover -remove; memory_map; opt -full; dffunmap; opt_clean; check -assert; write_rtlil {netlist}")
    written, kept = text.count(": assert "), netlist.read_text().count("cell $assert ")
    if written != kept or not kept:
        raise RuntimeError(f"{bound}: {written} assertions, {kept} of them in the netlist")
    return netlist


def properties(model):
    names = model.properties or (model.unit,)
    return "".join((FORMAL / "control" / f"{name}.sv").read_text() for name in names)


def yosys(script):
    return run("yosys", "-Q", "-T", "-p", script, seconds=SECONDS)


def prove(netlist, *options):
    """What the SAT solver prints."""
    options = " ".join(options)
    return yosys(f"read_rtlil {netlist}; sat -set-assumes -prove-asserts -show-all -tempinduct {options}")


def clocks(output):
    """[{name: bits}] of the table that the solver prints of a model, one a clock."""
    rows = {}
    for step, name, bits in re.findall(r"(?m)^ +(\d+) \\?(\S+) +\S+ +\S+ +([01x]+)$", output):
        rows.setdefault(int(step), {})[name] = bits
    return [rows[step] for step in sorted(rows)]


def counterexample(output, model, netlist):
    """What fails in the last clock; the ports, a line a clock, in hexadecimal; what stands beside them."""
    rows, cells = clocks(output), netlist.read_text()
    last = rows[-1]
    assertions = r"cell \$assert \\(\w+)\n +connect \\A \\?(\S+)\n +connect \\EN \\?(\S+)\n"
    failing = [name for name, check, enable in re.findall(assertions, cells)
               if last.get(check) == "0" and last.get(enable, "1") == "1"]
    lines = [line.strip() for line in properties(model).splitlines()
             if line.strip().startswith(tuple(f"{name}: " for name in failing))]
    ports = [name for way in ("input", "output") for name in
             re.findall(rf"(?m)^  wire (?:width \d+ )?{way} \d+ \\(\w+)$", cells) if name != "clk_i"]

    def show(row, names):
        return " ".join(f"{name}={int(row[name], 2):x}" for name in names if "x" not in row.get(name, "x"))

    ghosts = [name for name in last if re.fullmatch(r"[a-z]\w+", name) and name not in ports
              and not re.match(r"n\d+_|rin$|clk_i", name)]
    lines += [f"clock {k}: {show(row, ports)}" for k, row in enumerate(rows)]
    return "\n    ".join([*lines, f"beside: {show(last, ghosts)}"])


def decide(model, netlist):
    path = netlist()
    output = prove(path, "-maxsteps 1")
    if "Induction step proven: SUCCESS!" in output:
        return Result(PROVED)
    if REFUTATION not in output:
        output = prove(path, f"-tempinduct-baseonly -maxsteps {model.depth}")
    if REFUTATION in output:
        return Result(REFUTED, counterexample(output, model, path))
    step = prove(path, "-tempinduct-inductonly -maxsteps 1")
    return Result(UNDECIDED, f"no counterexample in {model.depth} clocks, but the induction fails\n    "
                             f"{counterexample(step, model, path)}")


def reached(model, netlist):
    """A trace to a cover: a counterexample of its negation."""
    if REFUTATION in prove(netlist(), f"-tempinduct-baseonly -maxsteps {model.cover}"):
        return Result(PROVED)
    return Result(REFUTED, f"not reached in {model.cover} clocks: do the assumptions contradict each other?")


def covers(model):
    return re.findall(r"\b(\w+): cover ", properties(model)) if model.cover else []


def cases(work, rtl):
    made = []
    for model in MODELS:
        def add(name, check, quick, *cover, model=model):
            netlist = Once(lambda: build(model, work / model.theorem / name, rtl, *cover))
            made.append(Case(model.theorem, name, lambda: check(model, netlist), quick))

        add(model.name, decide, model.quick)
        for cover in covers(model):
            add(f"{model.name}.reached.{cover}", reached, False, cover)
    return made


EXPECTED = {"control.fifo": 6, "control.block_fifo": 4, "control.selector": 3, "control.pair_issue": 2,
            "control.decoder": 5, "control.walk": 5,
            "control.stack": 6, "control.range": 7, "control.tree_walk": 6, "control.tree_stack": 7,
            "control.tree_range": 8, "control.ram": 2, "control.result_memory": 4,
            "control.event_counters": 2, "control.unit_counters": 2, "control.pencil_control": 2,
            "control.column_selector": 3, "control.row_queue": 4, "control.triangle_room": 1, "control.hit_room": 1}
