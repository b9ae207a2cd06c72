"""The font for formulas inside an HTML page."""

import base64
import io
import re

import pytest

from notebook_reports.export.write.mathematics_font import font_face
from notebook_reports.mathematics import latex_to_mathml

pytestmark = pytest.mark.builds


def font_in(rule):
    from fontTools.ttLib import TTFont

    return TTFont(io.BytesIO(base64.b64decode(re.search(r"base64,([^)]*)\)", rule)[1])))


@pytest.mark.parametrize(
    "latex", [r"x^2", r"\frac{\alpha}{\beta}", r"\sqrt{\sum_{k=0}^{\infty} a_k'}", r"\mathbb{R} \ni \mathbf{K}"]
)
def test_every_character_of_a_formula_is_in_its_font(latex):
    page = f"<p>text</p>{latex_to_mathml(latex)}"
    font = font_in(font_face(page))
    letters = set(re.sub(r"<[^>]*>|\s", "", latex_to_mathml(latex)))
    assert letters <= {chr(code) for code in font.getBestCmap()}
    assert "MATH" in font and "GUST Font License" in str(font["name"].getName(0, 3, 1))


def test_a_single_letter_comes_with_its_italic_and_brackets_grow():
    font = font_in(font_face("<math><mi>x</mi><mo>(</mo></math>"))
    assert ord("𝑥") in font.getBestCmap()
    variants = font["MATH"].table.MathVariants.VertGlyphConstruction
    assert any(construction.MathGlyphVariantRecord for construction in variants)


@pytest.mark.parametrize("latex", [r"\sqrt{y}", r"\sqrt[3]{y}", r"y^{\sqrt{2}}"])
def test_a_root_comes_with_its_sign_in_all_sizes(latex):
    """The sign is no text of the formula: without its glyph a browser draws the radicand alone."""
    font = font_in(font_face(latex_to_mathml(latex)))
    sign = font.getBestCmap()[ord("√")]
    variants = font["MATH"].table.MathVariants
    sizes = dict(zip(variants.VertGlyphCoverage.glyphs, variants.VertGlyphConstruction, strict=True))
    assert len(sizes[sign].MathGlyphVariantRecord) > 2
    assert ord("√") not in font_in(font_face("<math><mi>y</mi></math>")).getBestCmap()


def test_a_page_without_formulas_brings_no_font_and_one_with_few_a_small_one():
    assert font_face("<p>x = 1</p>") == ""
    assert len(font_face("<math><mi>x</mi></math>")) < 12_000
    assert len(font_face(f"<math>{'abcxyzTKsLGiωφτ+−=()[]{}∑∫√⋅∂∞≤∈/|'}</math>")) < 40_000


def test_equal_characters_give_equal_bytes():
    from notebook_reports.export.write import mathematics_font

    first = font_face("<math>ab</math>")
    mathematics_font._part.cache_clear()
    assert font_face("<math>b</math><math>a</math>") == first
