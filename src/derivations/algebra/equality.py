"""Equalities as they stand: built, and changed on both sides, without asking whether the sides are equal.

`sympy.Eq` tries to decide that each time an equality is built or substituted into. A law says that its sides are equal,
so there is nothing to decide, and for signals and samples the attempt takes longer than the derivation.
"""

from collections.abc import Callable

from sympy import Eq, Expr


def equality(left: Expr, right: Expr) -> Eq:
    """left = right, also where SymPy could see that it is true or false.

    >>> from sympy.abc import x
    >>> equality(x, x)
    Eq(x, x)
    """
    return Eq(left, right, evaluate=False)


def both_sides(change: Callable[[Expr], Expr], law: Eq) -> Eq:
    """The law with the same change made to its left and to its right side.

    >>> from sympy.abc import x, y
    >>> both_sides(lambda side: side.diff(x), equality(y, x**2))
    Eq(0, 2*x)
    """
    return equality(change(law.lhs), change(law.rhs))
