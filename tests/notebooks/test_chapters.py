"""A chapter teaches first, its ledger stands aside: the countable parts of docs/how-to/chapter.md, a test per rule."""

import ast
import json
import math
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib
import pytest

import loopbook as lb
from notebook_reports.ledger.document import Document
from notebook_reports.project.parameters import read_parameters
from notebook_reports.project.source import Source, read_source

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "notebooks"
LINES, WIDTH, FIGURE_WITHIN, IMPORTS, STEPS, LEDGER_SHARE = 12, 100, 6, 12, 3, 0.15
FORM = "a report on the reader's own record: its first page is the sheet, its parameters are the command's options"
LET_OFF = {  # by chapter: the rules that do not apply to it, with the reason
    "own_process/design": {
        "opening": FORM,
        "a_figure_soon": FORM,
        "one_face": "the study is the face; it holds all that the page shows",
        "short_and_narrow": FORM,
        "numbers_in_sentences_are_computed": "the customary limits of Ms are named in prose",
        "something_to_try": "what to try next is what the page says of the record",
        "goes_on": "it goes on in the reader's plant",
    },
}
CHAPTERS = sorted(
    p.relative_to(FOLDER).with_suffix("").as_posix()
    for p in FOLDER.rglob("[!.]*.ipynb")
    if not {".ipynb_checkpoints", "exercises"} & set(p.parts)
)
NO_MEASURES = re.compile(
    r"`[^`]*`|\]\([^)]*\)|\b(sections?|eqs?\.|equations?|figures?|tables?|chapters?) [\d., and]+", re.IGNORECASE
)
LEDGER = re.compile(r"\.(check|claims?|misprints?|noted|said)\(")
RULES: dict[str, Callable[[Source], Iterator[str]]] = {}


def rule(check: Callable[[Source], Iterator[str]]) -> Callable[[Source], Iterator[str]]:
    RULES[check.__name__] = check
    return check


def code(source: Source):
    return [c for c in source.cells if c.runs]


def prose(source: Source):
    return [c for c in source.cells if c.kind == "markdown"]


def calls(text: str) -> Iterator[ast.Call]:
    yield from (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call))


def called(node: ast.Call) -> str:
    return node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")


def sections(source: Source) -> list[list]:
    """The cells of each section, its first cell the one that opens with the heading; what comes before is the first."""
    found: list[list] = [[]]
    for cell in source.cells:
        if cell.kind == "markdown" and cell.text.startswith("## "):
            found.append([])
        found[-1].append(cell)
    return found


def is_ledger(section: list) -> bool:
    return bool(section) and bool(re.match(r"## (Verdicts|Appendix)\b", section[0].text))


def main_part(source: Source) -> list:
    """The cells outside the sections of verdicts and appendices."""
    return [cell for section in sections(source) if not is_ledger(section) for cell in section]


def sentences(text: str) -> int:
    """How many sentences a paragraph has; formulas and code are words.

    >>> sentences("It is 0.5 s. Is $y = 1.0$? Yes: see eq. 4.17.")
    3
    """
    plain = re.sub(r"\$[^$]*\$|`[^`]*`", "X", text)
    plain = re.sub(r"\b(eq|eqs|fig|no|e\.g|i\.e|vs|cf)\.", r"\1", plain)
    return len(re.findall(r"[.!?](?=\s+[A-Z\"“(*]|\s*$)", plain))


@rule
def opening(source):
    parts = [p.strip() for p in re.split(r"\n\s*\n", source.cells[0].text)]
    if len(parts) < 3 or not parts[0].startswith("# "):
        yield "the first cell has a title, what it is about, and what the reader can do afterwards"
        return
    if (count := sentences(parts[1])) != 3:
        yield f"what the chapter is about takes {count} sentences; three"
    if not parts[2].startswith("**Afterwards you can** "):
        yield "the third paragraph says what the reader can do: **Afterwards you can** …"


@rule
def a_figure_soon(source):
    first = [c.text for c in source.cells[:FIGURE_WITHIN] if c.runs]
    if not any(called(node) in ("figure", "drawing") for text in first for node in calls(text)):
        yield f"a figure or a drawing within the first {FIGURE_WITHIN} cells"


