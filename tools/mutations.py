"""What can be altered: printed digits, words of statements, constants of derivations, literals of notebooks."""

import ast
import csv
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

SWAPS = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}
SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
DIGITS = r"[-+]?[\d.]+(e[-+]?\d+)?"
OPPOSITES = (
    *(("larger", "smaller"), ("higher", "lower"), ("longer", "shorter"), ("faster", "slower"), ("better", "worse")),
    *(("more", "less"), ("increases", "decreases"), ("rises", "falls"), ("grows", "shrinks"), ("raises", "lowers")),
    *(
        ("above", "below"),
        ("improves", "worsens"),
        ("increase", "decrease"),
        ("before", "after"),
        ("largest", "smallest"),
    ),
    *(("high", "low"), ("long", "short"), ("most", "least"), ("over", "under"), ("positive", "negative"), (">", "<")),
    *(("fast", "slow"), ("large", "small"), ("much", "little"), ("raise", "lower"), ("maximum", "minimum")),
    *(("amplifies", "attenuates"), ("shortens", "lengthens"), ("helps", "harms"), ("improve", "harm")),
    *(("nearer", "farther"), ("two", "three"), ("half", "twice"), ("tenth", "ninth")),
)
TURNED = {"+": "-", "-": "+", "*": "/", "/": "*"}
WORDS = {a: b for pair in OPPOSITES for a, b in (pair, pair[::-1])}


@dataclass(frozen=True)
class Mutant:
    """One alteration: in `file`, the characters from `start` to `end` become `text`. what: for people.

    names: what a failure must hold to name the place. notebooks: those that may notice it, the nearest first; none for
    words that nothing reads. undetermined: True for a printed input, which may be determined by nothing.
    """

    kind: str
    file: str
    start: int
    end: int
    text: str
    what: str
    names: tuple[str, ...]
    notebooks: tuple[str, ...] = ()
    undetermined: bool = False
    module: str = ""


def altered(digits: str) -> str:
    """The same number with its last digit one higher, nine becoming eight.

    >>> altered("6.44"), altered("1.1881e+05"), altered("0.9")
    ('6.45', '1.1882e+05', '0.8')
    """
    mantissa, e, exponent = digits.partition("e")
    last = int(mantissa[-1])  # printed digits end in a digit
    return f"{mantissa[:-1]}{last + 1 if last < 9 else 8}{e}{exponent}"


