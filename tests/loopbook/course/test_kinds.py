"""What answers can be: read from plain values with words for what is wrong, compared, shown."""

import math

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from loopbook.course.asking import answer
from loopbook.course.errors import Redraw, SheetError, Unreadable
from loopbook.course.kinds.kind import shown_number
from loopbook.course.session import Session, during
from loopbook.course.tolerance import read_tolerance


def asked(value, **told):
    with during(Session(strict=False)) as session:
        answer("x", value, **told)
    return session.asked["x"]


def right(value, raw, **told):
    one = asked(value, **told)
    return one.right(one.kind.read(raw))


def refused(value, raw, **told):
    with pytest.raises(Unreadable) as error:
        asked(value, **told).kind.read(raw)
    return str(error.value)


K, T, s = sp.symbols("K T s", positive=True)
e, k = sp.Function("e"), sp.Symbol("k", integer=True)
FORMULA = {"symbols": "K T s"}


@pytest.mark.parametrize(
    ("value", "raw", "told", "is_right"),
    [
        (0.65432, 0.654, {}, True),
        (0.65432, 0.66, {}, False),
        (-2.0, -2, {}, True),
        (100.0, 103.9, {"tolerance": "4 %"}, True),
        (100.0, 104.1, {"tolerance": "4 %"}, False),
        (0.0, 0.04, {"tolerance": 0.05}, True),
        ([1.0, 2.0], [1.001, 2], {}, True),
        ([1.0, 2.0], [2.0, 1.0], {}, False),
        ([1.0, 2.0], [2.0, 1.0], {"any_order": True}, True),
        ([1, -1.5, 0.56], "z^2 - 1.5*z + 0.56", {"kind": "polynomial"}, True),
        ([1, -1.5, 0.56], "(z - 0.7)*(z - 0.8)", {"kind": "polynomial"}, True),
        ([1, -1.5, 0.56], [0, 1, -1.5, 0.56], {"kind": "polynomial"}, True),
        ([1, -1.5, 0.56], [1, -1.5], {"kind": "polynomial"}, False),
        (s**2 + 2, [1, 0, 2], {"kind": "polynomial", "symbol": "s"}, True),
        (K / (T * s + 1), "1/(1/K + T*s/K)", FORMULA, True),
        (K / (T * s + 1), "K/(T*s + 1) + 0", FORMULA, True),
        (K / (T * s + 1), "K/(T*s + 1.0001)", FORMULA, False),
        (K * (e(k) - e(k - 1)), "u = K*e[k] - K*e[k-1]", {"symbols": "K e[k] e[k-1] u"}, True),
        (sp.sqrt(K) * sp.sqrt(T), "sqrt(K*T)", {"symbols": "K T"}, True),
        (True, "yes", {}, True),
        (True, "Yes ", {}, True),
        (False, True, {}, False),
        ("b", "b", {"options": ["a", "b"]}, True),
        ([0.0, 1.0, 4.0], [0.01, 1.0, 3.99], {"kind": "curve", "x": [0, 1, 2], "tolerance": "1 %"}, True),
        ([0.0, 1.0, 4.0], [0.0, 1.1, 4.0], {"kind": "curve", "x": [0, 1, 2], "tolerance": "1 %"}, False),
        ([0.0, 1.0, 2.0], [[-1, 5], [-1, 5]], {"kind": "curve", "x": [0, 1, 2]}, True),
        (4, 4, {}, True),
    ],
)
def test_right_and_wrong(value, raw, told, is_right):
    assert right(value, raw, **told) is is_right


@pytest.mark.parametrize(
    ("value", "raw", "told", "words"),
    [
        (1.0, None, {}, "nothing was written"),
        (1.0, "1,23", {}, "write 1.23, without quotes"),
        (1.0, "1.23 s", {}, "without quotes and without its unit"),
        (1.0, [1, 23], {}, "1, 23 are two numbers: in Python the decimal sign is a point, 1.23"),
        (1.0, "abc", {}, "a text, not a number"),
        (1.0, True, {}, "True is no number"),
        (1.0, math.nan, {}, "no number that can be compared"),
        (1.0, {"a": 1}, {}, "not a table of names"),
        (1.0, 10**400, {}, "too large"),
        ([1.0, 2.0], [1.0], {}, "2 numbers are asked for, 1 are given"),
        ([1.0, 2.0], 3.0, {}, "in square brackets"),
        ([1, 2], "z^2 + w", {"kind": "polynomial"}, 'at character 7: "w" is not known'),
        ([1, 2], "1/z", {"kind": "polynomial"}, "no polynomial in z"),
        ([1, 2], "z**99", {"kind": "polynomial"}, "beyond 30"),
        (K / T, "__import__('os').system('true')", FORMULA, "no formula"),
        (K / T, "K/Q", FORMULA, '"Q" is not known'),
        (K / T, "9**9**9**9", FORMULA, "the exponent is beyond 100"),
        (K / T, 3.0, FORMULA, "a formula is asked for, as a text in K, T, s"),
        (True, "maybe", {}, '"maybe" is none of yes, no'),
        (True, ["yes", "q"], {"reason": "r", "reasons": ["r", "s"]}, "none of the reasons a, b"),
        ([0.0, 1.0], [1.0], {"kind": "curve", "x": [0, 1]}, "2 values are asked for, 1 are given"),
        ([0.0, 1.0], [[0, 0.5], [0, 1]], {"kind": "curve", "x": [0, 1]}, "from 0 to 1 is asked for"),
        (math.sin, 3.0, {}, "a function is asked for, by its name"),
    ],
)
def test_what_cannot_be_read_is_said_in_words(value, raw, told, words):
    assert words in refused(value, raw, **told)


