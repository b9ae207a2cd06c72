"""Zero-order-hold sampling as one does it on paper, by areas under the impulse response.

    y(k) = sum over i >= 1 of h_i u(k - i),      h_i = integral of g(t) over ((i - 1) h, i h)

`zero_order_hold` is the quick way to the same; here every step can be shown. Without dead time, which is a power of
z^-1 when it is whole samples.
"""

import sympy as sp

from derivations.algebra.delay_polynomials import Z, coefficients
from derivations.sampling.zero_order_hold import S, T, modes

INDEX = sp.Symbol("i", integer=True, positive=True)


def area(G: sp.Expr, h: sp.Expr, i: sp.Expr = INDEX) -> sp.Eq:
    """h_i as an integral of the impulse response of G(s), and what it is; h > 0 [s], i = 1, 2, ....

    >>> K, T_1, h = sp.symbols("K T_1 h", positive=True)
    >>> area(K / (1 + T_1 * S), h).rhs
    K*(1 - exp(-h/T_1))*exp(-h*(i - 1)/T_1)
    """
    found = modes(G, S, T)
    response = sp.Add(*(r * sp.exp(p * T) for p, r in found.items()))
    total = sp.Add(*(_under(r, p, h, i) for p, r in found.items()))
    return sp.Eq(sp.Integral(response, (T, (i - 1) * h, i * h)), total, evaluate=False)


def _under(r: sp.Expr, p: sp.Expr, h: sp.Expr, i: sp.Expr) -> sp.Expr:
    """The area under one mode r(t) e^(pt) from (i - 1) h to i h: e^(p (i-1) h) times what is left."""
    pole, total = sp.Symbol("p", nonzero=True), sp.S.Zero
    for (power,), c in sp.Poly(r.subs(T, T + (i - 1) * h), T).terms():
        grows = sp.exp(pole * T) if p != 0 else sp.S.One
        total += c * sp.integrate(T**power * grows, (T, 0, h)).subs(pole, p)
    return sp.factor_terms(sp.expand(total)) * sp.exp(p * (i - 1) * h)


def numerator(G: sp.Expr, A: sp.Expr, h: sp.Expr, count: int, z: sp.Symbol = Z) -> list[sp.Expr]:
    """The coefficients of z^-1, ..., z^-count of A(z) (h_1 z^-1 + h_2 z^-2 + ...).

    A: the polynomial in z^-1 whose roots are the e^(ph) of the poles p of G; beyond its degree all are zero, which is
    why the numerator of a sampled process is finite.

    >>> K, T_1, h = sp.symbols("K T_1 h", positive=True)
    >>> numerator(K / (1 + T_1 * S), 1 - sp.exp(-h / T_1) / Z, h, 3)
    [K*(1 - exp(-h/T_1)), 0, 0]
    """
    a = coefficients(A, "A", z)
    areas = [sp.S.Zero, *(area(G, h, sp.Integer(i)).rhs for i in range(1, count + 1))]
    sums = (sum(a[j] * areas[n - j] for j in range(min(n + 1, len(a)))) for n in range(1, count + 1))
    return [sp.factor_terms(sp.powsimp(sp.expand(total))) for total in sums]
