"""The model structures that a step record can support, each with its exact response to the recorded input."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from loopbook.lazy import late
from loopbook.printed.store import kept_for, lambda_text, run_text
from loopbook.process.transfer_function import Process

if TYPE_CHECKING:
    from derivations.experiments import step_responses
else:
    step_responses = late("derivations.experiments.step_responses")


@dataclass(frozen=True)
class Structure:
    """One model structure: a gain times a shape with dead time.

    name: in words. lags: how many numbers give its shape, time constants unless `parts` names others. integrating: the
    gain is a slope Kv [y/(u s)], else Kp [y/u]. formula: LaTeX of the transfer function. parts: names of the shape's
    numbers. axes: where the search begins for each but the first, which is a time constant; low, high: their ends.
    """

    name: str
    lags: int
    integrating: bool
    formula: str
    parts: tuple[str, ...] = ()
    axes: tuple[tuple[float, ...], ...] = ()
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """What the shape's numbers are called."""
        return self.parts or (("T",) if self.lags == 1 else ("T1", "T2")[: self.lags])

    @property
    def common(self) -> bool:
        """Is it a structure of lags, tried on every record?"""
        return not self.parts

    def numbers(self, first: float, others: Sequence[float] | np.ndarray) -> tuple[float, ...]:
        """The shape's numbers from the search: the second lag and the zero as shares of the first, damping as it is."""
        if not self.lags:
            return ()
        if self.parts == RINGS:
            return (first, float(others[0]))
        return (first, *(first * float(share) for share in others))

    def span(self, lags: tuple[float, ...]) -> float:
        """How long [s] the shape takes to settle to e^-1."""
        if self.parts == RINGS:
            return lags[0] / lags[1]
        return sum(lags[:2])

    def shape(self, tau: np.ndarray, lags: tuple[float, ...]) -> np.ndarray:
        """Unit step response of gain 1 at the times tau since the step reached the output; zero for tau <= 0.

        tau: seconds, any shape. lags: time constants in seconds, positive, longest first.
        """
        after = np.maximum(tau, 0.0)
        if self.parts == RINGS:
            return _function("ringing")(after, 1 / lags[0], lags[1])
        if self.parts == INVERSE:
            return self._inverse(after, *lags)
        if self.lags == 2 and lags[1] > 0.98 * lags[0]:
            return _function("two_equal_lags")(after, (lags[0] + lags[1]) / 2)
        return _function(_RESPONSES[self])(after, *lags)

    def response(
        self, time: np.ndarray, steps: Sequence[tuple[float, float]], lags: tuple[float, ...], delay: float
    ) -> np.ndarray:
        """Response of gain 1 to input steps [(instant in s, height)], each delayed by the dead time.

        Many steps, as a recorded ramp has them, go through `memory`: one pass for all.
        """
        if len(steps) > FEW_STEPS and self.common:
            return self._course(time - delay, steps, lags)
        total = np.zeros_like(time)
        for instant, height in steps:
            total += height * self.shape(time - instant - delay, lags)
        return total

    def _course(self, tau: np.ndarray, steps: Sequence[tuple[float, float]], lags: tuple[float, ...]) -> np.ndarray:
        """The sum over many steps, from the input itself, its integral and what the lags remember of it."""
        instants, heights = (np.array(part) for part in zip(*steps, strict=True))
        at = np.searchsorted(instants, tau, side="right")
        levels = np.concatenate([[0.0], np.cumsum(heights)])[at]
        if self.integrating:
            moments = np.concatenate([[0.0], np.cumsum(heights * (instants - instants[0]))])[at]
            ramp = levels * (tau - instants[0]) - moments
            return ramp - lags[0] * (levels - memory(instants, heights, lags[0], tau, at)) if lags else ramp
        if self.lags == 2:
            T1, T2 = lags[0], min(lags[1], 0.98 * lags[0])
            first, second = (memory(instants, heights, T, tau, at) for T in (T1, T2))
            return levels - (T1 * first - T2 * second) / (T1 - T2)
        return levels - memory(instants, heights, lags[0], tau, at)

    @staticmethod
    def _inverse(after: np.ndarray, T1: float, T2: float, Tz: float) -> np.ndarray:
        """The two lags' response less Tz times its slope: 1 - Tz s in front of it."""
        T2 = min(T2, 0.98 * T1)
        slope = (np.exp(-after / T1) - np.exp(-after / T2)) / (T1 - T2)
        return np.asarray(_function("two_lags")(after, T1, T2) - Tz * slope)

    def process(self, gain: float, lags: tuple[float, ...], delay: float) -> Process:
        """The model as a `loopbook.process.transfer_function.Process`."""
        if self.parts == RINGS:
            return Process([gain], [lags[0] ** 2, 2 * lags[0] * lags[1], 1.0], delay)
        if self.parts == INVERSE:
            return Process([-gain * lags[2], gain], np.polymul([lags[0], 1.0], [lags[1], 1.0]).tolist(), delay)
        den = np.array([1.0])
        for lag in lags:
            den = np.polymul(den, [lag, 1.0])
        if self.integrating:
            den = np.polymul(den, [1.0, 0.0])
        return Process([gain], den.tolist(), delay)


