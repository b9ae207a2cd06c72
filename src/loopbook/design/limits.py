"""The actuator's limits: as given and compared with the record, or taken from the record, to be confirmed."""

import math
from dataclasses import dataclass

from loopbook.design.model import Model, ModelError
from loopbook.identification.choice import Identified

OTHER_SCALE = 50.0  # times the record's largest input: limits that far apart are on another scale


@dataclass(frozen=True)
class Limits:
    """low, high: absolute, in the unit of the input; infinite where there is none. confirmed: they were given.

    notes: what was assumed, one sentence each.
    """

    low: float
    high: float
    confirmed: bool
    notes: tuple[str, ...] = ()

    @property
    def pair(self) -> tuple[float, float]:
        return self.low, self.high


def find_limits(low: float | None, high: float | None, found: Identified | None, model: Model) -> Limits:
    """Limits for a design. low, high: None where they are to come from the record, infinite for none.

    The record's own extremes are what its input is known to reach. Around an integrating process they are made to lie
    on both sides of the rest, which such a process needs to come back. Raises ModelError where given limits do not fit
    the record.
    """
    if found is None:
        return Limits(-math.inf if low is None else low, math.inf if high is None else high, True)
    name, unit = found.record.input_name, found.record.input_unit
    unit = f" {unit}" if unit else ""
    least, most = float(found.record.u.min()), float(found.record.u.max())
    if low is not None or high is not None:
        _compare(low, high, least, most, name)
    rest = rest_input(found)
    from_record = [least, most]
    if model.integrating:
        reach = max(most - rest, rest - least)
        from_record = [rest - reach, rest + reach]
        if least >= 0:
            from_record[0] = max(from_record[0], 0.0)
        if from_record[0] >= rest and low is None:
            raise ModelError(
                f"the process integrates and {name!r} rests at {rest:.6g}, its lowest: nothing in the record brings "
                "the output back; give the actuator's limits on both sides of the rest with --limits LOW HIGH"
            )
    lower = from_record[0] if low is None else low
    upper = from_record[1] if high is None else high
    confirmed = low is not None and high is not None
    notes: list[str] = []
    if not confirmed:
        notes.append(
            f"Limits {lower:.6g} to {upper:.6g}{unit} were taken from the record, as far as its input went: confirm "
            "them, or give the actuator's own with --limits LOW HIGH."
        )
    return Limits(lower, upper, confirmed, tuple(notes))


def rest_input(found: Identified) -> float:
    """The input before the first step."""
    record, steps = found.record, found.steps
    return float(record.u[: steps.before].mean())


def _compare(low: float | None, high: float | None, least: float, most: float, name: str) -> None:
    lower, upper = -math.inf if low is None else low, math.inf if high is None else high
    slack = 1e-6 * max(most - least, abs(most))
    if least < lower - slack or most > upper + slack:
        raise ModelError(
            f"the recorded input {name!r} runs from {least:.6g} to {most:.6g}, outside the limits {lower:g} to "
            f"{upper:g}: one of them is wrong, or on another scale; give the limits in the record's unit "
            "(--limits LOW HIGH), or leave them out to have them taken from the record"
        )
    size = max(abs(least), abs(most))
    if math.isfinite(upper - lower) and upper - lower >= OTHER_SCALE * size:
        raise ModelError(
            f"the recorded input {name!r} runs from {least:.6g} to {most:.6g}, the limits from {lower:g} to {upper:g}: "
            "they are on different scales (0..1 and 0..100?); give the limits in the record's unit (--limits LOW HIGH)"
        )
