"""Arithmetic with its order of operations: binary nodes that SymPy prints and never rearranges.

Rounding depends on the order of operations. `freeze` turns a derived expression into a tree of Plus, Minus, Times, Over
and Negative, in one order that depends on the expression alone; `thawed` turns it back, and `freeze` has shown that
both are equal before it returns. A condition is a Relation of two such trees, or Both, Either, Unless of conditions:
SymPy's own would turn ``not a > b`` into ``a <= b``, which is another thing where a is not a number.
"""

from collections.abc import Iterable
from functools import reduce

from sympy import Add, Basic, Expr, Integer, Mul, Pow, Rational, Symbol, fraction
from sympy.core.symbol import Str
from sympy.logic.boolalg import false, true

from derivations.algebra.rational import vanishes
from derivations.errors import LoopbookError

TRUE, FALSE = true, false


class OrderError(LoopbookError):
    """An expression that these nodes cannot hold; the message shows it."""


class FrozenOperation(Expr):
    """One operation of the machine on one or two operands."""

    @property
    def operands(self) -> tuple[Expr, ...]:
        return self.args


class Plus(FrozenOperation):
    """left + right."""


class Minus(FrozenOperation):
    """left - right."""


class Times(FrozenOperation):
    """left * right."""


class Over(FrozenOperation):
    """left / right."""


class Negative(FrozenOperation):
    """-operand."""


class Element(Expr):
    """One place of a ring buffer: Element(buffer, index), index counted from zero."""


class Whole(Expr):
    """Whole(Integer(n)): a whole number that counts or points, not one that is computed with."""


class Condition(Basic):
    """True or false."""


class Relation(Condition):
    """Relation(Str(sign), left, right), sign one of < <= > >= == !=."""


class Both(Condition):
    """left and right."""


class Either(Condition):
    """left or right."""


class Unless(Condition):
    """not operand."""


def relation(left: Expr, sign: str, right: Expr | int) -> Relation:
    """A comparison, as in ``relation(v, ">", u_high)``."""
    if sign not in ("<", "<=", ">", ">=", "==", "!="):
        raise OrderError(f"{sign}: one of < <= > >= == != is expected")
    return Relation(Str(sign), left, Integer(right) if isinstance(right, int) else right)


def all_of(*conditions: Basic) -> Basic:
    """All of the conditions hold."""
    return reduce(Both, conditions)


def any_of(*conditions: Basic) -> Basic:
    """At least one of the conditions holds."""
    return reduce(Either, conditions)


def finite(*values: Expr) -> Basic:
    """Neither NaN nor infinite, each: x - x is 0 only for a finite x."""
    return all_of(*(relation(Minus(value, value), "==", 0) for value in values))


def freeze(expr: Expr, first: Expr | None = None) -> Expr:
    """A derived expression in the order in which it is computed.

    Sums from left to right, positive terms first and alphabetically, products likewise, then one division. first: a
    symbol that stands alone in a sum: ``first + (all the rest)``, so that an increment is computed before it is added.
    Raises OrderError for anything but + - * / and whole powers of symbols and rational numbers.

    >>> a, b, c = (Symbol(n) for n in "abc")
    >>> freeze(a - b * c + c / b**2)
    Minus(Plus(a, Over(c, Times(b, b))), Times(b, c))
    """
    tree = _frozen(expr) if first is None else Plus(first, _frozen(_collected(expr - first)))
    if not vanishes(thawed(tree) - expr):
        raise OrderError(f"{expr} was ordered as {tree}, which is not the same")
    return tree


def constant(value: Expr) -> Expr:
    """An exact number as a node; a negative one is the negative of a positive one.

    >>> constant(Rational(-1, 2))
    Negative(1/2)
    """
    return Negative(-value) if value < 0 else value


def thawed(tree: Expr) -> Expr:
    """The expression that a tree computes, for SymPy to work with.

    >>> a, b = Symbol("a"), Symbol("b")
    >>> thawed(Minus(Plus(a, b), b)), thawed(constant(Rational(-1, 2)))
    (a, -1/2)
    """
    if not isinstance(tree, FrozenOperation):
        return tree
    parts = [thawed(part) for part in tree.operands]
    if isinstance(tree, Negative):
        return -parts[0]
    left, right = parts
    if isinstance(tree, Plus):
        return left + right
    if isinstance(tree, Minus):
        return left - right
    return left * right if isinstance(tree, Times) else left / right


def _collected(expr: Expr) -> Expr:
    """The rest of a sum as its terms stand, not multiplied out."""
    return Add(*(term for term in Add.make_args(expr) if term != 0))


def _frozen(expr: Expr) -> Expr:
    if isinstance(expr, Symbol | Integer | FrozenOperation | Element | Whole):
        return Negative(Integer(-expr)) if isinstance(expr, Integer) and expr < 0 else expr
    if isinstance(expr, Add):
        return _sum(expr.args)
    if isinstance(expr, Mul | Pow | Rational):
        if expr.could_extract_minus_sign():
            return Negative(_frozen(-expr))
        return _fraction(expr)
    raise OrderError(f"{expr}: only + - * / and whole powers have an order here")


def _sum(terms: Iterable[Expr]) -> Expr:
    ordered = sorted(terms, key=lambda term: (term.could_extract_minus_sign(), str(term)))
    first, *rest = ordered
    tree = _frozen(first)
    for term in rest:
        tree = Minus(tree, _frozen(-term)) if term.could_extract_minus_sign() else Plus(tree, _frozen(term))
    return tree


def _fraction(expr: Expr) -> Expr:
    above, below = fraction(expr)
    numerator = _product(above)
    return numerator if below == 1 else Over(numerator, _product(below))


def _product(expr: Expr) -> Expr:
    factors: list[Expr] = []
    for factor in expr.as_ordered_factors() if isinstance(expr, Mul) else (expr,):
        base, power = factor.as_base_exp()
        if not (power.is_Integer and power > 0):
            raise OrderError(f"{factor}: only whole powers have an order here")
        factors += [base] * int(power)
    frozen = [_frozen(factor) for factor in factors if factor != 1] or [Integer(1)]
    return reduce(Times, frozen)


def operations(tree: Basic) -> set[str]:
    """The names of all operations in a tree: what a processor must be able to do."""
    return {type(node).__name__ for node in _nodes(tree) if isinstance(node, FrozenOperation)}


def _nodes(tree: Basic) -> Iterable[Basic]:
    yield tree
    for part in tree.args:
        yield from _nodes(part)
