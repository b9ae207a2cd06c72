"""A derived transfer function with numbers put in: the `Process` that runs is the expression that is shown."""

from collections.abc import Mapping
from typing import Any

from loopbook.numerics.rational_numbers import decimal
from loopbook.process.transfer_function import Process, ProcessError


def process_of(expression: Any, values: Mapping[Any, Any], s: Any = None) -> Process:
    """The process of a SymPy expression num(s)/den(s) exp(-L s).

    values: symbol or its name -> number; a float counts as the decimal that it is written as.
    s: the Laplace variable; default the symbol named "s".
    Raises ProcessError where a symbol is left, or the expression is no rational function times one exponential.

    >>> import sympy
    >>> s, T = sympy.symbols("s T")
    >>> process_of(sympy.exp(-2 * s) / (T * s + 1), {"T": 5})
    Process(num=(1.0,), den=(5.0, 1.0), delay=2.0)
    """
    import sympy

    s = sympy.Symbol("s") if s is None else s
    named = {str(name): _number(value) for name, value in values.items()}
    expression = sympy.sympify(expression, strict=True).subs(
        {x: named[x.name] for x in expression.free_symbols if x.name in named}
    )
    left = expression.free_symbols - {s}
    if left:
        raise ProcessError(f"no value for {', '.join(sorted(map(str, left)))}; given: {', '.join(named) or 'none'}")
    factors = sympy.Mul.make_args(sympy.powsimp(sympy.factor(expression)))
    exponents = [factor.args[0] for factor in factors if isinstance(factor, sympy.exp)]
    delay = -sum((sympy.cancel(exponent / s) for exponent in exponents), sympy.S.Zero)
    num, den = sympy.fraction(sympy.Mul(*(factor for factor in factors if not isinstance(factor, sympy.exp))))
    if delay.has(s) or not (num.is_polynomial(s) and den.is_polynomial(s)):
        raise ProcessError(f"{expression} is no rational function of {s} times exp(-L {s})")
    num, den = (sympy.Poly(p, s).all_coeffs() for p in (num, den))
    last = den[-1] if den[-1] != 0 else den[0]
    return Process(tuple(float(c / last) for c in num), tuple(float(c / last) for c in den), float(delay))


def _number(value: Any) -> Any:
    import sympy

    if isinstance(value, sympy.Basic):
        return value
    exact = decimal(value)
    return sympy.Rational(exact.numerator, exact.denominator)
