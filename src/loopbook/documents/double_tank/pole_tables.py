"""The computed counterparts of the pole-placement tables, by the ids that the printed data gives their cells."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from loopbook.pole_placement.exact_placement import PlacedLoop
from loopbook.pole_placement.sampled_plant import SampledPlant
from loopbook.response import step_metrics
from notebook_reports.ledger.printed_data import PrintedDocument

MEASURES = ("rise", "settling", "overshoot", "peak")


def regulator_coefficients(plant: SampledPlant, *prefixes: str) -> dict[str, Fraction]:
    """The coefficients of a sampled plant once under each prefix: ``sampled-a1``, ....

    >>> regulator_coefficients(SampledPlant((Fraction(-1, 2),), (Fraction(3),), Fraction(1)), "script-")
    {'script-a1': Fraction(-1, 2), 'script-b1': Fraction(3, 1)}
    """
    return {f"{p}{name.replace('_', '')}": v for p in prefixes for name, v in plant.values.items()}


def parameters(loops: Mapping[float, PlacedLoop]) -> dict[str, Fraction]:
    """Regulator parameters of several poles: ``regulator-Kr-q0.3``, ...."""
    return {
        f"regulator-{name.replace('_', '')}-q{q}": v for q, loop in loops.items() for name, v in loop.parameters.items()
    }


def performance(responses: Mapping[float, Sequence[Any]], t: Sequence[float]) -> dict[str, float]:
    """`step_metrics.sampled_metrics` of several responses: ``rise-q0.3`` [s], ``overshoot-q0.3`` [%], ...."""
    measured = {q: step_metrics.sampled_metrics(y, t) for q, y in responses.items()}
    return {f"{name}-q{q}": getattr(m, name) for q, m in measured.items() for name in MEASURES}


def printed_only(found: Mapping[str, Any], document: PrintedDocument) -> dict[str, Any]:
    """Those of the computed values that the document prints; another plant or pole has more."""
    return {i: v for i, v in found.items() if i in document.values}
