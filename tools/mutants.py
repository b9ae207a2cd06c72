"""Break the project on purpose and count what its checks notice.

    python tools/mutants.py [--values 60] [--constants 30] [--seed 1] [--jobs 2]

Two kinds of mutants, each alone in a copy of the project in a temporary folder:

value      the last digit of one printed number is altered; the notebook that checks it is run. Caught by a *check*
           where the build fails and names the entry; otherwise by the *ledger*: its committed file has the true digits.
constant   in a derivation one number, sign or operator is altered; the tests that import the module are run, then the
           notebooks that need it. Caught where one fails; "named" where the output names the module or its function.

The exit code is 0 where at least 98 % were caught. Survivors are listed with their place.
"""

import argparse
import ast
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from queue import Queue

ROOT = Path(__file__).resolve().parent.parent
PARTS = (
    *("src", "notebooks", "tests", "tools", "bench", "reports", "docs"),
    *("pyproject.toml", "environment.txt", "requirements.txt", "Makefile", "README.md"),
)
WANTED = 0.98
SWAPS = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}


@dataclass(frozen=True)
class Mutant:
    """One alteration: in `file`, the characters from `start` to `end` become `text`. what: for people."""

    kind: str
    file: str
    start: int
    end: int
    text: str
    what: str
    names: tuple[str, ...]
    notebook: str = ""


@dataclass(frozen=True)
class Fate:
    """What became of a mutant. by: "check", "test", "notebook", "ledger" or "" where it survived."""

    mutant: Mutant
    by: str
    named: bool


def altered(digits: str) -> str:
    """The same number with its last digit one higher, nine becoming eight.

    >>> altered("6.44"), altered("1.1881e+05"), altered("0.9")
    ('6.45', '1.1882e+05', '0.8')
    """
    mantissa, e, exponent = digits.partition("e")
    last = int(mantissa[-1])  # printed digits end in a digit
    return f"{mantissa[:-1]}{last + 1 if last < 9 else 8}{e}{exponent}"


def value_mutants(root: Path) -> list[Mutant]:
    """One mutant for every printed number that the ledger knows."""
    import csv

    with (root / "reports" / "ledger.csv").open(encoding="utf-8", newline="") as file:
        notebooks = {(row["document"], row["id"]): row["notebook"] for row in csv.DictReader(file)}
    mutants = []
    for path in sorted((root / "src/loopbook/documents").glob("*/printed/*.toml")):
        text = path.read_text(encoding="utf-8")
        document = path.parents[1].name.replace("_", "-")
        entries = [m.start() for m in re.finditer(r'(?m)(?<![\w-])id\s*=\s*"', text)] + [len(text)]
        for start, end in pairwise(entries):
            id = re.match(r'id\s*=\s*"([^"]+)"', text[start:])[1]
            printed = re.search(r'(?<![\w-])printed\s*=\s*"([^"]*)"', text[start:end])
            if printed and (document, id) in notebooks and re.fullmatch(r"[-+]?[\d.]+(e[-+]?\d+)?", printed[1]):
                span = (start + printed.start(1), start + printed.end(1))
                new = altered(printed[1])
                what = f"{document}, {id}: {printed[1]} -> {new}"
                where = path.relative_to(root).as_posix()
                mutants.append(Mutant("value", where, *span, new, what, (id,), notebooks[document, id]))
    return mutants


def _sites(tree: ast.Module) -> Iterator[tuple[ast.AST, str, str]]:
    """(node, function, kind) of everything worth altering inside functions: numbers, signs, operators."""
    for function in (n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)):
        skipped: set[ast.AST] = set()
        for node in ast.walk(function):
            if isinstance(node, ast.Raise | ast.Subscript | ast.JoinedStr | ast.Assert):
                skipped |= set(ast.walk(node))
        for node in ast.walk(function):
            if node in skipped:
                continue
            if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) == "Rational":
                yield node.args[0], function.name, "number"
            elif isinstance(node, ast.BinOp) and type(node.op) in SWAPS:
                yield node, function.name, "operator"
            elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
                yield node, function.name, "sign"


def constant_mutants(root: Path) -> list[Mutant]:
    """Mutants of the derivations: a rule's number, a minus sign, an operator."""
    mutants = []
    for path in sorted((root / "src/derivations").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        starts = [0]
        for line in text.splitlines(keepends=True):
            starts.append(starts[-1] + len(line))

        def at(line: int, column: int, text=text, starts=starts) -> int:
            whole = text[starts[line - 1] : starts[line]].encode()[:column].decode()
            return starts[line - 1] + len(whole)

        for node, function, kind in _sites(ast.parse(text)):
            if kind == "operator":
                a, b = at(node.left.end_lineno, node.left.end_col_offset), at(node.right.lineno, node.right.col_offset)
                between = text[a:b]
                sign = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}[type(node.op)]
                if between.count(sign) != 1 or "**" in between:
                    continue
                new = between.replace(sign, SWAPS[type(node.op)])
            elif kind == "sign":
                a, b = at(node.lineno, node.col_offset), at(node.operand.lineno, node.operand.col_offset)
                new = text[a:b].replace("-", "+", 1)
            else:
                a, b = at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)
                literal = node.value if isinstance(node, ast.Constant) else None
                if not isinstance(literal, int | str):
                    continue
                new = repr(altered(literal)) if isinstance(literal, str) else str(literal + 1)
            line = text[starts[node.lineno - 1] : starts[node.lineno]].strip()
            where = path.relative_to(root).as_posix()
            what = f"{where}:{node.lineno}, {function}: {text[a:b].strip()} -> {new.strip()} in `{line[:90]}`"
            mutants.append(Mutant("constant", where, a, b, new, what, (path.stem, function)))
    return mutants


