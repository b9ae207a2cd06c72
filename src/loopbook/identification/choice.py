"""Which model a record supports, and why, in words an engineer can argue with."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from loopbook.identification import diagnosis
from loopbook.identification.closed_loop import closed_steps, fit_all_closed, recognised
from loopbook.identification.criteria import CLEARLY_BETTER, criteria_of, criterion, effective_samples, size_of
from loopbook.identification.directions import CLEARLY_DIFFERENT, Directions, fit_directions
from loopbook.identification.fit import Fit
from loopbook.identification.least_squares import fit_all
from loopbook.identification.models import FIRST_ORDER, INTEGRATING, Structure
from loopbook.identification.oscillation import Oscillation, find_oscillation, integrator_through
from loopbook.identification.reasons import both_ways, limits_of_use, why_chosen
from loopbook.identification.unusual import asks, unusual_fits
from loopbook.loop.ultimate_point import NoSuchFrequency, ultimate
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record, RecordError
from loopbook.records.steps import Steps, find_steps

POOREST_FIT = 40.0  # percent
HALF = 0.5  # of the samples at a limit of the sensor: where nothing else can be seen, that is why
GOOD_FIT, PATTERN = 97.0, 0.5  # percent; correlation of residuals that shows a pattern


@dataclass(frozen=True)
class Identified(ShownAsTable):
    """A record with its fitted models and the one that was chosen.

    criteria: Akaike's criterion of each structure relative to the best, all with the same effective number of samples.
    reasons: why this one. warnings: what a user of the model has to know; empty where nothing is to be said.
    directions: a model for each direction of the output, where they differ; `chosen` is then the worse one.
    oscillation: of a relay or at the edge of stability, where the record ends in one.
    """

    record: Record
    steps: Steps
    fits: dict[Structure, Fit]
    criteria: dict[Structure, float]
    chosen: Fit
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]
    directions: Directions | None = None
    oscillation: Oscillation | None = None

    @property
    def process(self) -> Process:
        """The chosen model."""
        return self.chosen.process

    def table(self) -> PlainTable:
        """The chosen model's parameters with the half-widths of their 95 % intervals."""
        return self.chosen.table()

    def __str__(self) -> str:
        return "\n".join([str(self.chosen), *self.reasons, *(f"mind: {text}" for text in self.warnings)])


def determined(fit: Fit) -> bool:
    """Does the record determine the gain and every time constant to better than their own size?"""
    return all(p.half_width < abs(p.value) for p in fit.parameters[:-1])


def identify(record: Record, fixed: Mapping[str, float] | None = None) -> Identified:
    """Fit every structure and choose the simplest that no other one clearly beats.

    fixed: parameters by name that are not fitted. Raises RecordError with the reason where no step is found, the output
    does not answer, or no model can be relied on. A record that ends in a steady oscillation tells K180 and T180.
    """
    swing = find_oscillation(record)
    if swing is not None and swing.kind == "sustained":
        return _sustained(record, swing)
    found = _identified(record, fixed)
    return found if swing is None else _by_relay(found, swing)


