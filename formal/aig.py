"""An and-inverter graph, made and written for ABC."""

FALSE, TRUE = 0, 1  # literals: twice the variable, plus 1 for its complement


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
