"""Break the project on purpose and count what its checks notice.

    python tools/mutants.py [--values 100] [--claims 100] [--derivations 60] [--inputs 0] [--seed 1] [--jobs 2] [--off]

Four kinds of mutants, each alone in a copy of the project that has no committed ledger:

value       the last digit of one printed number; caught where a check of a notebook fails that did not
claim       one number, direction word, comparison or operator of a statement; caught where its verdict is another
derivation  one number, sign or operator; caught where a test fails, or a check of a notebook has another verdict
input       one literal of a notebook's code; caught where a computed number, a verdict or an evidence moves

First the harness shows that it can report survivors: with the verdicts switched off a few mutants of each kind must all
survive (`--off` does only that, on the whole sample). A true input, which nothing else determines, is counted apart.
Caught is only what something noticed that names the place: the row, or the module or function. The exit code is 0 where
at least 98 % of values, claims and derivations were caught. Survivors are listed.
"""

import argparse
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from queue import Queue
from typing import Any

from mutations import Mutant, claim_mutants, derivation_mutants, importers, input_mutants, value_mutants

ROOT = Path(__file__).resolve().parent.parent
PARTS = ("src", "notebooks", "tests", "tools", "docs", "pyproject.toml", "README.md", "environment.txt")
LEDGER = {"ledger.csv", "claims.csv", "misprints.csv"}
WANTED = 0.98
SERVERS = 4  # notebooks at a time that a copy keeps ready
BY = ("check", "test", "error")
INPUT = "nothing determines it"
PATIENCE = 240  # seconds of computing for the tests of one mutant, which may run for ever
OFF = """

def value_verdict(value, found):
    return GIVEN if value.kind == "given" else REPRODUCED


def claim_verdict(parts):
    return HOLDS


def misprint_verdict(holds, mended):
    return PROVED


FAILING = set()
"""
Runs = dict[str, dict[str, Any]]


@dataclass(frozen=True)
class Fate:
    """What became of a mutant. by: "check", "test", "error", "nothing determines it", or "" where it survived.

    named: does what noticed it name the place, the module or the function?
    """

    mutant: Mutant
    by: str
    named: bool = False

    @property
    def counts(self) -> bool:
        return self.by != INPUT

    @property
    def caught(self) -> bool:
        """By a check that names the place. Other evidence is none: only the committed ledger would show it."""
        return self.counts and self.named and self.by != "evidence"


@dataclass
class Copy:
    """A copy of the project to break. off: without verdicts. source: what it is a copy of. runs: what its notebooks say
    unbroken. servers: running processes by notebook, the one used last at the end; see `notebook_checks.serve`.
    """

    folder: Path
    off: bool = False
    source: Path = ROOT
    runs: Runs = field(default_factory=dict)
    servers: dict[str, subprocess.Popen[str]] = field(default_factory=dict)

    def make(self) -> "Copy":
        self.folder.mkdir(parents=True)
        for part in PARTS:
            if (self.source / part).is_dir():
                ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
                shutil.copytree(self.source / part, self.folder / part, ignore=ignored)
            elif (self.source / part).exists():
                shutil.copy(self.source / part, self.folder / part)
        if self.off:
            verdicts = self.folder / "src/notebook_reports/ledger/verdicts.py"
            verdicts.write_text(verdicts.read_text(encoding="utf-8") + OFF, encoding="utf-8")
        return self

    @property
    def environment(self) -> dict[str, str]:
        clean = {k: v for k, v in os.environ.items() if k != "PYTEST_ADDOPTS"}
        return clean | {"PYTHONPATH": str(self.folder / "src"), "PYTHONDONTWRITEBYTECODE": "1"}

    def said(self, *command: str) -> tuple[int, str]:
        limited = ("sh", "-c", f'ulimit -t {PATIENCE}; exec "$@"', "sh", sys.executable, *command)
        whole: dict[str, Any] = {"cwd": self.folder, "env": self.environment, "text": True, "check": False}
        done = subprocess.run(limited, capture_output=True, stdin=subprocess.DEVNULL, **whole)
        if done.returncode < 0:
            return 1, f"ended by signal {-done.returncode} within {PATIENCE} s of computing"
        return done.returncode, done.stdout + done.stderr

    def checks(self, notebook: str, anew: bool = False) -> dict[str, Any]:
        """What a notebook says now. anew: in a process of its own, which a changed module needs."""
        if not anew:
            return self._served(notebook)
        code, said = self.said("tools/notebook_checks.py", f"notebooks/{notebook}.ipynb")
        return json.loads(said.splitlines()[-1]) if code == 0 else {"error": said[-500:], "records": {}}

    def _served(self, notebook: str) -> dict[str, Any]:
        server = self.servers.pop(notebook, None) or self._serve(notebook)
        self.servers[notebook] = server
        assert server.stdin and server.stdout
        server.stdin.write("\n")
        server.stdin.flush()
        return json.loads(server.stdout.readline() or '{"error": "the run ended without a word", "records": {}}')

    def _serve(self, notebook: str) -> subprocess.Popen[str]:
        while len(self.servers) >= SERVERS:
            self.servers.pop(next(iter(self.servers))).kill()
        command = [sys.executable, "tools/notebook_checks.py", f"notebooks/{notebook}.ipynb", "--serve"]
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
        server = subprocess.Popen(command, cwd=self.folder, env=self.environment, text=True, **pipes)
        assert server.stdout
        while (line := server.stdout.readline()) and line != "ready\n":
            pass
        return server

    def unbroken(self, notebook: str) -> dict[str, Any]:
        """What a notebook says of the project as it is; ask before something is broken."""
        if notebook not in self.runs:
            self.runs[notebook] = self.checks(notebook)
        return self.runs[notebook]

    def close(self) -> None:
        """End the processes."""
        while self.servers:
            self.servers.popitem()[1].kill()


