"""Theorems bounds.*: how far the datapaths are from mathematics, proved by gappa.

bounds/*.g.in holds a datapath's operations in the RTL's order; cmodel/test/bounds_script_test.cpp compares them with
the golden model's, one by one. The notation:

    word A B ..  M        operands of the datapath: fp24 numbers of magnitude <= M
    x = a * b  below L    an operation, rounded; L is a power of two
    exact x  M            the exact value of x, computed from the words without rounding, is <= M
    sum x y ..  S         the magnitudes of these products, before they are rounded, add up to <= S
    norm A B ..  K        the magnitudes of these words, or differences A-B of words, add up to <= K
    error x  E            |x - exact value of x| <= E; proved in every theorem that uses it
    bound NAME  x         theorem bounds.NAME: |x - exact value of x| <= the number in bounds/bounds.json

One description gives gappa scripts for both adders. X is the exact value of x; an operation is its exact result
with up to two errors:

    guarded   x = rz(a + b) + z_x        truncated to 17 bits;
    paper     x = (a + b) + c_x + z_x    |c_x| <= L 2^-17, see below;
    both      |z_x| <= 2^-62             what is below the smallest normal number becomes 0.

Theorem bounds.ranges: x, and for an addition both operands and the exact sum, stay below L (as fp24 numbers: below
L (1 - 2^-10)). So nothing saturates, and |c_x| <= L 2^-17, the last place of numbers below L: the paper's adder
cuts the smaller operand to the last place of the larger one, adds exactly, and truncates. Signs equal: cutting to
that place and then to a higher one is truncating the exact sum, and costs less than the sum's last place. Signs
opposite: the difference needs no more than 17 bits; only the cut costs, less than the larger operand's last place.
(Theorem fp_add.cut. By induction along the operations: what is said of x needs only what is said of its operands.)

The other theorems take the ranges for granted, and two sums that gappa can't bound well by itself (Hoelder): the
rounding errors of products with `sum` S add up to at most 2^-16 S + 2^-62 each, and errors of operands that are at
most E, multiplied by words with `norm` K, to at most K E.

usage: bounds.py [NAME guarded|paper|both]    prints the best bounds that gappa finds, or the script of one
"""
import decimal
import json
import subprocess
import sys

from common import FORMAL, PROVED, UNDECIDED, Case, Result

FOLDER = FORMAL / "bounds"
DATAPATHS = ("plane_sphere", "ray_triangle")
VARIANTS = ("guarded", "paper")
SCRIPTS = ("radius_factor", "radius_underflow", "radius_underflow_normal")  # the same for both adders
SECONDS = 300  # a script takes 1 to 30


class Operation:
    def __init__(self, name, equals, a, operator, b, below, limit):
        if equals != "=" or operator not in "+-*" or below != "below":
            raise ValueError(f"operation {name}")
        self.name, self.a, self.operator, self.b, self.limit = name, a, operator, b, int(limit)
        self.is_product = operator == "*"
        self.term = f"{a} {operator} {b}"
        self.range = repr(self.limit * (1 - 2**-10))

    def cut(self, variant):
        return variant == "paper" and not self.is_product

    def rounded(self, variant):
        return (f"({self.term}) + c_{self.name}" if self.cut(variant) else f"rz({self.term})") + f" + z_{self.name}"

    def own_error(self, variant):
        return (f"c_{self.name}" if self.cut(variant) else f"(rz({self.term}) - ({self.term}))") + f" + z_{self.name}"


