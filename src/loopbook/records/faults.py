"""What a sensor does wrong: single samples far off, and a measurement cut at a limit. Said, and left out of a fit."""

from dataclasses import dataclass

import numpy as np

from loopbook.records.steps import noise_level

FAR = 8.0  # standard deviations of the noise, for a sample that both its sides contradict
FAR_AWAY = 2.0  # times the range of all other samples
MOST_MISSING = 0.4  # of the samples
WINDOW = 7  # samples
LONGEST_SPIKE = 3  # samples
LEAST_CUT = 0.02  # of the samples: a shorter stand-still at the extreme is no limit
LONGEST_STILL = 10  # samples that noise does not leave equal
STILL_ELSEWHERE = 0.05  # of the samples
NAMED_ONE_BY_ONE = 5


@dataclass(frozen=True)
class Faults:
    """left_out: samples that a fit must not use, shape (n,). cut: the share of the samples at a sensor's limit."""

    left_out: np.ndarray
    cut: float
    notes: tuple[str, ...]


def find_faults(time: np.ndarray, u: np.ndarray, y: np.ndarray) -> Faults:
    """Outliers and cut-off stretches of the measurement y, shape (n,)."""
    missing = _stand_ins(y, u)
    usual = np.interp(np.arange(len(y)), np.flatnonzero(~missing), y[~missing]) if missing.any() else y
    spikes = _spikes(usual, u)
    limits, notes = _cuts(np.where(spikes | missing, np.nan, y))
    if missing.any():
        value = f"{y[missing][0]:.6g}"
        notes.insert(0, f"The measurement is {value} at {missing.sum()} samples, far from all others: a logger's sign "
                        "for a missing value; these samples were left out.")  # fmt: skip
    if spikes.any():
        shown = [f"{y[k]:.4g} at {time[k]:.4g} s" for k in np.flatnonzero(spikes)[:NAMED_ONE_BY_ONE]]
        more = f" and {spikes.sum() - len(shown)} more" if spikes.sum() > len(shown) else ""
        one = "is an outlier" if spikes.sum() == 1 else "are outliers"
        notes.insert(0, f"The measurement {', '.join(shown)}{more} {one} (a sensor's glitch) and left out of the fit.")
    stuck = _stuck(np.where(spikes | missing | limits, np.nan, y))
    if stuck.any():
        k = np.flatnonzero(stuck)
        notes.append(f"The measurement stands still at {y[k[0]]:.4g} for {len(k)} samples from {time[k[0]]:.4g} s on, "
                     "though elsewhere it never does: these samples were left out of the fit.")  # fmt: skip
    return Faults(spikes | limits | missing | stuck, float(limits.mean()), tuple(notes))