@rule
def one_face(source):
    lines = [n for n in ast.parse(code(source)[0].text).body if isinstance(n, ast.Import | ast.ImportFrom)]
    if len(lines) > IMPORTS:
        yield f"{len(lines)} imports; at most {IMPORTS}"
    offered = {place.replace(":", "."): name for name, place in lb.TABLE.items()}
    if not any(isinstance(n, ast.Import) and n.names[0].asname == "lb" for n in lines):
        yield "import loopbook as lb"
    for node in lines:
        for alias in node.names if isinstance(node, ast.ImportFrom) else ():
            if name := offered.get(f"{node.module}.{alias.name}"):
                yield f"{alias.name} from {node.module}: write lb.{name}"


@rule
def short_and_narrow(source):
    for cell in code(source):
        lines = cell.text.splitlines()
        if (count := len([line for line in lines if line.strip()])) > LINES:
            yield f"cell {cell.number} has {count} lines; at most {LINES}"
        if (widest := max(map(len, lines), default=0)) > WIDTH:
            yield f"cell {cell.number} is {widest} wide; at most {WIDTH}"


@rule
def no_lambda(source):
    for cell in code(source):
        if any(isinstance(node, ast.Lambda) for node in ast.walk(ast.parse(cell.text))):
            yield f"cell {cell.number} has a lambda; show the equations, or name the function"


@rule
def the_ledger_stands_aside(source):
    if not any("open_document(" in c.text for c in code(source)):
        return
    if not any(is_ledger(s) for s in sections(source)):
        yield "a section ## Verdicts at the end holds the checks"
    main = main_part(source)
    serving = [c.number for c in main if c.runs and LEDGER.search(c.text)]
    if len(serving) >= LEDGER_SHARE * len(main):
        yield f"cells {serving} of {len(main)} before the verdicts serve the ledger; fewer than {LEDGER_SHARE:.0%}"
    for section in sections(source):
        if is_ledger(section) and "folded" not in section[0].tags:
            yield f"cell {section[0].number}: verdicts and appendices are folded (tag folded)"


@rule
def margin_notes_lead_to_proofs(source):
    proofs = any(re.search(r"\.misprints?\(", c.text) for c in code(source))
    notes = [c for c in prose(source) if "margin" in c.tags]
    if proofs and not notes:
        yield "a misprint is told where it stands, in a cell tagged margin"
    for cell in notes:
        if len(cell.text.splitlines()) > 1 or not re.search(r"\]\(#(misprint|claim)-[\w.-]+\)", cell.text):
            yield f"cell {cell.number}: a note is one line with a link to its proof, [proof](#misprint-…)"


@rule
def derivations_are_shown(source):
    derives = re.search(r"^(from|import) derivations\b", code(source)[0].text, re.MULTILINE)
    tagged = [s for s in sections(source) if s and "derivation" in s[0].tags]
    if derives and not tagged:
        yield "tag the heading of each derivation that is shown: derivation"
    for section in tagged:
        shown = sum(_equations(node) for c in section if c.runs for node in calls(c.text))
        if shown < STEPS:
            yield f"cell {section[0].number}: {shown} computed equations; a derivation shows at least {STEPS}"


def _equations(node: ast.Call) -> int:
    """The computed equations that a call shows; LaTeX that was typed is none."""
    if called(node) not in ("equation", "eq") or not node.args:
        return 0
    first = node.args[0]
    if called(node) == "equation" and isinstance(first, ast.Constant):
        return 0
    return len(first.elts) if isinstance(first, ast.List) else 1


@rule
def parameters_have_ranges(source):
    parameters = read_parameters(source)
    if not parameters:
        yield "what the chapter computes from stands in a cell of parameters"
    for parameter in parameters.values():
        number = isinstance(parameter.default, int | float) and not isinstance(parameter.default, bool)
        ranged = parameter.range.bounds or parameter.range.choices or "any number" in parameter.comment
        if number and not ranged:
            yield f"{parameter.name} has no range: say in its comment what it may be: [0, 1), > 0, any number"
    for cell in code(source):
        for node in calls(cell.text):
            told = {k.arg for k in node.keywords}
            if called(node) == "open_document" and parameters and not told & {"compare", "given"}:
                yield f"cell {cell.number}: open_document needs given= or compare=, for other values of the parameters"


