"""`make chaos`: faults at random during builds, and whether anything wrong comes of them.

Three small notebooks are built over and over: one prints a number from a module, one from a file of data and from a
variable of the environment, one from its own code and leaves a record for the ledger. In each round one fault happens,
of a kind drawn from a seeded row: the build is killed, a file of the cache or a report is damaged, the disk is full, a
source is changed while the build runs, the environment is another. Then it is built once more as usual.

A report is wrong where a build that says it succeeded leaves other bytes than the sources of that moment give. A state
is not mended where the next build does not succeed with the right reports. What the right bytes are is known without
the builds under test: from one build of the same notebooks with marks in place of the numbers.

The run is made twice: as it is, where nothing may be wrong; and with the verification of what is remembered taken out,
where something has to be: else the faults would not matter.
"""

import argparse
import contextlib
import gc
import io
import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

KINDS = ("kill", "corrupt", "disk", "file", "environment")
FORMATS = ("html", "ipynb")
MODULE, DATA, VARIABLE, CODE = "module", "data", "variable", "code"
PLACES = {"a/one": (MODULE,), "a/two": (DATA, VARIABLE), "b/three": (CODE,)}
MARKS = {MODULE: 1111111, DATA: 2222222, VARIABLE: 3333333, CODE: 4444444}
NAME = "CHAOS_VALUE"
WAIT = 300  # s for one build
LEAST = 10
"""Faults of each kind that have to land in a whole run."""