def _identified(record: Record, fixed: Mapping[str, float] | None) -> Identified:
    _refuse(diagnosis.saturated(record))
    if recognised(record):
        return _closed(record, fixed)
    try:
        steps = find_steps(record)
    except RecordError:
        _refuse(diagnosis.saturated(record, HALF))
        raise
    _, fits = fit_all(record, steps, fixed=fixed)
    if not fits:
        raise RecordError(f"no model has the parameters {', '.join(fixed or {})} together; fix K, T (or T1, T2) and L")
    fits = _started_off_rest(record, steps, fits, fixed)
    n = int(record.used.sum())
    criteria = criteria_of(fits, n)
    best = min(fits.values(), key=lambda fit: fit.rmse)
    _refuse(diagnosis.closed_loop(record) if best.fit < GOOD_FIT else "")
    usable = [s for s in fits if determined(fits[s])]
    first = fits.get(FIRST_ORDER)
    directions = _directions(record, steps, first, best, n) if first and not fixed else None
    strange = _unusual(record, steps, fits, best, n) if directions is None else None
    if strange is not None and fixed:
        _refuse(diagnosis.rings(strange))
    elif strange is not None:
        fits, best = {**fits, strange.structure: strange}, strange
        criteria = criteria_of(fits, n)
        usable.append(strange.structure)
    if directions is None:
        poor = best.fit < GOOD_FIT and not fixed
        _refuse(diagnosis.asymmetric(record, steps, best) if poor else "")
        _refuse(diagnosis.drift_explains(record, best))
        lost = diagnosis.below_noise(best, steps)
        _refuse(lost and (diagnosis.saturated(record, HALF) or lost))
        _refuse(diagnosis.has_zero(record, steps, best) if poor and strange is None else "")
        _refuse(diagnosis.disturbed(best) if poor else "")
        if not usable or max(fits[s].fit for s in usable) < POOREST_FIT:
            _refuse(diagnosis.below_sample(record, best) if best.fit >= POOREST_FIT else "")
            _refuse(diagnosis.not_at_rest(record, steps))
            _refuse(diagnosis.disturbed(best, GOOD_FIT))
            _refuse(diagnosis.not_determined(list(fits.values()) if best.fit >= POOREST_FIT else []))
            raise RecordError(
                f"no model explains the response: the best ({best.structure.name}) leaves {100 - best.fit:.0f} % of "
                "it; was something else disturbing the process, or is the response not that of a step?"
            )
        chosen = _simplest(fits, criteria, usable)
        _refuse(diagnosis.drift_explains(record, fits[chosen]))
        _refuse(diagnosis.not_determined(_settling(record, fits, criteria, chosen)))
    else:
        chosen = FIRST_ORDER
        fits[chosen] = directions.worse
        criteria = criteria_of(fits, n)
    fit = fits[chosen]
    _refuse(diagnosis.below_sample(record, fit))
    _refuse(diagnosis.extrapolated(record, steps, fit))
    reasons = why_chosen(fits, criteria, chosen, usable) if directions is None else both_ways(directions)
    warnings = (*record.faults, *limits_of_use(fit, fits, steps))
    return Identified(record, steps, fits, criteria, fit, tuple(reasons), warnings, directions)


def _by_relay(found: Identified, swing: Oscillation) -> Identified:
    """With what the oscillation says: K180 and T180 as measured, or the model's where the relay stops short."""
    reasons = [swing.describe()]
    if swing.frequency is None:
        try:
            point = ultimate(found.process if found.chosen.gain > 0 else found.process * -1.0)
            reasons.append(f"At -180 degrees the model has K180 = {point.K180:.4g} and T180 = {point.T180:.4g} s.")
        except NoSuchFrequency as error:
            reasons.append(f"The model has no point at -180 degrees: {error}")
    warnings = tuple(text for text in found.warnings if "after the last step" not in text)
    return replace(found, reasons=(*found.reasons, *reasons), warnings=warnings, oscillation=swing)


def _sustained(record: Record, swing: Oscillation) -> Identified:
    """A loop on the edge of stability: two numbers at one frequency, and the integrator with dead time through them."""
    whole, steps, fit = integrator_through(record, swing)
    warning = (
        "One frequency gives two numbers: the model is the integrator with dead time through K180 and T180. It says "
        "nothing of the gain at rest; a step test would."
    )
    reasons, alone = (swing.describe(),), {INTEGRATING: fit}
    return Identified(whole, steps, alone, {INTEGRATING: 0.0}, fit, reasons, (warning,), None, swing)


def _closed(record: Record, fixed: Mapping[str, float] | None) -> Identified:
    """The same with a regulator at work, from its set-point steps."""
    steps, moves = closed_steps(record)
    fits = fit_all_closed(record, steps, fixed)
    criteria = criteria_of(fits, len(record.time))
    usable = [s for s in fits if determined(fits[s])]
    best = min(fits.values(), key=lambda fit: fit.rmse)
    if not usable or max(fits[s].fit for s in usable) < POOREST_FIT:
        _refuse(diagnosis.not_determined(list(fits.values())) if best.fit >= POOREST_FIT else "")
        raise RecordError(
            f"no model explains the closed loop: the best ({best.structure.name}) leaves {100 - best.fit:.0f} % of the "
            "output; was a load moving it too? Step the set-point further, or record in manual"
        )
    chosen = _simplest(fits, criteria, usable)
    _refuse(diagnosis.below_sample(record, fits[chosen]))
    many = "one set-point step" if moves == 1 else f"{moves} set-point steps"
    reasons = [
        f"The record was made in closed loop: the input follows set-point and measurement. The process was identified "
        f"from {many} by prediction error with a model of the noise, which is consistent with a regulator at work.",
        *why_chosen(fits, criteria, chosen, usable),
    ]
    return Identified(
        record, steps, fits, criteria, fits[chosen], tuple(reasons), tuple(limits_of_use(fits[chosen], fits, steps))
    )