@rule
def numbers_in_sentences_are_computed(source):
    """A decimal number in plain prose is one that the code starts from; what is computed is said by `prose`."""
    written = {float(n) for c in code(source) for n in re.findall(r"(?<![\w.])\d+\.\d+", c.text)}
    plain = [c for c in main_part(source) if c.kind == "markdown" and not {"margin", "try-it"} & set(c.tags)]
    for cell in plain:
        text = NO_MEASURES.sub(" ", cell.text)
        loose = [n for n in re.findall(r"(?<![\w.])\d+\.\d+", text) if float(n) not in written]
        if loose:
            yield f"cell {cell.number}: {', '.join(loose)}: computed numbers are said by prose(f'…') (remove-input)"


@rule
def something_to_try(source):
    tried = [c for c in prose(source) if "try-it" in c.tags]
    if not tried or not all(c.text.startswith("**Try it.** ") for c in tried):
        yield "a question **Try it.** where a parameter teaches something, in a cell tagged try-it"


@rule
def goes_on(source):
    if not any(s and s[0].text.startswith("## Going on") for s in sections(source)):
        yield "a section ## Going on: the next chapter, later its exercises and its interactive page"


@pytest.mark.parametrize("name", RULES)
@pytest.mark.parametrize("chapter", CHAPTERS)
def test_chapter(chapter, name):
    problems = list(RULES[name](read_source(FOLDER / f"{chapter}.ipynb")))
    if name in LET_OFF.get(chapter, {}):
        assert problems, f"{chapter} keeps {name}: take it out of LET_OFF"
        return
    assert not problems, "\n".join(problems)


def other_value(parameter) -> Any:
    """Another value within the parameter's range; None where there is no telling."""
    if isinstance(parameter.default, bool) or not isinstance(parameter.default, int | float):
        return None
    kind, base = type(parameter.default), parameter.default
    tried = (base + 1, base - 1) if kind is int else (base * 1.25, base * 0.75, base + 0.1)
    return next((kind(x) for x in tried if parameter.range.holds(x) and x != base), None)


def opened(source: Source, changed: dict[str, Any], names: dict[str, Any]) -> list[Document]:
    """The documents that a chapter opens, its parameters changed: what stands before and opens them is run.

    names: what is imported; kept for the next time.
    """
    for cell in code(source):
        if cell.text in names:
            continue
        for statement in ast.parse(cell.text).body:
            exec(compile(ast.Module([statement], []), f"cell {cell.number}", "exec"), names)
            if "open_document(" in ast.unparse(statement):
                return [value for value in names.values() if isinstance(value, Document)]
        names |= changed if "parameters" in cell.tags else {}
        if "import loopbook" in cell.text:
            names[cell.text] = True
    return []


@pytest.mark.parametrize(
    "chapter", [c for c in CHAPTERS if "open_document(" in (FOLDER / f"{c}.ipynb").read_text("utf-8")]
)
def test_with_another_value_of_any_parameter_there_is_no_verdict(chapter):
    matplotlib.use("Agg")
    source, names = read_source(FOLDER / f"{chapter}.ipynb"), {"__name__": "__main__"}
    assert all(document.compare for document in opened(source, {}, names))
    for parameter in read_parameters(source).values():
        if (value := other_value(parameter)) is not None:
            documents = opened(source, {parameter.name: value}, names)
            assert documents and not any(d.compare for d in documents), f"{parameter.name} = {value} is compared"


def test_chapters_are_linted_like_the_rest():
    """No chapter is let off width or lambdas; a sheet's `answer(...)` stands on one line with its wrong methods."""
    lint = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["ruff"]["lint"]
    let_off = {name for name, rules in lint["per-file-ignores"].items() if {"E501", "E731"} & set(rules)}
    assert let_off == {"notebooks/exercises/**"}
    files = [str(FOLDER / f"{name}.ipynb") for name in CHAPTERS]
    told = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--no-cache", "--line-length", str(WIDTH), *files],
        cwd=ROOT, capture_output=True, text=True,
    )  # fmt: skip
    assert told.returncode == 0, told.stdout


def chapter(tmp_path, *cells):
    """A chapter of (kind, text, tags...)."""
    made = []
    for number, (kind, text, *tags) in enumerate(cells, 1):
        extra = {"outputs": [], "execution_count": None} if kind == "code" else {}
        made.append({"cell_type": kind, "id": f"c{number}", "metadata": {"tags": tags}, "source": text, **extra})
    content = {"cells": made, "metadata": {"kernelspec": {"name": "python3"}}, "nbformat": 4, "nbformat_minor": 5}
    (tmp_path / "sample.ipynb").write_text(json.dumps(content))
    return read_source(tmp_path / "sample.ipynb")


