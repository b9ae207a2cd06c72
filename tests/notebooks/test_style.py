"""Notebooks are written to be read, and clean in git: the rules that a program can hold, one test per rule."""

import ast
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from clear_outputs import clear, unclean

from notebook_reports.project.parameters import ParameterError, read_parameters
from notebook_reports.project.source import Source, read_source

FOLDER = Path(__file__).parents[2] / "notebooks"
NOTEBOOKS = sorted(p for p in FOLDER.rglob("*.ipynb") if not {".ipynb_checkpoints", "exercises"} & set(p.parts))
LINES_OF_A_CELL = 12
LINES_OF_A_FUNCTION = 5
WORDS_PER_LINE = 5
RULES: dict[str, Callable[[Source], Iterator[str]]] = {}


def rule(check: Callable[[Source], Iterator[str]]) -> Callable[[Source], Iterator[str]]:
    RULES[check.__name__] = check
    return check


def code(source: Source):
    return [c for c in source.cells if c.runs]


def tree(text: str) -> ast.Module:
    """The syntax of a cell; lines for IPython count as none."""
    return ast.parse("\n".join("pass" if re.match(r"\s*[%!?]", line) else line for line in text.splitlines()))


def written(text: str) -> list[str]:
    """The lines of code that are neither empty nor comments."""
    return [line for line in text.splitlines() if line.strip() and not line.strip().startswith("#")]


@rule
def clean_in_git(source):
    yield from unclean(source.content)
    if source.content["metadata"].get("kernelspec", {}).get("name") != "python3":
        yield "the kernel must be called python3"


@rule
def stable_ids(source):
    ids = [c.get("id", "") for c in source.content["cells"]]
    for id in ids:
        if not re.fullmatch(r"[A-Za-z0-9_.-]{1,64}", id) or re.fullmatch(r"[0-9a-f]{8}(-[0-9a-f-]+)?", id):
            yield f"id {id!r}: give the cell a name of its own"
    if len(set(ids)) < len(ids):
        yield f"ids stand twice: {sorted({i for i in ids if ids.count(i) > 1})}"


@rule
def one_title_at_the_top(source):
    first = source.cells[0]
    if first.kind != "markdown" or not re.match(r"# \S", first.text):
        yield "the first cell must open with the title, `# Title`"
    elif len(first.text.splitlines()) < 2 and "code-only" not in source.cells[1].tags:  # that one is the opening
        yield "the first cell needs an opening paragraph under the title"
    titles = [c.number for c in source.cells if c.kind == "markdown" and re.search(r"^# \S", c.text, re.MULTILINE)]
    if len(titles) > 1:
        yield f"titles of level one in cells {titles}; use ## for sections"


@rule
def imports_first(source):
    for index, cell in enumerate(code(source)):
        imports = any(isinstance(n, ast.Import | ast.ImportFrom) for n in ast.walk(tree(cell.text)))
        if imports and index and "detail" not in cell.tags:  # a page without the details does not load what they need
            yield f"cell {cell.number} imports; all imports go to the first code cell"


@rule
def short_functions(source):
    for cell in code(source):
        for node in ast.walk(tree(cell.text)):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                lines = node.end_lineno - node.lineno + 1
                if isinstance(node, ast.ClassDef) or lines > LINES_OF_A_FUNCTION:
                    yield f"cell {cell.number}: {node.name} has {lines} lines; it belongs in src/"


@rule
def short_cells(source):
    for index, cell in enumerate(code(source)):
        lines = len(written(cell.text))
        if index and "parameters" not in cell.tags and lines > LINES_OF_A_CELL:
            yield f"cell {cell.number} has {lines} lines of code; at most {LINES_OF_A_CELL}"


@rule
def prose_between(source):
    """What is folded away is not read in a row; a cell that only says a sentence is prose."""
    folded = next((c.number for c in source.cells if "folded" in c.tags), len(source.cells) + 1)
    read = [c for c in source.cells if c.number < folded]
    said = [c for c in read if c.kind == "markdown" or "remove-input" in c.tags]
    words = sum(len(c.text.split()) for c in said)
    lines = sum(len(written(c.text)) for c in [c for c in read if c.runs][1:] if c not in said)
    if lines and words / lines < WORDS_PER_LINE:
        yield f"{words / lines:.1f} words of prose per line of code; at least {WORDS_PER_LINE}"


@rule
def ends_with_the_summary(source):
    checks = any("Document(" in c.text for c in code(source))
    if checks and not re.search(r"\.summary\(\)\s*$", source.cells[-1].text):
        yield "the last cell must show the summary of the checks: doc.summary()"


@rule
def figures_with_caption(source):
    for cell in code(source):
        if re.search(r"plt\.show\(|\bfig\.show\(", cell.text):
            yield f"cell {cell.number}: show a figure with figure(fig, caption, alt)"
        made = len(re.findall(r"plt\.(?:subplots|figure)\(", cell.text))
        if (
            made
            and "figure(" not in re.sub(r"plt\.figure\(", "", cell.text)
            and cell.text.rstrip().endswith(("fig", ";"))
        ):
            yield f"cell {cell.number}: a figure without caption and alternative text"


@rule
def no_bare_prints(source):
    for cell in code(source):
        if re.search(r"^\s*print\(", cell.text, re.MULTILINE):
            yield f"cell {cell.number} prints; show a Table, an equation or a sentence"


