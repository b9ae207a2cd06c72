"""The describing function of a relay with hysteresis, and what a relay oscillation tells about the process.

A relay of amplitude u_a switches up where its input passes +epsilon and down where it passes -epsilon. To a sine of
amplitude y_a > epsilon it answers with a square wave that lags the sine by the angle arcsin(epsilon/y_a). Its first
harmonic, divided by the sine, is the describing function N. An oscillation stands where N G = -1.
"""

from functools import cache

import sympy
from sympy import Expr, I, Symbol, asin, exp, pi, symbols

u_a, y_a = symbols("u_a y_a", positive=True)
epsilon = Symbol("epsilon", nonnegative=True)


@cache
def first_harmonic() -> Expr:
    """The complex amplitude of the square wave's first harmonic, from its Fourier integral, without the lag.

    >>> first_harmonic()
    4*u_a/pi
    """
    theta = Symbol("theta", real=True)
    return sympy.integrate(u_a * sympy.sin(theta), (theta, 0, pi)) * 2 / pi


@cache
def relay() -> Expr:
    """N = 4 u_a/(pi y_a) e^(-i arcsin(epsilon/y_a)), written with real and imaginary part.

    >>> relay().subs(epsilon, 0)
    4*u_a/(pi*y_a)
    """
    lag = exp(-I * asin(epsilon / y_a)).rewrite(sympy.cos)
    return first_harmonic() / y_a * lag


@cache
def process_at_oscillation() -> Expr:
    """G(i omega) = -1/N where the loop oscillates.

    Its phase is -180 degrees + arcsin(epsilon/y_a).

    >>> process_at_oscillation().subs(epsilon, 0)
    -pi*y_a/(4*u_a)
    """
    lead = exp(I * asin(epsilon / y_a)).rewrite(sympy.cos)
    return -lead * process_gain()


@cache
def process_gain() -> Expr:
    """K_180 = |G| = 1/|N| at the oscillation, with or without hysteresis: the lag does not change |N|.

    >>> process_gain()
    pi*y_a/(4*u_a)
    """
    return y_a / first_harmonic()


@cache
def phase_short_of_180() -> Expr:
    """By how much the process's phase at the oscillation falls short of -180 degrees (rad).

    >>> phase_short_of_180()
    asin(epsilon/y_a)
    """
    return asin(epsilon / y_a)