def _rows(root: Path, name: str) -> list[dict[str, str]]:
    with (root / "reports" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _entries(root: Path, table: str) -> Iterator[tuple[str, Path, str, str, int, int]]:
    """(document, file, text, id, start, end) of each entry of one table."""
    for path in sorted((root / "src/loopbook/documents").glob("*/printed/*.toml")):
        text = path.read_text(encoding="utf-8")
        heads = [
            (m.start(), m[1]) for m in re.finditer(r"(?m)^(?:\[\[)?(value|claim|misprint)(?:\]\]|\s*=\s*\[)", text)
        ]
        starts = [m.start() for m in re.finditer(r'(?m)(?<![\w-])id\s*=\s*"', text)]
        for start in starts:
            if [kind for at, kind in heads if at < start][-1] != table:
                continue
            line = text.rfind("\n", 0, start) + 1
            inline = text[line:start].lstrip().startswith("{")
            stop = text.index("\n", start) if inline else min([at for at, _ in heads if at > start] or [len(text)])
            found = re.match(r'id\s*=\s*"([^"]+)"', text[start:])
            assert found
            yield (
                path.parents[1].name.replace("_", "-"),
                path,
                text,
                found[1],
                line if inline else start,
                min(stop, len(text)),
            )


def _sources(root: Path) -> dict[str, str]:
    """The code of each notebook on documents, by its id."""
    made = {}
    for path in sorted((root / "notebooks").glob("*/*.ipynb")):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code")
        if "open_document(" in code:
            made[path.relative_to(root / "notebooks").with_suffix("").as_posix()] = code
    return made


def value_mutants(root: Path) -> Iterator[Mutant]:
    """One mutant for every printed number that the ledger knows."""
    rows = {(r["document"], r["id"]): r for r in _rows(root, "ledger.csv")}
    sources = _sources(root)
    repeats: dict[tuple[str, str], list[str]] = {}
    entries = list(_entries(root, "value"))
    for document, _, text, id, start, end in entries:
        if same := re.search(r'same_as\s*=\s*"([^"]+)"', text[start:end]):
            repeats.setdefault((document, same[1]), []).append(rows[document, id]["notebook"])
    for document, path, text, id, start, end in entries:
        printed = re.search(r'(?<![\w-])printed\s*=\s*"([^"]*)"', text[start:end])
        row = rows.get((document, id))
        if not (printed and row and re.fullmatch(DIGITS, printed[1])):
            continue
        readers = [n for n, code in sources.items() if f'"{id}"' in code or f'given("{row["place"]}")' in code]
        notebooks = tuple(dict.fromkeys([row["notebook"], *repeats.get((document, id), []), *readers]))
        span, new = (start + printed.start(1), start + printed.end(1)), altered(printed[1])
        what = f"{document}, {row['place']}, {id}: {printed[1]} -> {new}"
        where = path.relative_to(root).as_posix()
        yield Mutant("value", where, *span, new, what, (id,), notebooks, row["verdict"] == "given")


def claim_mutants(root: Path) -> Iterator[Mutant]:
    """Each number, direction word and comparison of each statement, in fields and words; each operator of a formula."""
    rows = {(r["document"], r["id"]): r for r in _rows(root, "claims.csv")}
    for document, path, text, id, start, end in _entries(root, "claim"):
        if (document, id) not in rows:
            continue  # not in the ledger yet: build first
        entry, row = text[start:end], rows[document, id]
        for value in re.finditer(r'(?<![\w-])(\w+)\s*=\s*"((?:[^"\\]|\\.)*)"', entry):
            key = value[1]
            if key in ("id", "place"):
                continue
            for a, b, new in _words(value[2]):
                formula = any(x <= a < y for x, y in _backticks(value[2]))
                read = key != "says" or formula
                span = (start + value.start(2) + a, start + value.start(2) + b)
                what = f"{document}, {row['place']}, {id}, {key}: {text[slice(*span)]} -> {new} in `{value[2][:70]}`"
                where = path.relative_to(root).as_posix()
                notebooks = (row["notebook"],) if read else ()
                yield Mutant("claim", where, *span, new, what, (id,), notebooks)


def _formulas(text: str) -> list[tuple[int, int]]:
    """What is set as mathematics: in backticks, which tests read, and between dollars, which nothing reads."""
    return _backticks(text) + [m.span() for m in re.finditer(r"\$[^$]*\$", text)]


def _backticks(text: str) -> list[tuple[int, int]]:
    return [m.span() for m in re.finditer(r"`[^`]*`", text)]


def _words(text: str) -> Iterator[tuple[int, int, str]]:
    """(start, end, replacement) of each number, direction and comparison; no exponents, indices or labels."""
    if text in ("up", "down"):
        yield 0, len(text), "down" if text == "up" else "up"
        return
    names = (
        r"(?:[Ff]igures?|[Ss]ections?|[Cc]hapters?|[Tt]ables?|eq\.|equations?)"
        r"\s*[\d.]+(?:\s*(?:and|to|,)\s*[\d.]+)*"
    )
    skipped = [
        m.span() for m in re.finditer(rf"{names}|\\[a-zA-Z]+|\{{\w+[^}}]*\}}|_\{{[^}}]*\}}|_\w+|\^\{{?-?\d+\}}?", text)
    ]
    for m in re.finditer(r"(?<![\w.])\d+(?:\.\d+)?(?![\w.]*\w)|\b[a-z]+\b|[<>](?!=)", text):
        if any(a <= m.start() < b for a, b in skipped):
            continue
        if m[0][0].isdigit():
            yield m.start(), m.end(), altered(m[0])
        elif m[0] in WORDS:
            yield m.start(), m.end(), WORDS[m[0]]
    for a, b in _formulas(text):
        for m in re.finditer(r"(?<=[^\s*/(])\s*([-+/]|(?<!\*)\*(?!\*))\s*(?=[^\s*/])", text[a:b]):
            at = a + m.start(1)
            if not any(x <= at < y for x, y in skipped):
                yield at, at + 1, TURNED[m[1]]


def _sites(tree: ast.Module) -> Iterator[tuple[ast.AST, str, str]]:
    """(node, function, kind) of everything worth altering: numbers, signs, operators; a module's constants too."""
    for node in (n for top in tree.body if not isinstance(top, ast.FunctionDef | ast.ClassDef) for n in ast.walk(top)):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Rational":
            yield node.args[0], "constants", "number"
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


def _positions(text: str) -> list[int]:
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    return starts


def _at(text: str, starts: list[int], line: int, column: int) -> int:
    return starts[line - 1] + len(text[starts[line - 1] : starts[line]].encode()[:column].decode())


def derivation_mutants(root: Path) -> Iterator[Mutant]:
    """A rule's number, a minus sign, an operator of the derivations."""
    for path in sorted((root / "src/derivations").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        starts = _positions(text)
        where = path.relative_to(root).as_posix()
        module = where.removeprefix("src/").removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        near: tuple[str, ...] | None = None
        for node, function, kind in _sites(ast.parse(text)):
            span = _span(text, starts, node, kind)
            if span is None:
                continue
            if near is None:
                found = importers(root, module, "notebooks")
                near = tuple(n.removeprefix("notebooks/").removesuffix(".ipynb") for n in found if "own_" not in n)[:3]
            a, b, new = span
            line = text[starts[node.lineno - 1] : starts[node.lineno]].strip()  # type: ignore[attr-defined]
            what = f"{where}:{node.lineno}, {function}: {text[a:b].strip()} -> {new.strip()} in `{line[:90]}`"  # type: ignore[attr-defined]
            yield Mutant("derivation", where, a, b, new, what, (f"{path.stem}.py", function), near, module=module)


def _span(text: str, starts: list[int], node: ast.AST, kind: str) -> tuple[int, int, str] | None:
    """(start, end, replacement) of a site, or None where it cannot be altered in place."""
    at = lambda line, column: _at(text, starts, line, column)  # noqa: E731
    if isinstance(node, ast.BinOp):
        a, b = at(node.left.end_lineno, node.left.end_col_offset), at(node.right.lineno, node.right.col_offset)
        between, sign = text[a:b], SIGNS[type(node.op)]
        if between.count(sign) != 1 or "**" in between:
            return None
        return a, b, between.replace(sign, SWAPS[type(node.op)])
    if isinstance(node, ast.UnaryOp):
        a, b = at(node.lineno, node.col_offset), at(node.operand.lineno, node.operand.col_offset)
        return a, b, text[a:b].replace("-", "+", 1)
    if isinstance(node, ast.Constant) and isinstance(node.value, int | str):
        a, b = at(node.lineno, node.col_offset), at(node.end_lineno, node.end_col_offset)
        return a, b, repr(altered(node.value)) if isinstance(node.value, str) else str(node.value + 1)
    return None


def input_mutants(root: Path) -> Iterator[Mutant]:
    """Each numeric literal that a computation starts from, in the cells of a notebook that check something.

    Left out is what bounds or shows: the limit of a comparison, a tolerance, the digits of a number on the page, what
    stands in figures and tables.
    """
    for path in sorted((root / "notebooks").glob("*/*.ipynb")):
        content = json.loads(path.read_text(encoding="utf-8"))
        id = path.relative_to(root / "notebooks").with_suffix("").as_posix()
        whole = path.read_text(encoding="utf-8")
        for cell in content["cells"]:
            text = "".join(cell["source"])
            if cell["cell_type"] != "code" or not re.search(r"\.(check|claims?|misprints?)\(", text):
                continue
            for node in _starting_points(ast.parse(text)):
                if isinstance(node, ast.Constant) and type(node.value) in (int, float):
                    line = cell["source"][node.lineno - 1]
                    raw = line.encode()
                    new = raw[: node.col_offset] + str(node.value + 1).encode() + raw[node.end_col_offset :]
                    old_json, new_json = (json.dumps(x, ensure_ascii=False) for x in (line, new.decode()))
                    if whole.count(old_json) == 1:
                        a = whole.index(old_json)
                        what = f"{id}, {cell['id']}: {node.value} -> {node.value + 1} in `{line.strip()[:80]}`"
                        where = path.relative_to(root).as_posix()
                        yield Mutant("input", where, a, a + len(old_json), new_json, what, (id,), (id,))


SHOWING = ("number", "round", "figure", "curves", "runs", "Table", "join", "shown", "told")
BOUNDING = ("rel_tol", "abs_tol", "rtol", "atol", "tol", "levels", "caption")


def _starting_points(tree: ast.Module) -> Iterator[ast.AST]:
    """The nodes of a cell without those that only bound or show a result."""
    skipped: set[ast.AST] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            sides = (node.left, *node.comparators)
            skipped |= {
                x for side in sides for x in ast.walk(side) if not any(isinstance(y, ast.Call) for y in ast.walk(side))
            }
        elif isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) in SHOWING:
            skipped |= {x for part in (*node.args[1:], *node.keywords) for x in ast.walk(part)}
            if node.func.__class__ is ast.Name and node.func.id in ("figure", "Table"):
                skipped |= set(ast.walk(node))
        elif isinstance(node, ast.keyword) and node.arg in BOUNDING:
            skipped |= set(ast.walk(node.value))
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "agrees":
            skipped |= {
                x for part in node.args[1:] if isinstance(part, ast.Constant | ast.UnaryOp) for x in ast.walk(part)
            }
    yield from (node for node in ast.walk(tree) if node not in skipped)


def needs_of(root: Path) -> dict[str, frozenset[str]]:
    """What each module of the sources imports."""
    source = root / "src"
    found = {}
    for path in source.rglob("*.py"):
        name = ".".join(path.relative_to(source).with_suffix("").parts).removesuffix(".__init__")
        found[name] = _imports(path.read_text(encoding="utf-8"))
    return found


def importers(root: Path, module: str, folder: str) -> list[str]:
    """Files below `folder` that need `module`, directly or through first-party modules, the nearest first."""
    needs = needs_of(root)
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


@cache
def _imports(text: str) -> frozenset[str]:
    found: set[str] = set()
    try:
        tree = ast.parse(text)
    except SyntaxError:
        return frozenset()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(found)
