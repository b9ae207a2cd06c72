"""The RST regulator as a program runs it, with the observer form that keeps it from winding up.

    R(z) u = T(z) r - S(z) y            polynomials in z^-1, R starting with 1

Adding (A_o - R) u on both sides, for any stable A_o starting with 1, and taking the u that the actuator delivered,

    A_o(z) v = T(z) r - S(z) y + (A_o(z) - R(z)) u,        u = sat(v)

Without saturation u = v and the law is the first one. In saturation the regulator's own poles, an integrator among
them, no longer run free: v follows its inputs with the poles of A_o.
"""

from functools import cache

from sympy import Eq, Symbol

from derivations.algebra.delay_polynomials import difference_equation, polynomial


def _symbols(letter: str, first: int, degree: int) -> list[Symbol]:
    return [Symbol(f"{letter}_{i}") for i in range(first, degree + 1)]


@cache
def law(r: int, s: int, t: int, o: int = 0) -> Eq:
    """v(k) in the symbols r_1.., s_0.., t_0.., o_1.. for polynomials of the degrees given; o = 0 means A_o = 1.

    >>> law(1, 0, 0, 0)
    Eq(v(k), -r_1*u(k - 1) - s_0*y(k) + t_0*r(k))
    """
    R = polynomial([1, *_symbols("r", 1, r)])
    S, T = polynomial(_symbols("s", 0, s)), polynomial(_symbols("t", 0, t))
    A_o = polynomial([1, *_symbols("o", 1, o)])
    return difference_equation(("v", A_o), {"r": T, "u": A_o - R, "y": -S})
