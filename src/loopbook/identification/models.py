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

    name: in words. lags: how many time constants. integrating: the gain is a slope Kv [y/(u s)], else Kp [y/u].
    formula: LaTeX of the transfer function.
    """

    name: str
    lags: int
    integrating: bool
    formula: str

    def shape(self, tau: np.ndarray, lags: tuple[float, ...]) -> np.ndarray:
        """Unit step response of gain 1 at the times tau since the step reached the output; zero for tau <= 0.

        tau: seconds, any shape. lags: time constants in seconds, positive, longest first.
        """
        after = np.maximum(tau, 0.0)
        if self.lags == 2 and lags[1] > 0.98 * lags[0]:
            return _function("two_equal_lags")(after, (lags[0] + lags[1]) / 2)
        return _function(_RESPONSES[self])(after, *lags)

    def response(
        self, time: np.ndarray, steps: Sequence[tuple[float, float]], lags: tuple[float, ...], delay: float
    ) -> np.ndarray:
        """Response of gain 1 to input steps [(instant in s, height)], each delayed by the dead time.

        Many steps, as a recorded ramp has them, go through `memory`: one pass for all.
        """
        if len(steps) > FEW_STEPS:
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

    def process(self, gain: float, lags: tuple[float, ...], delay: float) -> Process:
        """The model as a `loopbook.process.transfer_function.Process`."""
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
FIRST_ORDER = Structure("first order with dead time", 1, False, r"\frac{K_p e^{-Ls}}{1 + Ts}")
SECOND_ORDER = Structure("second order with dead time", 2, False, r"\frac{K_p e^{-Ls}}{(1 + T_1 s)(1 + T_2 s)}")
INTEGRATING = Structure("integrating with dead time", 0, True, r"\frac{K_v e^{-Ls}}{s}")
INTEGRATING_LAG = Structure("integrating with a lag and dead time", 1, True, r"\frac{K_v e^{-Ls}}{s (1 + Ts)}")
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
