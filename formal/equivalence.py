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
import json
import pathlib
import re
import subprocess
import threading

from mutants import modules

EQUIVALENT, DIFFERENT, UNDECIDED = "equivalent", "different", "undecided"
VERSION = 1    # raise it when verdicts may change: those that are kept are then made again
SECONDS = 120  # for each run of ABC
CONFLICTS = 20000  # of plain SAT, before ABC's iprove
CLOCKS = 100  # more than any pipeline has stages
MULTIPLIERS = 3  # as gates; with more of them ABC doesn't come to an end

# unit -> output -> the output that says whether it means something
MEANS = {
    "fifo": {"data_o": "valid_o"},
    "plane_sphere_subunit": {"row_flags_o": "valid_o", "column_flags_o": "valid_o", "tag_o": "valid_o"},
    "ray_triangle": {"ray_o": "valid_o", "result_o": "valid_o"},
    "plane_sphere_decoder": {"row_mask_o": "decided_o", "column_mask_o": "decided_o"},
    "selector": {"ray_o": "valid_o", "triangle_o": "valid_o"},
    "traversal": {"address_o": "request_o", "set_o": "request_o", "first_o": "request_o", "last_o": "request_o"},
    "intersection_unit": {"sphere_o": "request_o", "set_o": "request_o", "row_mask_o": "decided_o",
                          "column_mask_o": "decided_o", "stored_ray_o": "pair_done_o",
                          "stored_result_o": "pair_done_o"},
}

# unit -> input -> least and greatest value
RANGES = {
    "plane_sphere_decoder": {"rows_i": (1, 16), "columns_i": (1, 16)},
    "traversal": {"root_count_i": (0, 1 << 20), "push_count_i": (1, 127)},
}

FALSE, TRUE = 0, 1  # literals: twice the variable, plus 1 for its complement
FLIP_FLOPS = {"$_DFF_P_", "$dff"}
GATES = {"$_AND_", "$_OR_", "$_XOR_", "$_NOT_", "$_MUX_", "$_NAND_", "$_NOR_", "$_XNOR_", "$_ANDNOT_", "$_ORNOT_",
         "$_BUF_"}


class Aig:
    """An and-inverter graph with inputs and latches (reset to 0)."""

    def __init__(self):
        self.names = [None]   # by variable; None: an AND
        self.ands = {}        # (literal, literal) -> variable
        self.fanins = {}      # variable -> (literal, literal)
        self.inputs = {}      # name -> literal
        self.latches = {}     # name -> literal

    def _variable(self, name):
        self.names.append(name)
        return 2 * (len(self.names) - 1)

    def input(self, name):
        if name not in self.inputs:
            self.inputs[name] = self._variable(name)
        return self.inputs[name]

    def latch(self, name):
        if name not in self.latches:
            self.latches[name] = self._variable(name)
        return self.latches[name]

    def both(self, a, b):
        if a > b:
            a, b = b, a
        if a == FALSE or a ^ 1 == b:
            return FALSE
        if a == TRUE or a == b:
            return b
        if (a, b) not in self.ands:
            literal = self._variable(None)
            self.ands[a, b] = literal
            self.fanins[literal >> 1] = (a, b)
        return self.ands[a, b]

    def either(self, a, b):
        return self.both(a ^ 1, b ^ 1) ^ 1

    def differ(self, a, b):
        return self.both(self.both(a, b) ^ 1, self.both(a ^ 1, b ^ 1) ^ 1)

    def choose(self, s, a, b):
        """b if s, else a."""
        return self.either(self.both(s, b), self.both(s ^ 1, a))

    def any(self, literals):
        result = FALSE
        for literal in literals:
            result = self.either(result, literal)
        return result

    def add(self, a, b):
        """The low bits of a sum, as wide as a."""
        carry, result = FALSE, []
        for x, y in zip(a, b):
            half = self.differ(x, y)
            result.append(self.differ(half, carry))
            carry = self.either(self.both(x, y), self.both(half, carry))
        return result

    def multiply(self, a, b, width):
        total = [FALSE] * width
        for k, bit in enumerate(b[:width]):
            row = [FALSE] * k + [self.both(bit, x) for x in a]
            total = self.add(total, (row + [FALSE] * width)[:width])
        return total

    def write(self, path, bad, next_values=()):
        """Binary AIGER of the cone of the output `bad`; next_values: latch literal -> literal."""
        next_values = dict(next_values)
        order, number, stack = [], {0: 0}, [bad >> 1] + [v >> 1 for v in next_values.values()]
        inputs = [v >> 1 for v in self.inputs.values()]
        latches = [v >> 1 for v in next_values]
        for k, variable in enumerate(inputs + latches, 1):
            number[variable] = k
        while stack:
            variable = stack[-1]
            if variable in number:
                stack.pop()
                continue
            open_fanins = [f >> 1 for f in self.fanins[variable] if f >> 1 not in number]
            if open_fanins:
                stack += open_fanins
            else:
                number[variable] = len(inputs) + len(latches) + len(order) + 1
                order.append(variable)
                stack.pop()

        def literal(x):
            return 2 * number[x >> 1] + (x & 1)

        def delta(x):
            out = bytearray()
            while x >= 128:
                out.append(x & 127 | 128)
                x >>= 7
            out.append(x)
            return bytes(out)

        head = f"aig {len(inputs) + len(latches) + len(order)} {len(inputs)} {len(latches)} 1 {len(order)}\n"
        text = head + "".join(f"{literal(v)}\n" for v in next_values.values()) + f"{literal(bad)}\n"
        body = bytearray()
        for variable in order:
            high, low = sorted((literal(f) for f in self.fanins[variable]), reverse=True)
            body += delta(2 * number[variable] - high) + delta(high - low)
        path.write_bytes(text.encode() + bytes(body))
        return list(self.inputs)


