"""A first-order process under a held input, as one solves it on paper: what is left of the start, and an integral.

    T y' = -y + K u      becomes      y(t_{k+1}) = a y(t_k) + K (1 - a) u(t_k),      a = e^(-h/T)

for an input that stands still from t_k to t_{k+1} = t_k + h. Times in s. `derivations.sampling.zero_order_hold` does it
for any linear process; here every step can be shown.
"""

from functools import cache

from sympy import Add, Eq, Expr, Function, Integral, Symbol, collect, exp, expand, powsimp, simplify

from derivations.algebra.differences import FORWARD, at, by_signals, h, t, update
from derivations.algebra.equality import equality
from derivations.algebra.rational import factored, solved_for
from derivations.pid.pid_laws import tau, u, y

K = Symbol("K", real=True)
T = Symbol("T", positive=True)
w = Function("w")


@cache
def law() -> Eq:
    """T y' = -y + K u."""
    return equality(T * y(t).diff(t), K * u(t) - y(t))


@cache
def weighted() -> tuple[Eq, Eq]:
    """w = e^(t/T) y, and its derivative by the law, w' = K/T e^(t/T) u: y itself is in it no more."""
    product = equality(w(t), exp(t / T) * y(t))
    slope = solved_for(y(t).diff(t), *law().args)
    return product, equality(w(t).diff(t), simplify(product.rhs.diff(t).subs(y(t).diff(t), slope)))


@cache
def integrated() -> Eq:
    """w integrated from t_k to t_k + h, time counted from t_k: e^(h/T) y(t_{k+1}) - y(t_k) = K/T u(t_k) times an area.

    The input stands before the integral because it stands still.
    """
    product, slope = (law.rhs for law in weighted())
    area = Integral((slope / (K / T * u(t))).subs(t, tau), (tau, 0, h))
    return equality(product.subs(y(t), at("y", 1)).subs(t, h) - at("y"), K / T * at("u") * area)


@cache
def area() -> Eq:
    """The integral of e^(tau/T) from 0 to h, and what it is."""
    (integral,) = integrated().rhs.atoms(Integral)
    return equality(integral, collect(integral.doit(), T))


@cache
def recursion() -> Eq:
    """y(t_{k+1}) = e^(-h/T) y(t_k) + K (1 - e^(-h/T)) u(t_k): exact, whatever h is."""
    found = expand(solved_for(at("y", 1), integrated().lhs, integrated().rhs.subs(*area().args)))
    gains = {sample: powsimp(expand(found.coeff(sample))) for sample in (at("y"), at("u"))}
    return equality(at("y", 1), Add(*(collect(gain, K) * sample for sample, gain in gains.items())))


@cache
def by_forward_difference() -> Eq:
    """The same law under a forward difference: y(t_{k+1}) = (1 - h/T) y(t_k) + K h/T u(t_k)."""
    law_of_samples = update(law(), "y", FORWARD)
    gains = by_signals(law_of_samples.rhs)
    return equality(law_of_samples.lhs, Add(*(factored(gain) * sample for sample, gain in gains.items())))


def kept(order: int) -> Expr:
    """The share e^(-h/T) of y(t_k) that is left after one interval, as a series up to a power of h.

    >>> kept(1)
    1 - h/T
    """
    return exp(-h / T).series(h, 0, order + 1).removeO()