def noticed(before: dict[str, Any], after: dict[str, Any], differs: Callable[[Any, Any], bool]) -> list[str]:
    """The keys of the records that differ or are missing, and the error if there is a new one."""
    old, new = before["records"], after["records"]
    keys = [k for k in new if k not in old or differs(old[k], new[k])]
    keys += [k for k in old if k not in new and not after["error"]]
    return keys + ([after["error"]] if after["error"] and after["error"] != before["error"] else [])


def fails_now(old: dict[str, Any], new: dict[str, Any]) -> bool:
    return new["fails"] and not old["fails"]


def verdict_moved(old: dict[str, Any], new: dict[str, Any]) -> bool:
    return old["verdict"] != new["verdict"]


def outcome_moved(old: dict[str, Any], new: dict[str, Any]) -> bool:
    """Another verdict, or one that does not hold for other parts of the statement; numbers in their names aside."""
    parts = [re.sub(r"[\d.]+", "#", x["fields"].get("evidence", "").partition("Not for: ")[2]) for x in (old, new)]
    return verdict_moved(old, new) or parts[0] != parts[1]


def evidence_moved(old: dict[str, Any], new: dict[str, Any]) -> bool:
    return old["fields"].get("evidence") != new["fields"].get("evidence")


def computed_moved(old: dict[str, Any], new: dict[str, Any]) -> bool:
    return old != new


WAYS = {
    "value": {"check": fails_now},
    "claim": {"check": outcome_moved, "evidence": evidence_moved},
    "derivation": {"check": verdict_moved},
    "input": {"check": computed_moved},
}


def fate(copy: Copy, mutant: Mutant) -> Fate:
    """Make one mutant in a copy, look whether it is noticed, and unmake it."""
    for notebook in mutant.notebooks:
        copy.unbroken(notebook)
    path = copy.folder / mutant.file
    original = path.read_text(encoding="utf-8")
    path.write_text(original[: mutant.start] + mutant.text + original[mutant.end :], encoding="utf-8")
    try:
        return _look(copy, mutant)
    finally:
        path.write_text(original, encoding="utf-8")


def _look(copy: Copy, mutant: Mutant) -> Fate:
    if mutant.kind == "claim" and not mutant.notebooks:
        return Fate(mutant, "")  # free words, which nothing reads
    if mutant.kind == "derivation" and not copy.off:
        near = [t for t in importers(copy.folder, mutant.module, "tests") if "/notebook_reports/" not in t]
        flags = ("-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--doctest-modules")
        code, said = copy.said("-m", "pytest", *flags, mutant.file, *near[:12])
        if code in (1, 2):
            return Fate(mutant, "test", any(n in said for n in mutant.names))
    for notebook in mutant.notebooks:
        before, after = copy.unbroken(notebook), copy.checks(notebook, anew=mutant.kind == "derivation")
        for by, differs in WAYS[mutant.kind].items():
            if found := noticed(before, after, differs):
                named = any(n in line for n in mutant.names for line in found)
                if mutant.undetermined and not named:
                    return Fate(mutant, INPUT)  # what follows from it fails
                return Fate(mutant, by if named or found != [after["error"]] else "error", named)
    return Fate(mutant, INPUT if mutant.undetermined else "")


