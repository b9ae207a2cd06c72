"""Akaike's corrected criterion of fitted models, with samples counted for what they are worth."""

import numpy as np

from loopbook.identification.fit import Fit
from loopbook.identification.models import Structure

CLEARLY_BETTER = 10.0  # Akaike's criterion: a difference beyond 10 leaves the other model no support


def size_of(fit: Fit) -> int:
    """How many numbers a fit took."""
    beside = {"rest": 1, "drift": 2, "start": 1 + max(fit.structure.lags, 1)}[fit.nuisance]
    return len(fit.parameters) + beside + len(fit.effects)


def criterion(fit: Fit, size: int, effective: float) -> float:
    p = min(size, effective - 2.5)
    return float(effective * np.log(max(fit.rmse, 1e-300) ** 2) + 2 * p * effective / (effective - p - 1))


def effective_samples(fits: list[Fit], n: int) -> float:
    """How many independent samples n are worth, by the correlation of the best fit's residuals."""
    r = min(fits, key=lambda fit: fit.rmse).correlation
    return max(n * (1 - r) / (1 + r), 12.0)


def criteria_of(fits: dict[Structure, Fit], n: int) -> dict[Structure, float]:
    """Akaike's corrected criterion of each fit, less the smallest.

        n_e ln(rmse^2) + 2 p n_e/(n_e - p - 1),    n_e = n (1 - r)/(1 + r)

    with the correlation r of the best fit's residuals for all, so that the criteria count the same samples.
    """
    effective = effective_samples(list(fits.values()), n)
    values = {structure: criterion(fit, size_of(fit), effective) for structure, fit in fits.items()}
    return {structure: value - min(values.values()) for structure, value in values.items()}
