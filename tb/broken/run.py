#!/usr/bin/env python3
"""Show that the benches catch broken designs.

usage: run.py [--only NAME ...] [--first] [--list FILE] [--work DIR] [--cmake-source DIR]

Each design of designs.toml is a copy of rtl/ with one change; its bench, in GHDL, must then fail.
That the bench passes without the change is its own test's business. A change that does not apply
exactly once, or that does not compile, is an error and not a catch. --first takes the first design
of each bench only. DIR (default build/broken) keeps the copy and its
build, so a second run compiles only what changes.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SECONDS = 600  # for one bench; a broken design may hang it, which is a catch too


class Work:
    """A copy of rtl/ and a build of it."""

    def __init__(self, folder, cmake_source):
        self.rtl, self.build = folder / "rtl", folder / "build"
        for stale in set(self.files(self.rtl)) - set(self.files(ROOT / "rtl")):
            (self.rtl / stale).unlink()
        self.change({})
        run("cmake", "-G", "Ninja", "-S", cmake_source, "-B", self.build,
            f"-DRAPLAS_SOURCES={self.rtl / 'sources.txt'}")

    @staticmethod
    def files(folder):
        return [path.relative_to(folder) for path in folder.rglob("*") if path.is_file()]

    def change(self, changed):
        """Makes the copy equal to rtl/, but for `changed`: relative path -> text."""
        for path in self.files(ROOT / "rtl"):
            text = changed.get(path, (ROOT / "rtl" / path).read_text())
            copy = self.rtl / path
            if not copy.exists() or copy.read_text() != text:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(text)

    def bench(self, target):
        """Builds and runs a bench: 'passes', or the first thing that failed."""
        run("ninja", "-C", self.build, "-j1", target)
        program = next(path for path in self.build.rglob(target) if path.is_file())
        try:
            done = subprocess.run([program], capture_output=True, text=True, timeout=SECONDS)
        except subprocess.TimeoutExpired:
            return "does not end"
        if done.returncode == 0:
            return "passes"
        failure = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
        return failure[1] if failure else f"exit code {done.returncode}: {done.stderr.strip()[:200]}"


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")


def patched(design):
    """relative path -> text of the one file that the design changes."""
    path = pathlib.Path(design["file"])
    text = (ROOT / "rtl" / path).read_text()
    if (count := text.count(design["search"])) != 1:
        raise RuntimeError(f"the search text occurs {count} times in rtl/{path}, not once")
    return {path: text.replace(design["search"], design["replace"])}


def target(design):
    return f"{design['bench']}.{design.get('prim', 'generic')}.ghdl"


def caught(said):
    """A test of the bench failed; a crash is no catch."""
    return said == "does not end" or re.fullmatch(r"\w+\.\w+", said.rstrip(",")) is not None


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ", 1)[1])
    parser.add_argument("--only", action="append")
    parser.add_argument("--first", action="store_true")
    parser.add_argument("--list", type=pathlib.Path, default=HERE / "designs.toml")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/broken")
    parser.add_argument("--cmake-source", type=pathlib.Path, default=ROOT)
    args = parser.parse_args()
    designs = tomllib.loads(args.list.read_text())["design"]
    designs = [d for d in designs if not args.only or d["name"] in args.only]
    if args.first:
        designs = list({target(d): d for d in reversed(designs)}.values())[::-1]
    work = Work(args.work.resolve(), args.cmake_source)
    results = []
    for design in designs:
        try:
            work.change(patched(design))
            said = work.bench(target(design))
            results.append(caught(said))
        except RuntimeError as error:
            said = f"ERROR: {error}"
            results.append(False)
        print(f"{'ok' if results[-1] else 'WRONG'}: {design['name']}: {target(design)}: {said}", flush=True)
    print(f"{sum(results)} passed, {len(results) - sum(results)} failed")
    sys.exit(0 if results and all(results) else 1)


if __name__ == "__main__":
    main()
