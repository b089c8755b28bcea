"""What the programs of this folder share: cases and verdicts, runs of tools, exports of the RTL, progress."""
import dataclasses
import pathlib
import subprocess
import sys
import threading
import time
from collections.abc import Callable

ROOT = pathlib.Path(__file__).resolve().parent.parent
FORMAL = ROOT / "formal"
sys.path.insert(0, str(ROOT / "scripts"))
from figures import write_json  # noqa: E402, F401: for the programs of this folder

PROVED, REFUTED, UNDECIDED = "proved", "refuted", "undecided"


@dataclasses.dataclass(frozen=True)
class Result:
    verdict: str      # PROVED, REFUTED or UNDECIDED
    detail: str = ""  # REFUTED: the counterexample as operands; UNDECIDED: why


@dataclasses.dataclass(frozen=True)
class Case:
    """One thing to prove. All cases of a theorem together are the theorem."""

    theorem: str                    # a row of prove.py's table and of docs/numerics.md
    name: str                       # unique within the theorem
    decide: Callable[[], Result]    # called at most once, from any thread
    quick: bool = False             # part of `make sim`


class Once:
    """A value made by the first thread that asks for it; the others wait."""

    def __init__(self, make):
        self._make, self._lock, self._made, self._value = make, threading.Lock(), False, None

    def __call__(self):
        with self._lock:
            if not self._made:
                self._value, self._made = self._make(), True
            return self._value


def run(*command, seconds=None, cwd=None):
    """Standard output of a command; RuntimeError when it fails, subprocess.TimeoutExpired when it is late."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=seconds, cwd=cwd)
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))[:300]}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


class Progress:
    """One line on a terminal, a line a minute elsewhere."""

    def __init__(self, total, what="cases"):
        self.total, self.what, self.done = total, what, 0
        self.start = self.last = time.monotonic()

    def step(self, name):
        self.done += 1
        now = time.monotonic()
        text = f"{self.done}/{self.total} {self.what}, {now - self.start:.0f} s, {name}"
        if sys.stdout.isatty():
            print(f"\r\033[K{text[:100]}", end="" if self.done < self.total else "\r\033[K", flush=True)
        elif now - self.last > 60:
            self.last = now
            print(text, flush=True)


def export(unit, folder, generics=(), prim="generic", rtl=ROOT / "rtl"):
    """The unit as Verilog, U.v and (vendor cells) unisim.v in `folder`, made by scripts/export_verilog.py."""
    run(sys.executable, ROOT / "scripts/export_verilog.py", "--unit", unit, "--prim", prim,
        "--sources", rtl / "sources.txt", *(f"--generic={g}" for g in generics), "--out", folder)
    return folder / f"{unit}.v"


def patched_rtl(folder, design):
    """A copy of rtl/ in `folder` with one change: design["file"], "search" (once in the file), "replace"."""
    for path in (ROOT / "rtl").rglob("*"):
        if path.is_file():
            text = path.read_text()
            relative = path.relative_to(ROOT / "rtl")
            if relative == pathlib.Path(design["file"]):
                if (count := text.count(design["search"])) != 1:
                    raise RuntimeError(f"the search text occurs {count} times in rtl/{relative}, not once")
                text = text.replace(design["search"], design["replace"])
            copy = folder / relative
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(text)
    return folder
