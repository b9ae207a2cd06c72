"""A closed loop with exact dead time: one object that answers everything about it.

    u = T/R r - S/R (y + n),      y = P(s) (u + d) + W(s) w,      P(s) = B/A exp(-L s)

r reference, d load disturbance at the process input, n measurement noise, w a disturbance that enters elsewhere and
reaches the output through W (which may have dead times of its own).

    tank = Process([1 / 8360], [35, 12, 1], delay=2)
    loop = Loop(tank, PidParallel(25194, 1956, 68803, 28.6))
    loop.margins().phase                   # degrees, with the exact dead time
    loop.step("reference").metrics().rise  # s, from the continuous response, accurate to rounding
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.loop.closed import LoopRows, closed
from loopbook.loop.frequency_curves import of_transfer
from loopbook.loop.margins import Margins, margins
from loopbook.loop.shown_loop import ShownLoop, said_of
from loopbook.loop.stability import BorderError, decay_rate, is_stable, unstable_roots
from loopbook.loop.step_response import StepResponse
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.real_numbers import plain_number, real
from loopbook.numerics.signals import Signal
from loopbook.plots.frequency import Curve
from loopbook.process.transfer_function import DelayedSum, Process, TransferFunction
from loopbook.response.closed_loop import INPUTS, ResponseError, closed_loop_step

AT_REST = 1e-10
PROLONGED = 8
PATIENCE = np.log(1e11)


@dataclass(frozen=True, repr=False)
class Loop(ShownLoop):
    """process with regulator in negative feedback; path: W(s) of the disturbance w, if there is one.

    regulator: a `Regulator`, a PID form of `loopbook.controllers.pid_forms`, what `loopbook.tuning` gives, a rational
    `Process` or a number.

    >>> loop = Loop(Process.fopdt(2, 10, 3), 1.0)
    >>> loop.is_stable, round(loop.margins().gain, 3)
    (True, 2.945)
    """

    process: Process
    regulator: Any
    path: Process | DelayedSum | None = None
    polynomials: Regulator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "polynomials", Regulator.of(self.regulator))

    @cached_property
    def _rows(self) -> tuple[tuple[float, ...], ...]:
        """B, A, T, S, R, with no factor s that all of B, A or all of T, S, R share."""
        c = self.polynomials
        process = _without_common_integrators(self.process.num, self.process.den)
        return *process, *_without_common_integrators(c.T, c.S, c.R)

    def closed(self, source: str = "reference", output: str = "y") -> Process | DelayedSum | TransferFunction:
        """The closed loop's transfer function from "reference", "load", "noise" or "disturbance" to "y" or "u".

        A `Process` without dead time, else with the dead time inside, exact: see `loopbook.loop.closed`.
        """
        return closed(self.loop_rows, source, output, self.path)

    @cached_property
    def characteristic(self) -> ExponentialPolynomial:
        """R A + S B exp(-L s), whose zeros are the loop's poles: `loopbook.loop.roots.poles` finds them."""
        return self.loop_rows.characteristic

    @property
    def loop_rows(self) -> LoopRows:
        """B, A, T, S, R and the dead time, without the integrators that process or regulator cancel in themselves."""
        B, A, T, S, R = self._rows
        return LoopRows(B, A, T, S, R, self.process.delay)

    @cached_property
    def transfer(self) -> LoopTransfer:
        """G(s) = S/R B/A exp(-Ls), from the loop's error around to the measurement."""
        B, A, _, S, R = self._rows
        num, den = np.convolve(S, B), np.convolve(R, A)
        return LoopTransfer(tuple(num.tolist()), tuple(den.tolist()), self.process.delay)

    def sensitivity(self, s: Any) -> Any:
        """1/(1 + G) at complex s."""
        return 1 / (1 + self.transfer(s))

    def complementary_sensitivity(self, s: Any) -> Any:
        """G/(1 + G) at complex s."""
        G = self.transfer(s)
        return G / (1 + G)

    @cached_property
    def unstable_roots(self) -> float:
        """The number of closed-loop roots in the right half plane; see `stability.unstable_roots`."""
        return unstable_roots(self.transfer)

    @cached_property
    def is_stable(self) -> bool:
        """Do all roots lie to the left? False on the border too, and where a root there is cancelled."""
        return is_stable(self.transfer)

    @cached_property
    def decay_rate(self) -> float:
        """The slowest mode decays as exp(-decay_rate t) [1/s]. Raises LoopError for an unstable loop."""
        return decay_rate(self.transfer)

    def margins(self) -> Margins:
        """Gain (both sides), phase and delay margins, Ms and Mt. Raises LoopError for an unstable loop."""
        return margins(self.transfer)

    def with_delay(self, more: float) -> "Loop":
        """The same regulator on a process with `more` seconds of dead time added."""
        return Loop(self.process.delayed(more), self.regulator, self.path)

    def with_gain(self, factor: float) -> "Loop":
        """The same regulator on a process with `factor` times the gain."""
        return Loop(self.process * real(factor, "factor"), self.regulator, self.path)

    def final_values(self, source: str) -> tuple[float, float]:
        """What (y, u) tend to after a unit step of one input, by the final value theorem.

        Raises LoopError for an unstable loop, which has no final values.
        """
        self._need_stable("final values")
        if source not in INPUTS:
            raise ResponseError(f"source = {source!r}; one of {', '.join(INPUTS)}")
        B, A, T, S, R = (row[-1] for row in self._rows)
        below = R * A + S * B
        if source == "disturbance":
            w = self._path_times_den()
            return R * w / below, -S * w / below
        upper = {"reference": (T * B, T * A), "load": (R * B, -S * B), "noise": (-S * B, -S * A)}[source]
        return upper[0] / below, upper[1] / below

    def _path_times_den(self) -> float:
        """lim W(s) A(s) for s to 0: finite also where W and the process share an integrator."""
        if self.path is None:
            raise ResponseError("a disturbance needs the path it takes to the output: Loop(process, regulator, path)")
        total = 0.0
        for term in self.path.terms if isinstance(self.path, DelayedSum) else (self.path,):
            num, den = np.convolve(term.num, self._rows[1]), np.asarray(term.den)
            while den[-1] == 0 and num[-1] == 0 and len(den) > 1:
                num, den = num[:-1], den[:-1]
            if den[-1] == 0:
                raise ResponseError(
                    "the disturbance's path has poles that do not decay and are not the process's own: no regulator "
                    "can hold it"
                )
            total += num[-1] / den[-1]
        return float(total)

    def _need_stable(self, what: str) -> None:
        try:
            count = self.unstable_roots
        except BorderError as border:
            raise LoopError(f"{border}; it has no {what}") from None
        if count:
            raise LoopError(f"the loop is not stable ({count} roots in the right half plane): it has no {what}")

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        rows = [["process", said_of(self.process)], ["regulator", said_of(self.regulator)]]
        return rows if self.path is None else [*rows, ["path of w", said_of(self.path)]]

    def default_horizon(self) -> float:
        """Three times the settling time [s]."""
        return 3 * float(self.step("reference").metrics().settling)

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """Gain and phase of the loop transfer at w [rad/s], with its margins: what a diagram draws."""
        return of_transfer(self.transfer, w, self.is_stable)

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)) after a unit step of the reference at 0 and one of the load at half the horizon [s]."""
        t = np.linspace(0.0, horizon, 800)
        y1, u1 = self.step("reference", horizon).after([(0.0, 1.0)], t)
        y2, u2 = self.step("load", horizon).after([(horizon / 2, 1.0)], t)
        return (t, y1 + y2), (t, u1 + u2)

    def settling_horizon(self) -> float:
        """A time [s] after which the slowest mode has fallen by eleven decades; of a stable loop."""
        self._need_stable("settling time")
        return float(PATIENCE / self.decay_rate + 3 * self.process.delay)

    def step(self, source: str = "reference", horizon: float | None = None) -> StepResponse:
        """y and u after a unit step of one input at t = 0 from rest, exact to rounding.

        source: "reference", "load", "noise" or "disturbance". horizon [s]: up to when; without it, until the response
        has settled, which needs a stable loop. An unstable loop can be simulated over a given horizon.
        """
        if horizon is not None:
            until = float(plain_number(horizon))
            return StepResponse(self, source, until, *self._answer(source, until))
        until = self.settling_horizon()
        final = self.final_values(source)
        signals = self._answer(source, until)
        for _ in range(PROLONGED):
            left = _left(signals, final)
            if left <= AT_REST:
                break
            longer = self._answer(source, 2 * until)  # modes of one speed die out later than each of them alone
            if _left(longer, final) > left / 4:  # what waiting does not take away is rounding
                break
            signals, until = longer, 2 * until
        return StepResponse(self, source, until, *signals, settled=True)

    def _answer(self, source: str, horizon: float) -> tuple[Signal, Signal]:
        return closed_loop_step(self.process, self.polynomials, source, horizon, self.path)


def _left(signals: Sequence[Signal], finals: Sequence[float]) -> float:
    """How far from its final value a signal ends, as a part of the largest mean of a cell: the worst of them."""
    left = 0.0
    for signal, final in zip(signals, finals, strict=True):
        size = max(abs(final), float(np.abs(signal.coefficients[:, 0]).max()))
        left = max(left, abs(float(signal.coefficients[-1].sum()) - final) / size if size else 0.0)
    return left


def _without_common_integrators(*rows: Sequence[float]) -> list[tuple[float, ...]]:
    """Polynomials of one transfer function divided by the factors s that all of them share."""
    while all(len(row) > 1 and row[-1] == 0 for row in rows if row != (0.0,)) and rows[-1] != (0.0,):
        rows = tuple(row[:-1] if row != (0.0,) else row for row in rows)
    return [tuple(row) for row in rows]
