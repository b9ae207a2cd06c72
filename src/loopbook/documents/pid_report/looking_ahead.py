"""Looking ahead along the tangent: what the derivative part does with a clean, a noisy and a filtered signal.

Source: pid-report, figures 3.12 and 3.13.
"""

from dataclasses import dataclass

import numpy as np

from loopbook.controllers.pid import Pid
from loopbook.controllers.settings import PidSettings


def swing(t: np.ndarray) -> np.ndarray:
    """A decaying error, exp(-t/4) cos t."""
    return np.exp(-t / 4) * np.cos(t)


@dataclass(frozen=True)
class Prediction:
    """Values predicted at the instants t [s] for t + Td, and what came."""

    t: np.ndarray
    predicted: np.ndarray
    true: np.ndarray

    @property
    def scatter(self) -> float:
        """Root mean square of predicted minus true."""
        return float(np.sqrt(np.mean((self.predicted - self.true) ** 2)))


def predict(
    Td: float, Tf: float = 0.0, noise: float = 0.0, h: float = 0.05, end: float = 10.0, high_pass: bool = False
) -> Prediction:
    """Predict `swing` Td ahead from samples every h: the signal plus the D part of a controller with K = 1.

    Tf: time constant of the derivative's filter [s]; it lets low frequencies pass, or, with high_pass, the others.
    noise: standard deviation added to each sample, the same noise on every call.
    """
    t = np.arange(round(end / h) + 1) * h
    seen = swing(t) + noise * np.random.default_rng(7).standard_normal(len(t))
    low, all_of_it = (-Pid(PidSettings(K=1.0, Td=Td, Tf=T, h=h)).run(seen, 0.0) - seen for T in (Tf, 0.0))
    derivative = all_of_it - low if high_pass else low
    return Prediction(t[1:], (seen + derivative)[1:], swing(t[1:] + Td))


def noise_gain(Td: float, h: float) -> float:
    """Standard deviation of an unfiltered prediction per unit of noise: sqrt((1 + Td/h)^2 + (Td/h)^2)."""
    return float(np.hypot(1 + Td / h, Td / h))
