"""Prove that a mutant is no mutant: that no input can tell it from the unit.

The netlist with all mutants is read twice, with port mutant_i at 0 and at the mutant's number, into one
and-inverter graph in which equal nodes are shared, with one output that is 1 where the two differ; ABC must
show that it never is. Three ways, each enough by itself:

step      registers and memories hold the same in both: then so do all outputs and all next values
pipeline  (units without feedback) outputs as functions of the inputs of earlier clocks, all registers
          unrolled: equal once the pipeline is full
reset     (units with feedback) after a clock of rst_i = 1 in the same arbitrary state, and with the same words
          in memories, no outputs differ, whatever comes in (ABC's scorr and pdr)

A part (an instance that stays a module, see mutants.py) gives anything, the same in both netlists, as long as its
inputs have never differed; so they are compared like outputs, in the clocks of the reset too.
An output that means something only beside a valid bit is compared only then: MEANS. Inputs keep to what the
unit's page says of them: RANGES. A multiplication is first
any function of its operands, the same in both netlists; only if that fails, gates.
"""
import re
import subprocess
import threading

from aig import FALSE, TRUE, Aig
from common import run
from gate_netlist import FLIP_FLOPS, Endless, Netlist, View
from mutants import modules

EQUIVALENT, UNDECIDED = "equivalent", "undecided"
VERSION = 2    # raise it when verdicts may change: those that are kept are then made again
SECONDS = 120  # for each run of ABC
CONFLICTS = 20000  # of plain SAT, before ABC's iprove
MULTIPLIERS = 3  # as gates; with more of them ABC doesn't come to an end

# unit -> output -> the output that says whether it means something, or several, of which one must be 1
MEANS = {
    "fifo": {"data_o": "valid_o"},
    "block_fifo": {"data_o": "valid_o"},
    "plane_sphere_subunit": {"row_flags_o": "valid_o", "column_flags_o": "valid_o", "tag_o": "valid_o"},
    "ray_triangle": {"ray_o": "valid_o", "result_o": "valid_o"},
    "hit_queue": {"write_bank_o": "write_o", "ray_o": "write_o", "result_o": "write_o", "bound_o": "bounds_o",
                  "done_bank_o": "done_o"},
    "plane_sphere_decoder": {"row_mask_o": "decided_o", "column_mask_o": "decided_o"},
    "selector": {"ray_o": "valid_o", "triangle_o": "valid_o"},
    "traversal": {"address_o": "request_o", "set_o": "request_o", "first_o": "request_o", "last_o": "request_o"},
    "tree_walk": {"vertex_o": "request_o", "address_o": "request_o", "rows_o": "request_o", "columns_o": "request_o",
                  "last_o": "request_o"},
    "triangle_lines": {"rows_o": "valid_o", "columns_o": "valid_o", "z_o": "valid_o", "triangle_o": "valid_o"},
    "ray_bounds": {"bounds_o": "row_hit_o"},
    "row_selector": {"bank_o": "read_o", "row_o": "read_o", "row_word_o": "row_valid_o"},
    "column_selector": {"ray_o": "issue_o", "triangle_o": "issue_o", "z_o": "issue_o",
                        "bank_o": ("issue_o", "last_o")},
    "pencil_control": {"clear_bank_o": "clear_o", "load_bank_o": "load_o", "line_o": "load_o"},
    "intersection_unit": {"sphere_o": "request_o", "set_o": "request_o", "row_mask_o": "decided_o",
                          "column_mask_o": "decided_o", "stored_ray_o": "pair_done_o",
                          "stored_result_o": "pair_done_o"},
    "raplas_unit": {"vertex_o": "request_o", "object_o": "request_o", "found_triangle_o": "triangle_found_o",
                    "found_rows_o": "triangle_found_o", "found_columns_o": "triangle_found_o",
                    "found_z_o": "triangle_found_o", "ray_o": "issue_o", "triangle_o": "issue_o",
                    "stored_ray_o": "stored_o", "stored_result_o": "stored_o"},
}

# unit -> input -> least and greatest value
RANGES = {
    "plane_sphere_decoder": {"rows_i": (1, 16), "columns_i": (1, 16)},
    "traversal": {"root_count_i": (0, 1 << 20), "push_count_i": (1, 127)},
    "tree_walk": {"root_count_i": (1, 127), "triangles_i": (0, 32)},
    "pencil_control": {"rows_i": (1, 16), "columns_i": (1, 16)},
}


def abc(path, commands):
    done = subprocess.run(["berkeley-abc", "-q", f"read_aiger {path}; {commands}"], capture_output=True, text=True,
                          timeout=SECONDS)
    return done.stdout + done.stderr  # its exit code says nothing


