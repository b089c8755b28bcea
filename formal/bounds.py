"""Theorems bounds.*: how far the datapaths are from mathematics, proved by gappa.

bounds/*.g.in holds a datapath's operations in the RTL's order; cmodel/test/bounds_test.cpp compares them with
the golden model's, one by one. One description gives a gappa script for each adder:

    word A B ..  M        operands of the datapath: fp24 numbers of magnitude <= M
    x = a * b  below L    an operation, rounded. Magnitudes of x, and of both operands and the exact sum of an
                          addition, are below L, a power of two (part of what is proved)
    exact x  M            the exact value of x, computed from the words without rounding, is <= M
    bound NAME  x         theorem bounds.NAME: |x - exact value of x| <= the number in bounds/bounds.json

In the scripts X is the exact value of x, and an operation is its exact result with two errors:

    guarded   x = rz(a + b) + z_x        truncated to 17 bits;
    paper     x = (a + b) + c_x + z_x    |c_x| <= L 2^-17, see below;
    both      |z_x| <= 2^-62             what is below the smallest normal number becomes 0.

Why |c_x| <= L 2^-17, the last place of numbers below L. The paper's adder cuts the smaller operand to the last
place of the larger one, adds exactly, and truncates. Signs equal: cutting to that place and then to a higher one
is truncating the exact sum, and costs less than the sum's last place. Signs opposite: the difference needs no more
than 17 bits; only the cut costs, less than the larger operand's last place.

usage: bounds.py [NAME guarded|paper|both]    prints the best bounds that gappa finds, or the script of one
"""
import json
import subprocess
import sys

from proof import FORMAL, PROVED, UNDECIDED, Case, Result

FOLDER = FORMAL / "bounds"
DATAPATHS = ("plane_sphere", "ray_triangle")
VARIANTS = ("guarded", "paper")
SCRIPTS = ("radius_factor", "radius_underflow", "radius_underflow_normal")  # scripts that hold for both adders
SECONDS = 300  # a script takes 1 to 10


class Datapath:
    """A file of bounds/*.g.in."""

    def __init__(self, path):
        self.words, self.operations, self.exact, self.bounds = {}, [], {}, {}
        for line in path.read_text().splitlines():
            fields = line.split("#")[0].split()
            if not fields:
                continue
            if fields[0] == "word":
                self.words |= {word: fields[-1] for word in fields[1:-1]}
            elif fields[0] == "exact":
                self.exact[fields[1]] = fields[2]
            elif fields[0] == "bound":
                self.bounds[fields[1]] = fields[2]
            else:
                name, equals, a, operator, b, below, limit = fields
                if equals != "=" or operator not in "+-*" or below != "below":
                    raise ValueError(f"{path}: {line}")
                self.operations.append((name, a, operator, b, int(limit)))

    def needed(self, name):
        """Operations and words that the value `name` is made of."""
        names, operations = {name}, []
        for operation in reversed(self.operations):
            if operation[0] in names:
                names |= {operation[1], operation[3]}
                operations.insert(0, operation)
        return operations, [word for word in self.words if word in names]

    def script(self, target, variant, number):
        """gappa's script for |target - exact| <= number; number None: for the best bound."""
        operations, words = self.needed(target)
        computed = {operation[0] for operation in operations}

        def exact(name):
            return name.upper() if name in computed else name

        def rounded(name, a, operator, b):
            return f"rz({a} {operator} {b})" if operator == "*" or variant == "guarded" else \
                f"({a} {operator} {b}) + c_{name}"

        def own_error(name, a, operator, b):
            return f"(rz({a} {operator} {b}) - ({a} {operator} {b}))" \
                if operator == "*" or variant == "guarded" else f"c_{name}"

        def propagated(a, operator, b):
            """How the operands' errors come through, as an expression; empty if they have none."""
            if operator == "*":
                parts = [f"{a} * ({b} - {exact(b)})"] if b in computed else []
                parts += [f"({a} - {exact(a)}) * {exact(b)}"] if a in computed else []
            else:
                parts = [f"({a} - {exact(a)})"] if a in computed else []
                parts += [f"({b} - {exact(b)})" if operator == "+" else f"({exact(b)} - {b})"] if b in computed else []
            return " + ".join(parts)

        lines = ["@rz = float<17,-78,zr>;  # 17 bits toward zero", "", "# operands"]
        lines += [f"{word} = rz({word}_);" for word in words]
        lines += ["", "# the datapath"]
        lines += [f"{name} = {rounded(name, a, o, b)} + z_{name};" for name, a, o, b, _ in operations]
        lines += ["", "# the same without rounding"]
        lines += [f"{exact(name)} = {exact(a)} {o} {exact(b)};" for name, a, o, b, _ in operations]
        given = [f"|{word}| <= {self.words[word]}" for word in words]
        given += [f"|{exact(name)}| <= {limit}" for name, limit in self.exact.items() if name in computed]
        given += [f"|z_{name}| <= 1b-62" for name in sorted(computed)]
        goals = [f"|{target} - {exact(target)}| " + ("in ?" if number is None else f"<= {number}")]
        for name, a, operator, b, limit in operations:
            below = limit * (1 - 2**-10)  # so that an fp24 number cannot be `limit`
            if number is not None:
                goals.append(f"|{name}| <= {below}")
                goals += [f"|{a} {operator} {b}| <= {below}"] if operator != "*" else []
            if variant == "paper" and operator != "*":
                given.append(f"|c_{name}| <= {limit}b-17")
                goals += [f"|{word}| <= {below}" for word in (a, b) if word in words and number is not None]
        lines += ["", "{ " + "\n  /\\ ".join(given), "  ->", "  " + "\n  /\\ ".join(dict.fromkeys(goals)) + " }"]
        lines += ["", "# errors, split into what an operation adds and what its operands bring along"]
        for name, a, operator, b, _ in operations:
            errors = propagated(a, operator, b)
            lines.append(f"{name} - {exact(name)} -> {own_error(name, a, operator, b)} + z_{name}"
                         + (f" + ({errors})" if errors else "") + ";")
            if operator != "*" and errors:
                lines.append(f"{a} {operator} {b} -> {exact(name)} + ({errors});")
        return "\n".join(lines) + "\n"


