"""How far an estimate may be off: noise whose samples follow each other, and a measurement that moves in steps.

    covariance = s^2 c A A' + q^2/12 (A Z)(A Z)',    A = (J'J)^-1 J'

s^2 c is the residuals' variance times what their correlation costs: n samples are worth n/c independent ones
(Bartlett). A quantised measurement that stands still on one level is off by the same unknown amount, up to half a
step q, all the while; averaging does not help. So each run of equal samples has one error of variance q^2/12 (Z adds
up the samples of a run); with noise that makes the measurement change levels, the runs are short and the term is
small.
"""

import numpy as np

CLOSEST = 0.98  # the correlation beyond which residuals are no noise but a poor model
MOST = (1 + CLOSEST) / (1 - CLOSEST)  # what the correlation may cost


def correlation(residuals: np.ndarray) -> float:
    """Of neighbouring residuals, from 0 to `CLOSEST`."""
    return float(np.clip(residuals[1:] @ residuals[:-1] / max(residuals @ residuals, 1e-300), 0.0, CLOSEST))


def cost_of_correlation(residuals: np.ndarray) -> float:
    """c = 1 + 2 (r_1 + r_2 + ...), at least 1, with the autocorrelations r_k up to the first that is not positive.

    At least (1 + r_1)/(1 - r_1), which it is for residuals that forget exponentially.
    """
    n = len(residuals)
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.abs(np.fft.rfft(residuals, size)) ** 2
    lags = np.fft.irfft(spectrum, size)[: n // 3]
    following = lags[1:] / max(lags[0], 1e-300)
    ends = np.flatnonzero(following <= 0)
    total = float(following[: ends[0] if ends.size else None].sum())
    r = correlation(residuals)
    return min(max(1 + 2 * total, (1 + r) / (1 - r)), MOST)


def quantum(y: np.ndarray) -> float:
    """The step of a quantised measurement, 0 where it is none (more than a quarter of the samples differ)."""
    levels = np.unique(y)
    return float(np.diff(levels).min()) if 1 < len(levels) < len(y) / 4 else 0.0


def covariance(jacobian: np.ndarray, residuals: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, float]:
    """(covariance of the parameters, degrees of freedom) of a least-squares fit.

    jacobian: shape (n, p). residuals, y: shape (n,).
    """
    n, p = jacobian.shape
    cost = cost_of_correlation(residuals)
    gains = np.linalg.pinv(jacobian)
    found = float(residuals @ residuals) / max(n - p, 1) * cost * gains @ gains.T
    step = quantum(y)
    if step:
        runs = np.concatenate([[0], 1 + np.flatnonzero(np.diff(y))])
        together = np.add.reduceat(gains, runs, axis=1)
        found += step**2 / 12 * together @ together.T
    return found, max(n / cost - p, 1.0)