@pytest.mark.parametrize(
    ("value", "told", "words"),
    [
        (1.0, {"digits": 3, "tolerance": "3 %"}, "not both"),
        (1.0, {"digits": 1}, "from 2 to 12"),
        (1.0, {"tolerance": "three"}, "tolerance is written"),
        (1.0, {"kind": "colour"}, "kind is one of"),
        (1.0, {"points": 0}, "points are above 0"),
        (math.nan, {}, "is not finite"),
        ("abc", {"kind": "number"}, "no real number"),
        (K, {"kind": "formula"}, "needs symbols="),
        (0.5 * K, {"symbols": "K"}, "a formula is exact"),
        (K * T, {"symbols": "K"}, "the formula has T"),
        ("c", {"options": ["a", "b"]}, "'c' is none of a, b"),
        ("a", {"options": ["a"]}, "two or more"),
        (True, {"reason": "r", "reasons": ["s", "t"]}, "the right reason is one of"),
        ([1.0, 2.0], {"kind": "curve", "x": [0]}, "2 values at 1 places"),
        ([0.0], {"kind": "polynomial"}, "zero polynomial"),
        (1.0, {"holds": lambda x: {}, "wrong": {"a": 2}}, "say the conditions"),
    ],
)
def test_an_author_is_told(value, told, words):
    with pytest.raises(SheetError, match=words.replace("(", r"\(")):
        asked(value, **told)


def test_a_reason_is_half_of_a_choice_and_its_letter_says_nothing():
    told = {"reason": "right", "reasons": ["right", "wrong", "worse"]}
    one = asked(False, **told)
    letter = one.key[1]
    assert one.kind.letters[letter] == "right" and one.right(one.kind.read(["no", letter]))
    assert one.right(one.kind.read(f"no, ({letter})")) and not one.right(one.kind.read("no"))
    assert one.kind.right_without_reason(one.kind.read("no"), one.key)
    letters = [asked(True, reason=f"r{i}", reasons=[f"r{i}", f"s{i}", f"t{i}"]).key[1] for i in range(40)]
    assert set(letters) == {"a", "b", "c"}


def test_numbers_that_make_no_exercise_are_drawn_again():
    with during(Session()):
        with pytest.raises(Redraw, match='"w" gives nearly the right value'):
            answer("x", 1.0, wrong={"w": 1.01})
        with pytest.raises(Redraw, match="is 0"):
            answer("y", 0.0)
        with pytest.raises(Redraw, match="the key itself fails: it is small"):
            answer("z", 9.0, holds=lambda v: {"it is small": v < 5})


def test_conditions_decide_where_they_are_given():
    one = asked([1.0, 2.0], holds=lambda a, b: {"they rise": b > a, "they are small": b < 9})
    assert one.right((3.0, 4.0)) and not one.right((4.0, 3.0)) and not one.right((3.0, 11.0))


def test_later_cells_go_on_with_the_answer_in_the_author_s_form():
    import numpy as np

    with during(Session(own={"a": [2.0, 3.0], "b": "nonsense", "c": "no", "d": [1, 5]}, strict=False)):
        assert isinstance(answer("a", np.array([1.0, 2.0])), np.ndarray)
        assert answer("b", 4.5) == 4.5
        assert answer("c", True) is False
        assert answer("d", (1.0, 2.0)) == (1.0, 5.0)


@given(st.floats(1e-5, 1e6), st.integers(2, 6))
def test_a_number_rounded_to_the_digits_asked_for_is_right(value, digits):
    tolerance = read_tolerance(digits)
    assert tolerance.within(float(f"{value:.{digits}g}"), value)
    shown = float(shown_number(value, digits).replace("−", "-"))
    assert abs(shown - value) <= 0.5000001 * 10.0 ** (math.floor(math.log10(value)) - digits + 1) * 10
