"""Polynomials in the delay operator z^-1, exact, and the difference equations they stand for.

A(z) = 1 + a1 z^-1 + a2 z^-2 is written as a SymPy expression in negative powers of z. `coefficients` turns it into the
list [1, a1, a2], position = number of delays; `polynomial` turns the list back. Numbers are exact or they are refused.
"""

from collections.abc import Sequence

import sympy as sp

from derivations.errors import LoopbookError

Z = sp.Symbol("z")
K = sp.Symbol("k", integer=True)


class DelayPolynomialError(LoopbookError):
    """An expression is not an exact polynomial in z^-1. Attributes: name (of the polynomial), expression."""

    def __init__(self, name: str, expression: sp.Expr, why: str):
        self.name, self.expression = name, expression
        text = str(expression)
        super().__init__(f"{name} = {text if len(text) < 200 else text[:200] + '...'}: {why}")


def coefficients(expression: sp.Expr, name: str = "polynomial", z: sp.Symbol = Z) -> list[sp.Expr]:
    """[p0, p1, ..., pn] of p0 + p1 z^-1 + ... + pn z^-n; pn is not zero, the zero polynomial is [].

    Raises DelayPolynomialError for floating-point numbers, positive powers of z and anything that is not a polynomial.

    >>> coefficients((1 - Z**-1) * (1 + Z**-2))
    [1, -1, 1, -1]
    """
    expression = sp.sympify(expression, strict=True)
    if expression.has(sp.Float):
        value = min(expression.atoms(sp.Float), key=str)
        text = str(sp.Float(value, 15)).rstrip("0")
        raise DelayPolynomialError(
            name, expression, f"exact numbers only, write Rational('{text}') for {text} or use sympy.nsimplify"
        )
    w = sp.Dummy("w")
    in_w = expression.xreplace({z: 1 / w})
    if (found := _as_written(in_w, w)) is not None:
        return found
    if not in_w.is_polynomial(w):
        in_w = sp.cancel(sp.together(in_w))
    if not in_w.is_polynomial(w):
        raise DelayPolynomialError(
            name, expression, f"must be a polynomial in {z}^-1 (powers {z}^0, {z}^-1, {z}^-2, ...), not in {z}"
        )
    return _trimmed([sp.sympify(c, strict=True) for c in reversed(sp.Poly(in_w, w).all_coeffs())])


def _trimmed(values: list[sp.Expr]) -> list[sp.Expr]:
    while values and values[-1] == 0:
        values.pop()
    return values


def _as_written(in_w: sp.Expr, w: sp.Symbol) -> list[sp.Expr] | None:
    """The coefficients of a plain sum of c w^i, each left as it is written; None for any other form."""
    found: dict[int, sp.Expr] = {}
    for term in sp.Add.make_args(in_w):
        c, power = term.as_independent(w, as_Add=False)
        base, exponent = power.as_base_exp()
        if power != 1 and not (base == w and exponent.is_Integer and exponent > 0):
            return None
        i = 0 if power == 1 else int(exponent)
        found[i] = found.get(i, sp.S.Zero) + c
    return _trimmed([found.get(i, sp.S.Zero) for i in range(max(found) + 1)])


def polynomial(values: Sequence[sp.Expr], z: sp.Symbol = Z) -> sp.Expr:
    """The expression p0 + p1 z^-1 + ... of a list of coefficients.

    >>> polynomial([1, 0, 3])
    1 + 3/z**2
    """
    return sp.Add(*(sp.sympify(c, strict=True) * z**-i for i, c in enumerate(values)))


def in_delays(transfer: sp.Expr, z: sp.Symbol = Z) -> tuple[sp.Expr, sp.Expr]:
    """(A, B) with transfer = B/A, both in z^-1, A starting with 1, of a proper rational function of z.

    Raises DelayPolynomialError where numerator and denominator are not polynomials or the degree of the numerator is
    the larger one (the output would depend on future inputs).

    >>> in_delays((2 * Z + 1) / (2 * Z**2 - Z))
    (1 - 1/(2*z), 1/z + 1/(2*z**2))
    """
    transfer = sp.sympify(transfer, strict=True)
    num, den = sp.fraction(sp.cancel(sp.together(transfer)))
    if not (num.is_polynomial(z) and den.is_polynomial(z)):
        raise DelayPolynomialError("transfer function", transfer, f"must be a rational function of {z}")
    num, den = sp.Poly(num, z), sp.Poly(den, z)
    if num.degree() > den.degree():
        raise DelayPolynomialError(
            "transfer function", transfer, "needs future inputs: its numerator is of higher degree"
        )
    lead, n = den.LC(), den.degree()
    return tuple(sp.expand(sp.cancel(p.as_expr() / lead) * z**-n) for p in (den, num))


def difference_equation(
    own: tuple[str, sp.Expr], inputs: dict[str, sp.Expr], k: sp.Symbol = K, z: sp.Symbol = Z
) -> sp.Eq:
    """Solve  own polynomial * own signal = sum of input polynomial * input signal  for the newest own sample.

    own: ("y", A) with A starting with 1. inputs: {"u": B}. Terms are ordered by signal and delay.
    Raises DelayPolynomialError where the own polynomial does not start with 1.

    >>> a, b = sp.symbols("a b")
    >>> difference_equation(("y", 1 + a / Z), {"u": b / Z**2})
    Eq(y(k), -a*y(k - 1) + b*u(k - 2))
    """
    name, own_polynomial = own
    lead, *rest = coefficients(own_polynomial, name, z) or [sp.S.Zero]
    if sp.cancel(lead - 1) != 0:
        raise DelayPolynomialError(name, own_polynomial, f"must start with 1 to be solved for {name}({k}), not {lead}")
    signal = sp.Function(name)
    terms = [-c * signal(k - i) for i, c in enumerate(rest, start=1)]
    for other, values in inputs.items():
        terms += [c * sp.Function(other)(k - i) for i, c in enumerate(coefficients(values, other, z))]
    return sp.Eq(signal(k), sp.Add(*terms), evaluate=False)
