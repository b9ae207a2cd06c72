"""The Typst form: exact strings of the tricky constructs, and what the compiler measures of their spaces and sizes."""

import pytest

from notebook_reports.mathematics import latex_to_typst

THIN, MEDIUM, THICK = 3 / 18, 4 / 18, 5 / 18

EXACT = {
    # characters, never names; punctuation escaped; text as string literals
    r"x": "x",
    r"ab": "a b",
    r"12.5x": "12.5 x",
    r"\alpha_i": "attach(α, br: i)",
    r"a;b": r"a\;b",
    r"f(1, 2)": r"f\(1\,2\)",
    r"a:b": r"a\:b",
    r"\#\$\%\&\_": (r'class("normal", \#)class("normal", \$)class("normal", \%)class("normal", \&)class("normal", \_)'),
    r'\text{say "a\textbackslash{}b" #x}': r'"say \"a\\b\" '.rstrip() + ' #x"',
    r"a/b": r"a\/b",
    # decimal comma, and a comma in braces that is none
    r"3{,}14": '"3,14"',
    r"x{,}y": r'x class("normal", \,)y',
    r"1,5": r"1\,5",
    # unary and binary signs
    r"-x": r'class("normal", \−)x',
    r"a-b": r"a\− b",
    r"a=-b": r'a\=class("normal", \−)b',
    r"a\times-b": r'a\× class("normal", \−)b',
    r"{-}x": r'class("normal", \−)x',
    # scripts and primes
    r"x_1^2": "attach(x, tr: 2, br: 1)",
    r"{x_1}^2": "attach(attach(x, br: 1), tr: 2)",
    r"f''": "attach(f, tr: ″)",
    r"f'^2": "attach(f, tr: ′ 2)",
    r"{}_2F_1": 'attach("", br: 2)attach(F, br: 1)',
    r"\frac{{ab}^2}{c}": "frac(attach(a b, tr: 2), c)",
    # limits beside or above and below
    r"\sum_i^n": "attach(∑, t: n, b: i)",
    r"\sum\nolimits_i": "attach(scripts(∑), br: i)",
    r"\int_0^1": "attach(∫, tr: 1, br: 0)",
    r"\int\limits_0": "attach(limits(∫), b: 0)",
    r"\max_x": 'attach(op("max", limits: #true), b: x)',
    r"\sin^2": 'attach(op("sin", limits: #false), tr: 2)',
    r"\operatorname*{arg\,max}_\theta": 'attach(op("arg"#h(0.1667em)"max", limits: #true), b: θ)',
    r"\operatorname{a-b}": 'op("a-b", limits: #false)',
    # delimiters
    r"\left(x\right)": r"lr(\(x\))",
    r"\left.x\right|_0": r'attach(lr(""x class("closing", \|)), br: 0)',
    r"\left\{x\middle|y\right\}": r'lr(\{x class("normal", mid(\|))y\})',
    r"\|x\|": r'class("normal", \‖)x class("normal", \‖)',
    r"\bigl(x\bigr)": r'class("opening", lr(\(, size: #1.2em))x class("closing", lr(\), size: #1.2em))',
    r"\langle x\rangle": r"\⟨ x\⟩",
    # names, alphabets
    r"\mathrm{TPM}": '"TPM"',
    r"\mathrm{d}x": '"d"x',
    r"\mathbf{A}": "𝐀",
    r"\mathbb{R}": "ℝ",
    r"\boldsymbol{x\Sigma}": "𝒙 𝚺",
    r"\mathit{ab}": '"𝑎𝑏"',
    r"\Gamma": '"Γ"',
    r"\hat{x}": r'accent(x, #"\u{302}", size: #0%)',
    r"\widehat{xy}": r'accent(x y, #"\u{302}")',
    r"\underbrace{x}_{n}": "underbrace(x, n)",
    r"\overbrace{x}": "overbrace(x)",
    r"\stackrel{!}{=}": r'class("relation", attach(limits(\=), t: class("closing", \!)))',
    r"\binom{n}{k}": "binom(n, k)",
    r"\dfrac12": "display(frac(1, 2))",
    r"\sqrt[3]{x}": "root(3, x)",
    r"\sqrt{x}": "sqrt(x)",
    r"\text{if $x>0$, \textbf{then}}": r'"if "x\>0", "bold("then")',
    # nothing is ever an empty argument
    r"\frac{}{}": 'frac("", "")',
    r"": '""',
    r"\begin{matrix}a&\\&b\end{matrix}": (
        'mat(delim: #none, align: #center, row-gap: #0.3em, column-gap: #1em, inline(a), ""; "", inline(b))'
    ),
    r"\begin{array}{l|r}a&b\\\hline c&d\end{array}": (
        "mat(delim: #none, align: #center, row-gap: #0.3em, column-gap: #1em, augment: #(vline: (1, ), hline: (1, )), "
        "&inline(a), inline(b)&; &inline(c), inline(d)&)"
    ),
    r"\begin{align}a&=b\tag{1}\\&=c\end{align}": (
        "mat(delim: #none, align: #center, row-gap: #0.6em, column-gap: #0em, "
        r'display(a)&, &display(""\=b), &display(#h(2em)"(1)"); ""&, &display(""\=c), &"")'
    ),
}


@pytest.mark.parametrize("latex", EXACT)
def test_exact_form(latex):
    assert latex_to_typst(latex) == EXACT[latex]


def test_exact_forms_compile(refused):
    assert refused(list(EXACT.items())) is None


@pytest.fixture
def width(size):
    return lambda latex: size(latex_to_typst(latex, True))[0]


@pytest.fixture
def height(size):
    return lambda latex: size(latex_to_typst(latex, True))[1]


