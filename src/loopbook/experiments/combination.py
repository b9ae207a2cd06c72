"""Step and frequency experiment together: Kp e^(-L1 s)/((1 + s T1)(1 + s T2)) (pid-report, section 5.2.7).

T1 follows from the gain at -180 degrees and L1 from the phase, for any alpha = T2/T1; what is left is one equation in
alpha, the step response at T63 (`derivations.experiments.two_lags`). `solve` brackets its root. `grid` walks through
100,000 alphas as the program of figure 5.12 does, with its sums and its rounding.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from loopbook.experiments.data import FrequencyData, StepData, TwoLagData
from loopbook.experiments.plant import ExperimentError
from loopbook.lazy import late
from loopbook.printed.store import kept_for, lambda_text, run_text

d = late("derivations.experiments.two_lags")

PRINTED_TAIL = 0.37
ALPHAS = np.concatenate([np.geomspace(1e-9, 1e-2, 60)[:-1], np.linspace(0.01, 1.0, 199)])
EDGE = 1e-6  # what the equation may leave at the ends alpha = 0 and 1, where it touches zero without crossing


@cache
def _functions(backend: str) -> tuple[Callable[..., Any], ...]:
    """T1(alpha, w, Kp, Ku) as printed and without cancellation, L1(w, T1, T2), e1(T1, T2, L1, T63, tail), the same for
    equal lags, e2 and e3."""
    return tuple(run_text(text, backend) for text in _texts(backend))


@kept_for(("math",), ("numpy",))
def _texts(backend: str) -> list[str]:
    import sympy

    tail = sympy.Symbol("tail")
    found = d.residuals(tail)
    forms = d.first_lag(), d.first_lag_without_cancellation()
    first, safe = (lambda_text((d.alpha, d.omega, d.K_p, d.K_u), e, backend) for e in forms)
    dead = lambda_text((d.omega, d.T_1, d.T_2), d.dead_time(), backend)
    arguments = (d.T_1, d.T_2, d.L_1, d.T_63, tail)
    e1, equal = (lambda_text(arguments, e, backend) for e in (found.e1, found.e1_equal))
    e2 = lambda_text((d.T_1, d.T_2, d.omega, d.K_p, d.K_u), found.e2, backend)
    e3 = lambda_text((d.T_1, d.T_2, d.L_1, d.omega), found.e3, backend)
    return [first, safe, dead, e1, equal, e2, e3]


def lags(alpha: float, step: StepData, frequency: FrequencyData) -> tuple[float, float, float]:
    """T1, T2 and L1 that give gain and phase at -180 degrees for one alpha in (0, 1]."""
    _, safe, dead, *_ = _functions("math")
    T1 = safe(alpha, frequency.w180, step.Kp, frequency.Ku)
    return T1, alpha * T1, dead(frequency.w180, T1, alpha * T1)


def residual(alpha: float, step: StepData, frequency: FrequencyData, tail: float = math.exp(-1)) -> float:
    """What the step response at T63 lacks of 1 - tail, for one alpha; the root is the answer."""
    _, _, _, e1, equal, *_ = _functions("math")
    T1, T2, L1 = lags(alpha, step, frequency)
    if step.T63 <= L1:
        return tail - 1.0
    return equal(T1, T1, L1, step.T63, tail) if abs(alpha - 1) < 1e-9 else e1(T1, T2, L1, step.T63, tail)


def solve(step: StepData, frequency: FrequencyData, tail: float = math.exp(-1)) -> TwoLagData:
    """The two-lag model with this step and frequency data, to rounding.

    tail: what of the step is left at T63; e^-1, or 0.37 as section 5.2.7 prints.
    Some data have two solutions; the one whose own tangent starts nearer to step.L is taken.
    Raises ExperimentError where kappa = K180/Kp >= 1, or where no alpha from 0 to 1 satisfies the equation: the process
    is then not of this form, and `nearest` or one of the simpler rules applies.

    >>> found = solve(StepData(1, 1.04, 0.075), FrequencyData(0.0091, 0.199), tail=0.37)
    >>> round(found.T1, 4), round(found.T2, 4), round(found.L1, 4)
    (0.9988, 0.1057, 0.0102)
    """
    found, left = nearest(step, frequency, tail)
    if abs(left) > EDGE:
        raise ExperimentError(
            f"no T2/T1 between 0 and 1 gives both T63 = {step.T63:.4g} s and the frequency data (the equation is short "
            f"by {abs(left):.2g} of the step at best): two lags and a dead time do not describe the process; use "
            "amigo-step-pid, or amigo-frequency-pid where kappa > 0.2, or combination.nearest"
        )
    return found


def nearest(step: StepData, frequency: FrequencyData, tail: float = math.exp(-1)) -> tuple[TwoLagData, float]:
    """The two-lag model that comes closest, and what it leaves of the equation (0 where `solve` succeeds).

    It has the measured gain and phase at -180 degrees whatever is left; the step response is then missed by that much
    at T63. This is where the program of figure 5.12 ends for a process of another form.
    Raises ExperimentError where kappa >= 1 or no alpha gives a dead time that is not negative.
    """
    if frequency.kappa(step.Kp) >= 1:
        raise ExperimentError(
            f"kappa = K180/Kp = {frequency.kappa(step.Kp):.4g} >= 1: no lag lowers the gain at -180 degrees; the "
            "process is nearly a pure dead time, use amigo-step-pi or amigo-step-pid"
        )
    _, safe, dead, e1, equal, *_ = _functions("numpy")
    T1 = safe(ALPHAS, frequency.w180, step.Kp, frequency.Ku)
    L1 = dead(frequency.w180, T1, ALPHAS * T1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        values = e1(T1, ALPHAS * T1, L1, step.T63, tail)
    values[-1] = equal(T1[-1], T1[-1], L1[-1], step.T63, tail)
    values = np.where(step.T63 <= L1, tail - 1.0, values)
    possible = np.flatnonzero(L1 >= 0)
    if not possible.size:
        raise ExperimentError(f"every model would need a negative dead time, L1 = {L1.max():.3g} s at most")
    change = [i for i in possible[:-1] if i + 1 in possible and (values[i] < 0) != (values[i + 1] < 0)]
    if change:
        data = step, frequency
        roots = [_root(float(ALPHAS[i]), float(ALPHAS[i + 1]), (*data, tail)) for i in change]
        found = [TwoLagData(step.Kp, *lags(alpha, *data)) for alpha in roots]
        return min(found, key=lambda model: abs(_tangent(model) - step.L) if len(found) > 1 else 0.0), 0.0
    i = int(possible[np.argmin(abs(values[possible]))])
    return TwoLagData(step.Kp, float(T1[i]), float(ALPHAS[i] * T1[i]), float(L1[i])), float(values[i])


def _root(a: float, b: float, data: tuple[StepData, FrequencyData, float]) -> float:
    """The alpha in [a, b] at which the equation holds; an end where nothing but rounding is left of it."""
    from scipy.optimize import brentq

    ends = {alpha: residual(alpha, *data) for alpha in (a, b)}
    if ends[a] * ends[b] >= 0:
        return min(ends, key=lambda alpha: abs(ends[alpha]))
    return brentq(residual, a, b, data, xtol=1e-15, rtol=1e-13)


def _tangent(model: TwoLagData) -> float:
    """The dead time that a step experiment would read off the two-lag model: where its steepest tangent starts.

    The slope of the step response, the difference of both modes, is largest at t = log(T1/T2) T1 T2/(T1 - T2) after L1.
    """
    T1, T2 = model.T1, model.T2
    if T2 < 1e-9 * T1:
        return model.L1
    ratio = T1 / T2
    t = T1 if abs(ratio - 1) < 1e-6 else math.log(ratio) * T1 / (ratio - 1)
    slope = math.exp(-t / T1) / T1  # both modes fall together there
    reached = 1 - (T1 + T2) * slope
    return model.L1 + t - reached / slope


@dataclass(frozen=True)
class GridSearch:
    """The outcome of the printed program: the best alpha with its error and lags, and how many alphas were tried.

    equal_lags: whether the branch for alpha = 1 was ever taken. largest_e2, largest_e3: of the residuals that vanish.
    """

    error: float
    alpha: float
    data: TwoLagData
    tried: int
    equal_lags: bool
    largest_e2: float
    largest_e3: float


def grid(step: StepData, frequency: FrequencyData, spacing: float = 1e-5, tail: float = PRINTED_TAIL) -> GridSearch:
    """Walk alpha from `spacing` to 1 by repeated addition, in double precision, and keep the smallest error.

    The accumulated sum matters: after 100,000 additions alpha is not exactly 1.
    """
    count = round(1 / spacing) + 2
    alpha = np.cumsum(np.full(count, spacing))  # adds in order, as the program does
    alpha = alpha[alpha <= 1.0]
    first, _, dead, e1, equal, e2, e3 = _functions("numpy")
    w, Kp, Ku = frequency.w180, step.Kp, frequency.Ku
    T1 = first(alpha, w, Kp, Ku)
    T2 = alpha * T1
    L1 = dead(w, T1, T2)
    with np.errstate(divide="ignore", invalid="ignore"):
        one = np.where(alpha != 1.0, e1(T1, T2, L1, step.T63, tail), equal(T1, T2, L1, step.T63, tail))
    two, three = e2(T1, T2, w, Kp, Ku), e3(T1, T2, L1, w)
    error = np.sqrt(one**2 + two**2 + three**2)
    best = int(np.argmin(error))
    found = TwoLagData(Kp, float(T1[best]), float(T2[best]), float(L1[best]))
    exact_one = bool((alpha == 1.0).any())
    largest = float(abs(two).max()), float(abs(three).max())
    return GridSearch(float(error[best]), float(alpha[best]), found, len(alpha), exact_one, *largest)
