"""What is said of a chosen model: why it, and what limits its use."""

from loopbook.identification.criteria import CLEARLY_BETTER
from loopbook.identification.directions import Directions
from loopbook.identification.fit import Fit
from loopbook.identification.models import FIRST_ORDER, SECOND_ORDER, Structure
from loopbook.records.steps import Steps


def both_ways(directions: Directions) -> list[str]:
    """Why there is a model per direction."""
    up, down = directions.up, directions.down
    return [
        f"The process is not the same both ways: T = {up.lags[0]:.3g} s while the output rises, {down.lags[0]:.3g} s "
        f"while it falls. A first-order model for each explains {up.fit:.1f} % of the response.",
        f"The design is for the worse one, T = {directions.worse.lags[0]:.3g} s, and is checked on the other.",
    ]


def why_chosen(
    fits: dict[Structure, Fit], criteria: dict[Structure, float], chosen: Structure, usable: list[Structure]
) -> list[str]:
    """Why this structure, and why none of the others."""
    fit = fits[chosen]
    reasons = [f"{chosen.name.capitalize()} explains {fit.fit:.1f} % of the response (rms residual {fit.rmse:.3g})."]
    if fit.nuisance == "start":
        reasons.append("The record starts off rest; the state at its first sample was estimated along with the model.")
    for name, effect in fit.effects.items():
        reasons.append(f"{name} moves too; its effect (gain {effect:.3g}) was estimated along with the model.")
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


def limits_of_use(fit: Fit, fits: dict[Structure, Fit], steps: Steps) -> list[str]:
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
    if 0 < delay.value < delay.half_width:
        found.append(
            f"The dead time ({delay.value:.3g} s) cannot be told from zero (± {delay.half_width:.2g} s): rules that "
            "divide by L would ask for gains the data do not support."
        )
    if delay.value == 0:
        found.append("No dead time was seen: it is below half a sampling interval, and the model has none.")
    second = fits.get(SECOND_ORDER)
    if fit.structure is FIRST_ORDER and fit.correlation > 0.9 and second and second.rmse < 0.8 * fit.rmse:
        found.append("The residuals have structure: a second lag may be there.")
    if fit.fit < 80:
        found.append(f"The model leaves {100 - fit.fit:.0f} % of the response unexplained.")
    return found