def _refuse(reason: str) -> None:
    if reason:
        raise RecordError(reason)


def _simplest(fits: dict[Structure, Fit], criteria: dict[Structure, float], usable: list[Structure]) -> Structure:
    least = min(criteria[s] for s in usable)
    near = [s for s in usable if criteria[s] - least <= CLEARLY_BETTER]
    return min(near, key=lambda s: (len(fits[s].parameters), criteria[s]))


def _settling(
    record: Record, fits: dict[Structure, Fit], criteria: dict[Structure, float], chosen: Structure
) -> list[Fit]:
    """The simplest fit that settles within the record and explains it clearly better than a chosen integrating one.

    An undetermined lag in place of another is a matter of degree, this one of where the output ends. A lag longer than
    the record is an integrator for it.
    """
    if not chosen.integrating:
        return []
    clearly, length = criteria[chosen] - CLEARLY_BETTER, float(record.time[-1] - record.time[0])
    found = [f for s, f in fits.items() if not s.integrating and criteria[s] < clearly and sum(f.lags) < length]
    return sorted(found, key=lambda fit: len(fit.parameters))[:1]


def _started_off_rest(
    record: Record, steps: Steps, fits: dict[Structure, Fit], fixed: Mapping[str, float] | None
) -> dict[Structure, Fit]:
    """The same fits with the state at the first sample estimated, where that explains the record clearly better."""
    best = min(fits.values(), key=lambda fit: fit.rmse)
    if best.nuisance == "rest" and (best.fit > GOOD_FIT or best.correlation < PATTERN):
        return fits
    lagging = {s: fit for s, fit in fits.items() if s.lags}
    if not lagging:
        return fits
    _, others = fit_all(record, steps, "start", fixed)
    others = {s: fit for s, fit in others.items() if s in lagging}
    n = int(record.used.sum())
    effective = effective_samples([*fits.values(), *others.values()], n)
    better = min(others.values(), key=lambda fit: fit.rmse)
    gain = criterion(best, size_of(best), effective) - criterion(better, size_of(better), effective)
    return {**fits, **others} if gain > CLEARLY_BETTER else fits


def _directions(record: Record, steps: Steps, first: Fit, best: Fit, n: int) -> Directions | None:
    """A model per direction, where it explains the record clearly better than any symmetric one."""
    if best.correlation < PATTERN and best.fit > GOOD_FIT:
        return None
    found = fit_directions(record, steps, first)
    if found is None:
        return None
    directions, size = found
    up, down = directions.up.lags[0], directions.down.lags[0]
    effective = effective_samples([best, directions.up], n)
    gain = criterion(best, size_of(best), effective) - criterion(directions.up, size, effective)
    separate = abs(up - down) > max(f.parameter("T").half_width for f in (directions.up, directions.down))
    different = max(up, down) > CLEARLY_DIFFERENT * min(up, down) and separate
    return directions if different and gain > CLEARLY_BETTER and directions.up.fit > 80 else None


def _unusual(record: Record, steps: Steps, fits: dict[Structure, Fit], best: Fit, n: int) -> Fit | None:
    """A shape that no lags have, where it explains the record clearly better than every one of lags."""
    if not asks(best, steps):
        return None
    found = unusual_fits(record, steps, best.nuisance)
    if not found:
        return None
    better = min(found, key=lambda fit: fit.rmse)
    effective = effective_samples([*fits.values(), *found], n)
    gain = criterion(best, size_of(best), effective) - criterion(better, size_of(better), effective)
    return better if gain > CLEARLY_BETTER and better.fit > POOREST_FIT else None
