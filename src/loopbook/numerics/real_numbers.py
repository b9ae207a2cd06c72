"""The numbers people have, as Python's own: taken at the door, or refused there in one sentence.

int, float, Fraction, Decimal, NumPy scalars and arrays of one, SymPy numbers. What is exact stays exact: a Decimal
and a SymPy rational become a Fraction, a NumPy integer an int. What is rounded becomes a float, so that nothing goes
on in single precision or in whole numbers that overflow.
"""

import math
import numbers
from decimal import Decimal
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np

Number: TypeAlias = Any
"""A real number of any kind that adds, multiplies and compares: int, float, Fraction, NumPy's single precision."""

LONGEST = 60
EXPECTED = "a real number is expected (int, float, Fraction, Decimal, a NumPy or SymPy number)"


def in_a_sentence(value: Any) -> str:
    """The value as a sentence can show it: its repr, cut where that is long.

    >>> len(in_a_sentence(10**400)) <= LONGEST
    True
    """
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]} ..."


def plain_number(value: Any) -> int | float | Fraction:
    """The same number as an int, a float or a Fraction. Raises TypeError for anything that is no real number.

    >>> from decimal import Decimal
    >>> plain_number(np.int64(3)), plain_number(Decimal("0.1")), plain_number(np.float32(0.5))
    (3, Fraction(1, 10), 0.5)
    """
    kind = type(value)
    if kind is float or kind is int or kind is Fraction:
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        return plain_number(value.item())
    if isinstance(value, bool | np.bool_ | str | bytes):
        raise TypeError(f"{in_a_sentence(value)} is no number: {EXPECTED}")
    if isinstance(value, Decimal):
        return Fraction(value) if value.is_finite() else float(value)
    if isinstance(value, np.integer):
        return int(value)
    if getattr(value, "is_Rational", False):
        return Fraction(int(value.p), int(value.q))
    if isinstance(value, numbers.Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    if isinstance(value, numbers.Real) or (getattr(value, "is_extended_real", False) and value.is_number):
        return float(value)
    raise TypeError(f"{in_a_sentence(value)} is a {kind.__name__}: {EXPECTED}")


def real(value: Any, name: str, error: type[ValueError] = ValueError, unit: str = "") -> float:
    """The same number as a finite float. Raises `error` with the name, the value and what is expected.

    >>> from decimal import Decimal
    >>> real(Decimal("2.5"), "h")
    2.5
    """
    try:
        number = float(plain_number(value))
    except (TypeError, OverflowError):
        raise error(f"{name} = {in_a_sentence(value)}: {EXPECTED}") from None
    if not math.isfinite(number):
        raise error(
            f"{name} = {in_a_sentence(value)}: a finite number{' of seconds' if unit == ' s' else ''} is expected"
        )
    return number


def positive(value: Any, name: str, error: type[ValueError] = ValueError, unit: str = "") -> float:
    """The same number as a finite float above zero. Raises `error` otherwise.

    >>> positive(3, "h")
    3.0
    """
    number = real(value, name, error, unit)
    if not number > 0:
        raise error(f"{name} = {in_a_sentence(value)}{unit} must be positive")
    return number


def whole(value: Any, name: str, error: type[ValueError] = ValueError, least: int = 0) -> int:
    """The same number as an int, `least` or more. Raises `error` for fractions, text and truth values.

    >>> whole(np.int64(3), "order")
    3
    """
    try:
        number = plain_number(value)
    except TypeError:
        number = None
    if not isinstance(number, int | Fraction) or number != int(number) or number < least:
        raise error(f"{name} = {in_a_sentence(value)}: a whole number, {least} or more, is expected")
    return int(number)


def complex_number(value: Any, name: str, error: type[ValueError] = ValueError) -> complex:
    """The same number as a finite complex one. Raises `error` for anything else.

    >>> complex_number(Fraction(1, 2), "pole")
    (0.5+0j)
    """
    symbolic = getattr(value, "is_number", False) and not getattr(value, "is_real", True)
    if isinstance(value, complex | np.complexfloating) or symbolic:
        number = complex(value)
        if math.isfinite(number.real) and math.isfinite(number.imag):
            return number
        raise error(f"{name} = {in_a_sentence(value)}: a finite number is expected")
    return complex(real(value, name, error))


def real_array(values: Any, name: str, error: type[ValueError] = ValueError) -> np.ndarray:
    """The same numbers as an array of finite floats, of any shape. Raises `error` for text, complex numbers and NaN.

    >>> real_array([1, Fraction(1, 2)], "t").tolist()
    [1.0, 0.5]
    """
    array = np.asarray(values)
    if array.dtype.kind == "O":
        found = np.array([real(value, f"{name}[{i}]", error) for i, value in enumerate(array.flat)])
        return found.reshape(array.shape)
    if array.dtype.kind not in "iufb":
        raise error(f"{name} = {in_a_sentence(values)}: {EXPECTED}")
    found = array.astype(float, copy=False)
    if not np.isfinite(found).all():
        first = int(np.flatnonzero(~np.isfinite(found))[0])
        raise error(f"{name}[{first}] = {found.flat[first]:g}: a finite number is expected")
    return found
