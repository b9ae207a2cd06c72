"""The circles that keep a loop robust, and the PI and PID settings of largest integral gain outside them.

Sensitivity |1/(1+L)| <= M and complementary sensitivity |L/(1+L)| <= M each keep the Nyquist curve of the loop L out
of a circle; one circle encloses both. With the regulator k + k_i/s + k_d s and the process G(i w) = a + i b the
distance of L to the circle's centre -C is

    f(k, k_i, k_d, w) = |C + L|^2 >= R^2    for all w.

The largest k_i for a given k_d lies where the curve touches the circle smoothly: f = R^2, df/dw = 0, df/dk = 0.
`smooth_branch` solves these three equations: k, k_i and k_d are explicit functions of the touching frequency w.
"""

from dataclasses import dataclass
from functools import cache

import sympy
from sympy import Expr, I, Rational, Symbol, symbols

from derivations.algebra.rational import solved_for

M = Symbol("M", positive=True)  # > 1
C, R, w = symbols("C R omega", positive=True)
k, k_i, k_d = symbols("k k_i k_d", real=True)
a, b, da, db = symbols("a b a' b'", real=True)  # G(i w) = a + i b and its derivative along w
r = Symbol("r", positive=True)  # |G(i w)|
ONE = sympy.S.One


@dataclass(frozen=True)
class DerivedCircle:
    """A circle around a point of the real axis."""

    centre: Expr
    radius: Expr

    @property
    def left(self) -> Expr:
        return sympy.factor(self.centre - self.radius)

    @property
    def right(self) -> Expr:
        return sympy.factor(self.centre + self.radius)


@dataclass(frozen=True)
class Branch:
    """The smooth optimum with the touching frequency w as parameter; k_i for any k_d, k_d where it is stationary."""

    k: Expr
    k_i: Expr
    k_d: Expr


def _between(left: Expr, right: Expr) -> DerivedCircle:
    return DerivedCircle(sympy.factor((left + right) / 2), sympy.factor((right - left) / 2))


@cache
def sensitivity_circle() -> DerivedCircle:
    """|1/(1+L)| <= M: outside the circle around -1 of radius 1/M."""
    return DerivedCircle(-ONE, 1 / M)


@cache
def complementary_circle() -> DerivedCircle:
    """|L/(1+L)| <= M: outside the circle with |x/(1+x)| = M at its two real points x.

    >>> complementary_circle().centre
    -M**2/((M - 1)*(M + 1))
    """
    x = Symbol("x", real=True)
    left, right = (solved_for(x, x / (1 + x), sign * M) for sign in (1, -1))
    return _between(left, right)


@cache
def joint_circle() -> DerivedCircle:
    """The smallest circle around both.

    Its left end is the complementary circle's, -M/(M-1), its right end the sensitivity circle's, -(M-1)/M.

    >>> joint_circle().radius
    (2*M - 1)/(2*M*(M - 1))
    """
    return _between(complementary_circle().left, sensitivity_circle().right)


def _loop() -> Expr:
    """L = (k + i (k_d w - k_i/w)) (a + i b)."""
    return (k + I * (k_d * w - k_i / w)) * (a + I * b)


@cache
def distance_squared() -> Expr:
    """f = |C + L|^2 as a polynomial in k, k_i and k_d."""
    real, imaginary = sympy.expand(C + _loop()).as_real_imag()
    return sympy.expand(real**2 + imaginary**2)


def along_frequency(expression: Expr) -> Expr:
    """The total derivative along w: a, b and r = |a + i b| move with a', b' and r' = (a a' + b b')/r."""
    moves = ((w, 1), (a, da), (b, db), (r, (a * da + b * db) / r))
    return sum(sympy.diff(expression, symbol) * rate for symbol, rate in moves)


@cache
def smooth_branch() -> Branch:
    """Solve f = R^2, df/dk = 0 and df/dw = 0 for k, k_i and k_d.

    For each w and k_d the settings outside the circle lie outside an ellipse in the (k, k_i) plane. df/dk = 0 gives the
    k of its lowest point, f = R^2 then the k_i there: the lower of two roots. Along these lowest points f = R^2 holds,
    so df/dw = 0 says dk_i/dw = 0, which is linear in k_d.

    >>> smooth_branch().k
    -C*a/r**2
    >>> smooth_branch().k_i
    k_d*omega**2 - omega*(C*b + R*r)/r**2
    """
    f = distance_squared()
    lowest = solved_for(k, sympy.diff(f, k)).subs(b, sympy.sqrt(r**2 - a**2))
    slope = Symbol("v", real=True)  # v = k_i/w - k_d w, the only way in which k_i and k_d enter f
    at_lowest = f.subs(k_i, w * slope + k_d * w**2).subs(k, lowest).subs(a, sympy.sqrt(r**2 - b**2))
    square, linear, constant = sympy.Poly(sympy.expand(at_lowest - R**2), slope).all_coeffs()  # square = r^2 > 0
    lower = (-linear - sympy.sqrt(sympy.expand(linear**2 - 4 * square * constant))) / (2 * square)
    edge = w**2 * k_d + w * sympy.factor(lower)
    return Branch(lowest, edge, solved_for(k_d, along_frequency(edge)))


def high_frequency_limit() -> Expr:
    """The largest |L| that keeps every phase out of the joint circle: (M-1)/M.

    It binds where dead time turns the phase for ever while |L| tends to a constant.

    >>> high_frequency_limit()
    (M - 1)/M
    """
    return -joint_circle().right


@cache
def joint_M() -> Expr:
    """The M of the joint circle that passes through the point L = a + i b of the Nyquist curve, for a < 0.

    C^2 - R^2 = 1 for every M, so |L + C|^2 = R^2 gives C at once: C - 1 = -|1 + L|^2/(2 a) = 1/(2 M (M-1)), and that M.
    The joint M of a loop is the largest along its curve; points with a >= 0 lie outside every joint circle.

    >>> joint_M().subs({a: -Rational(2, 7), b: 0})
    7/5
    """
    inverse = Symbol("q", positive=True)  # 1/(C - 1)
    (root,) = [x for x in sympy.roots(2 * M * (M - 1) - inverse, M) if x.subs(inverse, 1) > 0]
    return root.subs(inverse, -2 * a / ((1 + a) ** 2 + b**2))


def example_M() -> Expr:
    """The robustness used throughout: M = 1.4.

    >>> example_M()
    7/5
    """
    return Rational(7, 5)
