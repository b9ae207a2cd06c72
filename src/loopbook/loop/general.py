"""A loop whose process and regulator may hold dead times anywhere: predictors, cascades, sums of delayed paths.

    u = T/R r - S/R (y + n),   y = P (u + d) + W w,   P = B/A

with T, S, R, B, A sums of polynomials times exponentials. It answers what a `loopbook.loop.continuous.Loop` does, with
the same exactness: poles counted by the argument principle, margins and peaks certified, responses by the method of
steps.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.loop.continuous import PATIENCE
from loopbook.loop.frequency_curves import of_sums
from loopbook.loop.margins import GainCrossover, Margins, PhaseCrossover
from loopbook.loop.ratio_curve import RatioCurve
from loopbook.loop.sensitivity_peaks import Peak, closest
from loopbook.loop.shown_loop import ShownLoop, said_of
from loopbook.loop.stability import BorderError
from loopbook.loop.step_response import StepResponse
from loopbook.loop.transfer import LoopError
from loopbook.numerics.argument_principle import BoundaryError
from loopbook.numerics.characteristic_roots import zeros_in
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial, characteristic_time_of
from loopbook.numerics.right_half_plane import zeros_on_the_right
from loopbook.plots.frequency import Curve
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.transfer_function import simplest
from loopbook.response.closed_loop import INPUTS, ResponseError

FLOORS = (0.5, 0.1, 0.02, 1e-3, 1e-5)
BORDER = 1e-12


@dataclass(frozen=True)
class DelayedRegulator:
    """R u = T r - S y with sums of polynomials times exponentials."""

    T: ExponentialPolynomial
    S: ExponentialPolynomial
    R: ExponentialPolynomial

    @classmethod
    def of(cls, regulator: Any) -> "DelayedRegulator":
        """From one of these, or from anything that `Regulator.of` takes."""
        if isinstance(regulator, cls):
            return regulator
        rows = Regulator.of(regulator)
        return cls(*(ExponentialPolynomial.of(row) for row in (rows.T, rows.S, rows.R)))


@dataclass(frozen=True, repr=False)
class GeneralLoop(ShownLoop):
    """process: any transfer function. regulator: a `DelayedRegulator` or what a `Loop` takes. path: W, if there is one.

    >>> from loopbook.process.transfer_function import Process
    >>> echo = Process([1], [2, 1], 1) + Process([0.5], [2, 1], 3)
    >>> loop = GeneralLoop(echo, 0.5)
    >>> loop.is_stable, round(loop.margins().gain, 4)
    (True, 8.9163)
    """

    process: TransferAlgebra
    regulator: Any
    path: TransferAlgebra | None = None

    @cached_property
    def rows(self) -> tuple[ExponentialPolynomial, ...]:
        """B, A, T, S, R."""
        c = DelayedRegulator.of(self.regulator)
        return *self.process.fraction, c.T, c.S, c.R

    @cached_property
    def characteristic(self) -> ExponentialPolynomial:
        """R A + S B, whose zeros are the poles of the loop, hidden ones included."""
        B, A, _, S, R = self.rows
        return R * A + S * B

    @cached_property
    def transfer(self) -> Any:
        """S/R B/A, from the loop's error around to the measurement."""
        B, A, _, S, R = self.rows
        return simplest(S * B, R * A)

    def sensitivity(self, s: Any) -> Any:
        """1/(1 + G) at complex s."""
        return 1 / (1 + self.transfer(s))

    def complementary_sensitivity(self, s: Any) -> Any:
        """G/(1 + G) at complex s."""
        G = self.transfer(s)
        return G / (1 + G)

    def closed(self, source: str = "reference", output: str = "y") -> Any:
        """From "reference", "load", "noise" or "disturbance" to "y" or "u"."""
        if source not in INPUTS or output not in ("y", "u"):
            raise ResponseError(f"from {source!r} to {output!r}: from one of {', '.join(INPUTS)}, to y or u")
        B, A, T, S, R = self.rows
        below, to_y = self.characteristic, output == "y"
        if source == "disturbance":
            if self.path is None:
                raise ResponseError("a disturbance needs the path it takes to the output: give path")
            num, den = self.path.fraction
            above = (R if to_y else S * -1.0) * A * num
            return simplest(above, below * den)
        above = {
            "reference": T * B if to_y else T * A,
            "load": R * B if to_y else S * B * -1.0,
            "noise": S * B * -1.0 if to_y else S * A * -1.0,
        }[source]
        return simplest(above, below)

    @cached_property
    def unstable_roots(self) -> float:
        """How many poles lie in the right half plane, counted by the argument principle; inf for a chain of them there.

        Raises BorderError, a LoopError, for one on the imaginary axis.
        """
        try:
            return zeros_on_the_right(self.characteristic)
        except BoundaryError as error:
            raise BorderError(abs(error.at.imag)) from None

    @cached_property
    def is_stable(self) -> bool:
        """Do all poles lie to the left? False on the border too, and where one there is cancelled."""
        try:
            return self.unstable_roots == 0
        except BorderError:
            return False

    def need_stable(self, what: str) -> None:
        """Raises LoopError, with the count, for a loop that is not."""
        try:
            count = self.unstable_roots
        except BorderError as border:
            raise LoopError(f"{border}; it has no {what}") from None
        if count:
            raise LoopError(f"the loop is unstable ({count} roots in the right half plane) and has no {what}")

    @cached_property
    def decay_rate(self) -> float:
        """The slowest mode decays as exp(-decay_rate t) [1/s]. Raises LoopError for an unstable loop."""
        self.need_stable("decay")
        found = zeros_in(self.characteristic)[0].values.real
        return float(-found.max()) if found.size else np.inf

    def margins(self) -> Margins:
        """Gain (both sides), phase and delay margins, Ms and Mt, certified. Raises LoopError for an unstable loop."""
        self.need_stable("margins")
        return ratio_margins(*strictly_proper(self.transfer))

    def final_values(self, source: str) -> tuple[float, float]:
        """What (y, u) tend to after a unit step of one input. Raises LoopError for an unstable loop."""
        self.need_stable("final values")
        y, u = (self.closed(source, output).static_gain for output in ("y", "u"))
        return y, u

    def settling_horizon(self) -> float:
        """A time [s] after which the slowest mode has fallen by eleven decades; of a stable loop."""
        return float(PATIENCE / self.decay_rate + 3 * max(self.characteristic.delays))

    def step(self, source: str = "reference", horizon: float | None = None) -> StepResponse:
        """y and u after a unit step of one input at t = 0 from rest, exact to rounding; as of a `Loop`."""
        until = self.settling_horizon() if horizon is None else float(horizon)
        y, u = (self.closed(source, output).step_signal(until) for output in ("y", "u"))
        return StepResponse(self, source, until, y, u, settled=horizon is None)

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)) after a unit step of the reference at 0 and one of the load at half the horizon [s]."""
        t = np.linspace(0.0, horizon, 800)
        y1, u1 = self.step("reference", horizon).after([(0.0, 1.0)], t)
        y2, u2 = self.step("load", horizon).after([(horizon / 2, 1.0)], t)
        return (t, y1 + y2), (t, u1 + u2)

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        rows = [["process", said_of(self.process)], ["regulator", said_of(self.regulator)]]
        return rows if self.path is None else [*rows, ["path of w", said_of(self.path)]]

    def default_horizon(self) -> float:
        """Three times the settling time [s]."""
        return 3 * float(self.step("reference").metrics().settling)

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """Gain and phase of the loop transfer at w [rad/s], with its margins: what a diagram draws."""
        try:
            found = self.margins()
        except LoopError:
            found = None
        return of_sums(self.transfer, w, found)


def strictly_proper(transfer: TransferAlgebra) -> tuple[ExponentialPolynomial, ExponentialPolynomial]:
    """(num, den) of a loop transfer function that is not zero and falls off. Raises LoopError for another."""
    num, den = transfer.fraction
    if num.is_zero:
        raise LoopError("the loop is open: its transfer function is zero and has no margins")
    if num.degree >= den.degree:
        raise LoopError("the loop gain does not fall off with frequency: its margins cannot be certified; filter it")
    return num, den


def ratio_margins(num: ExponentialPolynomial, den: ExponentialPolynomial) -> Margins:
    """The margins of a stable loop whose transfer function is num/den, strictly proper."""
    time = characteristic_time_of(num, den)
    above, below = num.in_units(time), den.in_units(time)
    curve = RatioCurve(above, below)
    at_gain, at_phase = ratio_crossovers(num, den)
    Ms, Mt = closest(curve), closest(RatioCurve(above, below, inverse=True))
    for distance, w in (Ms, Mt):
        if distance < BORDER:
            raise LoopError(f"the loop is on the border of stability: 1 + G = 0 at w = {w / time:.6g} rad/s")
    return Margins(
        gain=min((c.gain for c in at_phase if c.gain > 1), default=np.inf),
        gain_low=max((c.gain for c in at_phase if c.gain < 1), default=0.0),
        phase=min((c.phase_margin for c in at_gain), key=abs, default=np.inf),
        delay=min((c.delay_margin for c in at_gain), default=np.inf),
        Ms=Peak(1 / Ms[0], Ms[1] / time),
        Mt=Peak(1 / Mt[0], Mt[1] / time),
        gain_crossovers=at_gain,
        phase_crossovers=at_phase,
    )


def ratio_crossovers(
    num: ExponentialPolynomial, den: ExponentialPolynomial
) -> tuple[tuple[GainCrossover, ...], tuple[PhaseCrossover, ...]]:
    """Where the gain of num/den passes 1 and its phase -180 degrees, whether the loop is stable or not."""
    time = characteristic_time_of(num, den)
    curve = RatioCurve(num.in_units(time), den.in_units(time))
    at_gain = []
    for w in curve.gain_crossovers().tolist():
        margin = float(np.angle(-complex(curve(np.array(w)))))
        at_gain.append(GainCrossover(w / time, float(np.degrees(margin)), (margin % (2 * np.pi)) / w * time))
    return tuple(at_gain), (*_at_zero(num, den), *_phase_crossovers(curve, time))


def _phase_crossovers(curve: RatioCurve, time: float) -> list[PhaseCrossover]:
    found: list[PhaseCrossover] = []
    for floor in FLOORS:
        w = curve.phase_crossovers(floor)
        found = [PhaseCrossover(x / time, float(1 / abs(complex(curve(np.array(x)))))) for x in w.tolist()]
        if any(c.gain > 1 for c in found):
            break
    return found


def _at_zero(num: ExponentialPolynomial, den: ExponentialPolynomial) -> list[PhaseCrossover]:
    gain = simplest(num, den).static_gain
    return [PhaseCrossover(0.0, -1 / gain)] if np.isfinite(gain) and gain < 0 else []
