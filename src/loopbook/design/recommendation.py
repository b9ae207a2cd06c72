"""Which regulator for which aim, with the reasons in numbers."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from derivations.errors import LoopbookError
from loopbook.design.evaluation import Evaluation, Robustness


class AimError(LoopbookError):
    """An aim that is not known, or one that no candidate can serve at all."""


@dataclass(frozen=True)
class Aim:
    """What is asked of a regulator.

    admits: what a loop must keep, in words and as a function. Ms: the largest of these.
    cost: what is then made smallest, in words and as a function; smaller is better.
    """

    name: str
    keeps: str
    admits: Callable[[Evaluation, float], bool]
    Ms: float
    smallest: str
    cost: Callable[[Evaluation], float]


def _ms(limit: float) -> Callable[[Evaluation, float], bool]:
    return lambda e, Ms: Ms <= limit


AIMS = {
    "robust": Aim(
        "robust", "Ms at most 1.6", _ms(1.6), 1.6, "the integrated error after a load step", lambda e: e.iae_load
    ),
    "fast": Aim(
        "fast",
        "Ms at most 2 and a phase margin of 30 degrees",
        lambda e, Ms: Ms <= 2.0 and e.phase_margin >= 30,
        2.0,
        "the product of the integrated errors after a reference and a load step",
        lambda e: e.iae_reference * e.iae_load,
    ),
    "no-overshoot": Aim(
        "no-overshoot",
        "an overshoot of at most 1 % and Ms at most 2",
        lambda e, Ms: e.overshoot <= 1.0 and Ms <= 2.0,
        2.0,
        "the integrated error after a reference step",
        lambda e: e.iae_reference,
    ),
    "quiet": Aim(
        "quiet",
        "Ms at most 1.6",
        _ms(1.6),
        1.6,
        "the noise amplification times the integrated error after a load step",
        lambda e: e.noise_gain * e.iae_load,
    ),
}


@dataclass(frozen=True)
class Recommendation:
    """The chosen loop, why, and what to mind.

    admitted: the loops that kept what the aim asks, best first. compromise: True where none did and the most robust
    loop was taken instead.
    """

    aim: Aim
    chosen: Evaluation
    admitted: tuple[Evaluation, ...]
    reasons: tuple[str, ...]
    compromise: bool


def worst_peak(e: Evaluation, found: Robustness | None) -> float:
    """Ms of a loop over its model's uncertainty, infinite where a model of it makes the loop unstable."""
    if found is None or not found.models:
        return e.Ms
    return max(e.Ms, found.Ms) if found.stable == found.models else math.inf


def recommend(
    evaluations: Sequence[Evaluation], aim: str = "robust", spread: dict[str, Robustness] | None = None
) -> Recommendation:
    """Choose for an aim: "robust", "fast", "no-overshoot" or "quiet".

    spread: by candidate name, how it bears the model's uncertainty; Ms is then its 95 % quantile, and a candidate with
    an unstable loop in the confidence region is not admitted. Raises AimError for an unknown aim, and where no loop is
    stable at all.
    """
    if aim not in AIMS:
        raise AimError(f"aim = {aim!r}: one of {', '.join(AIMS)}")
    wanted, spread = AIMS[aim], spread or {}
    stable = [e for e in evaluations if e.stable]
    if not stable:
        raise AimError("no rule gives a stable loop with this process: it needs a design of its own")

    def worst(e: Evaluation) -> float:
        return worst_peak(e, spread.get(e.candidate.name))

    admitted = sorted((e for e in stable if wanted.admits(e, worst(e))), key=wanted.cost)
    if admitted:
        best, *others = admitted
        reasons = [f"{best.candidate.name} keeps {wanted.keeps} and makes {wanted.smallest} smallest."]
        if others:
            ratio = wanted.cost(others[0]) / wanted.cost(best) if wanted.cost(best) else math.inf
            reasons.append(f"Next comes {others[0].candidate.name}, {100 * (ratio - 1):.0f} % more.")
        reasons.append(f"{len(admitted)} of {len(evaluations)} settings keep {wanted.keeps}.")
    else:
        best = min(stable, key=worst)
        reasons = [
            f"No setting keeps {wanted.keeps}; {best.candidate.name} comes nearest by its Ms of {worst(best):.2f}."
        ]
    if spread and math.isfinite(worst(best)):
        reasons.append(f"Over the model's uncertainty its Ms stays below {worst(best):.2f} in 95 of 100 models.")
    reasons += best.candidate.notes
    return Recommendation(wanted, best, tuple(admitted), tuple(reasons), not admitted)
