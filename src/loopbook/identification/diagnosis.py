"""Why a record supports no model: the true reason, found from the record, in words that say what to do.

Each function looks for one reason and returns the sentence, or "" where it is not that.
"""

import numpy as np

from loopbook.identification.fit import Fit
from loopbook.identification.least_squares import FitProblem
from loopbook.identification.models import FIRST_ORDER, UNDERDAMPED
from loopbook.identification.normal_equations import linear
from loopbook.records.record import Record
from loopbook.records.steps import Steps, drifts

BELOW_NOISE = 3.0  # peak to peak of the input's contribution, in standard deviations of the noise
MOST_CUT = 0.9  # of the samples
BEYOND_DRIFT = 15.0  # Akaike's criterion: what the input has to bring beyond a straight line
CONTINUAL = 0.4  # of the samples: an input that changes as often may be a regulator's
FOLLOWS = 0.9  # of the input's own news explained by the measurement
BEYOND_PARABOLA = 2.0  # the same beyond a parabola in time
AS_WELL = 1.2  # rms residual of that parabola, against that of the model
LEAST_DISTURBED, DISTURBED = 80.0, 0.9  # percent explained; correlation of the residuals
LONGEST_LAGS = 5.0  # times the record after its first step
CLEARLY_BETTER = 0.7  # rms residual of another kind of model, relative


def saturated(record: Record, most: float = MOST_CUT) -> str:
    """The sensor stood at its limit for more than that share of the record."""
    if record.cut <= most:
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
    """A straight line through the whole record, or a parabola, does as well as the input."""
    used = record.used
    t, y = record.time[used], record.y[used]
    left = [_beside_polynomial(t, y, degree) for degree in (1, 2)]
    alone, bent = left
    if bent > CLEARLY_BETTER * float(np.std(y)):
        return ""
    if alone > 1e-9 * float(np.ptp(y)):
        worth = len(t) * (1 - fit.correlation) / (1 + fit.correlation)
        brings = worth * np.log(alone**2 / max(fit.rmse, 1e-300) ** 2)
        beyond_parabola = worth * np.log(bent**2 / max(fit.rmse, 1e-300) ** 2)
        as_well = beyond_parabola < BEYOND_PARABOLA and bent < AS_WELL * fit.rmse
        if not as_well and (brings > BEYOND_DRIFT or fit.rmse < CLEARLY_BETTER * alone):
            return ""
    return (
        "a drift explains the response as well as the input does: the output was not at rest before the step, or the "
        "record does not show it there; record the process at rest, then the step"
    )


def _beside_polynomial(t: np.ndarray, y: np.ndarray, degree: int) -> float:
    """Root mean square of what a polynomial in time leaves."""
    x = 2 * (t - t[0]) / (t[-1] - t[0]) - 1
    columns = np.polynomial.legendre.legvander(x, degree)
    return float(np.sqrt(np.mean((y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]) ** 2)))


def disturbed(fit: Fit, least: float = LEAST_DISTURBED) -> str:
    """What the input leaves unexplained is large and no noise: its samples follow each other.

    least: percent of the response that a fit has to explain.
    """
    if fit.fit >= least or fit.correlation < DISTURBED:
        return ""
    return (
        f"something else moved the output: the best model ({fit.structure.name}) leaves {100 - fit.fit:.0f} % of it, "
        "and what it leaves is no noise, its samples follow each other; record the step while nothing else happens"
    )


def extrapolated(record: Record, steps: Steps, fit: Fit) -> str:
    """The lags are so long against the record that gain and lags are a guess."""
    length = float(record.time[-1] - steps.list[0][0])
    if fit.structure.integrating or sum(fit.lags) < LONGEST_LAGS * length:
        return ""
    return (
        f"the model is not determined: its time constants ({sum(fit.lags):.3g} s) are far longer than what was "
        f"recorded after the first step ({length:.3g} s); record longer"
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


def has_zero(record: Record, steps: Steps, fit: Fit) -> str:
    """Two lags with gains of their own, of opposite sign, fit clearly better: the response turns back."""
    if steps.course or (fit.correlation < 0.5 and fit.fit > 90):
        return ""
    problem = FitProblem(record, FIRST_ORDER, steps, "rest", {})
    h, length = record.sampling, problem.length
    lags = np.geomspace(max(h / 2, length / 300), length, 14)
    best = (np.inf, 0.0, 0.0)
    for delay in dict.fromkeys((0.0, h, fit.delay)):
        answers = [FIRST_ORDER.response(problem.time, steps.list, (T,), delay) for T in lags]
        for i, fast in enumerate(answers):
            for slow in answers[i + 1 :]:
                columns = np.column_stack([problem.columns((1.0,), delay), fast, slow])
                found = linear(columns, problem.y)
                rms = float(np.sqrt(np.mean((problem.y - columns @ found) ** 2)))
                best = min(best, (rms, float(found[-2]), float(found[-1])))
    rms, fast_gain, slow_gain = best
    if rms > CLEARLY_BETTER * fit.rmse or fast_gain * slow_gain >= 0:
        return ""
    if abs(fast_gain) > abs(slow_gain) or fast_gain * (fast_gain + slow_gain) > 0:
        how = "the response goes beyond where it settles and comes back without ringing"
    else:
        how = "the response first goes the wrong way (an inverse response)"
    return (
        f"{how}: the process has a zero, and the rules here are for processes of lags; a fast and a slow path work "
        "against each other, so tune by hand and slowly, or act on one of them alone"
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
    """The fits are good, their parameters are not; nothing to say of none."""
    if not fits:
        return ""
    best = max(fits, key=lambda fit: fit.fit)
    wide = [f"{p.name} = {p.value:.3g} ± {p.half_width:.2g}" for p in best.parameters]
    return (
        f"the model is not determined: of the best fit ({best.structure.name}) the record leaves open "
        f"{', '.join(wide)}; record longer after the step, sample faster, or step higher"
    )