class Prover:
    """Decides about mutants of one bench's netlist."""

    def __init__(self, row, folder, work):
        self.unit, self.folder, self.work = row.unit, folder, work
        self.means, self.parts = MEANS.get(row.unit, {}), modules(row)
        work.mkdir(parents=True, exist_ok=True)
        self.netlist, self.lock = None, threading.Lock()

    def _read(self):
        """The netlist with all mutants, as gates and plain registers."""
        whole = "t:$mem_v2 %d t:$mul %d t:$dff %d t:$_DFF_P_ %d"
        path = self.work / "netlist.json"
        script = f"read_ilang {self.folder / 'netlist.il'}; script {self.folder / 'mutants.ys'}; dffunmap; opt_clean; "
        if self.parts:
            script += f"blackbox {self.parts}; "
        script += "; ".join([f"techmap t:* {whole}"] * 6)
        run("yosys", "-q", "-Q", "-T", "-p", f"{script}; opt_clean; write_json {path}")
        self.netlist = Netlist(path, self.unit)
        try:
            if any(cell["type"] == "$mem_v2" for cell in self.netlist.cells.values()):
                raise Endless
            view = View(self.netlist, 0, Aig(), False, unrolled=True)
            for port in self.netlist.ports.values():
                for bit in port["bits"]:
                    view(bit)
            self.feedback = False
        except Endless:
            self.feedback = True
        self.multipliers = sum(cell["type"] == "$mul" for cell in self.netlist.cells.values())
        path.unlink()

    def decide(self, mutant):
        """[verdict, by which proof or why not] of the mutant of this number."""
        try:
            with self.lock:
                if self.netlist is None:
                    self._read()
            path = self.work / f"{mutant}.aig"
            ways = [self._step, self._reset if self.feedback else self._pipeline]
            verdict = [UNDECIDED, ""]
            for way in ways:
                for gates in (False, True):
                    verdict = way(mutant, gates, path)
                    if verdict[0] == EQUIVALENT:
                        path.unlink(missing_ok=True)
                        return verdict
                    if not 0 < self.multipliers <= MULTIPLIERS:
                        break
            return verdict
        except subprocess.TimeoutExpired:
            return [UNDECIDED, f"not within {SECONDS} s"]
        except Endless:
            return [UNDECIDED, "the mutant has feedback"]
        except (RuntimeError, KeyError) as error:
            return [UNDECIDED, f"{type(error).__name__}: {error}"]

    def _outputs(self, unit, mutant):
        """Literal: 1 where an output that means something differs."""
        aig, different = unit.aig, []
        for name, port in self.netlist.ports.items():
            if port["direction"] != "output":
                continue
            bad = aig.any(aig.differ(unit(bit), mutant(bit)) for bit in port["bits"])
            if name in self.means:
                valid = self.means[name] if isinstance(self.means[name], tuple) else (self.means[name],)
                bad = aig.both(bad, aig.any(unit(self.netlist.ports[one]["bits"][0]) for one in valid))
            different.append(bad)
        return aig.any(different)

    def _allowed(self, view):
        """Literal: 1 while the inputs keep their ranges."""
        aig, result = view.aig, TRUE
        for name, (least, greatest) in RANGES.get(self.unit, {}).items():
            word = [view(bit) for bit in self.netlist.ports[name]["bits"]]
            below, above = FALSE, FALSE  # from the low end: less than least, more than greatest
            for k, bit in enumerate(word):
                below = aig.either(bit ^ 1, below) if least >> k & 1 else aig.both(bit ^ 1, below)
                above = aig.both(bit, above) if greatest >> k & 1 else aig.either(bit, above)
            result = aig.both(result, aig.both(below ^ 1, above ^ 1))
        return result

    def _memories(self, unit, mutant, moves=None):
        """Literal: 1 where a memory's inputs differ; addresses and data of a write only while it writes.

        `moves` gets, for each clocked read port, whether it is read elsewhere; without it that counts too.
        """
        aig, different = unit.aig, []
        for name, cell in self.netlist.cells.items():
            if cell["type"] != "$mem_v2":
                continue
            parameters = cell["parameters"]
            clocked = parameters["RD_CLK_ENABLE"][::-1]
            pins = {view: lambda port, view=view: [view(b) for b in view.netlist.pins(name, port)]
                    for view in (unit, mutant)}
            pairs = {port: list(zip(pins[unit](port), pins[mutant](port))) for port in
                     ("RD_EN", "RD_ARST", "RD_SRST", "RD_ADDR", "WR_EN", "WR_ADDR", "WR_DATA")}
            width = int(parameters["ABITS"], 2)
            for port in range(int(parameters["RD_PORTS"], 2)):
                if int(clocked[port]):
                    different += [aig.differ(*pairs[p][port]) for p in ("RD_EN", "RD_ARST", "RD_SRST")]
                    elsewhere = aig.any(aig.differ(*pair) for pair in pairs["RD_ADDR"][port * width:(port + 1) * width])
                    if moves is None:
                        different.append(elsewhere)
                    else:  # a word that is kept stays as wrong as it was
                        moves[name, port] = pairs["RD_EN"][port][0], elsewhere
            bits = int(parameters["WIDTH"], 2)
            for port in range(int(parameters["WR_PORTS"], 2)):
                enables = pairs["WR_EN"][port * bits:(port + 1) * bits]
                different += [aig.differ(*pair) for pair in enables]
                writes = aig.any(a for a, _ in enables)
                different += [aig.both(writes, aig.differ(*pair))
                              for pair in pairs["WR_ADDR"][port * width:(port + 1) * width]]
                different += [aig.both(a, aig.differ(*pair))
                              for (a, _), pair in zip(enables, pairs["WR_DATA"][port * bits:(port + 1) * bits])]
        return aig.any(different)

    def _parts(self, unit, mutant):
        """Literal: 1 where an input of a part differs."""
        return unit.aig.any(unit.aig.differ(unit(bit), mutant(bit)) for name in self.netlist.parts
                            for port, direction in self.netlist.cells[name]["port_directions"].items()
                            if direction == "input" for bit in self.netlist.pins(name, port))

    def _registers(self):
        """(cell, place, the bit that it takes next) of all registers."""
        for name, cell in self.netlist.cells.items():
            if cell["type"] in FLIP_FLOPS:
                yield from ((name, k, bit) for k, bit in enumerate(cell["connections"]["D"]))

    def _solve(self, aig, bad, path, way):
        if bad == FALSE:
            return [EQUIVALENT, way]
        names = aig.write(path, bad)
        said = abc(path, f"strash; sat -C {CONFLICTS}; write_cex {path.with_suffix('.cex')}")
        if "UNDECIDED" in said:
            said = abc(path, f"strash; fraig; iprove; write_cex {path.with_suffix('.cex')}")
        if "UNSATISFIABLE" in said:
            return [EQUIVALENT, way]
        return [UNDECIDED, f"{way}: {self._counterexample(names, path)}"]

    def _counterexample(self, names, path):
        cex = path.with_suffix(".cex")
        if not cex.exists():
            return "no verdict"
        bits = cex.read_text().strip()
        cex.unlink()
        words = {}
        for name, value in zip(names, bits):
            if place := re.fullmatch(r"(\w+)\[(\d+)\](@-?\d+)", name):
                words.setdefault(place[1] + place[3], {})[int(place[2])] = int(value)
        return " ".join(f"{name}={sum(v << k for k, v in word.items()):x}" for name, word in sorted(words.items()))

    def _step(self, mutant, gates, path):
        aig = Aig()
        a = View(self.netlist, 0, aig, gates)
        b = View(self.netlist, mutant, aig, gates, other=a)
        bad = [self._outputs(a, b), self._memories(a, b), self._parts(a, b)]
        bad += [aig.differ(a(bit), b(bit)) for _, _, bit in self._registers()]
        return self._solve(aig, aig.both(aig.any(bad), self._allowed(a)), path, "step")

    def _pipeline(self, mutant, gates, path):
        aig = Aig()
        a, b = (View(self.netlist, number, aig, gates, unrolled=True) for number in (0, mutant))
        return self._solve(aig, aig.either(self._outputs(a, b), self._parts(a, b)), path, "pipeline")

    def _reset(self, mutant, gates, path):
        aig = Aig()
        started = aig.latch("started")

        def port(name, bit, age):
            literal = aig.input(f"{name}[{bit}]@0")
            return aig.either(literal, started ^ 1) if name == "rst_i" else literal

        def register(copy):
            return lambda name, bit: aig.choose(started, aig.input(f"start {name}.{bit}"),
                                                aig.latch(f"{copy} {name}.{bit}"))

        a = View(self.netlist, 0, aig, gates, register=register("unit"), port=port)
        b = View(self.netlist, mutant, aig, gates, register=register("mutant"), port=port, other=a,
                 moved=lambda cell, place: aig.both(started, aig.latch(f"moved {cell} {place}")))
        strayed = aig.latch("strayed")  # the inputs left their ranges
        stray = aig.either(strayed, self._allowed(a) ^ 1)
        next_values = {started: TRUE, strayed: stray}
        for copy, view in (("unit", a), ("mutant", b)):
            for name, k, bit in self._registers():
                next_values[aig.latch(f"{copy} {name}.{k}")] = view(bit)
        moves = {}
        bad = aig.both(started, aig.either(self._outputs(a, b), self._memories(a, b, moves)))
        bad = aig.either(bad, self._parts(a, b))
        bad = aig.both(bad, stray ^ 1)
        for (cell, place), (enable, elsewhere) in moves.items():
            moved = aig.latch(f"moved {cell} {place}")
            next_values[moved] = aig.choose(enable, moved, elsewhere)
        aig.write(path, bad, next_values)
        said = abc(path, f"scorr; pdr -T {SECONDS - 20}; print_status")
        if "Property proved" in said or "Status = 1" in said:
            return [EQUIVALENT, "reset"]
        return [UNDECIDED, "reset: " + (" ".join(said.split())[-160:])]
