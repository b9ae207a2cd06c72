"""Poles and zeros of anything linear: all of them, or with dead time those in a half plane or a box, counted."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from loopbook.numerics.argument_principle import Rectangle
from loopbook.numerics.characteristic_roots import zeros_in
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.right_half_plane import RootsError
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.process.transfer_function import simplest

SHOWN = 24


@dataclass(frozen=True, eq=False)
class Roots(ShownAsTable):
    """The roots in a region, the rightmost first; NumPy takes them as an array.

    values: each distinct root once [1/s] (of a sampled system: z, without unit). multiplicity: of each. region: the box
    (left, right, bottom, top) that was searched, None where these are all. h [s]: of a sampled system, else None.
    """

    values: np.ndarray
    multiplicity: np.ndarray
    region: Rectangle | None = None
    h: float | None = None

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.repeat(self.values, self.multiplicity).astype(dtype or complex)

    def __len__(self) -> int:
        return int(self.multiplicity.sum())

    def __iter__(self) -> Iterator[complex]:
        return iter(np.asarray(self).tolist())

    def __getitem__(self, index: Any) -> Any:
        return np.asarray(self)[index]

    def __repr__(self) -> str:
        shown = ", ".join(f"{value:.4g}" for value in self.values[:6])
        return f"Roots({shown}{', ...' if len(self.values) > 6 else ''}; {len(self)})"

    @property
    def in_time(self) -> np.ndarray:
        """The same in continuous time [1/s]: ln(z)/h of a sampled system."""
        if self.h is None:
            return self.values
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(self.values.astype(complex)) / self.h)

    def table(self) -> PlainTable:
        """Each root with its multiplicity, its natural frequency, its damping ratio and its time constant."""
        rows: list[list[Any]] = []
        for value, times, s in zip(self.values, self.multiplicity, self.in_time, strict=True):
            w = float(abs(s))
            zeta = -s.real / w if w else float("nan")
            slow = -1 / s.real if s.real else float("inf")
            rows.append([_shown(complex(value)), str(times), w, zeta, slow])
        notes = [f"and {len(rows) - SHOWN} more"] if len(rows) > SHOWN else []
        notes += [self._where] if self.region is not None else []
        head = "root [1/s]" if self.h is None else "root z"
        return PlainTable([head, "times", "frequency [rad/s]", "damping", "time constant [s]"], rows[:SHOWN], notes)

    @property
    def _where(self) -> str:
        left, right, bottom, top = self.region or (0.0, 0.0, 0.0, 0.0)
        if np.isinf(right):
            return f"all roots with Re s from {left:.4g} 1/s on"
        return f"all roots with Re s in [{left:.4g}, {right:.4g}] and Im s in [{bottom:.4g}, {top:.4g}] 1/s"


def _shown(value: complex) -> str:
    if not value.imag:
        return f"{value.real:.4g}"
    return f"{value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j"


def poles(system: Any, right_of: float | None = None, box: tuple[float, float, float, float] | None = None) -> Roots:
    """The poles of a transfer function, a loop, a sampled process or loop.

    Without dead time inside the denominator: all. A closed loop with dead time has infinitely many: those with
    Re s >= right_of [1/s], those in a box (left, right, bottom, top) [1/s], by default the rightmost six or so. They
    are found and counted by the argument principle; raises RootsError where that does not come out even, and where
    infinitely many are asked for.

    >>> from loopbook.loop.continuous import Loop
    >>> from loopbook.process.transfer_function import Process
    >>> print(poles(Loop(Process([1.0], [1.0, 0.0], 1.0), 1.0), right_of=-1.0))
    root [1/s]        times  frequency [rad/s]  damping  time constant [s]
    -0.3181 + 1.337j  1      1.375              0.2314   3.143
    -0.3181 - 1.337j  1      1.375              0.2314   3.143
    all roots with Re s from -1 1/s on
    """
    characteristic = getattr(system, "characteristic", None)
    if characteristic is None and hasattr(system, "fraction"):
        characteristic = system.fraction[1]
    return _of(characteristic, system, "poles", right_of, box)


def zeros(system: Any, right_of: float | None = None, box: tuple[float, float, float, float] | None = None) -> Roots:
    """The zeros of a transfer function, or of a loop from the reference to the output; arguments as for `poles`.

    >>> from loopbook.process.transfer_function import Process
    >>> zeros(Process([1, 1], [1, 2]) + Process([0.5], [1, 2], 2), right_of=-1.0)          # s + 1 + exp(-2 s)/2
    Roots(-0.4305+1.037j, -0.4305-1.037j; 2)
    """
    if hasattr(system, "closed"):
        system = system.closed("reference", "y")
    fraction = getattr(system, "fraction", None)
    return _of(fraction and fraction[0], system, "zeros", right_of, box)


def dcgain(system: Any) -> float:
    """The gain at frequency zero; of a loop that from the reference to y. Infinite where the system integrates.

    >>> from loopbook.process.transfer_function import Process
    >>> dcgain(Process([6], [5, 3], 2))
    2.0
    """
    if hasattr(system, "closed"):
        system = system.closed("reference", "y")
    if hasattr(system, "static_gain"):
        return float(system.static_gain)
    if hasattr(system, "fraction"):
        return float(simplest(*system.fraction).static_gain)
    if not hasattr(system, "num"):
        raise RootsError(f"{type(system).__name__} has no gain that could be told")
    above, below = float(np.sum(system.num)), float(np.sum(system.den))
    with np.errstate(divide="ignore"):
        return float(np.divide(above, below))


def _of(f: ExponentialPolynomial | None, system: Any, kind: str, right_of: float | None, box: Any) -> Roots:
    if f is None:
        values = _of_pulses(system, kind) if hasattr(system, "num") else getattr(system, kind, None)
        if values is None:
            raise RootsError(f"{type(system).__name__} has no {kind} that could be told")
        return _grouped(np.asarray(values), getattr(system, "h", None))
    if right_of is not None and box is not None:
        raise RootsError("right_of and box: give one of them")
    if f.is_zero:
        return Roots(np.zeros(0, complex), np.zeros(0, int))
    region = None if box is None else Rectangle(*map(float, box))
    if region is not None and not (region.left < region.right and region.bottom < region.top):
        raise RootsError(f"box = {box}: left < right and bottom < top are expected")
    found, searched = zeros_in(f, None if right_of is None else float(right_of), region)
    everything = len(f.terms) == 1 and right_of is None and box is None
    return Roots(*found, None if everything else searched)


def _of_pulses(system: Any, kind: str) -> np.ndarray:
    """The z of a ratio of polynomials in z^-1, those at the origin included."""
    above, below = (np.asarray(row, dtype=float) for row in (system.num, system.den))
    length = max(len(above), len(below))
    row = below if kind == "poles" else above
    return np.roots(np.pad(row, (0, length - len(row)))).astype(complex)


def _grouped(values: np.ndarray, h: float | None) -> Roots:
    order = np.lexsort((-values.imag, -np.abs(values)))
    return Roots(values[order], np.ones(len(values), int), None, h)