def gappa(script):
    """(proved?, what gappa said); RuntimeError if it said anything but that it proved it, or couldn't."""
    done = subprocess.run(["gappa"], input=script, capture_output=True, text=True, timeout=SECONDS)
    said = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    said = [line for line in said if "no need for the rewriting" not in line and line != "Results:"]
    if done.returncode != 0 and "Error: some properties were not satisfied:" not in said:
        raise RuntimeError("\n".join(said)[-2000:])
    return done.returncode == 0, "\n".join(said)


def proven():
    """bounds.json: {name: {variant: number}} with numbers as they are written, exactly."""
    return json.loads((FOLDER / "bounds.json").read_text(), parse_float=str, parse_int=str)


def statements():
    """(name, variant, number -> script) of every bound."""
    for datapath in DATAPATHS:
        tree = Datapath(FOLDER / f"{datapath}.g.in")
        for name, target in tree.bounds.items():
            for variant in VARIANTS:
                yield name, variant, lambda number, t=tree, x=target, v=variant: t.script(x, v, number)
    for name in SCRIPTS:
        text = (FOLDER / f"{name}.g").read_text()
        yield name, "both", lambda number, t=text: t if number is None else t.replace("in ?", f"<= {number}")


def prove(script, number, folder, name):
    def decide():
        folder.mkdir(parents=True, exist_ok=True)
        text = script(number)
        (folder / f"{name}.g").write_text(text)
        done, said = gappa(text)
        return Result(PROVED if done else UNDECIDED, said[-600:])
    return decide


def refuse(script, number):
    """gappa must not prove half the bound: a script whose hypotheses contradict each other proves anything."""
    def decide():
        done, _ = gappa(script(repr(float(number) / 2)))
        return Result(UNDECIDED if done else PROVED, "gappa proves half the bound" if done else "")
    return decide


NAMES = ("distance", "nd", "t", "u", "v", "uv", *SCRIPTS)
EXPECTED = {**{f"bounds.{name}": 1 if name in SCRIPTS else len(VARIANTS) for name in NAMES},
            "bounds.half_is_refused": sum(1 if name in SCRIPTS else len(VARIANTS) for name in NAMES)}


def cases(work, rtl):
    numbers = proven()
    for name, variant, script in statements():
        number = numbers[name][variant]
        quick = name in ("distance", "nd", *SCRIPTS)
        yield Case(f"bounds.{name}", variant, prove(script, number, work / "bounds", f"{name}.{variant}"), quick)
        yield Case("bounds.half_is_refused", f"{name}.{variant}", refuse(script, number), quick)


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
