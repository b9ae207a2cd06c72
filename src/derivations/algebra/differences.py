"""Difference approximations as operators on a continuous law: substitute, solve for the newest sample, name the gains.

A continuous law is an equation between signals ``s(t)`` and their first derivatives. A difference says what stands,
at sample k, for a signal and what for its derivative:

    forward    s(t) -> s(t_k)                       s'(t) -> (s(t_{k+1}) - s(t_k)) / h
    backward   s(t) -> s(t_k)                       s'(t) -> (s(t_k) - s(t_{k-1})) / h
    Tustin     s(t) -> (s(t_k) + s(t_{k-1})) / 2    s'(t) -> (s(t_k) - s(t_{k-1})) / h

Source: pid-report, sections 4.2.2 (forward) and 4.2.4 (backward); Tustin is the trapezoidal rule.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from sympy import Add, Derivative, Eq, Expr, Function, Rational, Symbol, collect, expand, factor
from sympy.core.function import AppliedUndef

from derivations.algebra.equality import both_sides, equality
from derivations.algebra.rational import solved_for, vanishes

h = Symbol("h", positive=True)
t = Symbol("t", real=True)
_INSTANTS = {-1: Symbol("t_{k-1}"), 0: Symbol("t_k"), 1: Symbol("t_{k+1}")}


@dataclass(frozen=True)
class Difference:
    """What stands for a signal and for its derivative: weights by sample offset; the slope's are divided by h."""

    name: str
    value: Mapping[int, Expr]
    slope: Mapping[int, Expr]


FORWARD = Difference("forward", {0: Rational(1)}, {1: Rational(1), 0: Rational(-1)})
BACKWARD = Difference("backward", {0: Rational(1)}, {0: Rational(1), -1: Rational(-1)})
TUSTIN = Difference("Tustin", {0: Rational(1, 2), -1: Rational(1, 2)}, {0: Rational(1), -1: Rational(-1)})


def at(signal: str, offset: int = 0) -> Expr:
    """One sample of a signal: ``at("y", -1)`` is ``y(t_{k-1})``."""
    return Function(signal)(_INSTANTS[offset])


def discretise(law: Eq, difference: Difference) -> Eq:
    """Replace every signal and every first derivative in a continuous law.

    law: equation in functions of t. Raises ValueError where a derivative of higher order remains.

    >>> y, yf, Tf = Function("y"), Function("y_f"), Symbol("T_f", positive=True)
    >>> discretise(Eq(Tf * yf(t).diff(t), y(t) - yf(t)), BACKWARD)
    Eq(T_f*(y_f(t_k) - y_f(t_{k-1}))/h, y(t_k) - y_f(t_k))
    """

    def mean(signal: AppliedUndef) -> Expr:
        return Add(*(w * at(signal.func.__name__, n) for n, w in difference.value.items()))

    def slope(derivative: Derivative) -> Expr:
        if derivative.derivative_count != 1:
            raise ValueError(f"{derivative}: only first derivatives have a {difference.name} difference here")
        return Add(*(w * at(derivative.expr.func.__name__, n) for n, w in difference.slope.items())) / h

    slopes = {d: slope(d) for d in law.atoms(Derivative)}
    means = {f: mean(f) for f in law.atoms(AppliedUndef) if f.args == (t,)}
    return both_sides(lambda side: side.xreplace(slopes | means), law)


def by_signals(expr: Expr) -> dict[Expr, Expr]:
    """The coefficient of each sample in a linear expression, each as one fraction in factors."""
    expr = expand(expr)
    return {s: factor(expr.coeff(s)) for s in sorted(expr.atoms(AppliedUndef), key=str)}


def update(law: Eq, state: str, difference: Difference) -> Eq:
    """The recursion for one signal: discretise the law and solve it for the newest sample of ``state``.

    The right-hand side is a sum of gain times sample.

    >>> I, e = Function("I"), Function("e")
    >>> update(Eq(I(t).diff(t), e(t)), "I", FORWARD)
    Eq(I(t_{k+1}), h*e(t_k) + I(t_k))
    """
    equation = discretise(law, difference)
    newest = at(state, 1) if equation.has(at(state, 1)) else at(state)
    gains = by_signals(solved_for(newest, *equation.args))
    return equality(newest, Add(*(gain * sample for sample, gain in gains.items())))


def name_gains(equation: Eq, names: Mapping[Symbol, Expr]) -> tuple[dict[Symbol, Expr], Eq]:
    """Give gains of an update a name, so that they are computed only when a setting changes.

    names: for each name a sample whose gain it shall stand for. A gain that is not plus or minus a named one is
    expressed through the first name by eliminating h. Returns the definitions and the shorter equation; each
    rewriting is proven (the difference vanishes), else ValueError.
    """
    gains = by_signals(equation.rhs)
    defined = {name: gains[sample] for name, sample in names.items()}

    def short(gain: Expr) -> Expr:
        for name, value in defined.items():
            for sign in (1, -1):
                if vanishes(gain - sign * value):
                    return sign * name
        name, value = next(iter(defined.items()))
        through = factor(gain.subs(h, solved_for(h, name, value))) if value.has(h) and gain.has(h) else gain
        if not vanishes(through.subs(name, value) - gain):
            raise ValueError(f"the gain {gain} cannot be written with {name} = {value}")
        return through

    terms = Add(*(short(gain) * sample for sample, gain in gains.items()))
    return defined, equality(equation.lhs, collect(terms, list(defined)))
