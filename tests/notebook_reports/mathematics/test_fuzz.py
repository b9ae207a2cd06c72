"""Whatever comes in: the result compiles, or the error is a MathError with a position in the formula."""

import xml.etree.ElementTree as ElementTree

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from notebook_reports.mathematics import MathError, latex_to_mathml, latex_to_text, latex_to_typst
from notebook_reports.mathematics.commands import COMMANDS, INFIX
from notebook_reports.mathematics.environments import LAYOUTS
from notebook_reports.mathematics.symbols import DELIMITERS, GREEK, SYMBOLS

NAMES = sorted(
    {
        *COMMANDS,
        *INFIX,
        *SYMBOLS,
        *GREEK,
        "left",
        "right",
        "middle",
        "tag",
        "limits",
        "end",
        "hline",
        "cr",
        "tabularnewline",
    }
)
ENVIRONMENTS = sorted({*LAYOUTS, "equation", "pmatrix*"})
PUNCTUATION = list("{}{}{}[]()^_&'~%$#\\,;:.!?|/<>=+-*\"`@ \n09aZé°∑→α∞½ł\u0301\x00😀")


def examples(count: int) -> settings:
    """The same examples in every run; each is a list of formulas that go through the compiler in one document."""
    slow = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture, HealthCheck.data_too_large]
    return settings(max_examples=count, deadline=None, derandomize=True, suppress_health_check=slow)


commands = st.sampled_from(NAMES).map(lambda name: "\\" + name + (" " if name.isalpha() else ""))
environments = st.sampled_from(ENVIRONMENTS)
soup = st.lists(
    st.one_of(
        commands,
        st.sampled_from(PUNCTUATION),
        environments.map(lambda name: f"\\begin{{{name}}}"),
        environments.map(lambda name: f"\\end{{{name}}}"),
        st.sampled_from(["{2}", "{lc|r}", "[3]", "[2pt]", "1.5", "{,}", "3em", "red", "\\\\"]),
    ),
    max_size=20,
).map("".join)
delimiters = st.sampled_from(sorted(DELIMITERS))
COLUMNS = {"array": "{c|c}", "subarray": "{c}", "alignat": "{1}", "alignat*": "{1}", "alignedat": "{1}"}


ARGUMENTS = sorted(name for name in COMMANDS if name[0].isalpha())
GRIDS = [name for name in ENVIRONMENTS if name not in ("subarray", "gathered", "gather", "gather*", "cases", "dcases")]
ATOMS = list("abxyz0123456789+-=<>,;:.()[]|/!'") + ["\\text{ä ö, #$x$}"]


@st.composite
def valid(draw, depth: int = 3) -> str:
    """A formula built from smaller ones, more often valid than not."""
    kind = draw(st.integers(0, 7)) if depth else 0
    if kind <= 1:
        return draw(st.one_of(commands, st.sampled_from(ATOMS)))
    a, b, c = (draw(valid(depth=depth - 1)) for _ in range(3))
    if kind == 2:
        name = draw(st.sampled_from(["frac", "binom", "overset", "underset", "tfrac"]))
        return f"\\{name}{{{a}}}{{{b}}}"
    if kind == 3:
        return f"{{{a}}}_{{{b}}}^{{{c}}}"
    if kind == 4:
        return f"\\left{draw(delimiters)} {a} \\middle| {b} \\right{draw(delimiters)} "
    if kind == 5:
        return f"\\{draw(st.sampled_from(ARGUMENTS))}{{{a}}}"
    if kind == 6:
        name = draw(st.sampled_from(GRIDS))
        return f"\\begin{{{name}}}{COLUMNS.get(name, '')} {a} & {b} \\\\ {c} \\end{{{name}}}"
    return f"{a} {b} {c}"


def convert(latex: str) -> str | None:
    """Typst code, or None for a MathError; all three emitters agree on which of the two it is."""
    try:
        code = latex_to_typst(latex, True)
    except MathError as error:
        assert 0 <= error.position <= len(latex)
        assert error.latex == latex
        assert error.reason and "\n" not in error.reason
        for emit in (latex_to_mathml, latex_to_text):
            with pytest.raises(MathError):
                emit(latex)
        return None
    ElementTree.fromstring(latex_to_mathml(latex))
    assert isinstance(latex_to_text(latex), str)
    return code


def check(formulas: list[str], refused, glyphs: bool = True) -> None:
    codes = [(latex, convert(latex)) for latex in formulas]
    assert refused([(latex, code) for latex, code in codes if code is not None], glyphs) is None


@examples(30)
@given(st.lists(soup, min_size=10, max_size=40))
@example(["", " ", "%", "\\", "{", "}", "^", "_", "'", "&", "\\\\", "\\end", "\\left", "\\begin{", "\\text{$", "\\tag"])
def test_token_soup(refused, formulas):
    check(formulas, refused)


@examples(20)
@given(st.lists(valid(), min_size=10, max_size=30))
def test_random_formulas(refused, formulas):
    check(formulas, refused)


@examples(20)
@given(st.lists(st.text(max_size=30), min_size=5, max_size=30))
def test_any_text(refused, formulas):
    check([*formulas, *(f"\\text{{{text}}}" for text in formulas)], refused, glyphs=False)


@examples(20)
@given(data=st.data())
def test_damaged_formulas(refused, report_formulas, data):
    """A character taken out of a good formula, or a token put in."""
    damaged = []
    for latex in data.draw(st.lists(st.sampled_from(report_formulas), min_size=5, max_size=20)):
        i = data.draw(st.integers(0, len(latex) - 1))
        put = data.draw(st.one_of(st.just(""), commands, st.sampled_from(PUNCTUATION)))
        damaged.append(latex[:i] + put + latex[i + (not put) :])
    check(damaged, refused)


@pytest.mark.parametrize("opening", ["{", "\\left(", "\\frac{", "x^{", "\\sqrt{", "\\text{$", "\\begin{matrix}", "x_"])
def test_deep_nesting_is_an_error_and_no_crash(opening):
    with pytest.raises(MathError):
        latex_to_typst(opening * 5000)


@pytest.mark.parametrize("depth", [10, 25, 36])
def test_reasonable_nesting_compiles(depth, refused):
    forms = ["\\frac{1}{1+%s}", "\\sqrt{%s}", "x^{%s}", "\\left(%s\\right)", "\\begin{pmatrix}%s\\end{pmatrix}"]
    formulas = []
    for form in forms:
        latex = "x"
        for _ in range(depth):
            latex = form % latex
        formulas.append((latex, latex_to_typst(latex)))
    assert refused(formulas) is None