class Datapath:
    """A file of bounds/*.g.in."""

    def __init__(self, path):
        self.words, self.operations, self.exact, self.errors, self.bounds = {}, {}, {}, {}, {}
        self.sums, self.norms = {}, {}
        for line in path.read_text().splitlines():
            fields = line.split("#")[0].split()
            if not fields:
                continue
            kind, *names, last = fields
            if kind == "word":
                self.words |= {name: last for name in names}
            elif kind in ("sum", "norm"):
                (self.sums if kind == "sum" else self.norms)[frozenset(names)] = decimal.Decimal(last)
            elif kind in ("exact", "error"):
                (self.exact if kind == "exact" else self.errors)[names[0]] = last
            elif kind == "bound":
                self.bounds[names[0]] = last
            else:
                self.operations[kind] = Operation(*fields)

    def needed(self, target):
        """The operations that the value `target` is made of; None: all."""
        names, operations = {target}, []
        for operation in reversed(self.operations.values()):
            if target is None or operation.name in names:
                names |= {operation.a, operation.b}
                operations.insert(0, operation)
        return operations

    def x(self, name):
        """The exact value's name."""
        return name.upper() if name in self.operations else name

    def head(self, operations, variant):
        """Definitions, and what both kinds of script take for granted."""
        used = {name for o in operations for name in (o.a, o.b)}
        words = [word for word in self.words if word in used]
        lines = ["@rz = float<17,-78,zr>;  # 17 bits toward zero", "", "# operands"]
        lines += [f"{word} = rz({word}_);" for word in words]
        lines += ["", "# the datapath"] + [f"{o.name} = {o.rounded(variant)};" for o in operations]
        lines += ["", "# the same without rounding"]
        lines += [f"{self.x(o.name)} = {self.x(o.a)} {o.operator} {self.x(o.b)};" for o in operations]
        given = [f"|{word}| <= {self.words[word]}" for word in words]
        given += [f"|{self.x(o.name)}| <= {self.exact[o.name]}" for o in operations if o.name in self.exact]
        given += [f"|z_{o.name}| <= 1b-62" for o in operations]
        given += [f"|c_{o.name}| <= {o.limit}b-17" for o in operations if o.cut(variant)]
        return lines, given

    @staticmethod
    def script(lines, given, goals, rules):
        return "\n".join([*lines, "", "{ " + "\n  /\\ ".join(given), "  ->",
                          "  " + "\n  /\\ ".join(dict.fromkeys(goals)) + " }", "", *rules]) + "\n"

    def ranges(self, variant):
        """gappa's script of theorem bounds.ranges."""
        operations = self.needed(None)
        lines, given = self.head(operations, variant)
        goals, rules = [], ["# errors: what an operation adds, and what its operands bring along"]
        for o in operations:
            goals.append(f"|{o.name}| <= {o.range}")
            goals += [] if o.is_product else [f"|{name}| <= {o.range}" for name in (o.term, o.a, o.b)]
            a, b = self.x(o.a), self.x(o.b)
            if o.is_product:
                brought = [f"{o.a} * ({o.b} - {b})"] if o.b != b else []
                brought += [f"({o.a} - {a}) * {b}"] if o.a != a else []
            else:
                brought = [f"({o.a} - {a})"] if o.a != a else []
                brought += [f"({o.b} - {b})" if o.operator == "+" else f"({b} - {o.b})"] if o.b != b else []
            brought = " + ".join(brought)
            rules.append(f"{o.name} - {self.x(o.name)} -> {o.own_error(variant)}"
                         + (f" + ({brought})" if brought else "") + ";")
            if not o.is_product and brought:
                rules.append(f"{o.term} -> {self.x(o.name)} + ({brought});")
        return self.script(lines, given, goals, rules)

    def expand(self, target):
        """[(sign, addition)], [(sign, product)]: target as a sum of products, and the additions on the way."""
        additions, products = [], []

        def walk(name, sign):
            o = self.operations.get(name)
            if o is None:
                return
            if o.is_product:
                products.append((sign, o))
            else:
                additions.append((sign, o))
                walk(o.a, sign)
                walk(o.b, sign if o.operator == "+" else -sign)

        walk(target, 1)
        return additions, products

    def error_of(self, target, variant):
        """(hypotheses, rule) for target's error."""
        additions, products = self.expand(target)
        given, parts = [], []
        for sign, o in additions:
            given.append(f"|{o.term}| <= {o.range}")
            parts.append(f"{'+' if sign > 0 else '-'} ({o.own_error(variant)})")
        # products' own errors, by the groups of `sum`
        for group, limit in self.sums.items():
            here = [(sign, o) for sign, o in products if o.name in group]
            if not here:
                continue
            if len(here) != len(group):
                raise ValueError(f"{target} has not all of {sorted(group)}")
            term = " ".join(f"{'+' if sign > 0 else '-'} ({o.name} - {o.term})" for sign, o in here).removeprefix("+ ")
            limit = limit / 2**16 + len(here) * decimal.Decimal(2)**-62
            given.append(f"|{term}| <= {limit}")
            parts.append(f"+ ({term})")
        if any(not any(o.name in group for group in self.sums) for _, o in products):
            raise ValueError(f"{target}: a product without a sum")
        # errors of the products' operands: the words that each of them is multiplied by
        factors = {}
        for sign, o in products:
            for value, word in ((o.a, o.b), (o.b, o.a)):
                if value in self.operations:
                    factors.setdefault(value, []).append((sign, word))
        if factors:
            keys, terms = set(), []
            for value, signed in factors.items():
                signed.sort(reverse=True)  # plus first
                if len(signed) == 1:
                    sign, word = signed[0]
                    keys.add(word)
                    terms.append(f"{'+' if sign > 0 else '-'} ({value} - {self.x(value)}) * {word}")
                else:
                    (plus, word), (minus, other) = signed
                    if (plus, minus) != (1, -1):
                        raise ValueError(f"{target}: {value} twice")
                    keys.add(f"{word}-{other}")
                    terms.append(f"+ ({value} - {self.x(value)}) * ({word} - {other})")
            largest = max(decimal.Decimal(self.errors[value]) for value in factors)
            term = " ".join(terms).removeprefix("+ ")
            given.append(f"|{term}| <= {self.norms[frozenset(keys)] * largest}")
            parts.append(f"+ ({term})")
        return given, f"{target} - {self.x(target)} -> " + " ".join(parts).removeprefix("+ ") + ";"

    def bound(self, target, variant, number):
        """gappa's script for |target - exact value| <= number; number None: for the best bound."""
        operations = self.needed(target)
        lines, given = self.head(operations, variant)
        goals = [f"|{target} - {self.x(target)}| " + ("in ?" if number is None else f"<= {number}")]
        rules = ["# errors of sums: of the additions, of the products, and of the products' operands"]
        for name in [o.name for o in operations if o.name in self.errors] + [target]:
            more, rule = self.error_of(name, variant)
            given += more
            rules.append(rule)
            if number is not None and name != target:
                goals.append(f"|{name} - {self.x(name)}| <= {self.errors[name]}")
        return self.script(lines, given, goals, rules)