def sample(mutants: list[Mutant], number: int, seed: int) -> list[Mutant]:
    """A seeded choice, the same on every run over the same files: one of each place before a second of any."""
    before: Counter[tuple[str, ...]] = Counter()
    turns: list[tuple[int, int]] = []
    order = random.Random(seed).sample(mutants, len(mutants))
    for i, mutant in enumerate(order):
        turns.append((before[mutant.names], i))
        before[mutant.names] += 1
    return [order[i] for _, i in sorted(turns)[:number]]


def fates(chosen: list[Mutant], jobs: int, off: bool = False, source: Path = ROOT) -> list[Fate]:
    """Each mutant's fate, in copies of the project at `source`."""
    with tempfile.TemporaryDirectory(prefix="mutants") as temporary:
        copies: Queue[Copy] = Queue()
        for i in range(jobs):
            copies.put(Copy(Path(temporary) / str(i), off, source).make())
        work = partial(_with_copy, copies)
        try:
            with ThreadPoolExecutor(jobs) as pool:
                return list(pool.map(work, sorted(chosen, key=lambda m: m.notebooks)))
        finally:
            while not copies.empty():
                copies.get().close()


def _with_copy(copies: "Queue[Copy]", mutant: Mutant) -> Fate:
    copy = copies.get()
    try:
        found = fate(copy, mutant)
    finally:
        copies.put(copy)
    seen = found.by + ("" if found.named or not (found.by and found.counts) else ", unnamed")
    print(f"{seen or 'SURVIVED':9} {mutant.kind:10} {mutant.what}", flush=True)
    return found


def report(found: list[Fate]) -> bool:
    """Print the counts and the survivors; True where enough of each kind was caught."""
    print()
    enough = True
    for kind in dict.fromkeys(f.mutant.kind for f in found):
        these = [f for f in found if f.mutant.kind == kind]
        counted = [f for f in these if f.counts]
        caught = [f for f in counted if f.caught]
        share = len(caught) / len(counted) if counted else 1.0
        ways = ", ".join(f"{sum(f.by == by for f in caught)} by {by}" for by in BY)
        print(f"{kind:10} {len(caught)} of {len(counted)} caught by what names the place, {100 * share:.1f} % ", end="")
        print(f"({ways}); {len(these) - len(counted)} that nothing determines")
        enough &= share >= WANTED or kind == "input"
    for f in found:
        if not f.caught:
            how = (
                f"noticed by {f.by}, which does not name it"
                if f.by and f.counts and not f.named
                else f.by or "survived"
            )
            how = "nothing but its evidence moved" if f.by == "evidence" else how
            print(f"{how}: {f.mutant.kind}, {f.mutant.what}")
    return enough


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for kind, number in (("values", 100), ("claims", 100), ("derivations", 60), ("inputs", 0)):
        parser.add_argument(f"--{kind}", type=int, default=number)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--off", action="store_true", help="only show that the harness can report survivors")
    wanted = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="mutants") as temporary:
        source = Copy(Path(temporary) / "as-it-is").make().folder  # so that the project may be worked on meanwhile
        shutil.copytree(ROOT / "reports", source / "reports", ignore=lambda _, names: {*names} - LEDGER)
        return _counted(wanted, source)


def _counted(wanted: argparse.Namespace, source: Path) -> int:
    """The exit code of what was asked for, over the project at `source`."""
    made: dict[str, Callable[[Path], Iterator[Mutant]]] = {
        "values": value_mutants, "claims": claim_mutants, "derivations": derivation_mutants, "inputs": input_mutants,
    }  # fmt: skip
    chosen = {kind: sample(list(make(source)), getattr(wanted, kind), wanted.seed) for kind, make in made.items()}
    everything = [m for mutants in chosen.values() for m in mutants]
    unseen = everything if wanted.off else [m for k in ("values", "claims", "derivations") for m in chosen[k][:2]]
    print("with the verdicts switched off:")
    seen = fates(unseen, wanted.jobs, True, source)
    blind = [f for f in seen if f.caught and f.mutant.kind != "input"]
    print(f"caught {len(blind)} of {len(unseen)} that nothing can see\n")
    if wanted.off or len(blind) > WANTED * 0.1 * len(unseen) + 1:
        return 1 if blind else 0
    return 0 if report(fates(everything, wanted.jobs, source=source)) else 1


if __name__ == "__main__":
    raise SystemExit(main())
