"""PI by its phase at the crossover frequency: C(jw) = P - j I/w turns the process's phase to -180 degrees + margin.

|C(jw)| |G(jw)| = 1,   arg C(jw) = phi_m - pi - phi_p        phi_p: the phase of the process at w
"""

from functools import cache

import sympy as sp

w, g = sp.symbols("w g", positive=True)
phase, margin = sp.symbols("phi_p phi_m", real=True)
P, I = sp.symbols("P I", real=True)


@cache
def angle() -> sp.Expr:
    """arg C(jw) [rad]: between -pi/2 and 0 for a PI controller with positive gains."""
    return margin - sp.pi - phase


@cache
def gains() -> dict[sp.Symbol, sp.Expr]:
    """P and I of P + I/s, g = |G(jw)|.

    >>> gains()[P]
    -cos(phi_m - phi_p)/g
    """
    wanted = sp.exp(sp.I * angle()) / g
    re, im = (sp.simplify(part.rewrite(sp.cos)) for part in wanted.as_real_imag())
    return {P: re, I: -w * im}
