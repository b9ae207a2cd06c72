"""Pole placement with numbers: the RST regulator R u = T r - S y of a sampled process, and its quality.

The numeric twin of `derivations.pole_placement.diophantine`, for processes of any order whose coefficients are measured
numbers. All polynomials are in z^-1, coefficients ascending: [1, a1, a2] is 1 + a1 z^-1 + a2 z^-2.

    y = B/A u        A D R' + B' S = P A_o        R = R' D B+,   T = t0 A_o,   t0 = P(1)/B'(1)

P wanted poles, A_o observer polynomial (poles that a reference does not excite), D = (1 - z^-1)^integrators, B = B+ B'
with B+ the zeros to be cancelled. Then y = t0 B'/P r.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.lazy import late
from loopbook.numerics import polynomial_text
from loopbook.numerics.real_numbers import plain_number, positive
from loopbook.numerics.recursion import recursion
from loopbook.numerics.units import CANCELLED
from loopbook.process import formulas

rst_law = late("derivations.pole_placement.rst_law")

Polynomial = Sequence[float] | np.ndarray
NEAR = 1e-8


class PlacementError(LoopbookError):
    """The polynomial equation has no solution or no meaning; the message names the factor or the polynomial."""


def _row(p: Polynomial, name: str) -> np.ndarray:
    try:
        known = isinstance(p, list | tuple) and all(type(c) is float or type(c) is int for c in p)
        row = np.array(p if known else [plain_number(c) for c in np.atleast_1d(np.asarray(p, dtype=object))], float)
    except (TypeError, OverflowError):
        row = np.zeros(0)
    if row.ndim != 1 or not row.size or not np.isfinite(row).all():
        raise PlacementError(f"{name} = {p!r}: finite coefficients of z^0, z^-1, z^-2, ... are expected")
    last = np.flatnonzero(row)
    return row[: last[-1] + 1] if last.size else row[:1]


def zeros_of(p: Polynomial) -> np.ndarray:
    """The z where p0 + p1 z^-1 + ... = 0, without the z at infinity of leading zeros (delays).

    A root at z = 1, where the coefficients add up to nothing but rounding, is exactly 1 and divided out first.

    >>> zeros_of([1, -2, 1])
    array([1.+0.j, 1.+0.j])
    """
    rest, ones = np.asarray(p, dtype=float).tolist(), 0
    while rest and not rest[0]:
        rest = rest[1:]
    while len(rest) > 1 and abs(sum(rest)) <= CANCELLED * sum(map(abs, rest)):
        rest, ones = list(accumulate(rest))[:-1], ones + 1
    return np.append(np.ones(ones), np.roots(rest)).astype(complex)


def with_zeros(zeros: Sequence[complex]) -> np.ndarray:
    """The polynomial (1 - z1 z^-1)(1 - z2 z^-1)... with real coefficients; PlacementError where they are not real.

    >>> with_zeros([0.5, 0.5])
    array([ 1.  , -1.  ,  0.25])
    """
    row = np.atleast_1d(np.poly(np.asarray(zeros, dtype=complex)))
    if np.abs(row.imag).max() > NEAR * np.abs(row).max():
        raise PlacementError(f"{list(zeros)} are not real or in conjugate pairs")
    return row.real


@dataclass(frozen=True)
class Rst:
    """R u = T r - S y; coefficients of z^0, z^-1, ...; R starts with 1 (it is scaled to). h: sampling interval [s].

    observer: A_o of the anti-windup form (see `derivations.pole_placement.rst_law`); (1,) sets v from the inputs alone.

    >>> controller = Rst(R=(1, -1), S=(1, -0.5), T=(0.5,), h=1.0).controller(low=0.0, high=2.0)
    >>> [controller.step(y, 1.0) for y in (0.0, 0.2, 0.4)]
    [0.5, 0.8, 1.0]
    """

    R: tuple[float, ...]
    S: tuple[float, ...]
    T: tuple[float, ...]
    h: float
    observer: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        object.__setattr__(self, "h", positive(self.h, "h", PlacementError, " s"))
        lead = _row(self.R, "R")[0]
        if lead == 0:
            raise PlacementError(f"R = {self.R} has no term without delay: u(k) would not appear in its own equation")
        for name in ("R", "S", "T"):
            object.__setattr__(self, name, tuple((_row(getattr(self, name), name) / lead).tolist()))
        observer = _row(self.observer, "observer")
        if observer[0] != 1:
            raise PlacementError(f"observer = {self.observer} must start with 1")
        if (abs(zeros_of(observer)) >= 1).any():
            raise PlacementError(f"observer = {self.observer} is not stable: the anti-windup form would not be either")
        object.__setattr__(self, "observer", tuple(observer.tolist()))

    @cached_property
    def poles(self) -> np.ndarray:
        """The regulator's own poles, zeros of R. One outside the unit circle: unstable by itself."""
        return zeros_of(self.R)

    @property
    def is_stable(self) -> bool:
        """No pole outside the unit circle, and on it at most the simple pole of one integrator at z = 1."""
        outside = self.poles[abs(self.poles) > 1 - NEAR]
        return len(outside) <= 1 and bool((abs(outside - 1) < 1e-6).all())

    def feedback(self, z: Any) -> Any:
        """S/R at complex z."""
        inverse = 1 / np.asarray(z)
        return np.polyval(self.S[::-1], inverse) / np.polyval(self.R[::-1], inverse)

    def latex(self) -> str:
        """R, S and T in LaTeX, in powers of z^-1."""
        rows = (f"{name} &= {polynomial_text.in_delays(getattr(self, name))}" for name in "RST")
        return r"\begin{aligned} " + r" \\ ".join(rows) + r" \end{aligned}"

    def __repr__(self) -> str:
        rows = ", ".join(f"{name}={formulas.short_row(getattr(self, name))}" for name in "RST")
        observer = "" if self.observer == (1.0,) else f", observer={formulas.short_row(self.observer)}"
        return f"Rst({rows}, h={self.h!r}{observer})"

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def controller(self, low: float = -np.inf, high: float = np.inf) -> "RstController":
        """A controller that runs it, with the output limited to [low, high] and no windup."""
        return RstController(self, low, high)


