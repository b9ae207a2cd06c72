"""From a record or a model to a regulator: the whole design in one object, each part computed when it is asked for."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from loopbook.design import candidates as rules
from loopbook.design import evaluation
from loopbook.design.model import Model, ModelError, from_identified, read_toml

if TYPE_CHECKING:
    from loopbook.design.placement import Placed
    from loopbook.design.program import SampledProgram
    from loopbook.design.recommendation import Recommendation
    from loopbook.identification.choice import Identified
    from loopbook.response.simulation import Simulation
    from notebook_reports.display import Table

VARIATIONS = 20
EXPECTED = (
    *("Ms", "Mt", "gain_margin", "phase_margin", "delay_margin", "iae_reference", "iae_load"),
    *("overshoot", "settling", "peak_input", "variation", "noise_gain"),
)


@dataclass(frozen=True)
class Study:
    """One design.

    data: path of a CSV record or a TOML model. time, input, output: columns of the record, "" to have them found.
    aim: see `recommendation.AIMS`. u_low, u_high: the actuator's limits, absolute, None for none. h: sampling interval
    [s], 0 to have it chosen. K180 [y/u], T180 [s]: from a relay or oscillation experiment, 0 where there was none.
    reference [y], load [u]: the steps of the final simulation, 0 to have them chosen. seed: of the drawn models.
    """

    data: str | Path
    time: str = ""
    input: str = ""
    output: str = ""
    aim: str = "robust"
    u_low: float | None = None
    u_high: float | None = None
    h: float = 0.0
    K180: float = 0.0
    T180: float = 0.0
    reference: float = 0.0
    load: float = 0.0
    seed: int = 0

    def __post_init__(self):
        if bool(self.K180) != bool(self.T180):
            raise ModelError(f"K180 = {self.K180}, T180 = {self.T180}: an ultimate point needs both, or neither")
        if self.u_low is not None and self.u_high is not None and not self.u_low < self.u_high:
            raise ModelError(f"u_low = {self.u_low} must be below u_high = {self.u_high}")

    @property
    def recorded(self) -> bool:
        """Is the data a record, not a model?"""
        return Path(self.data).suffix.lower() != ".toml"

    @cached_property
    def identified(self) -> "Identified | None":
        """The record with its fitted models; None where a model was given."""
        from loopbook.identification.choice import identify
        from loopbook.records.reading import read_csv

        if not self.recorded:
            return None
        return identify(read_csv(self.data, self.time or None, self.input or None, self.output or None))

    @cached_property
    def model(self) -> Model:
        """What is designed for."""
        from dataclasses import replace

        from loopbook.experiments.data import FrequencyData

        measured = FrequencyData(self.K180, self.T180) if self.K180 else None
        if self.identified is not None:
            return from_identified(self.identified, measured)
        model = read_toml(self.data)
        return replace(model, frequency=measured) if measured else model

    @cached_property
    def _rules(self) -> tuple[list[rules.Candidate], list[rules.Refused]]:
        return rules.candidates(self.model)

    @property
    def refused(self) -> list[rules.Refused]:
        """The rules that do not apply."""
        return self._rules[1]

    @cached_property
    def evaluations(self) -> list[evaluation.Evaluation]:
        """Every rule that applies, its loop measured."""
        return [evaluation.evaluate(self.model, c) for c in self._rules[0]]

    @cached_property
    def spread(self) -> dict[str, evaluation.Robustness]:
        """Each stable loop on models from the confidence region, by the rule's name."""
        stable = [e.candidate for e in self.evaluations if e.stable]
        return {c.name: evaluation.robustness(self.model, c, VARIATIONS, self.seed) for c in stable}

    @cached_property
    def recommendation(self) -> "Recommendation":
        from loopbook.design.recommendation import recommend

        return recommend(self.evaluations, self.aim, self.spread)

    @cached_property
    def placements(self) -> "list[Placed]":
        """Pole placements for the sampled model, at the given sampling interval or one of their own."""
        from loopbook.design.placement import placements

        return placements(self.model, self.time_constant, self.h)

    @cached_property
    def rest(self) -> tuple[float, float]:
        """(u, y) at rest before the first step of the record; (0, 0) for a model."""
        if self.identified is None:
            return 0.0, 0.0
        record, steps = self.identified.record, self.identified.steps
        return float(record.u[: steps.before].mean()), self.identified.chosen.rest

    @property
    def limits(self) -> tuple[float, float]:
        """The actuator's limits, absolute."""
        return (
            -math.inf if self.u_low is None else self.u_low,
            math.inf if self.u_high is None else self.u_high,
        )

    @cached_property
    def program(self) -> "SampledProgram":
        """The chosen regulator as a discrete program with absolute limits."""
        from loopbook.design.program import sampled_program

        return sampled_program(self.recommendation.chosen, self.time_constant, self.h, self.limits)

    @property
    def time_constant(self) -> float:
        """The process's time scale [s]: T of its step response, for an integrating process its apparent dead time."""
        data = self.model.step_data
        return getattr(data, "T", 0.0) or data.L

    @property
    def horizon(self) -> float:
        """A time [s] in which the chosen loop settles twice: after a reference and after a load step."""
        chosen = self.recommendation.chosen
        return 2 * max(1.5 * chosen.settling, 10 * self.model.delay, 2 * self.time_constant)

    @cached_property
    def steps(self) -> tuple[float, float]:
        """(reference [y], load [u]) of the final simulation: as given, or half of what the record saw, or 1 and 1/2."""
        reference, load = self.reference, self.load
        if self.identified is not None:
            span = float(self.identified.record.y.max() - self.identified.record.y.min())
            height = max(abs(size) for _, size in self.identified.steps.list)
            return reference or span / 2, load or height / 4
        return reference or 1.0, load or 0.5 * (reference or 1.0) / abs(self.model.gain)

    @cached_property
    def simulation(self) -> "Simulation":
        """The program on the model within the limits, as deviations from rest."""
        from dataclasses import replace

        from loopbook.design import limited

        u0 = self.rest[0]
        settings = self.program.settings
        shifted = settings.changed(u_low=settings.u_low - u0, u_high=settings.u_high - u0)
        return limited.run(self.model, replace(self.program, settings=shifted), self.horizon, *self.steps)

    @property
    def best(self) -> list[evaluation.Evaluation]:
        """The recommended loop and the next best for the aim, five at most."""
        chosen = self.recommendation.chosen
        return [chosen, *[e for e in self.recommendation.admitted if e is not chosen][:4]]

    def results(self) -> dict[str, Any]:
        """The design as plain data: process, rule, the program's numbers, what to expect, what to mind.

        Units: seconds, rad/s, degrees, those of the record. null stands for infinite and for unknown.
        """
        chosen, model = self.recommendation.chosen, self.model
        names = ("gain", "time_constants", "delay", "integrating")
        process = dict(zip(names, (model.gain, list(model.lags), model.delay, model.integrating), strict=True))
        expected = {name: getattr(chosen, name) for name in EXPECTED}
        found = self.identified
        fit = {"percent": found.chosen.fit, "rms": found.chosen.rmse} if found else None
        widths = {p.name: p.half_width for p in found.chosen.parameters} if found else None
        return {
            "data": Path(self.data).name,
            "process": {**process, "source": model.source, "fit": fit, "half_widths_95": widths},
            "aim": self.aim,
            "rule": chosen.candidate.name,
            **self.program.data(),
            "expected": {name: float(v) if math.isfinite(v) else None for name, v in expected.items()},
            "mind": [*(found.warnings if found else ()), *chosen.candidate.notes],
        }

    def summary(self) -> "Table":
        """The design on one page."""
        from loopbook.design.tables import summary

        return summary(self)