def evidence_of(call: ast.Call) -> Iterator[tuple[str, ast.expr]]:
    """(claim, evidence) of a call of `claim` or `claims`, as far as they stand in it."""
    name = getattr(call.func, "attr", "")
    if name == "claims" and call.args and isinstance(call.args[0], ast.Dict):
        for key, value in zip(call.args[0].keys, call.args[0].values, strict=True):
            if key is not None and isinstance(value, ast.Tuple) and len(value.elts) == 2:
                yield ast.unparse(key), value.elts[1]
    if name == "claim":
        named = [k.value for k in call.keywords if k.arg == "evidence"]
        yield ast.unparse(call.args[0]), (call.args[2:] or named)[0]


@rule
def evidence_is_computed(source):
    for cell in code(source):
        for node in ast.walk(tree(cell.text)):
            for claim, evidence in evidence_of(node) if isinstance(node, ast.Call) else ():
                if isinstance(evidence, ast.Constant):
                    yield f"cell {cell.number}: the evidence of {claim} says the same whatever the outcome"


@rule
def honest_parameters(source):
    try:
        parameters = read_parameters(source)
    except ParameterError as error:
        yield str(error)
        return
    if parameters and "parameters" not in code(source)[1].tags:
        yield "the parameters belong into the second code cell"
    for cell in source.tagged("parameters"):
        for node in tree(cell.text).body:
            if isinstance(node, ast.Assign):
                yield f"cell {cell.number}: `{ast.unparse(node)}` needs its type, as in `q: float = 0.5  # unit`"
    for parameter in parameters.values():
        if not parameter.comment:
            yield f"{parameter.name} needs a comment: its meaning, unit and range"


def test_there_are_notebooks():
    assert NOTEBOOKS, f"no notebook in {FOLDER}"


@pytest.mark.parametrize("name", RULES)
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.relative_to(FOLDER).with_suffix("").as_posix())
def test_style(path, name):
    problems = list(RULES[name](read_source(path)))
    assert not problems, "\n".join(problems)


def sample(tmp_path, *cells):
    """A notebook of (text, tags...) with names for ids; text that starts with a hash and a blank is prose."""
    made = []
    for number, (text, *tags) in enumerate(cells, 1):
        kind = "markdown" if text.startswith(("# ", "> ")) else "code"
        extra = {"outputs": [], "execution_count": None} if kind == "code" else {}
        metadata = {"tags": tags} if tags else {}
        made.append({"cell_type": kind, "id": f"cell-{number}", "metadata": metadata, "source": text, **extra})
    content = {"cells": made, "metadata": {"kernelspec": {"name": "python3"}}, "nbformat": 4, "nbformat_minor": 5}
    path = tmp_path / "sample.ipynb"
    path.write_text(json.dumps(content))
    return read_source(path)


GOOD = [
    ("# Title\n\nAn opening paragraph that says what is shown here and why it matters to a reader of the notebook.",),
    ("import math\nfrom notebook_reports.ledger.document import Document",),
    ("q: float = 0.5  # pole, [0, 1)", "parameters"),
    ("> The claim, in a sentence or two, with enough words to carry the few lines of code below it.",),
    ("doc = Document('double-tank')\ndoc.check('Table 5')",),
    ("doc.summary()",),
]


def test_a_good_notebook_passes_every_rule(tmp_path):
    source = sample(tmp_path, *GOOD)
    assert [p for check in RULES.values() for p in check(source)] == []


@pytest.mark.parametrize(
    ("name", "at", "cell", "message"),
    [
        ("one_title_at_the_top", 0, ("> no title",), "must open with the title"),
        ("one_title_at_the_top", 0, ("# Only a title",), "opening paragraph"),
        ("one_title_at_the_top", 3, ("# Another",), "titles of level one in cells [1, 4]"),
        ("imports_first", 4, ("import os",), "cell 5 imports"),
        ("short_functions", 4, ("def f():\n" + "    x = 1\n" * 5,), "f has 6 lines"),
        ("short_cells", 4, ("x = 1\n" * 13,), "has 13 lines"),
        ("prose_between", 4, ("x = 1\n" * 12,), "words of prose per line"),
        ("ends_with_the_summary", 5, ("1",), "summary of the checks"),
        ("figures_with_caption", 4, ("fig, ax = plt.subplots()\nplt.show()",), "figure(fig, caption, alt)"),
        ("no_bare_prints", 4, ("print(1)",), "cell 5 prints"),
        ("honest_parameters", 2, ("q: float = 0.5", "parameters"), "q needs a comment"),
        ("honest_parameters", 2, ("q = 0.5  # pole", "parameters"), "needs its type"),
        ("honest_parameters", 2, ("q: float = 1 / 2  # pole", "parameters"), "is derived"),
    ],
)
def test_each_rule_sees_its_fault(tmp_path, name, at, cell, message):
    cells = [*GOOD]
    cells[at] = cell
    problems = list(RULES[name](sample(tmp_path, *cells)))
    assert any(message in p for p in problems), problems


def test_outputs_and_random_ids_are_seen(tmp_path):
    source = sample(tmp_path, *GOOD)
    before = json.dumps(source.content)
    source.content["cells"][1]["execution_count"] = 3
    source.content["cells"][2]["id"] = "1a2b3c4d"
    source.content["cells"][0]["metadata"]["collapsed"] = True
    source.content["metadata"]["language_info"] = {"version": "3.13"}
    found = list(RULES["clean_in_git"](source))
    wanted = ("cell 1 has the metadata", "cell 2 has outputs", "language_info names")
    assert len(found) == len(wanted) and all(line.startswith(start) for line, start in zip(found, wanted, strict=True))
    assert "1a2b3c4d" in next(iter(RULES["stable_ids"](source)))
    clear(source.content)
    source.content["cells"][2]["id"] = "cell-3"
    assert list(unclean(source.content)) == []
    source.content["metadata"].pop("language_info")
    assert json.dumps(source.content) == before, "nothing else is changed"
