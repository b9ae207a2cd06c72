"""A cascade: an inner loop around the first part of a process, an outer regulator that gives it its reference.

    y1 = P1 (u + d1)      u  = T1/R1 r1 - S1/R1 y1
    y  = P2 (y1 + d2)     r1 = T2/R2 r  - S2/R2 (y + n)

with dead time in both parts, exactly.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from loopbook.loop.closed import LoopRows
from loopbook.loop.continuous import Loop
from loopbook.loop.general import GeneralLoop
from loopbook.loop.margins import Margins
from loopbook.loop.shown_loop import ShownLoop, said_of
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.plots.frequency import Curve
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.transfer_function import Process, simplest
from loopbook.response.closed_loop import ResponseError

SOURCES = ("reference", "inner load", "outer load", "noise")
OUTPUTS = ("y", "y1", "u", "r1")


@dataclass(frozen=True, repr=False)
class CascadeLoop(ShownLoop):
    """inner_process P1, outer_process P2; their regulators, anything that a `Loop` takes.

    inner: the inner loop by itself. outer: the loop of the outer regulator around the closed inner one and P2; margins,
    poles and the like of the cascade are those of `outer`.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> cascade = CascadeLoop(Process([2], [5, 1], 0.5), Process([1], [40, 1], 4), 4.0, PidStandard(4.0, 40))
    >>> cascade.is_stable, round(cascade.margins().Ms.value, 3), round(cascade.inner.margins().Ms.value, 3)
    (True, 1.455, 2.143)
    """

    half_way: ClassVar[str] = "inner load"

    inner_process: Process
    outer_process: Process
    inner_regulator: Any
    outer_regulator: Any

    @cached_property
    def inner(self) -> Loop:
        """The inner loop: P1 with its regulator."""
        return Loop(self.inner_process, self.inner_regulator)

    @cached_property
    def outer(self) -> GeneralLoop:
        """The outer regulator with what it controls: P2 behind the closed inner loop."""
        closed = self.inner.closed("reference", "y")
        return GeneralLoop(closed * self.outer_process, self.outer_regulator)

    @property
    def characteristic(self) -> ExponentialPolynomial:
        """The sum whose zeros are the poles of the whole cascade."""
        return self.outer.characteristic

    @property
    def is_stable(self) -> bool:
        """Is the whole cascade stable? The inner loop by itself may not be."""
        return self.outer.is_stable

    @property
    def unstable_roots(self) -> float:
        """The number of poles of the cascade in the right half plane."""
        return self.outer.unstable_roots

    @property
    def transfer(self) -> Any:
        """The transfer function around the outer loop, the inner one closed."""
        return self.outer.transfer

    def margins(self) -> Margins:
        """Those of the outer loop, the inner one closed; `inner.margins()` are those of the inner one."""
        return self.outer.margins()

    def inner_margins(self) -> Margins:
        """Those at the process's input with the outer loop closed: what the inner regulator really bears."""
        B1, A1, _, S1, R1 = (ExponentialPolynomial.of(row) for row in self._inner_rows[:5])
        L1 = self.inner_process.delay
        B2, A2 = self.outer_process.fraction
        c2 = GeneralLoop(self.outer_process, self.outer_regulator).rows
        T1 = ExponentialPolynomial.of(self._inner_rows.T)
        S2, R2 = c2[3], c2[4]
        # u = -(S1/R1 + T1/R1 S2/R2 B2/A2) y1
        back = simplest(S1 * R2 * A2 + T1 * S2 * B2, R1 * R2 * A2)
        opened = simplest(B1.delayed(L1), A1) * back
        return GeneralLoop(opened, 1.0).margins()

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        rows = [["inner process", self.inner_process], ["inner regulator", self.inner_regulator]]
        rows += [["outer process", self.outer_process], ["outer regulator", self.outer_regulator]]
        return [[name, said_of(part)] for name, part in rows]

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """That of the outer loop."""
        return self.outer.frequency_curve(w)

    def default_horizon(self) -> float:
        """Three times the settling time [s]."""
        return self.outer.default_horizon()

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)) after a unit step of the reference at 0 and of the inner load at half the horizon [s]."""
        t = np.linspace(0.0, horizon, 800)
        y, u = (
            self.closed("reference", output).step(t) + self.closed("inner load", output).step(t - horizon / 2)
            for output in ("y", "u")
        )
        return (t, y), (t, u)

    @property
    def _inner_rows(self) -> LoopRows:
        return self.inner.loop_rows

    def closed(self, source: str = "reference", output: str = "y") -> TransferAlgebra:
        """From "reference", "inner load" (d1), "outer load" (d2) or "noise" to "y", "y1" (between), "u" or "r1"."""
        if source not in SOURCES or output not in OUTPUTS:
            raise ResponseError(f"from {source!r} to {output!r}: from {', '.join(SOURCES)}, to {', '.join(OUTPUTS)}")
        inner, outer, P2 = self.inner, self.outer, self.outer_process
        path: TransferAlgebra
        if source in ("reference", "noise"):
            to_y, to_r1 = (outer.closed(source, name) for name in ("y", "u"))
            if output in ("y", "r1"):
                return to_y if output == "y" else to_r1
            return inner.closed("reference", "y" if output == "y1" else "u") * to_r1
        path = P2 if source == "outer load" else inner.closed("load", "y") * P2
        disturbed = GeneralLoop(outer.process, outer.regulator, path)
        to_y, to_r1 = (disturbed.closed("disturbance", name) for name in ("y", "u"))
        if output in ("y", "r1"):
            return to_y if output == "y" else to_r1
        signal = "y" if output == "y1" else "u"
        through = inner.closed("reference", signal) * to_r1
        return through + inner.closed("load", signal) if source == "inner load" else through