def gappa(script):
    """(proved?, what gappa said); RuntimeError if it said anything but that it proved it, or couldn't."""
    done = subprocess.run(["gappa"], input=script, capture_output=True, text=True, timeout=SECONDS)
    said = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    said = [line for line in said if "no need for the rewriting" not in line and line != "Results:"]
    if done.returncode != 0 and "Error: some properties were not satisfied:" not in said:
        raise RuntimeError("\n".join(said)[-2000:])
    return done.returncode == 0, "\n".join(said)


def proven():
    """bounds.json: {name: {variant: number}} with the numbers as they are written."""
    return json.loads((FOLDER / "bounds.json").read_text(), parse_float=str, parse_int=str)


def statements():
    """(name, variant, number -> script) of every bound."""
    for datapath in DATAPATHS:
        tree = Datapath(FOLDER / f"{datapath}.g.in")
        for name, target in tree.bounds.items():
            for variant in VARIANTS:
                yield name, variant, lambda number, t=tree, x=target, v=variant: t.bound(x, v, number)
    for name in SCRIPTS:
        text = (FOLDER / f"{name}.g").read_text()
        yield name, "both", lambda number, t=text: t if number is None else t.replace("in ?", f"<= {number}")


def prove(script, folder, name):
    def decide():
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{name}.g").write_text(script)
        done, said = gappa(script)
        return Result(PROVED if done else UNDECIDED, said[-600:])
    return decide


def refuse(script):
    """gappa must not prove it."""
    def decide():
        done, _ = gappa(script)
        return Result(UNDECIDED if done else PROVED, "gappa proves half the bound" if done else "")
    return decide


NAMES = ("distance", "nd", "t", "u", "v", "uv")
EXPECTED = {"bounds.ranges": len(DATAPATHS) * len(VARIANTS)} \
    | {f"bounds.{name}": len(VARIANTS) for name in NAMES} | {f"bounds.{name}": 1 for name in SCRIPTS} \
    | {"bounds.half_is_refused": len(NAMES) * len(VARIANTS) + len(SCRIPTS)}


def cases(work, rtl):
    folder = work / "bounds"
    for datapath in DATAPATHS:
        tree = Datapath(FOLDER / f"{datapath}.g.in")
        for variant in VARIANTS:
            yield Case("bounds.ranges", f"{datapath}.{variant}",
                       prove(tree.ranges(variant), folder, f"ranges.{datapath}.{variant}"), datapath == "plane_sphere")
    numbers = proven()
    for name, variant, script in statements():
        number = numbers[name][variant]
        yield Case(f"bounds.{name}", variant, prove(script(number), folder, f"{name}.{variant}"), True)
        # a script whose hypotheses contradict each other would prove anything
        half = str(decimal.Decimal(number) / 2)
        yield Case("bounds.half_is_refused", f"{name}.{variant}", refuse(script(half)),
                   name not in ("u", "v", "uv"))


def main():
    if len(sys.argv) == 1:
        for name, variant, script in statements():
            print(f"{name:24} {variant:8} {gappa(script(None))[1]}", flush=True)
        return
    scripts = {(name, variant): script for name, variant, script in statements()}
    if tuple(sys.argv[1:]) not in scripts:
        sys.exit(__doc__.split("\n\n")[-1])
    print(scripts[tuple(sys.argv[1:])](proven()[sys.argv[1]][sys.argv[2]]), end="")


if __name__ == "__main__":
    main()
