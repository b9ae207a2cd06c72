"""The reader of formulas: what it means, what it refuses and where, and that no text can run, hang or crash it."""

import string
import time

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from notebook_reports.formula.read import (
    FUNCTIONS,
    FormulaError,
    Symbols,
    UnknownName,
    read_equations,
    read_formula,
)

a, b, c, x, I = sp.symbols("a b c x I")
k = sp.Symbol("k", integer=True)
y = sp.Function("y")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a + b*c", a + b * c),
        ("a/b*c", a * c / b),
        ("a/b/c", a / (b * c)),
        ("a - b - c", a - b - c),
        ("-a**2", -(a**2)),
        ("(-a)**2", a**2),
        ("2**-1", sp.Rational(1, 2)),
        ("a**b**c", a ** (b**c)),
        ("a^2", a**2),
        ("a*-b", -a * b),
        ("0.37", sp.Rational(37, 100)),
        (".5e-3", sp.Rational(1, 2000)),
        ("1e2", sp.Integer(100)),
        ("I + 1", I + 1),
        ("2*pi", 2 * sp.pi),
        ("exp(-a)*log(b)", sp.exp(-a) * sp.log(b)),
        ("abs(a) + max(a, b)", sp.Abs(a) + sp.Max(a, b)),
        ("y[k-1] + y[k]", y(k - 1) + y(k)),
        ("a − b · c", a - b * c),
        ("gamma + S + N + E", sum(sp.symbols("gamma S N E"))),
    ],
)
def test_what_a_formula_means(text, value):
    assert read_formula(text) == value


@pytest.mark.parametrize(
    ("text", "position", "reason"),
    [
        ("", 0, "a number, a name or"),
        ("a +* b", 3, 'not "*"'),
        ("2x", 1, "an operator or the end is expected"),
        ("(a", 2, 'an operator or ")" is expected, not the end'),
        ("a b", 2, "an operator"),
        ("0,5", 1, "an operator"),
        ("x²", 0, "no part of a formula"),
        ("a.b", 1, "no part of a formula"),
        ("a(b + c)", 0, "a product is written with *"),
        ("exp(1, 2)", 0, "exp of 2"),
        ("1/0", 1, "division by zero"),
        ("1/(a - a)", 1, "division by zero"),
        ("log(0)", 0, "no value"),
        ("0**0", 1, "positive exponent"),
        ("9**9**9", 1, "the exponent is beyond 100"),
        ("(9**99)**99", 7, "digits"),
        ("((a + 1)**50)**50", 13, "terms"),
        ("(a + b + c + x)**99", 15, "terms"),
        ("exp(exp(exp(9)))", 4, "the argument of exp is beyond"),
        ("1e999", 0, "a number has at most"),
        ("1e" + "9" * 1000, 0, "a number has at most"),
        ("9" * 400, 0, "a number has at most"),
        ("-" * 60 + "a", 50, "in each other"),
        ("(" * 60 + "a" + ")" * 60, 50, "in each other"),
        ("a" * 3000, 2000, "at most 2000 characters"),
        ("y[j]", 2, "a sample is written as y[k]"),
        ("y[k-0.5]", 4, "a whole number of steps"),
        ("__import__('os')", 11, "no part of a formula"),
        ("a = b", 2, "an operator or the end"),
    ],
)
def test_what_is_refused_and_where(text, position, reason):
    with pytest.raises(FormulaError) as caught:
        read_formula(text, where="table.toml, claim row")
    assert caught.value.position == position and reason in caught.value.reason
    assert str(caught.value).startswith(f"table.toml, claim row, character {position + 1}: ")


def test_only_the_names_that_are_given_may_stand():
    T = sp.Symbol("T", positive=True)
    assert read_formula("2*T", {"T": T}) == 2 * T
    with pytest.raises(UnknownName, match='"Ti" is not known'):
        read_formula("2*Ti", {"T": T})
    with pytest.raises(UnknownName, match='"exq" is no known function: did you mean'):
        read_formula("exq(2)")
    assert read_formula("2*Ti", Symbols(T=T)) == 2 * sp.Symbol("Ti")


def test_functions_and_samples_of_ones_own():
    assert read_formula("u(a)", functions={"u": lambda v: v + 1}) == a + 1

    def samples(name, shift):
        return {("y", -1): x}[name, shift]

    assert read_formula("2*y[k-1]", samples=samples) == 2 * x
    with pytest.raises(UnknownName, match=r"the sample y\[k\+1\] is not known"):
        read_formula("2*y[k+1]", samples=samples)


def test_equations_and_matrices():
    (one, two) = read_equations("a = [[1, b], [c, 0]]; b + c")
    assert one == (a, sp.Matrix([[1, b], [c, 0]])) and two == (b + c, None)
    with pytest.raises(FormulaError, match="same length"):
        read_equations("[[1, 2], [3]]")
    with pytest.raises(FormulaError, match=r'character 5: .* not "="'):
        read_equations("a=b =c")


ALPHABET = string.ascii_letters[:6] + "xyk0129" + "+-*/^()[],;=._eE \t'\"\\:{}@#%!<>²π∞\n"
WORDS = st.sampled_from(
    [*FUNCTIONS, "pi", "9", "99", "0.5", "1e9", "a", "b", "y[k-1]", "**", "*", "/", "+", "-", "(", ")"]
)
TEXTS = st.one_of(st.text(max_size=60), st.text(ALPHABET, max_size=60), st.lists(WORDS, max_size=25).map("".join))


@settings(max_examples=400, deadline=None)
@given(TEXTS)
def test_any_text_is_a_value_or_an_error_with_a_place(text):
    started = time.monotonic()
    try:
        value = read_formula(text)
    except FormulaError as error:
        assert 0 <= error.position <= len(text) and error.reason
    else:
        assert isinstance(value, sp.Expr) and value not in (sp.zoo, sp.nan)
    assert time.monotonic() - started < 10


FORMULAS = st.recursive(
    st.sampled_from([a, b, c, x])
    | st.fractions(-9, 9, max_denominator=9).map(lambda f: sp.Rational(f.numerator, f.denominator)),
    lambda inner: (
        st.tuples(inner, inner, st.sampled_from("+-*/")).map(
            lambda t: {"+": t[0] + t[1], "-": t[0] - t[1], "*": t[0] * t[1], "/": t[0] / t[1] if t[1] != 0 else t[0]}[
                t[2]
            ]
        )
        | inner.map(sp.exp)
        | inner.map(lambda e: e**2)
    ),
    max_leaves=6,
)


@settings(max_examples=150, deadline=None)
@given(FORMULAS)
def test_what_sympy_writes_is_read_back(expression):
    try:
        value = read_formula(str(expression), {"a": a, "b": b, "c": c, "x": x, "E": sp.E, "zoo": sp.zoo, "nan": sp.nan})
    except FormulaError as error:
        assert any(word in error.reason for word in ("beyond", "more than", "value", "zero"))
    else:
        assert value == expression


RUNS = ["__import__('os').system('touch {0}')", "open('{0}', 'w')", "exec(\"open('{0}','w')\")",
        "a.__class__", "(lambda: open('{0}', 'w'))()", "[x for x in open('{0}', 'w')]", "f'{{open(0)}}'"]  # fmt: skip


@pytest.mark.parametrize("text", RUNS)
def test_nothing_is_run(text, tmp_path):
    proof = tmp_path / "written"
    with pytest.raises(FormulaError):
        read_formula(text.format(proof))
    assert not proof.exists()