GOOD = [
    ("markdown", "# Title\n\nOne thing. Another thing. What follows from both.\n\n**Afterwards you can** do it."),
    ("code", "import loopbook as lb\nfrom derivations.pid import offset\nfrom loopbook.documents import open_document"),
    ("code", "q: float = 0.5  # pole, [0, 1)", "parameters"),
    ("code", "doc = open_document('double-tank', given={'recommended-q': q})\nfigure(fig, 'c', 'a')"),
    ("markdown", "## Steps\n\nFor $q = 0.5$:", "derivation"),
    ("code", "equation([a, b])\nequation(c)"),
    ("markdown", "In print it is $-3$; [proof](#misprint-p).", "margin"),
    ("markdown", "**Try it.** Set `q` to 0.7.", "try-it"),
    ("markdown", "## Going on\n\nThe next chapter."),
    ("markdown", "## Verdicts", "folded"),
    ("code", "doc.misprints({'p': True})"),
    ("code", "doc.summary()"),
]


def test_a_good_chapter_keeps_every_rule(tmp_path):
    source = chapter(tmp_path, *GOOD)
    assert [f"{name}: {p}" for name, check in RULES.items() for p in check(source)] == []


@pytest.mark.parametrize(
    ("name", "at", "cell", "message"),
    [
        ("opening", 0, ("markdown", "# T\n\nOne. Two.\n\n**Afterwards you can** do it."), "takes 2 sentences"),
        ("opening", 0, ("markdown", "# T\n\nOne. Two. Three.\n\nMore."), "Afterwards you can"),
        ("a_figure_soon", 3, ("code", "doc = open_document('x', given={})"), "within the first 6"),
        ("one_face", 1, ("code", "import loopbook as lb\nfrom loopbook.loop.continuous import Loop"), "write lb.Loop"),
        ("one_face", 1, ("code", "import numpy as np"), "import loopbook as lb"),
        ("one_face", 1, ("code", "import loopbook as lb\n" + "import os\n" * 12), "13 imports"),
        ("short_and_narrow", 5, ("code", "x = 1\n" * 13), "13 lines"),
        ("short_and_narrow", 5, ("code", f"x = '{'y' * 100}'"), "106 wide"),
        ("no_lambda", 5, ("code", "f = lambda x: x"), "cell 6 has a lambda"),
        ("the_ledger_stands_aside", 5, ("code", "doc.check('Table 5')\ndoc.said('x')"), None),
        ("the_ledger_stands_aside", 9, ("markdown", "## Verdicts"), "tag folded"),
        ("margin_notes_lead_to_proofs", 6, ("markdown", "In print it is $-3$.", "margin"), "a link to its proof"),
        ("margin_notes_lead_to_proofs", 6, ("markdown", "In print it is $-3$."), "a cell tagged margin"),
        ("derivations_are_shown", 5, ("code", "equation('x = 1')\nequation([a, b])"), "2 computed equations"),
        ("derivations_are_shown", 4, ("markdown", "## Steps"), "tag the heading"),
        ("parameters_have_ranges", 2, ("code", "q: float = 0.5  # pole", "parameters"), "q has no range"),
        ("parameters_have_ranges", 3, ("code", "doc = open_document('x')"), "needs given= or compare="),
        ("numbers_in_sentences_are_computed", 4, ("markdown", "## A\n\nIn 3.66 s.", "derivation"), "3.66"),
        ("something_to_try", 7, ("markdown", "Try it."), "Try it"),
        ("goes_on", 8, ("markdown", "The end."), "Going on"),
    ],
)  # fmt: skip
def test_each_rule_sees_its_fault(tmp_path, name, at, cell, message):
    cells = [*GOOD]
    cells[at] = cell
    if message is None:  # one cell in nine is allowed, two are not
        assert list(RULES[name](chapter(tmp_path, *cells))) == []
        cells[3], message = ("code", "doc = open_document('x', given={})\ndoc.noted('y')"), "cells [4, 6] of 9"
    problems = list(RULES[name](chapter(tmp_path, *cells)))
    assert any(message in p for p in problems), problems


def test_the_constants_are_what_the_guide_says():
    guide = (ROOT / "docs" / "how-to" / "chapter.md").read_text(encoding="utf-8")
    for told in (f"{LINES} lines", f"{WIDTH} characters", f"first {FIGURE_WITHIN} cells", f"{LEDGER_SHARE:.0%}"):
        assert told in guide
    assert math.isclose(LEDGER_SHARE, 0.15)