class Netlist:
    """A module of Yosys' JSON: who drives each bit."""

    def __init__(self, path, unit):
        module = json.loads(path.read_text())["modules"][unit]
        self.ports = module["ports"]
        self.cells = module["cells"]
        self.parts = {name for name, cell in self.cells.items() if not cell["type"].startswith("$")}
        self.driver = {}
        for name, port in self.ports.items():
            if port["direction"] == "input":
                self.driver |= {bit: ("input", name, k) for k, bit in enumerate(port["bits"])}
        for name, cell in self.cells.items():
            for port, direction in cell["port_directions"].items():
                if direction == "output":
                    self.driver |= {bit: (cell["type"], name, port, k)
                                    for k, bit in enumerate(cell["connections"][port])}

    def pins(self, cell, port):
        return self.cells[cell]["connections"].get(port, [])


class Endless(Exception):
    """A register can reach itself."""


class View:
    """A netlist's bits as literals. `unrolled`: a register is its input a clock earlier; otherwise a leaf."""

    def __init__(self, netlist, mutant, aig, gates, unrolled=False, register=None, port=None, other=None, moved=None):
        self.netlist, self.mutant, self.aig, self.gates, self.unrolled = netlist, mutant, aig, gates, unrolled
        self.moved = moved  # literal of (memory, read port): it was read elsewhere a clock ago; None: never
        self.register = register or (lambda name, bit: aig.input(f"{name}.{bit}"))
        self.port = port or (lambda name, bit, age: aig.input(f"{name}[{bit}]@{-age}"))
        self.other = other  # the unit's view, when this is a mutant's
        self.known = {}

    def __call__(self, bit, age=0):
        known, stack = self.known, [(bit, age)]
        while stack:
            key = stack[-1]
            if key in known:
                stack.pop()
                continue
            needs = self._needs(*key)
            missing = [need for need in needs if need not in known]
            if missing:
                stack += missing
            else:
                known[key] = self._make(*key, [known[need] for need in needs])
                stack.pop()
        return known[bit, age]

    def _needs(self, bit, age):
        driver = self.netlist.driver.get(bit)
        if driver is None or driver[0] == "input":
            return []
        kind, cell = driver[:2]
        pins = self.netlist.pins
        if kind in FLIP_FLOPS:
            if age > CLOCKS:
                raise Endless
            return [(pins(cell, "D")[driver[3]], age + 1)] if self.unrolled else []
        if kind == "$_MUX_":  # of other mutants: only one side
            select = (pins(cell, "S")[0], age)
            value = self.known.get(select)
            sides = [(pins(cell, port)[0], age) for port in "AB"]
            return [select] if value is None else [sides[value]] if value in (FALSE, TRUE) else sides + [select]
        if kind == "$mem_v2":
            return [(b, age) for b in pins(cell, "RD_ADDR")] if self.other else []
        if kind == "$mul":
            return [(b, age) for port in "AB" for b in pins(cell, port)]
        if cell in self.netlist.parts:
            return []
        if kind not in GATES:
            raise RuntimeError(f"a cell that no proof knows: {kind}")
        return [(pins(cell, port)[0], age) for port in "ABS" if pins(cell, port)]

    def _make(self, bit, age, values):
        aig, driver = self.aig, self.netlist.driver.get(bit)
        if driver is None:
            return TRUE if bit == "1" else FALSE
        if driver[0] == "input":
            if driver[1] == "mutant_i":
                return self.mutant >> driver[2] & 1
            return self.port(driver[1], driver[2], age)
        kind, cell, port, place = driver
        if kind in FLIP_FLOPS:
            return values[0] if self.unrolled else self.register(cell, place)
        if len(values) == 1 and kind == "$_MUX_":
            return values[0]
        if kind == "$mem_v2":
            return self._read(cell, place, values)
        if kind == "$mul":
            return self._product(cell, values)[place]
        if cell in self.netlist.parts:
            return aig.input(f"{cell}.{port}.{place}")
        a, b, s = (values + [None, None])[:3]
        return {"$_AND_": lambda: aig.both(a, b), "$_OR_": lambda: aig.either(a, b),
                "$_XOR_": lambda: aig.differ(a, b), "$_NOT_": lambda: a ^ 1, "$_BUF_": lambda: a,
                "$_NAND_": lambda: aig.both(a, b) ^ 1, "$_NOR_": lambda: aig.either(a, b) ^ 1,
                "$_XNOR_": lambda: aig.differ(a, b) ^ 1, "$_ANDNOT_": lambda: aig.both(a, b ^ 1),
                "$_ORNOT_": lambda: aig.either(a, b ^ 1), "$_MUX_": lambda: aig.choose(s, a, b)}[kind]()

    def _read(self, cell, place, values):
        """What memory gives: the same in both netlists, if an asynchronous read has the same address."""
        shared = self.aig.input(f"{cell}.read[{place}]")
        if self.other is None:
            return shared
        entry = self.netlist.cells[cell]["parameters"]
        port = place // int(entry["WIDTH"], 2)
        if int(entry["RD_CLK_ENABLE"][::-1][port]):
            if self.moved is None:
                return shared  # addresses are compared
            return self.aig.choose(self.moved(cell, port), shared, self.aig.input(f"{cell}.elsewhere[{place}]"))
        width = int(entry["ABITS"], 2)
        addresses = self.other.netlist.pins(cell, "RD_ADDR")
        moved = self.aig.any(self.aig.differ(self.other(addresses[k]), values[k])
                             for k in range(port * width, (port + 1) * width))
        return self.aig.choose(moved, shared, self.aig.input(f"{cell}.elsewhere[{place}]"))

    def _product(self, cell, values):
        pins = self.netlist.pins
        width, split = len(pins(cell, "Y")), len(pins(cell, "A"))
        a, b = values[:split], values[split:]
        parameters = self.netlist.cells[cell]["parameters"]
        if int(parameters["A_SIGNED"], 2) or int(parameters["B_SIGNED"], 2):
            raise RuntimeError("a signed multiplication, which no proof knows")
        if self.gates:
            return self.aig.multiply(a, b, width)
        return [self.aig.input(f"product {a} {b} {k}") for k in range(width)]


def abc(path, commands):
    done = subprocess.run(["berkeley-abc", "-q", f"read_aiger {path}; {commands}"], capture_output=True, text=True,
                          timeout=SECONDS)
    return done.stdout + done.stderr


class Prover:
    """Decides about mutants of one bench's netlist."""

    def __init__(self, bench, row, folder, work):
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
        done = subprocess.run(["yosys", "-q", "-Q", "-T", "-p", f"{script}; opt_clean; write_json {path}"],
                              capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"yosys: {done.stdout[-500:]}{done.stderr[-500:]}")
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
                bad = aig.both(bad, unit(self.netlist.ports[self.means[name]]["bits"][0]))
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
        return self._solve(aig, self._outputs(a, b), path, "pipeline")

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
