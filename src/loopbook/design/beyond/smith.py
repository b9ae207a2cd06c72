"""A Smith predictor, where dead time dominates: a PI for the model without dead time, as fast as robustness lets it.

    C = T/(Kp lambda) (1 + 1/(s T)),    lambda as small as Ms and a wrong dead time allow

The fastest lambda is taken for which the loop keeps the aim's Ms and stays stable with the dead time wrong by a quarter
either way, or by its own uncertainty where that is more.
"""

import numpy as np

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design.beyond.offer import Offer, best_pid, integrated_error, vanished
from loopbook.design.evaluation import Evaluation
from loopbook.design.model import Model
from loopbook.loop.smith import SmithLoop
from loopbook.loop.transfer import LoopError

DOMINATES = 0.5  # L/(L + T): from here on the dead time does
WRONG = 0.25  # of the dead time: what the loop must bear at least
SPEEDS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 0.7, 0.8, 1.0, 1.3)  # lambda over the dead time
NAME = "Smith predictor"


def smith_offer(model: Model, loops: list[Evaluation], Ms: float) -> Offer:
    """The predictor for this model beside the best PID of `loops` that keeps Ms."""
    T = sum(model.lags)
    share = model.delay / (model.delay + T) if T else 0.0
    if model.integrating:
        return Offer(NAME, refused="the process integrates: the predictor would let a load stay")
    if not model.of_lags:
        return Offer(NAME, refused="the process is not lags and a dead time")
    if share < DOMINATES:
        return Offer(NAME, refused=f"dead time does not dominate: L/(L + T) = {share:.2f}, {DOMINATES:g} is asked")
    pid = best_pid(loops, Ms)
    if pid is None:
        return Offer(NAME, refused=f"no PID keeps Ms = {Ms:g} to compare with")
    wrong = max(WRONG * model.delay, _uncertainty(model))
    for speed in SPEEDS:
        closed = speed * model.delay
        settings = PidStandard(T / (model.gain * closed), T)
        loop = SmithLoop(model.process, settings)
        try:
            bears = loop.robustness()
        except LoopError:
            continue
        low, high = (float(x) for x in bears.delay)
        if bears.margins.Ms.value > Ms or low > max(model.delay - wrong, 0.0) or high < model.delay + wrong:
            continue
        K, Kp = settings.K, model.gain
        horizon = vanished(loop, model.lags, model.delay)
        aimed = integrated_error(loop, "reference", horizon)
        return Offer(
            NAME,
            "a load step",
            integrated_error(loop, "load", horizon),
            pid.iae_load,
            (("K", K), ("Ti", T), ("model gain", Kp), ("model T", T), ("model L", model.delay), ("lambda", closed)),
            (
                f"PI with K = {K:.4g}, Ti = {T:.4g} s on the model {Kp:.4g}/(1 + {T:.4g} s) with {model.delay:.4g} s "
                f"of dead time; Ms = {bears.margins.Ms.value:.2f}.",
                f"The process's dead time may be between {low:.3g} and {high:.3g} s, its gain up to "
                f"{float(bears.gain.high):.2f} times the model's, before the loop is unstable.",
                f"After a set-point step the integrated error is {aimed:.4g} instead of "
                f"{pid.iae_reference:.4g} with {pid.candidate.name}.",
            ),
        )
    return Offer(NAME, refused=f"none keeps Ms = {Ms:g} with the dead time wrong by {wrong:.3g} s")


def _uncertainty(model: Model) -> float:
    """The half-width of the dead time's 95 % interval [s], 0 where it is taken as exact."""
    return 0.0 if model.covariance is None else 1.96 * float(np.sqrt(max(model.covariance[-1][-1], 0.0)))