@dataclass
class World:
    """A project, and what its sources hold now. right: bytes of each report with `MARKS` for the numbers."""

    root: Path
    verified: bool
    kernels: bool
    values: dict[str, int] = field(default_factory=lambda: dict(MARKS))
    surroundings: dict[str, str] = field(default_factory=dict)
    right: dict[str, bytes] = field(default_factory=dict)

    def write(self, what: str, value: int) -> None:
        """Put a number into one of the sources."""
        self.values[what] = value
        if what == MODULE:
            self._put("src/numbers_of.py", f"NUMBER = {value}\n")
        elif what == DATA:
            self._put("data.txt", str(value))
        elif what == CODE:
            self._notebook("b/three", f"value = {value}\nprint(value)", RECORD.replace("VALUE", str(value)))

    def prepare(self) -> None:
        """Write the project and learn what its reports look like."""
        self._notebook("a/one", "import numbers_of\nprint('from a module', numbers_of.NUMBER)")
        read = f"import os\nprint('from a file', open('../../data.txt').read(), os.environ.get({NAME!r}))"
        self._notebook("a/two", read)
        for what, value in MARKS.items():
            self.write(what, value)
        code, said = self.finished(self.start())
        if code:
            raise SystemExit(f"chaos: the first build failed\n{said}")
        self.right = self.reports()
        if len(self.right) != len(PLACES) * len(FORMATS):
            raise SystemExit(f"chaos: the first build made {sorted(self.right)}")

    def start(self, before: Callable[[], None] = lambda: None) -> "Builder":
        """Begin a build of the project as it is, in a process of its own. before: what that process does first."""
        values = {"LOOPBOOK_FRESH_KERNELS": "1", **self.surroundings, NAME: str(self.values[VARIABLE])}
        return Builder(self, values, before)

    @staticmethod
    def finished(builder: "Builder") -> tuple[int, str]:
        """Wait for a build: its exit code (that of a signal is negative) and what it said."""
        return builder.wait()

    def reports(self) -> dict[str, bytes]:
        """The reports that are there."""
        paths = {f"{id}.{format}": self.root / "reports" / f"{id}.{format}" for id in PLACES for format in FORMATS}
        return {name: path.read_bytes() for name, path in paths.items() if path.is_file()}

    def expected(self, values: dict[str, int]) -> dict[str, bytes]:
        """What the reports have to be where the sources hold these numbers."""
        made = {}
        for name, content in self.right.items():
            for what in PLACES[name.rpartition(".")[0]]:
                content = content.replace(str(MARKS[what]).encode(), str(values[what]).encode())
            made[name] = content
        return made

    def wrong(self, *possible: dict[str, int]) -> list[str]:
        """The reports there that are right for none of these states of the sources, and those that are not there."""
        wanted = [self.expected(values) for values in possible]
        there = self.reports()
        return [name for name in self.right if all(there.get(name) != each[name] for each in wanted)]

    def _put(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        aside = path.with_name(path.name + ".new")
        aside.write_text(text)
        aside.replace(path)

    def _notebook(self, id: str, *code: str) -> None:
        cells = [{"cell_type": "markdown", "id": "c0", "metadata": {}, "source": f"# {id}"}]
        for number, text in enumerate(code, 1):
            made = {"cell_type": "code", "id": f"c{number}", "metadata": {}, "source": text}
            cells.append({**made, "outputs": [], "execution_count": None})
        content = {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
        self._put(f"notebooks/{id}.ipynb", json.dumps(content))


class Builder:
    """A build in a fork of this process, which has imported what builds: a tenth of a second instead of a second."""

    def __init__(self, world: World, values: dict[str, str], before: Callable[[], None]):
        self.said = tempfile.TemporaryFile()  # noqa: SIM115 (closed when it was read)
        self.code: int | None = None
        self.pid = os.fork()
        if self.pid == 0:
            self._become(world, values, before)

    def _become(self, world: World, values: dict[str, str], before: Callable[[], None]) -> None:
        code = 70
        try:
            os.setsid()
            gc.callbacks.clear()  # of a test runner: an interruption in one would be lost
            for stream in (1, 2):
                os.dup2(self.said.fileno(), stream)
            sys.stdout = sys.stderr = open(self.said.fileno(), "w", buffering=1, errors="replace", closefd=False)  # noqa: SIM115
            signal.signal(signal.SIGINT, signal.default_int_handler)
            os.environ.update(values)
            before()
            code = build(world.root, world.verified, world.kernels)
        except BaseException:
            import traceback

            traceback.print_exc()
        finally:
            with contextlib.suppress(Exception):
                sys.stdout.flush()
                sys.stderr.flush()
            os._exit(code)

    def runs(self) -> bool:
        """Does it still build?"""
        if self.code is None:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.code = os.waitstatus_to_exitcode(status)
        return self.code is None

    def send(self, number: int) -> None:
        """Send a signal to it."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(self.pid, number)

    def wait(self) -> tuple[int, str]:
        """Wait for its end: the exit code and what it said."""
        ends = time.monotonic() + WAIT
        while self.runs():
            if time.monotonic() > ends:
                self.send(signal.SIGKILL)
            time.sleep(0.002)
        self.said.seek(0)
        with self.said:
            return self.code, self.said.read().decode(errors="replace")


RECORD = (
    "from IPython.display import display\n"
    "record = {'table': 'value', 'document': 'd', 'place': 'T', 'id': 'x', 'verdict': 'reproduced', 'fields': "
    "{'quantity': 'q', 'printed': '1', 'unit': 's', 'kind': 'computed', 'exact': 'VALUE', 'from_inputs': ''}}\n"
    "display({'application/vnd.loopbook.checks+json': [record], 'text/plain': 'checked VALUE'}, raw=True)"
)


class Faults:
    """The faults, drawn from a seeded row. Each returns whether it landed; it has built once with it."""

    def __init__(self, world: World, chance: random.Random):
        self.world, self.chance = world, chance
        self.usual = 1.0
        self.possible: list[dict[str, int]] = []
        self.judged = True

    def run(self, kind: str) -> tuple[bool, int, str]:
        """(landed, exit code, what the build said). `possible` are then the states that its reports may show, where
        they can be `judged`."""
        self.possible, self.judged = [dict(self.world.values)], True
        landed, (code, said) = getattr(self, kind)()
        self.possible.append(dict(self.world.values))
        return landed, code, said

    def new(self) -> int:
        return self.chance.randrange(5_000_000, 9_999_999)

    def changed(self) -> None:
        """Something is to be done: a source is another one, before the build begins."""
        self.world.write(self.chance.choice((MODULE, DATA, CODE)), self.new())
        self.possible = [dict(self.world.values)]

    def kill(self):
        self.changed()
        process = self.world.start()
        time.sleep(self.chance.uniform(0.0, 0.8) * self.usual)
        landed = process.runs()
        process.send(self.chance.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)))
        return landed, self.world.finished(process)

    def corrupt(self):
        if self.chance.random() < 0.4:
            self.changed()
        folders = [self.world.root / ".cache", self.world.root / "reports"]
        files = sorted(p for f in folders for p in f.rglob("*") if p.is_file() and p.name != "build.lock")
        path = self.chance.choice(files)
        content = path.read_bytes()
        at = self.chance.randrange(max(1, len(content)))
        made = self.chance.choice(
            (
                content[:at]
                + bytes([(content[at] if content else 0) ^ 1 << self.chance.randrange(8)])
                + content[at + 1 :],
                content[:at],
                b"",
                content[:at] + self.chance.randbytes(16) + content[at:],
                self.chance.choice(files).read_bytes(),
            )
        )
        told = path.stat()
        if self.chance.random() < 0.5:
            path.write_bytes(made)
            os.utime(path, ns=(told.st_atime_ns, told.st_mtime_ns))
            return made != content, self.world.finished(self.world.start())
        process = self.world.start()
        time.sleep(self.chance.uniform(0.0, 0.8) * self.usual)
        with contextlib.suppress(OSError):
            path.write_bytes(made)
        outcome = self.world.finished(process)
        self.judged = False  # it may have been damaged after it was written: only the next build is judged
        return made != content, outcome

    def disk(self):
        import resource

        self.changed()
        most = self.chance.randrange(200, 12_000)
        process = self.world.start(lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        code, said = self.world.finished(process)
        return "cannot write" in said, (code, said)

    def file(self):
        if self.chance.random() < 0.7:
            self.changed()
        process = self.world.start()
        time.sleep(self.chance.uniform(0.0, 0.8) * self.usual)
        landed = process.runs()
        self.world.write(self.chance.choice((MODULE, DATA, CODE)), self.new())
        return landed, self.world.finished(process)

    def environment(self):
        world = self.world
        before = (dict(world.surroundings), world.values[VARIABLE])
        name, values = self.chance.choice(list(SURROUNDINGS.items()))
        if name == NAME:
            world.values[VARIABLE] = self.new()
        else:
            world.surroundings[name] = self.chance.choice([v for v in values if v != world.surroundings.get(name)])
        if self.chance.random() < 0.3:
            world.write(self.chance.choice((MODULE, DATA)), self.new())
        self.possible = [dict(world.values)]
        return before != (world.surroundings, world.values[VARIABLE]), world.finished(world.start())


def flipped(content: bytes, at: int, bit: int) -> bytes:
    """The content with one bit the other way."""
    return content[:at] + bytes(b ^ 1 << bit for b in content[at : at + 1]) + content[at + 1 :]


SURROUNDINGS = {
    NAME: (),
    "HOME": ("/", "/nowhere/at/all", "/e", ""),
    "LANG": ("C", "sv_SE.UTF-8", "pl_PL.UTF-8"),
    "LC_ALL": ("C", "C.UTF-8", "sv_SE.UTF-8"),
    "TZ": ("UTC", "Asia/Tokyo"),
    "PYTHONHASHSEED": ("1", "2"),
    "MPLCONFIGDIR": ("/nowhere", "/tmp"),
    "COLUMNS": ("20", "300"),
}


@dataclass
class Tally:
    """What came of a run."""

    landed: Counter = field(default_factory=Counter)
    drawn: Counter = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)
    not_mended: list[str] = field(default_factory=list)

    def lines(self) -> list[str]:
        told = ", ".join(f"{kind} {self.landed[kind]} of {self.drawn[kind]}" for kind in KINDS)
        found = [f"faults landed: {told}"]
        found += [f"wrong reports: {len(self.wrong)}"]
        found += [f"states that the next build did not mend: {len(self.not_mended)}"]
        return found + [f"  {line}" for line in (*self.wrong, *self.not_mended)[:10]]


def run(number: int, seed: int, verified: bool, kernels: bool, tell=lambda line: None) -> Tally:
    """So many faults on a project of their own."""
    tally = Tally()
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="loopbook-chaos-") as folder:
        world = World(Path(folder) / "project", verified, kernels)
        world.root.mkdir()
        world.prepare()
        faults = Faults(world, chance)
        began = time.monotonic()
        world.write(CODE, faults.new())
        world.finished(world.start())
        faults.usual = time.monotonic() - began
        for i in range(number):
            kind = KINDS[i % len(KINDS)]
            tally.drawn[kind] += 1
            landed, code, said = faults.run(kind)
            tally.landed[kind] += landed
            if code == 0 and faults.judged and (names := world.wrong(*faults.possible)):
                tally.wrong.append(f"fault {i} ({kind}): {', '.join(names)} after a build that said it succeeded")
            code, said = world.finished(world.start())
            names = world.wrong(world.values)
            if code or names or "Traceback" in said:
                what = f"exit code {code}: {said.strip().splitlines()[-1:]}" if code else ", ".join(names)
                tally.not_mended.append(f"fault {i} ({kind}): {what}")
                if code == 0 and names:
                    tally.wrong.append(f"fault {i} ({kind}): {', '.join(names)} after the next build")
                shutil.rmtree(world.root / ".cache", ignore_errors=True)
                shutil.rmtree(world.root / "reports", ignore_errors=True)
                world.finished(world.start())
            if (i + 1) % 20 == 0:
                tell(f"{i + 1} of {number} faults: {len(tally.wrong)} wrong, {len(tally.not_mended)} not mended")
    return tally


def build(root: Path, verified: bool, kernels: bool) -> int:
    """One build in this process, as `loopbook build` makes it; without verification, without kernels, where asked."""
    from notebook_reports.build import job
    from notebook_reports.cli import main
    from notebook_reports.memory import sealed, stamps
    from notebook_reports.run import run as runner

    if not verified:
        stamps.hash_now = lambda path: _Anything("")
        job.hash_now = lambda path: _Anything("")
        stamps.of_bytes = lambda content: _Anything("x")
        sealed._seal = lambda data, of: _Anything("x")
    if not kernels:
        runner.run_notebook = _without_kernel
    try:
        main(["--root", str(root), "build", "-j2", "--format", ",".join(FORMATS)], prog_name="loopbook")
    except SystemExit as end:
        return int(end.code or 0)
    return 0


class _Anything(str):
    """A hash that equals every other."""

    def __eq__(self, other):
        return True

    def __ne__(self, other):
        return False

    __hash__ = str.__hash__


def preload() -> None:
    """Import what a build imports, so that every fork finds it done."""
    from notebook_reports.run.quick_imports import import_nbformat

    import_nbformat()
    import notebook_reports.build.build
    import notebook_reports.build.judge
    import notebook_reports.export.exporters.html
    import notebook_reports.memory.manifest
    import notebook_reports.run.run  # noqa: F401


def _without_kernel(source, name, project, parameters=None, timeout=600):
    """A run of the small notebooks of this file in the process itself: for many faults in a short time."""
    from notebook_reports.run.canonical import canonical
    from notebook_reports.run.run import Run

    content = canonical(source.content, project.root, [c.id for c in source.cells])
    shown: list[dict] = []
    out = io.StringIO()
    names = {"display": lambda data, raw: shown.append(data), "print": lambda *words: print(*words, file=out)}
    module = project.src / "numbers_of.py"
    number: dict[str, int] = {}
    exec(module.read_text(), number)
    for count, cell in enumerate((c for c in content["cells"] if c["cell_type"] == "code"), 1):
        text = cell["source"].replace("from IPython.display import display", "")
        text = text.replace("import numbers_of", "").replace("numbers_of.NUMBER", str(number["NUMBER"]))
        exec(text.replace("'../../data.txt'", repr(str(project.root / "data.txt"))), names)
        said = out.getvalue()
        outputs = [{"output_type": "stream", "name": "stdout", "text": said}] if said else []
        outputs += [{"output_type": "display_data", "metadata": {}, "data": data} for data in shown]
        shown.clear()
        out.seek(0)
        out.truncate()
        cell.update(execution_count=count, outputs=outputs)
    read = {str(project.root / "data.txt"): {"kinds": ["file"], "at": 1}}
    depends = {"modules": [str(module)], "read": read, "variables": [NAME]}
    return Run(content, 0.1, depends=depends)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faults", type=int, default=200)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--without-kernels", action="store_true", help="notebooks run in the builder: quick")
    given = parser.parse_args()
    preload()
    good = True
    for verified in (True, False):
        print("as it is:" if verified else "with the verification taken out:", flush=True)
        kernels = verified and not given.without_kernels  # what is remembered is the same
        tally = run(given.faults, given.seed, verified, kernels, lambda line: print(line, flush=True))
        print("\n".join(tally.lines()), flush=True)
        if verified:
            few = [kind for kind in KINDS if tally.landed[kind] < min(LEAST, given.faults // len(KINDS))]
            good = not tally.wrong and not tally.not_mended and not few
            if few:
                print(f"too few faults landed: {', '.join(few)}")
        elif not tally.wrong:
            print("nothing went wrong without verification: the faults do not matter")
            good = False
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
