"""From a converter's number to a quantity and back: the line through two points, as two operations without a state.

measurement(raw) = low + (raw - raw_low) (high - low)/(raw_high - raw_low)
actuator(u) = raw_low + (u - low) (raw_high - raw_low)/(high - low)
"""

from functools import cache

from sympy import Expr, Rational, Symbol

from derivations.algebra.rational import solved_for, vanishes
from derivations.programs.form import Assign, Operation, Variable
from derivations.programs.frozen import Minus, Over, Plus, Times, constant, thawed

x, x1, x2, y, y1, y2 = (Symbol(n) for n in ("x", "x_1", "x_2", "y", "y_1", "y_2"))
scaled = Symbol("scaled")


@cache
def line() -> Expr:
    """y1 + (x - x1)(y2 - y1)/(x2 - x1), as it is computed: both ends come out exactly but for one rounding.

    >>> line()
    Plus(y_1, Over(Times(Minus(x, x_1), Minus(y_2, y_1)), Minus(x_2, x_1)))
    """
    tree = Plus(y1, Over(Times(Minus(x, x1), Minus(y2, y1)), Minus(x2, x1)))
    if not vanishes(thawed(tree) - solved_for(y, (y - y1) * (x2 - x1), (x - x1) * (y2 - y1))):
        raise ArithmeticError(f"{tree} is not the line through two points")
    return tree


def operation(name: str, about: str, argument: Variable, ends: tuple[tuple[Rational, Rational], ...]) -> Operation:
    """A line as an operation. ends: ((x1, x2), (y1, y2))."""
    (first, last), (low, high) = ((constant(a), constant(b)) for a, b in ends)
    values = {x: argument.symbol, x1: first, x2: last, y1: low, y2: high}
    return Operation(
        name,
        about,
        (Assign(scaled, line().xreplace(values)),),
        arguments=(argument,),
        locals=(Variable(scaled),),
        result=scaled,
        pure=True,
    )
