"""Why a record supports no model: the true reason, found from the record, in words that say what to do.

Each function looks for one reason and returns the sentence, or "" where it is not that.
"""

import numpy as np

from loopbook.identification.fit import Fit
from loopbook.identification.least_squares import FitProblem, drifts
from loopbook.identification.models import UNDERDAMPED
from loopbook.records.record import Record
from loopbook.records.steps import Steps

BELOW_NOISE = 3.0  # peak to peak of the input's contribution, in standard deviations of the noise
MOST_CUT = 0.9  # of the samples
MOST_BESIDE_DRIFT = 0.7  # of the output's spread: a line that leaves more explains nothing
BEYOND_DRIFT = 15.0  # Akaike's criterion: what the input has to bring beyond a straight line
CONTINUAL = 0.4  # of the samples: an input that changes as often may be a regulator's
FOLLOWS = 0.9  # of the input's own news explained by the measurement
CLEARLY_BETTER = 0.7  # rms residual of another kind of model, relative


def saturated(record: Record) -> str:
    """The sensor stood at its limit for most of the record."""
    if record.cut <= MOST_CUT:
        return ""
    return (
        f"the measurement is saturated: for {100 * record.cut:.0f} % of the samples it is at a limit of the sensor; "
        "use a smaller step, or a sensor of a wider range"
    )


def below_noise(fit: Fit, steps: Steps) -> str:
    """The part of the output that the input made is not larger than the noise."""
    noise = max(fit.noise, steps.noise)
    if not fit.answer < BELOW_NOISE * noise:
        return ""
    return (
        f"the model is not determined: what the input does to the output ({fit.answer:.3g} from end to end) is lost in "
        f"the noise (standard deviation {noise:.3g}); use a higher step"
    )


def drift_explains(record: Record, fit: Fit) -> str:
    """A straight line through the whole record does as well as the input."""
    used = record.used
    t, y = record.time[used], record.y[used]
    columns = np.column_stack([np.ones(len(t)), t])
    left = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
    alone = float(np.sqrt(np.mean(left**2)))
    if alone > MOST_BESIDE_DRIFT * float(np.std(y)):
        return ""
    worth = len(t) * (1 - fit.correlation) / (1 + fit.correlation)
    if alone > 1e-9 * float(np.ptp(y)) and worth * np.log(alone**2 / max(fit.rmse, 1e-300) ** 2) > BEYOND_DRIFT:
        return ""
    return (
        "a drift explains the response as well as the input does: the output was not at rest before the step, or the "
        "record does not show it there; record the process at rest, then the step"
    )


def closed_loop(record: Record) -> str:
    """The input is made from the measurement, sample by sample: a regulator was at work.

    What the input's own past does not say of its next change is explained by the measurement.
    """
    u, y = record.u, record.y
    change = np.diff(u)
    if np.mean(change != 0) < CONTINUAL or len(u) < 40:
        return ""
    k = np.arange(3, len(u))
    past = np.column_stack([np.ones(len(k)), *[change[k - 1 - i] for i in (1, 2)]])
    with_y = np.column_stack([past, *[y[k - i] for i in range(4)]])
    news = _explained(change[k - 1], past)
    left = _explained(change[k - 1], with_y)
    if news <= 1e-6 * float(np.ptp(u)) or left**2 > (1 - FOLLOWS) * news**2:
        return ""
    return (
        "the record was made in closed loop: the input follows the measurement sample by sample, so it shows the "
        "regulator and not the process; put the regulator in manual and step the input"
    )


def _explained(target: np.ndarray, columns: np.ndarray) -> float:
    """Root mean square of what the columns leave, the few largest residuals (set-point changes) set aside."""
    left = target - columns @ np.linalg.lstsq(columns, target, rcond=None)[0]
    kept = np.abs(left) <= np.quantile(np.abs(left), 0.97)
    left = target[kept] - columns[kept] @ np.linalg.lstsq(columns[kept], target[kept], rcond=None)[0]
    return float(np.sqrt(np.mean(left**2)))


def rings(fit: Fit) -> str:
    """A pair of complex poles fits clearly better than the lags that the user fixed."""
    if fit.structure is not UNDERDAMPED:
        return ""
    T, zeta = fit.lags
    return (
        f"the process is underdamped: its response rings with a period of {2 * np.pi * T / np.sqrt(1 - zeta**2):.3g} s "
        f"and a damping ratio of {zeta:.2f}; time constants that are given do not describe it: leave them out"
    )


def asymmetric(record: Record, steps: Steps, fit: Fit) -> str:
    """The gain of steps upwards and downwards differs."""
    up = [s for s in steps.list if s[1] > 0]
    down = [s for s in steps.list if s[1] < 0]
    if steps.course or not up or not down:
        return ""
    problem = FitProblem(record, fit.structure, steps, fit.nuisance, {})
    answers = [fit.structure.response(problem.time, part, fit.lags, fit.delay) for part in (up, down)]
    columns = np.column_stack([problem.columns(fit.lags, fit.delay), *answers])
    coefficients = np.linalg.lstsq(columns, problem.y, rcond=None)[0]
    rms = float(np.sqrt(np.mean((problem.y - columns @ coefficients) ** 2)))
    a, b = coefficients[-2:]
    if rms > CLEARLY_BETTER * fit.rmse or abs(a - b) < 0.2 * max(abs(a), abs(b)):
        return ""
    return (
        f"the process is asymmetric: its gain is {a:.3g} for steps upwards and {b:.3g} for steps downwards; "
        "record the direction that matters alone, or both around the working point with small steps"
    )


def not_at_rest(record: Record, steps: Steps) -> str:
    """The output moved before the input did."""
    if not drifts(record, steps):
        return ""
    return (
        "the process was not at rest before the step: the output moves already then, and nothing here explains how; "
        "wait until it stands still, then step the input"
    )


def below_sample(record: Record, fit: Fit) -> str:
    """The process is over before the next sample."""
    if not fit.lags or max(fit.lags) >= record.sampling:
        return ""
    return (
        f"the time constant ({max(fit.lags):.3g} s) is shorter than the sampling interval ({record.sampling:.3g} s): "
        "the record does not show how the output gets there; sample at least five times in a time constant"
    )


def not_determined(fits: list[Fit]) -> str:
    """The fit is good, its parameters are not."""
    best = max(fits, key=lambda fit: fit.fit)
    wide = [f"{p.name} = {p.value:.3g} ± {p.half_width:.2g}" for p in best.parameters]
    return (
        f"the model is not determined: of the best fit ({best.structure.name}) the record leaves open "
        f"{', '.join(wide)}; record longer after the step, sample faster, or step higher"
    )
