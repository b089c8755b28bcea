"""A netlist of gates, registers and memories as Yosys writes it, and its bits as literals of an Aig.

A multiplication is any function of its operands, or gates; a memory's word and a part's output are any value.
"""
import json

from aig import FALSE, TRUE

CLOCKS = 100  # more than any pipeline has stages
FLIP_FLOPS = {"$_DFF_P_", "$dff"}
GATES = {"$_AND_", "$_OR_", "$_XOR_", "$_NOT_", "$_MUX_", "$_NAND_", "$_NOR_", "$_XNOR_", "$_ANDNOT_", "$_ORNOT_",
         "$_BUF_"}


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
            return aig.input(f"{cell}.{port}.{place}@{-age}")  # in the clocks before: something else
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