def memory(instants: np.ndarray, heights: np.ndarray, T: float, tau: np.ndarray, at: np.ndarray) -> np.ndarray:
    """sum_j h_j e^(-(tau - t_j)/T) over the steps made by then: how much of the steps a lag has not yet let through.

    instants, heights: of the steps, shape (m,). tau: where it is wanted. at: steps made by then, both of shape (n,).
    """
    decays = np.exp(-np.diff(instants, prepend=instants[0]) / T).tolist()
    after = list(accumulate(zip(heights.tolist(), decays, strict=True), lambda r, p: (r[0] * p[1] + p[0], 1.0)))
    states = np.array([r[0] for r in after])
    last = np.maximum(at - 1, 0)
    return np.where(at > 0, states[last] * np.exp(-np.maximum(tau - instants[last], 0) / T), 0.0)


FEW_STEPS = 12
RINGS, INVERSE = ("T", "zeta"), ("T1", "T2", "Tz")
FIRST_ORDER = Structure("first order with dead time", 1, False, r"\frac{K_p e^{-Ls}}{1 + Ts}")
SECOND_ORDER = Structure(
    "second order with dead time",
    2,
    False,
    r"\frac{K_p e^{-Ls}}{(1 + T_1 s)(1 + T_2 s)}",
    axes=((0.15, 0.6),),
    low=(1e-3,),
    high=(1.0,),
)
INTEGRATING = Structure("integrating with dead time", 0, True, r"\frac{K_v e^{-Ls}}{s}")
INTEGRATING_LAG = Structure("integrating with a lag and dead time", 1, True, r"\frac{K_v e^{-Ls}}{s (1 + Ts)}")
UNDERDAMPED = Structure(
    "underdamped second order with dead time",
    2,
    False,
    r"\frac{K_p e^{-Ls}}{1 + 2 \zeta T s + T^2 s^2}",
    RINGS,
    ((0.1, 0.4),),
    (0.01,),
    (0.99,),
)
INVERSE_RESPONSE = Structure(
    "two lags with a zero in the right half-plane and dead time",
    3,
    False,
    r"\frac{K_p (1 - T_z s) e^{-Ls}}{(1 + T_1 s)(1 + T_2 s)}",
    INVERSE,
    ((0.3, 0.8), (0.2, 0.7, 2.0)),
    (1e-2, 1e-2),
    (1.0, 5.0),
)
UNUSUAL = (UNDERDAMPED, INVERSE_RESPONSE)
"""Structures that are tried where no lags explain the record."""
STRUCTURES = (FIRST_ORDER, SECOND_ORDER, INTEGRATING, INTEGRATING_LAG)
_RESPONSES = {
    FIRST_ORDER: "first_order",
    SECOND_ORDER: "two_lags",
    INTEGRATING: "integrator",
    INTEGRATING_LAG: "integrator_with_lag",
}


@cache
def _function(name: str) -> Callable[..., np.ndarray]:
    """A derived step response as a NumPy function of t and its time constants."""
    compiled = run_text(_text(name), "numpy")
    return lambda t, *lags: np.broadcast_to(compiled(t, *lags), np.shape(t))


@kept_for(("first_order",), ("two_lags",), ("two_equal_lags",), ("integrator",), ("integrator_with_lag",))
def _text(name: str) -> str:
    expression = getattr(step_responses, name)()
    symbols = (step_responses.T, step_responses.T2, step_responses.w0, step_responses.zeta)
    return lambda_text([step_responses.t, *(c for c in symbols if c in expression.free_symbols)], expression, "numpy")