def importers(root: Path, module: str, folder: str) -> list[str]:
    """Files below `folder` that need `module`, directly or through first-party modules, the nearest first."""
    source = root / "src"
    needs: dict[str, set[str]] = {}
    for path in source.rglob("*.py"):
        name = ".".join(path.relative_to(source).with_suffix("").parts).removesuffix(".__init__")
        needs[name] = _imports(path.read_text(encoding="utf-8"))
    level, distance = {module}, {module: 0}
    while level:
        level = {n for n, used in needs.items() if n not in distance and used & level}
        distance.update(dict.fromkeys(level, max(distance.values()) + 1))
    ranked = []
    for path in sorted((root / folder).rglob("*.py" if folder == "tests" else "*.ipynb")):
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".ipynb":
            cells = json.loads(text)["cells"]
            text = "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code")
        near = [distance[m] for m in _imports(text) if m in distance]
        if near:
            ranked.append((min(near), path.relative_to(root).as_posix()))
    return [name for _, name in sorted(ranked)]


def _imports(text: str) -> set[str]:
    found: set[str] = set()
    try:
        tree = ast.parse(text)
    except SyntaxError:
        return found
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return found


def _run(folder: Path, command: list[str]) -> tuple[int, str]:
    clean = {k: v for k, v in os.environ.items() if k != "PYTEST_ADDOPTS"}
    env = {**clean, "PYTHONPATH": str(folder / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout + done.stderr


def _build(folder: Path, notebook: str) -> tuple[int, str]:
    command = [sys.executable, "-m", "loopbook.cli", "build", notebook, "--format", "ipynb", "-o", str(folder / "out")]
    code, said = _run(folder, [*command, "--force", "-j", "1"])
    failures = folder / ".cache" / "failures.txt"
    return code, said + (failures.read_text(encoding="utf-8") if code and failures.exists() else "")


def fate(folder: Path, mutant: Mutant) -> Fate:
    """Make one mutant in a copy of the project, look whether it is noticed, and unmake it."""
    path = folder / mutant.file
    original = path.read_text(encoding="utf-8")
    path.write_text(original[: mutant.start] + mutant.text + original[mutant.end :], encoding="utf-8")
    try:
        if mutant.kind == "value":
            code, said = _build(folder, mutant.notebook)
            caught = "check" if code == 1 else "ledger"
            return Fate(mutant, caught, caught == "ledger" or any(n in said for n in mutant.names))
        module = mutant.file.removeprefix("src/").removesuffix(".py").replace("/", ".")
        tests = [t for t in importers(folder, module, "tests") if "/notebook_reports/" not in t][:12]
        if tests:
            code, said = _run(folder, [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests])
            if code == 1 or "Error" in said:
                return Fate(mutant, "test", any(n in said for n in mutant.names))
        for notebook in importers(folder, module, "notebooks")[:3]:
            code, said = _build(folder, notebook.removeprefix("notebooks/").removesuffix(".ipynb"))
            if code == 1:
                return Fate(mutant, "notebook", any(n in said for n in mutant.names))
        return Fate(mutant, "", False)
    finally:
        path.write_text(original, encoding="utf-8")


def sample(mutants: list[Mutant], number: int, seed: int) -> list[Mutant]:
    """A seeded choice, the same on every run over the same files."""
    return random.Random(seed).sample(mutants, min(number, len(mutants)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--values", type=int, default=60)
    parser.add_argument("--constants", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    wanted = parser.parse_args()
    chosen = sample(value_mutants(ROOT), wanted.values, wanted.seed)
    chosen += sample(constant_mutants(ROOT), wanted.constants, wanted.seed)
    if not chosen:
        print("no mutants: run make first, the ledger is empty")
        return 2
    with tempfile.TemporaryDirectory(prefix="mutants") as temporary:
        copies: Queue[Path] = Queue()
        for i in range(wanted.jobs):
            copy = Path(temporary) / str(i)
            copy.mkdir()
            for part in PARTS:
                source = ROOT / part
                if source.is_dir():
                    shutil.copytree(source, copy / part, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
                elif source.exists():
                    shutil.copy(source, copy / part)
            copies.put(copy)

        def work(mutant: Mutant) -> Fate:
            copy = copies.get()
            try:
                found = fate(copy, mutant)
            finally:
                copies.put(copy)
            print(f"{found.by or 'SURVIVED':9} {mutant.what}", flush=True)
            return found

        with ThreadPoolExecutor(wanted.jobs) as pool:
            fates = list(pool.map(work, chosen))
    return report(fates)


def report(fates: list[Fate]) -> int:
    """Print the counts and the survivors; 0 where enough were caught."""
    caught = [f for f in fates if f.by]
    print()
    for kind in ("value", "constant"):
        these = [f for f in fates if f.mutant.kind == kind]
        ways = ", ".join(f"{sum(f.by == by for f in these)} by {by}" for by in ("check", "test", "notebook", "ledger"))
        named = sum(f.named for f in these if f.by)
        print(f"{kind:9} {sum(bool(f.by) for f in these)} of {len(these)} caught ({ways}); {named} named the place")
    for f in fates:
        if not f.by:
            print(f"survived  {f.mutant.what}")
    print(f"caught {len(caught)} of {len(fates)}: {100 * len(caught) / len(fates):.1f} %")
    return 0 if len(caught) >= WANTED * len(fates) else 1


if __name__ == "__main__":
    raise SystemExit(main())