def _stand_ins(y: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Samples of one same value, such as -9999, that is further from all others than these are from each other.

    A value that the measurement has at every sample before the input moves is its rest.
    """
    found = np.zeros(len(y), bool)
    moves = int(np.argmax(u != u[0])) or len(u)
    for extreme in (y.min(), y.max()):
        at = y == extreme
        others = y[~at]
        if 1 < at.sum() <= MOST_MISSING * len(y) and len(np.unique(others)) > 2 and not at[:moves].all():
            away = float(np.abs(others - extreme).min())
            if away > FAR_AWAY * float(np.ptp(others)):
                found |= at
    return found


def _spikes(y: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Samples, three in a row at most, that lie far from what both their sides agree on.

    At the ends one side is judged alone: the first sample against the next ones, if those agree among themselves.
    """
    n = len(y)
    if n < 3 * WINDOW:
        return np.zeros(n, bool)
    bends = np.abs(np.diff(y, 2))
    bends = bends[bends > 0]  # where a sensor stands at its limit there is nothing to see of its noise
    sigma = max(noise_level(y), _quiet(y), float(np.median(bends)) / 1.65 if len(bends) else 0.0)
    median = _running_median(y, WINDOW)
    rough = float(np.median(np.abs(y - median)))
    threshold = max(FAR * max(sigma, 1.4826 * rough), 0.02 * float(np.ptp(median)))
    found = np.abs(y - median) > threshold
    for at, inside in ((0, y[1:WINDOW]), (n - 1, y[-WINDOW:-1])):
        agree = float(np.ptp(inside))
        found[at] = abs(y[at] - np.median(inside)) > max(threshold, 3 * agree)
    runs = np.flatnonzero(np.diff(np.concatenate([[False], found, [False]]).astype(int)))
    for start, end in zip(runs[::2], runs[1::2], strict=True):
        beside = y[[i for i in (start - 1, end) if 0 <= i < n]]
        stays = end - start > LONGEST_SPIKE or (start and np.min(np.abs(beside - y[start])) < threshold / 2)
        stepped = len(beside) == 2 and abs(beside[1] - beside[0]) > np.min(np.abs(y[start] - beside))
        if stays or stepped:
            found[start:end] = False
    return found if found.sum() <= 0.05 * n else np.zeros(n, bool)


def _quiet(y: np.ndarray) -> float:
    """A floor for the noise: the smallest step between the levels of the measurement."""
    steps = np.diff(np.unique(y))
    return float(np.median(steps)) / 2 if 0 < len(steps) < len(y) / 4 else 0.0


def _running_median(y: np.ndarray, width: int) -> np.ndarray:
    padded = np.pad(y, width // 2, mode="reflect")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, width), axis=1)


def _stuck(y: np.ndarray) -> np.ndarray:
    """The longest stretch in which a noisy measurement stands still, where it does so nowhere else."""
    moves = np.diff(y)
    if not np.mean(moves[1:] * moves[:-1] < 0) > 0.2:  # no noise: standing still is what it does at rest
        return np.zeros(len(y), bool)
    same = moves == 0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], same, [False]]).astype(int)))
    found = np.zeros(len(y), bool)
    if not len(edges):
        return found
    start, end = max(zip(edges[::2], edges[1::2], strict=True), key=lambda run: run[1] - run[0])
    elsewhere = int(same.sum()) - int(end - start)
    if end - start >= max(LONGEST_STILL, LEAST_CUT * len(y)) and elsewhere < STILL_ELSEWHERE * len(y):
        found[start + 1 : end + 1] = True
    return found


def _cuts(y: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Stretches where the measurement stands still at its highest or lowest value, though elsewhere it does not."""
    left_out = np.zeros(len(y), bool)
    notes: list[str] = []
    known = y[np.isfinite(y)]
    if not len(known) or np.ptp(known) == 0:
        return left_out, notes
    for limit, word in ((known.max(), "highest"), (known.min(), "lowest")):
        at = y == limit
        if at.sum() >= max(5, LEAST_CUT * len(y)) and _is_cut(y, at, limit):
            left_out |= at
            notes.append(
                f"The measurement stands at its {word} value, {limit:.4g}, for {at.sum()} of {len(y)} samples: the "
                "sensor was cut off there; these samples were left out of the fit."
            )
    return left_out, notes


def _is_cut(y: np.ndarray, at: np.ndarray, limit: float) -> bool:
    """Does the curve run into the limit with a bend, or stand still where its noise should go on?"""
    edges = np.flatnonzero(np.diff(at.astype(int)))
    inner = [slice(a + 1, b + 1) for a, b in zip([-1, *edges], [*edges, len(y) - 1], strict=True)]
    longest = max((s for s in inner if at[s.start]), key=lambda s: s.stop - s.start)
    length = longest.stop - longest.start
    if length < 5:
        return False
    away = y[np.isfinite(y) & ~at]
    span = float(np.ptp(y[np.isfinite(y)]))
    near = np.abs(away - limit) < 0.02 * span
    moves = np.diff(away)
    noisy = float(np.mean(moves[1:] * moves[:-1] < 0)) > 0.2 and len(np.unique(away)) > len(away) / 3
    starts_there = longest.start == 0 and not near.any()
    if noisy and not starts_there:
        return True
    slopes = []
    for side in (y[max(longest.start - 6, 0) : longest.start], y[longest.stop : longest.stop + 6][::-1]):
        side = side[np.isfinite(side)]
        if len(side) >= 3:
            slopes.append(abs(limit - side[0]) / len(side))
    steepest = float(np.nanmax(np.abs(np.diff(y)))) if len(y) > 1 else 0.0
    before_step = longest.start == 0
    return bool(slopes) and not before_step and max(slopes) > 0.25 * steepest and max(slopes) * length > 0.2 * span
