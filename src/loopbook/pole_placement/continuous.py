"""Pole placement for a continuous process without dead time: A R + B S = P A_o in s, R u = T r - S y."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.controllers.rst import PlacementError
from loopbook.numerics.real_numbers import complex_number
from loopbook.plots.short_repr import ShortRepr
from loopbook.pole_placement.polynomial_equation import PolynomialEquationError, PolynomialSolution, diophantine
from loopbook.process.transfer_function import Process


@dataclass(frozen=True, repr=False)
class ContinuousPlacementResult(ShortRepr):
    """regulator: the `Regulator` with R, S, T. solution: of the polynomial equation, with condition and residual."""

    regulator: Regulator
    solution: PolynomialSolution

    def _repr_latex_(self) -> str:
        return self.regulator._repr_latex_()


def place_continuous(
    process: Process, poles: Any, *, observer: Sequence[complex] = (), integrators: int = 1
) -> ContinuousPlacementResult:
    """The regulator of least order of S that gives the loop these poles [1/s] and static gain one.

    poles: what the reference sees; one number for as many as make S/R proper, less those of the observer. observer:
    poles that it does not see. Complex ones in pairs. integrators: how many R has.
    Without fewer poles than 2 n + integrators - 1 (n: the order of the process) S/R would not be proper.
    Raises PlacementError for a process with dead time (sample it, or take `loopbook.loop.smith`), too few poles, poles
    on the right, a factor that process and integrator share and the poles lack, and a process that blocks constants.

    >>> found = place_continuous(Process([2], [1, 3, 0]), [-2 + 2j, -2 - 2j], observer=[-8], integrators=0).regulator
    >>> [round(c, 9) for c in (*found.R, *found.S, *found.T)]        # r1 = 9, s0 = (40 - 27)/2, s1 = 32, T = 4 (s + 8)
    [1.0, 9.0, 6.5, 32.0, 4.0, 32.0]
    """
    if process.delay:
        raise PlacementError(
            f"the process has a dead time of {process.delay:g} s, and its loop infinitely many poles: sample it and "
            "place those in z, or predict its output (loopbook.loop.smith)"
        )
    fixed = np.array([1.0] + [0.0] * integrators)
    n = process.order + integrators
    needed = n + process.order - 1 + (not process.relative_degree)
    hidden = [complex_number(p, "pole", PlacementError) for p in listed(observer, 1)]
    seen = [complex_number(p, "pole", PlacementError) for p in listed(poles, max(needed - len(hidden), 1))]
    wanted = [*seen, *hidden]
    if len(wanted) < needed:
        raise PlacementError(f"{len(wanted)} poles are given; a regulator that can be built needs {needed} or more")
    if any(not p.real < 0 for p in wanted):
        raise PlacementError(f"the poles {[p for p in wanted if not p.real < 0]} do not lie on the left: not stable")
    P, seen_by_r, A_o = (_polynomial(r) for r in (wanted, seen, hidden))
    if not process.num[-1]:
        raise PlacementError("the process blocks constant inputs (B(0) = 0): no T gives the loop static gain one")
    try:
        found = diophantine(np.convolve(process.den, fixed), process.num, P)
    except PolynomialEquationError as error:
        raise PlacementError(str(error)) from None
    R = np.convolve(found.X, fixed)
    gain = float(seen_by_r[-1] / process.num[-1])
    lead = float(R[0])
    rows = ((gain * A_o / lead), np.asarray(found.Y, dtype=float) / lead, R / lead)
    return ContinuousPlacementResult(Regulator(*(tuple(row.tolist()) for row in rows)), found)


def listed(poles: Any, count: int) -> list[Any]:
    """The poles as a list: those of a row, or one number `count` times."""
    if isinstance(poles, np.ndarray):
        poles = poles.tolist()
    return list(poles) if isinstance(poles, Sequence) else [poles] * count


def _polynomial(roots: Sequence[Any]) -> np.ndarray:
    row = np.poly(np.asarray(roots, dtype=complex)) if len(roots) else np.ones(1)
    if np.abs(np.imag(row)).max() > 1e-9 * np.abs(row).max():
        raise PlacementError(f"the poles {list(roots)} are not real or in conjugate pairs")
    return np.atleast_1d(np.real(row))
