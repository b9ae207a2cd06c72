"""The MathML form: structure, spaces and attributes that the browsers depend on."""

import re

import pytest

from notebook_reports.mathematics import latex_to_mathml


def inner(latex: str, display: bool = False) -> str:
    """The content of the math element."""
    return re.fullmatch(r"<math [^>]*>(.*)</math>", latex_to_mathml(latex, display))[1]


EXACT = {
    "x": "<mi>x</mi>",
    "12.5": "<mn>12.5</mn>",
    "3{,}14": "<mn>3,14</mn>",
    r"\frac{a}{b}": "<mfrac><mi>a</mi><mi>b</mi></mfrac>",
    r"\sqrt[3]{x}": "<mroot><mi>x</mi><mn>3</mn></mroot>",
    r"x_i^2": "<msubsup><mi>x</mi><mi>i</mi><mn>2</mn></msubsup>",
    "f'": '<msup><mi>f</mi><mo lspace="0" rspace="0">′</mo></msup>',
    r"\mathrm{d}": '<mi mathvariant="normal">d</mi>',
    r"\mathrm{TPM}": "<mi>TPM</mi>",
    r"\Gamma": '<mi mathvariant="normal">Γ</mi>',
    r"\mathbf{A}": "<mi>𝐀</mi>",
    r"\infty": '<mi mathvariant="normal">∞</mi>',
    r"\text{if }": "<mtext>if\u00a0</mtext>",
    r"\,": '<mspace width="0.1667em"/>',
    "a<b": '<mrow><mi>a</mi><mo form="infix">&lt;</mo><mi>b</mi></mrow>',
    "a-b": '<mrow><mi>a</mi><mo form="infix">−</mo><mi>b</mi></mrow>',
    "-b": '<mrow><mo form="prefix">−</mo><mi>b</mi></mrow>',
    r"\sin x": '<mrow><mi>sin</mi><mspace width="0.1667em"/><mi>x</mi></mrow>',
    r"\sin(x)": (
        '<mrow><mi>sin</mi><mo form="prefix" stretchy="false">(</mo><mi>x</mi>'
        '<mo form="postfix" stretchy="false">)</mo></mrow>'
    ),
    r"\hat{i}": '<mover accent="true"><mi>ı</mi><mo stretchy="false" lspace="0" rspace="0">^</mo></mover>',
    r"\binom{n}{k}": (
        '<mrow><mo form="prefix" stretchy="true" symmetric="true">(</mo>'
        '<mfrac linethickness="0"><mi>n</mi><mi>k</mi></mfrac>'
        '<mo form="postfix" stretchy="true" symmetric="true">)</mo></mrow>'
    ),
}


@pytest.mark.parametrize("latex", EXACT)
def test_exact_form(latex):
    assert inner(latex) == EXACT[latex]


def test_display_is_an_attribute():
    assert latex_to_mathml("x", True).startswith('<math xmlns="http://www.w3.org/1998/Math/MathML" display="block">')
    assert "display" not in latex_to_mathml("x").split(">")[0]


def test_operators_in_scripts_take_no_space():
    assert '<mo form="infix" lspace="0" rspace="0">=</mo>' in inner("x_{i=1}")


def test_bars_that_are_ordinary_take_no_space_wherever_they_stand():
    assert inner("|a|").count('lspace="0" rspace="0" stretchy="false">|</mo>') == 2


def test_limits_follow_the_operator():
    assert 'movablelimits="true">∑</mo>' in inner(r"\sum_i")
    assert "<munder>" in inner(r"\sum_i") and "<msub>" in inner(r"\sum\nolimits_i")
    assert "<munderover>" in inner(r"\int\limits_0^1") and "<msubsup>" in inner(r"\int_0^1")
    assert 'movablelimits="false"' in inner(r"\lim\limits_x") and 'movablelimits="true"' in inner(r"\lim_x")


def test_cells_are_aligned_in_the_words_of_every_browser():
    cells = re.findall(r'<mtd style="([^"]*)"', inner(r"\begin{array}{lcr}a&b&c\end{array}"))
    for cell, side in zip(cells, ("left", "center", "right"), strict=True):
        assert cell.startswith(f"text-align:{side};text-align:-webkit-{side};")


def test_lines_of_an_array_are_borders():
    table = inner(r"\begin{array}{|c|c|}\hline a&b\\\hline c&d\\\hline\end{array}")
    assert table.count("border-left") == 4 and table.count("border-right") == 2
    assert table.count("border-top") == 4 and table.count("border-bottom") == 2


def test_tags_of_rows_stand_in_their_rows():
    rows = inner(r"\begin{align}a&=b\tag{4.9}\\c&=d\end{align}").split("</mtr>")
    assert "(4.9)" in rows[0] and "(4.9)" not in rows[1]


@pytest.mark.parametrize("latex", [r"\text{<b>&amp;}", r"a<b>c", r"\tag{<1>}", r'\text{"}', r"\operatorname{a}"])
def test_markup_in_the_formula_stays_text(latex):
    assert "<b>" not in latex_to_mathml(latex) and "<1>" not in latex_to_mathml(latex)


@pytest.mark.parametrize("latex", ["s", "x + 1", "- T_d", "e^{-s T}", r"\omega_u t", r"\dot{x}", "1 + f(t)"])
def test_brackets_that_need_not_grow_do_not_take_the_room_for_it(latex):
    assert 'stretchy="true"' not in inner(rf"G{{\left({latex} \right)}}")


@pytest.mark.parametrize(
    "latex", [r"\frac{1}{s}", r"\sqrt{y}", r"\sum_k e_k", "x^{y^2}", r"\int e", r"1 + \frac{t}{T}"]
)
def test_brackets_round_what_is_tall_grow(latex):
    assert inner(rf"\left({latex}\right)").count('stretchy="true"') == 2
