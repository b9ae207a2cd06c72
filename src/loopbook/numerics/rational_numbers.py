"""Exact numbers for derived expressions: decimals as they are written, functions that keep fractions fractions."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import isfinite
from typing import Any


def decimal(value: Any) -> Fraction:
    """The number that was written: the shortest decimal that reads back as this float; exact types pass unchanged.

    Raises ValueError for NaN and infinity.

    >>> decimal(0.014), decimal(Fraction(1, 3)), decimal("1.526e-06")
    (Fraction(7, 500), Fraction(1, 3), Fraction(763, 500000000))
    """
    if isinstance(value, Fraction | int):
        return Fraction(value)
    if isinstance(value, str):
        return Fraction(value)
    if not isfinite(value):
        raise ValueError(f"{value} is not a finite number")
    return Fraction(repr(float(value)))


def rational(expression: Any, digits: int = 40) -> Fraction:
    """A SymPy number as a fraction: exactly where it is rational, else to that many significant digits.

    Raises ValueError where the expression still has symbols or is not real.

    >>> import sympy
    >>> rational(sympy.Rational(1, 3)), float(rational(sympy.exp(-1))) == 0.36787944117144233
    (Fraction(1, 3), True)
    """
    import sympy

    expression = sympy.sympify(expression, strict=True)
    if expression.free_symbols:
        raise ValueError(f"{expression} has no value before {sorted(map(str, expression.free_symbols))} have one")
    if not expression.is_Rational:
        expression = sympy.N(expression, digits)
        if not expression.is_real or not expression.is_finite:
            raise ValueError(f"{expression} is not a finite real number")
        expression = sympy.Rational(str(expression))
    return Fraction(int(expression.p), int(expression.q))


def function(symbols: Sequence[Any], expressions: Any) -> Callable:
    """lambdify that is exact: with int and Fraction arguments and rational operations the result is a Fraction.

    symbols: arguments in order. expressions: one SymPy expression or a sequence of them. Floats give floats.

    >>> from sympy.abc import x
    >>> function([x], x / 3 + 1)(Fraction(1, 2)), function([x], x / 4)(0.5)
    (Fraction(7, 6), 0.125)
    """
    import sympy
    from sympy.printing.lambdarepr import LambdaPrinter

    class Printer(LambdaPrinter):
        def _print_Rational(self, number: Any) -> str:
            return f"Fraction({number.p}, {number.q})"

        def _print_Integer(self, number: Any) -> str:
            return f"Fraction({int(number)})"

        def _print_Pow(self, power: Any, **_: Any) -> str:
            base, exponent = power.args
            if exponent.is_Integer:  # a Fraction as an exponent would turn the result into a float
                return f"({self._print(base)})**({int(exponent)})"
            return f"({self._print(base)})**({self._print(exponent)})"

    return sympy.lambdify(
        list(symbols), expressions, modules=[{"Fraction": Fraction}, "math"], printer=Printer, cse=True
    )
