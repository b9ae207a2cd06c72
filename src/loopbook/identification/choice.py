"""Which model a record supports, and why, in words an engineer can argue with."""

from dataclasses import dataclass

import numpy as np

from loopbook.identification.least_squares import Fit, fit_all
from loopbook.identification.models import FIRST_ORDER, INTEGRATING, SECOND_ORDER, Structure
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record, RecordError
from loopbook.records.steps import Steps

CLEARLY_BETTER = 10.0  # Akaike's criterion: a difference beyond 10 leaves the other model no support
POOREST_FIT = 40.0  # percent


@dataclass(frozen=True)
class Identified(ShownAsTable):
    """A record with its fitted models and the one that was chosen.

    criteria: Akaike's criterion of each structure relative to the best, all with the same effective number of samples.
    reasons: why this one. warnings: what a user of the model has to know; empty where nothing is to be said.
    """

    record: Record
    steps: Steps
    fits: dict[Structure, Fit]
    criteria: dict[Structure, float]
    chosen: Fit
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]

    @property
    def process(self) -> Process:
        """The chosen model."""
        return self.chosen.process

    def table(self) -> PlainTable:
        """The chosen model's parameters with the half-widths of their 95 % intervals."""
        return self.chosen.table()

    def __str__(self) -> str:
        return "\n".join([str(self.chosen), *self.reasons, *(f"mind: {text}" for text in self.warnings)])


def _criteria(fits: dict[Structure, Fit], n: int) -> dict[Structure, float]:
    """Akaike's corrected criterion of each fit, less the smallest.

        n_e ln(rmse^2) + 2 p n_e/(n_e - p - 1),    n_e = n (1 - r)/(1 + r)

    with the correlation r of the best fit's residuals for all, so that the criteria count the same samples.
    """
    r = min(fits.values(), key=lambda fit: fit.rmse).correlation
    effective = max(n * (1 - r) / (1 + r), 12.0)

    def criterion(fit: Fit) -> float:
        p = len(fit.parameters) + 1
        return effective * np.log(max(fit.rmse, 1e-300) ** 2) + 2 * p * effective / (effective - p - 1)

    values = {structure: float(criterion(fit)) for structure, fit in fits.items()}
    return {structure: value - min(values.values()) for structure, value in values.items()}


def determined(fit: Fit) -> bool:
    """Does the record determine the gain and every time constant to better than their own size?"""
    return all(p.half_width < abs(p.value) for p in fit.parameters[:-1])


def identify(record: Record) -> Identified:
    """Fit every structure and choose the simplest that no other one clearly beats.

    Raises RecordError where no step is found, the output does not answer, or no model explains the response.
    """
    steps, fits = fit_all(record)
    criteria = _criteria(fits, len(record.time))
    usable = [s for s in fits if determined(fits[s])]
    if not usable or max(fits[s].fit for s in usable) < POOREST_FIT:
        best = max(fits.values(), key=lambda fit: fit.fit)
        raise RecordError(
            f"no model explains the response: the best ({best.structure.name}) leaves {100 - best.fit:.0f} % of it; "
            "was something else disturbing the process, or is the response not that of a step?"
        )
    least = min(criteria[s] for s in usable)
    complexity = {s: len(fits[s].parameters) for s in usable}
    chosen = min(
        (s for s in usable if criteria[s] - least <= CLEARLY_BETTER), key=lambda s: (complexity[s], criteria[s])
    )
    return Identified(
        *(record, steps, fits, criteria, fits[chosen]),
        tuple(_reasons(fits, criteria, chosen, usable)),
        tuple(_warnings(fits[chosen], fits, steps)),
    )


def _reasons(fits, criteria, chosen, usable) -> list[str]:
    fit = fits[chosen]
    reasons = [f"{chosen.name.capitalize()} explains {fit.fit:.1f} % of the response (rms residual {fit.rmse:.3g})."]
    for other in (s for s in fits if s is not chosen):
        if other not in usable:
            reasons.append(f"{other.name.capitalize()}: the record does not determine its parameters.")
        elif criteria[other] - criteria[chosen] > CLEARLY_BETTER:
            reasons.append(
                f"{other.name.capitalize()} fits clearly worse ({fits[other].fit:.1f} %, "
                f"Akaike +{criteria[other] - criteria[chosen]:.0f})."
            )
        else:
            reasons.append(f"{other.name.capitalize()} fits no better to speak of ({fits[other].fit:.1f} %).")
    return reasons


def _warnings(fit: Fit, fits: dict[Structure, Fit], steps: Steps) -> list[str]:
    """What limits the use of the model."""
    found = [note for note in steps.notes if "uncertain" in note or "at rest" in note]
    if fit.settled < 3:
        found.append(
            f"The record ends {fit.settled:.1f} time constants after the last step, before the output has settled: "
            "the gain is an extrapolation. A record of four time constants or more would determine it."
        )
    gain = fit.parameters[0]
    if gain.half_width > 0.2 * abs(gain.value):
        found.append(f"The gain is uncertain by {100 * gain.half_width / abs(gain.value):.0f} %.")
    delay = fit.parameters[-1]
    if delay.value < delay.half_width:
        found.append(
            f"The dead time ({delay.value:.3g} s) cannot be told from zero (± {delay.half_width:.2g} s): rules that "
            "divide by L would ask for gains the data do not support."
        )
    if fit.structure is FIRST_ORDER and fit.correlation > 0.9 and fits[SECOND_ORDER].rmse < 0.8 * fit.rmse:
        found.append("The residuals have structure: a second lag may be there.")
    if fit.structure is not INTEGRATING and fit.fit < 80:
        found.append(f"The model leaves {100 - fit.fit:.0f} % of the response unexplained.")
    return found
