"""Routh's array, the stability conditions it gives, and the ultimate gain and period of a loop.

For a polynomial a0 s^n + ... + an with a0 > 0 all roots lie in the open left half-plane exactly if every element of
the array's first column is positive. The array is built with symbols, so it gives conditions, not only answers.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp
from sympy import Expr

from derivations.errors import LoopbookError

s = sp.Symbol("s")
K = sp.Symbol("K", positive=True)
omega = sp.Symbol("omega", positive=True)


class NoUltimateGain(LoopbookError):
    """The proportional loop never reaches the border of stability for a positive gain."""


def array(polynomial: Expr, variable: sp.Symbol = s) -> sp.Matrix:
    """Routh's array of a polynomial, one row per power, exact.

    Raises ZeroDivisionError where an element of the first column is identically zero while the array still needs it:
    roots lie symmetrically about the origin, and the plain array does not decide.

    >>> array(2 * s**3 + 5 * s**2 + 2 * s + 1)
    Matrix([
    [  2, 2],
    [  5, 1],
    [8/5, 0],
    [  1, 0]])
    """
    coefficients = sp.Poly(polynomial, variable).all_coeffs()
    width = (len(coefficients) + 1) // 2
    rows = [coefficients[i::2] + [sp.Integer(0)] * (width - len(coefficients[i::2])) for i in (0, 1)]
    for power in range(len(coefficients) - 3, -1, -1):
        above, last = rows[-2:]
        if last[0] == 0:
            raise ZeroDivisionError(f"the array's first column has a zero above the row of {variable}**{power}")
        cross = [last[0] * above[j + 1] - above[0] * last[j + 1] for j in range(width - 1)]
        rows.append([sp.factor(c / last[0]) for c in cross] + [sp.Integer(0)])
    return sp.Matrix(rows[: len(coefficients)])


def first_column(polynomial: Expr, variable: sp.Symbol = s) -> list[Expr]:
    """The elements that must all be positive (for a positive leading coefficient)."""
    return [sp.factor(e) for e in array(polynomial, variable)[:, 0]]


def is_stable(polynomial: Expr, variable: sp.Symbol = s) -> bool:
    """Are all roots of a polynomial with numeric coefficients in the open left half-plane?

    >>> is_stable(s**3 + 2 * s**2 + 2 * s + 5), is_stable(s**3 + 3 * s**2 + 2 * s + 5)
    (False, True)
    """
    try:
        signs = [sp.sign(e) for e in first_column(polynomial, variable)]
    except ZeroDivisionError:
        return False
    return all(x == signs[0] and x != 0 for x in signs)


def closed_loop(numerator: Expr, denominator: Expr, gain: Expr = K) -> Expr:
    """Characteristic polynomial of a proportional loop: denominator + gain * numerator."""
    return sp.expand(denominator + gain * numerator)


@dataclass(frozen=True)
class Ultimate:
    """Border of stability of a proportional loop: gain [u/y], angular frequency [rad/s] and period [s], exact."""

    gain: Expr
    frequency: Expr

    @property
    def period(self) -> Expr:
        return 2 * sp.pi / self.frequency


@cache
def ultimate(numerator: Expr, denominator: Expr) -> Ultimate:
    """The smallest positive gain at which the proportional loop around numerator/denominator has roots +-i omega.

    At the border the characteristic polynomial vanishes at s = i omega: its real and its imaginary part are two
    equations for the gain and the frequency. Routh's first column gives the same gain (a test holds them equal).
    Raises NoUltimateGain where no positive gain does (for example one lag or two lags without dead time).

    >>> found = ultimate(sp.Integer(3), 2 * s**3 + 5 * s**2 + 2 * s + 1)
    >>> found.gain, found.frequency, found.period
    (4/3, 1, 2*pi)
    """
    imaginary = sp.expand(closed_loop(numerator, denominator).subs(s, sp.I * omega))
    real_part, imaginary_part = sp.re(imaginary), sp.im(imaginary)
    found = []
    for solution in sp.solve([real_part, imaginary_part], [K, omega], dict=True):
        pair = solution.get(K), solution.get(omega)
        if None not in pair and all(p.is_number and p.is_real and p > 0 for p in pair):
            found.append(Ultimate(*pair))
    if not found:
        raise NoUltimateGain(f"no positive gain brings {denominator} + K ({numerator}) to the border of stability")
    return min(found, key=lambda u: float(u.gain))
