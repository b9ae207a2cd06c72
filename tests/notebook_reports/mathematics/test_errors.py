"""What is not understood is an error that says what, where and how to mend it; tags and text on the way."""

import pytest

from notebook_reports.mathematics import MathError, extract_tag, latex_to_mathml, latex_to_text, latex_to_typst

ERRORS = [
    (r"x = \fracc{1}{2}", r"unknown command \fracc: did you mean \frac", 4),
    (r"\aplha", r"did you mean \alpha?", 0),
    (r"\qwertyuiop", r"unknown command \qwertyuiop", 0),
    (r"\frac{a}{b", "{ is never closed", 8),
    (r"a}", "} without {", 1),
    (r"a & b", r"& outside of a matrix", 2),
    (r"a \\ b", r"\\ outside of an environment: put the lines into \begin{aligned}", 2),
    (r"\left( a", r"\left is never closed", 0),
    (r"\left x", r"\left needs a delimiter", 6),
    (r"a \right)", r"\right without \left", 2),
    (r"\middle|", r"\middle that is not directly between", 0),
    (r"\begin{matrix} a", r"never closed", 0),
    (r"\begin{matrix} a \end{pmatrix}", r"\begin{matrix} is closed by \end{pmatrix}", 22),
    (r"\begin{martix} a \end{martix}", r"unknown environment martix: did you mean", 7),
    (r"a \tabularnewline b", r"\tabularnewline outside of an environment", 2),
    (r"x^\over", r"\over cannot be an argument by itself", 2),
    (r"\frac\tag{1}", r"\tag cannot be an argument by itself", 5),
    (r"\end{matrix}", r"\end without \begin", 0),
    (r"\begin{array}{lxr} a \end{array}", r"unknown column type x", 15),
    (r"\begin{array}{l} a & b \end{array}", r"array has 1 column, a row here has 2 cells", 0),
    (r"\begin{cases} a & b & c \end{cases}", "cases has 2 columns", 0),
    (r"x^a^b", "two superscripts on one base: use braces", 3),
    (r"x_a_b", "two subscripts on one base: use braces", 3),
    (r"x^2'", "a prime after a superscript", 3),
    (r"x^", "^ needs an argument, found the end of the formula", 2),
    (r"\frac{a}", r"\frac needs an argument", 8),
    (r"\sqrt[3{x}", "[ is never closed", 5),
    (r"a \limits_b", r"\limits must follow an operator", 2),
    (r"a # b", r"write \# for the character", 2),
    (r"a $ b", r"write \$ for the character", 2),
    ("a\\", "a backslash with no command after it", 1),
    (r"\text{a \frac{1}{2}}", r"unknown command \frac in text; put mathematics between $ signs", 8),
    (r"\text{a $b}", "$ in text is never closed", 8),
    (r"\text", r"\text needs an argument in braces", 5),
    (r"\not\alpha", r"\not is known before relations and arrows only", 0),
    (r"\textcolor{rde}{x}", "unknown colour rde: did you mean red?", 11),
    (r"\hspace{2 bananas}", r"\hspace needs a length such as 1em", 8),
    (r"{a \tag{1}}", r"\tag inside a group", 3),
    (r"\begin{align} a \tag{1} \tag{2} \end{align}", r"a second \tag in one row", 24),
    (r"\genfrac{(}{)}{2pt}{}{n}{k}", r"\genfrac draws a line of the usual thickness", 15),
    ("x\u0301", "unknown character", 1),
    ("a\x00", "(U+0000)", 1),
]


@pytest.mark.parametrize("latex, message, position", ERRORS)
def test_error_says_what_and_where(latex, message, position):
    for emit in (latex_to_typst, latex_to_mathml, latex_to_text):
        with pytest.raises(MathError) as caught:
            emit(latex)
        assert message in caught.value.reason
        assert caught.value.position == position
        assert caught.value.latex == latex


def test_excerpt_points_at_the_place_in_a_long_formula():
    latex = "a + " * 100 + r"\nonsense" + " + b" * 100
    with pytest.raises(MathError) as caught:
        latex_to_typst(latex)
    first, shown, caret = str(caught.value).splitlines()
    assert "(character 401)" in first
    assert shown[caret.index("^") :].startswith(r"\nonsense")
    assert len(shown) < 80


def test_no_markup_of_typst_can_be_smuggled_in():
    for latex in (
        r'\text{"; #panic("x")}',
        r"\text{\textbackslash}",
        r"\operatorname{x}",
        r'\mathrm{"a}',
        r'\tag{"#x}',
    ):
        code = latex_to_typst(latex)
        outside = code.replace("\\\\", "").replace('\\"', "")
        assert outside.count('"') % 2 == 0
        assert "#panic" not in "".join(outside.split('"')[::2])


def test_one_tag_is_taken_out():
    assert extract_tag(r"u = K e \tag{4.9}") == ("u = K e", "4.9")
    assert extract_tag(r"\tag{A} u = K e") == ("u = K e", "A")
    assert extract_tag("u = K e") == ("u = K e", None)
    without, tag = extract_tag(r"\begin{equation} u = K e \tag{4.9} \end{equation}")
    assert tag == "4.9" and "tag" not in without and latex_to_typst(without) == latex_to_typst("{u = K e}")


def test_other_tags_stay_visible():
    starred = r"a = b \tag*{(A)}"
    assert extract_tag(starred) == (starred, None)
    assert '"(A)"' in latex_to_typst(starred) and "(A)" in latex_to_mathml(starred)
    rows = r"\begin{align} a &= b \tag{1} \\ c &= d \tag{2} \end{align}"
    assert extract_tag(rows) == (rows, None)
    for shown in (latex_to_typst(rows), latex_to_mathml(rows), latex_to_text(rows)):
        assert "(1)" in shown and "(2)" in shown
    with pytest.raises(MathError, match=r"a second \\tag"):
        extract_tag(r"a \tag{1} \tag{2}")


@pytest.mark.parametrize(
    "latex, text",
    [
        (r"G(s) = \frac{K_p}{1 + sT} e^{-sL}", "G(s) = K_p/(1 + sT) e^(−sL)"),
        (r"x = 3{,}14", "x = 3,14"),
        (r"\sqrt{1 + x}", "√(1 + x)"),
        (r"\begin{pmatrix} a & b \\ c & d \end{pmatrix}", "(a, b; c, d)"),
        (r"y_{sp}(t)", "y_sp(t)"),
        (r"\mathbf{A}\boldsymbol{x}", "Ax"),
        (r"30\,^\circ\mathrm{C}", "30 °C"),
        (r"\dot{x} = -x", "x dot = −x"),
        (r"b = \begin{cases} 0 & \text{if } a \\ 1 & \text{otherwise} \end{cases}", "b = {0, if a; 1, otherwise"),
        ("", ""),
    ],
)
def test_alternative_text_reads_the_formula(latex, text):
    assert latex_to_text(latex) == text