SPACES = {r"\,": THIN, r"\:": MEDIUM, r"\;": THICK, r"\!": -THIN, r"\quad": 1, r"\qquad": 2, r"\ ": 1 / 3, "~": 1 / 3}
SPACES |= {r"\hspace{1.5em}": 1.5, r"\mspace{9mu}": 0.5, r"\kern-3mu": -1 / 6, r"\enspace": 0.5, r"\hspace*{5pt}": 0.5}


@pytest.mark.parametrize("space", SPACES)
def test_space_between_letters(width, space):
    assert width(f"a{space} b") - width("ab") == pytest.approx(SPACES[space], abs=1e-3)


@pytest.mark.parametrize(
    "before, after",
    [("a", "b"), ("a", "= b"), ("a =", "b"), ("a", "+ b"), ("a +", "b"), ("a,", "b"), (r"\sin", "x"), ("a", r"\sin x")],
)
def test_explicit_space_adds_to_the_space_of_the_classes(width, before, after):
    """TeX adds both; Typst by itself drops its own space beside an explicit one."""
    assert width(rf"{before} \; {after}") - width(f"{before} {after}") == pytest.approx(THICK, abs=1e-3)


@pytest.mark.parametrize(
    "latex, same",
    [
        (r"3{,}14", "3.14"),  # the decimal comma takes no space
        (r"\left.a\right.", "a"),
        (r"{a}", "a"),
        (r"a\notag\label{eq:x}", "a"),
        (r"\begin{matrix}x\end{matrix}", "x"),  # no parentheses of Typst's own
        (r"\begin{array}{c}x\end{array}", "x"),
        (r"\left|{a}\right|", "|a|"),
        (r"\left(a\right)b", "(a)b"),
        (r"a % comment = b" + "\n", "a"),
        (r"\phantom{xyz}", "xyz"),
        (r"-{a}", "{-}a"),
        (r"\begin{aligned}a&=b\end{aligned}", "a=b"),  # the relation keeps its space at the start of a column
        (r"a\not= b", r"a\ne b"),
        (r"\mathrm{max}", r"\max"),
        (r"\begin{equation}a=b\end{equation}", "a=b"),
        (r"\vphantom{\frac{a}{b}}c", "c"),
    ],
)
def test_same_width(width, latex, same):
    assert width(latex) == pytest.approx(width(same), abs=2e-3)


def test_signs_are_unary_or_binary_as_in_tex(width):
    letters = width("a") + width("b") + width("{-}")
    assert width("a-b") == pytest.approx(letters + 2 * MEDIUM, abs=2e-3)
    assert width("a{-}b") == pytest.approx(letters, abs=2e-3)
    assert width("(-b)") == pytest.approx(width("(b)") + width("{-}"), abs=2e-3)
    assert width("a=-b") == pytest.approx(width("a=b") + width("{-}"), abs=2e-3)


def test_relations_take_no_space_in_scripts(width):
    assert width("x_{i=1}") < width("x_{i1}") + 0.7 * width("{=}") + 0.05


@pytest.mark.parametrize("latex", [r"\left.%s\right|", r"\left(%s\right.", r"\left\{%s\right\}", r"\left\|%s\right\|"])
def test_growing_delimiters_grow(height, latex):
    tall = r"\begin{matrix}a\\b\\c\end{matrix}"
    assert height(latex % tall) >= 0.95 * height(tall)
    assert height(latex % "a") < 1.6


def test_middle_bar_grows_with_its_neighbours(height, width):
    tall = r"\begin{matrix}a\\b\\c\end{matrix}"
    bar = width(rf"\left\{{{tall}\middle|x\right\}}") - width(rf"\left\{{{tall}x\right\}}")
    assert 0 < bar < 0.4
    assert height(rf"\left.\middle|{tall}\right.") > 0.95 * height(tall)


def test_invisible_delimiter_does_not_stretch_its_neighbour(height):
    plain = height(r"(d)")
    assert height(r"\left((d)\right.") == pytest.approx(height(r"((d)"), abs=0.01)
    assert plain < 1.3


@pytest.mark.parametrize("size_name, em", [("big", 1.2), ("Big", 1.8), ("bigg", 2.4), ("Bigg", 3.0)])
def test_big_delimiters_have_their_heights(height, size_name, em):
    assert height(rf"\{size_name}(") == pytest.approx(em, rel=0.15)


def test_row_space_is_kept(height):
    rows = r"\begin{matrix}a\\%sb\end{matrix}"
    assert height(rows % "[2em]") > height(rows % "") + 1.5


def test_display_style_reaches_fractions_in_aligned_rows(height):
    assert height(r"\begin{aligned}\frac{a}{b}\end{aligned}") == pytest.approx(height(r"\dfrac{a}{b}"), abs=0.02)
    assert height(r"\begin{matrix}\frac{a^2}{b^2}\end{matrix}") == pytest.approx(height(r"\tfrac{a^2}{b^2}"), abs=0.02)


def test_boxed_formula_keeps_its_baseline_and_text_alternative(size):
    code = latex_to_typst(r"\boxed{x^2}")
    assert 'alt: "x^2"' in code
    assert size(code)[1] > 1.2


def test_boxes_and_struts_are_as_tall_as_what_they_hold(height):
    """In a line of text Typst makes tall formulas less tall; a box must not cut through its fraction."""
    assert height(r"\boxed{\frac{a}{b}}") == pytest.approx(height(r"\dfrac{a}{b}") + 0.6, abs=0.02)
    fraction = height(r"\left(\frac{a}{b}\right)")
    assert height(r"\left(\vphantom{\frac{a}{b}}x\right)") == pytest.approx(fraction, rel=0.05)
