"""Every formula of the two corpora converts, compiles, and means the same in both output formats."""

import html
import re
import unicodedata
import xml.etree.ElementTree as ElementTree
from collections import Counter

import pytest

from notebook_reports.mathematics import latex_to_mathml, latex_to_text, latex_to_typst
from notebook_reports.mathematics.symbols import ACCENTS

pytestmark = pytest.mark.long

MATHML = "{http://www.w3.org/1998/Math/MathML}"
# MathML Core as of 2025, https://w3c.github.io/mathml-core/
CORE_ELEMENTS = {
    "math",
    "mrow",
    "mi",
    "mn",
    "mo",
    "mtext",
    "mspace",
    "mfrac",
    "msqrt",
    "mroot",
    "mstyle",
    "mpadded",
    "mphantom",
    "msub",
    "msup",
    "msubsup",
    "munder",
    "mover",
    "munderover",
    "mtable",
    "mtr",
    "mtd",
}
CHILDREN = {"mfrac": 2, "mroot": 2, "msub": 2, "msup": 2, "munder": 2, "mover": 2, "msubsup": 3, "munderover": 3}
STRUCTURE = ("mfrac", "msqrt", "mroot", "msub", "msup", "msubsup", "munder", "mover", "munderover", "mtr")
COMBINING = {spacing: combining for combining, spacing in ACCENTS.values()}
# Invisible or drawn things that Typst's HTML export leaves out.
NOT_EXPORTED = ("std.box(", "std.hide(", "cancel(")


@pytest.fixture(scope="session")
def formulas(report_formulas, sympy_formulas):
    return report_formulas + sympy_formulas


def test_there_are_enough_formulas(report_formulas, sympy_formulas):
    assert len(report_formulas) >= 100
    assert len(sympy_formulas) >= 1500
    assert len(set(report_formulas)) == len(report_formulas)


def test_the_corpus_is_the_same_every_time(sympy_formulas):
    assert sympy_formulas[0] != sympy_formulas[1]
    kinds = ("frac", "sqrt", "int", "sum", "prod", "lim_", "begin{cases}", "begin{matrix}", "operatorname", "middle")
    for kind in (*kinds, "mathcal{L}", "infty", "cup", "wedge", "mathbb{R}", "otimes", "partial", "hat", "{,}"):
        assert any(kind in latex for latex in sympy_formulas), f"no formula with {kind}"


def test_every_formula_compiles_in_typst(formulas, refused):
    assert refused([(latex, latex_to_typst(latex, True)) for latex in formulas]) is None


def test_every_formula_is_well_formed_mathml_core(formulas):
    for latex in formulas:
        root = ElementTree.fromstring(latex_to_mathml(latex, True))
        assert root.tag == MATHML + "math" and root.get("display") == "block"
        for element in root.iter():
            name = element.tag.removeprefix(MATHML)
            assert name in CORE_ELEMENTS, latex
            assert len(element) == CHILDREN.get(name, len(element)), f"{name} in {latex}"
            assert bool((element.text or "").strip()) == (name in ("mi", "mn", "mo", "mtext")), f"{name} in {latex}"


def test_every_formula_has_an_alternative_text(formulas):
    for latex in formulas:
        text = latex_to_text(latex)
        assert "\\" not in text.replace("∖", "") or "setminus" in latex or "backslash" in latex, latex
        assert text == " ".join(text.split())


def _characters(mathml: str) -> str:
    """The characters of a formula in reading order, letters of all alphabets as plain letters, without blanks."""
    text = html.unescape(re.sub(r"<[^>]*>", "", mathml))
    text = "".join(unicodedata.normalize("NFKC", c) if c.isalnum() or ord(c) > 0x1D000 else c for c in text)
    return "".join(text.translate({0xFE00: None, 0xFE01: None, ord("ı"): "i", ord("ȷ"): "j"}).split())


def _with_combining_accents(mathml: str) -> str:
    mark = r'(<mo stretchy="(?:true|false)" lspace="0" rspace="0">)(.)(</mo></mover>)'
    return re.sub(mark, lambda m: m[1] + COMBINING.get(m[2], m[2]) + m[3], mathml)


def _structure(mathml: str) -> Counter:
    """How many fractions, roots, rows, and parts in each script position; two scripts count as one and one."""
    found = Counter(name for name in re.findall(r"<(\w+)", mathml) if name in STRUCTURE)
    for both, one, other in (("msubsup", "msub", "msup"), ("munderover", "munder", "mover")):
        count = found.pop(both, 0)
        found += {one: count, other: count}
    return found


def test_typst_understands_what_the_mathml_says(formulas, understood):
    """Same characters in the same order, same fractions, roots, scripts and rows: two independent readings."""
    codes = [latex_to_typst(latex, True) for latex in formulas]
    compared = 0
    for latex, code, read in zip(formulas, codes, understood(codes), strict=True):
        if any(part in code for part in NOT_EXPORTED):
            continue
        ours = latex_to_mathml(latex, True)
        assert _characters(read) == _characters(_with_combining_accents(ours)), latex
        if "\\textstyle" not in latex and "matrix}\\end" not in latex and "}\\end{array}" not in latex:
            assert _structure(read) == _structure(ours), latex  # limits follow the style; empty matrices get one cell
        compared += 1
    assert compared > 0.98 * len(formulas)
