"""The model structures that a step record can support, each with its exact response to the recorded input."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np


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

    def response(self, time: np.ndarray, steps: list[tuple[float, float]], lags, delay: float) -> np.ndarray:
        """Response of gain 1 to input steps [(instant in s, height)], each delayed by the dead time."""
        total = np.zeros_like(time)
        for instant, height in steps:
            total += height * self.shape(time - instant - delay, lags)
        return total

    def process(self, gain: float, lags: tuple[float, ...], delay: float):
        """The model as a `loopbook.process.transfer_function.Process`."""
        from loopbook.process.transfer_function import Process

        den = np.array([1.0])
        for lag in lags:
            den = np.polymul(den, [lag, 1.0])
        if self.integrating:
            den = np.polymul(den, [1.0, 0.0])
        return Process([gain], den, delay)


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
    import sympy

    from derivations.experiments import step_responses

    expression = getattr(step_responses, name)()
    constants = [c for c in (step_responses.T, step_responses.T2) if c in expression.free_symbols]
    compiled = sympy.lambdify([step_responses.t, *constants], expression, "numpy")
    return lambda t, *lags: np.broadcast_to(compiled(t, *lags), np.shape(t))