class RstController:
    """An `Rst` that runs: u = controller.step(y, reference), once per sampling instant.

    Built from `derivations.pole_placement.rst_law.law`. In saturation the limited output is what the recursion
    remembers.
    """

    def __init__(self, regulator: Rst, low: float = -np.inf, high: float = np.inf):
        if not low < high:
            raise ValueError(f"limits [{low}, {high}]: the lower one must be below the upper one")
        self.regulator, self.low, self.high = regulator, low, high
        rows = {"r": regulator.R, "s": regulator.S, "t": regulator.T, "o": regulator.observer}
        values = {f"{letter}_{i}": c for letter, row in rows.items() for i, c in enumerate(row)}
        self._terms = recursion(rst_law.law(*(len(row) - 1 for row in rows.values())), values).terms
        self.reset()

    def reset(self) -> None:
        """Forget everything: all signals were zero."""
        longest = 1 + max((delay for _, delay, _ in self._terms), default=0)
        self._past = {name: deque([0.0] * longest, maxlen=longest) for name in ("r", "u", "v", "y")}

    def step(self, y: float, reference: float) -> float:
        """u(k) from y(k) and r(k)."""
        past = self._past
        past["y"].appendleft(float(y))
        past["r"].appendleft(float(reference))
        # u(k) and v(k) are not known yet: their newest stored sample is that of k - 1
        v = sum(gain * past[name][delay if name in "ry" else delay - 1] for name, delay, gain in self._terms)
        u = min(max(v, self.low), self.high)
        past["v"].appendleft(v)
        past["u"].appendleft(u)
        return u
