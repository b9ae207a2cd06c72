"""From a record or a model to a regulator: the whole design in one object, each part computed when it is asked for."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.design import candidates as rules
from loopbook.design import evaluation, recorded, speed
from loopbook.design.beyond.offers import offers
from loopbook.design.decision import conditions, curve, decide
from loopbook.design.limits import Limits, find_limits, rest_input
from loopbook.design.model import Model, ModelError, from_fit, from_identified
from loopbook.design.model_file import read_fixed, read_model, with_fixed
from loopbook.design.placement import placements
from loopbook.design.results import results
from loopbook.design.selection import horizon
from loopbook.design.speed import time_scale
from loopbook.experiments.data import FrequencyData
from loopbook.records.reading import read_record
from loopbook.records.summary import line

if TYPE_CHECKING:
    from loopbook.design.beyond.offer import Offer
    from loopbook.design.placement import Placed
    from loopbook.design.program import SampledProgram
    from loopbook.design.recommendation import Recommendation
    from loopbook.design.running import Running
    from loopbook.design.selection import Conditions, Selected
    from loopbook.design.speed import Speed
    from loopbook.identification.choice import Identified
    from loopbook.records.record import Record
    from loopbook.response.simulation import Simulation

VARIATIONS = 20


@dataclass(frozen=True)
class Study:
    """One design.

    data: path of a record (CSV, .xlsx, Parquet) or a TOML model. time, input, output: columns of the record, "" to have
    them found. aim: see `recommendation.AIMS`. u_low, u_high: the actuator's limits, absolute; None to take them from
    the record (of a model: none). unlimited: limits that are not given are none, whatever the record went through.
    h: sampling interval [s], 0 to have it chosen. K180 [y/u], T180 [s]: from a relay or oscillation experiment, 0 where
    there was none. reference [y], load [u]: the steps of the final simulation, 0 to have them chosen. interval [s]:
    between the samples of a record without a time column. speed: from 0 (slow) to 1 (fast), and closed_loop: the wanted
    time constant [s]; at most one of them, None and 0 for a rule's own speed. known: parameters of the model fixed by
    the user, "K=2, T=30". seed: of the drawn models.
    y_low, y_high [y]: the measuring range, for controllers that count in percent of it; None for not given. more:
    further records of the same process, file names separated by semicolons, beside data; they are pooled, the last of
    three or more held back. inner: a column between input and output, for a cascade. points: records at other points.
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
    interval: float = 0.0
    speed: float | None = None
    closed_loop: float = 0.0
    known: str = ""
    unlimited: bool = False
    y_low: float | None = None
    y_high: float | None = None
    more: str = ""
    inner: str = ""
    points: str = ""
    seed: int = 0

    def __post_init__(self) -> None:
        if bool(self.K180) != bool(self.T180):
            raise ModelError(f"K180 = {self.K180}, T180 = {self.T180}: an ultimate point needs both, or neither")
        if self.u_low is not None and self.u_high is not None and not self.u_low < self.u_high:
            raise ModelError(f"u_low = {self.u_low} must be below u_high = {self.u_high}")
        ends = (self.y_low, self.y_high)
        if ends != (None, None) and (None in ends or not ends[0] < ends[1]):  # type: ignore[operator]
            raise ModelError(
                f"y_low = {self.y_low}, y_high = {self.y_high}: a measuring range has both, the low end first"
            )
        if self.speed is not None and self.closed_loop:
            raise ModelError("speed and closed loop are two ways to say one thing: give one of them")

    @property
    def recorded(self) -> bool:
        """Is the data a record, not a model?"""
        return Path(self.data).suffix.lower() != ".toml"

    @cached_property
    def record(self) -> "Record | None":
        """The record as read; None where a model was given."""
        return read_record(self.data, self.time, self.input, self.output, self.interval) if self.recorded else None

    @cached_property
    def identified(self) -> "Identified | None":
        """The record with its fitted models; None where a model was given."""
        return recorded.identified(self)

    @cached_property
    def model(self) -> Model:
        """What is designed for: of a process that is faster one way, the model of that way."""
        measured = FrequencyData(self.K180, self.T180) if self.K180 else None
        if self.identified is not None:
            swing = self.identified.oscillation
            return from_identified(self.identified, measured or (swing.frequency if swing else None))
        model = read_model(self.data)
        if self.known:
            model = with_fixed(model, read_fixed(self.known))
        return replace(model, frequency=measured) if measured else model

    @cached_property
    def milder(self) -> Model | None:
        """The model of the other direction, where the process is not the same both ways."""
        found = self.identified
        if found is None or found.directions is None:
            return None
        return from_fit(found.directions.milder, found.record.source or "the record")

    @cached_property
    def knob(self) -> "Speed | None":
        """The wanted speed; None where the rules' own speed is taken."""
        if self.closed_loop:
            return speed.at_closed(self.model, self.closed_loop)
        return None if self.speed is None else speed.at_speed(self.model, self.speed)

    @cached_property
    def _rules(self) -> tuple[list[rules.Candidate], list[rules.Refused]]:
        return rules.candidates(self.model)

    @property
    def refused(self) -> list[rules.Refused]:
        """The rules that do not apply."""
        return self._rules[1]

    @cached_property
    def at_knob(self) -> list[evaluation.Evaluation]:
        """The loops of the rules that the knob turns, at the wanted speed; none where there is no wish."""
        return self.at_speed(self.knob) if self.knob else []

    def at_speed(self, knob: "Speed", without: str = "none") -> list[evaluation.Evaluation]:
        """The loops of the rules that the knob turns. without: of those whose name has this in it."""
        found, _ = rules.candidates(self.model, speed.rules(self.model, knob))
        return [evaluation.evaluate(self.model, c) for c in found if without not in c.name]

    @cached_property
    def evaluations(self) -> list[evaluation.Evaluation]:
        """Every rule that applies, its loop measured; first those at the wanted speed."""
        return [*self.at_knob, *[evaluation.evaluate(self.model, c) for c in self._rules[0]]]

    @cached_property
    def spread(self) -> dict[str, evaluation.Robustness]:
        """Each stable loop on models from the confidence region, by the rule's name."""
        return self.spread_of(self.evaluations)

    def spread_of(self, loops: list[evaluation.Evaluation]) -> dict[str, evaluation.Robustness]:
        """The stable ones of some loops on models from the confidence region, by name."""
        for c in [e.candidate for e in loops if e.stable and e.candidate not in self._robust]:
            self._robust[c] = evaluation.robustness(self.model, c, VARIATIONS, self.seed, self.milder)
        return {e.candidate.name: self._robust[e.candidate] for e in loops if e.stable}

    @cached_property
    def _robust(self) -> dict[rules.Candidate, evaluation.Robustness]:
        return {}

    @cached_property
    def curve(self) -> list[tuple["Speed", evaluation.Evaluation]]:
        """The trade-off along the knob: from slow to fast the PI and the PID that do best after a load step."""
        return curve(self)

    @property
    def recommendation(self) -> "Recommendation":
        return self._decided[0]

    @property
    def selected(self) -> "Selected":
        """The recommended loop with the program that runs it."""
        return self._decided[1]

    @cached_property
    def conditions(self) -> "Conditions":
        """What the program has to live with."""
        return conditions(self)

    @cached_property
    def _decided(self) -> "tuple[Recommendation, Selected]":
        """Recommended for the aim, and able to run. Raises RecordError where no regulator can be recommended."""
        return decide(self)

    @cached_property
    def placements(self) -> "list[Placed]":
        """Pole placements for the sampled model, at the given sampling interval or one of their own."""
        return placements(self.model, self.time_constant, self.h)

    @cached_property
    def rest(self) -> tuple[float, float]:
        """(u, y) at rest before the first step of the record; (0, 0) for a model."""
        if self.identified is None:
            return 0.0, 0.0
        return rest_input(self.identified), self.identified.chosen.rest

    @cached_property
    def actuator(self) -> Limits:
        """The actuator's limits, and where they come from."""
        low, high = self.u_low, self.u_high
        if self.unlimited:
            low, high = -math.inf if low is None else low, math.inf if high is None else high
        return find_limits(low, high, self.identified, self.model)

    @property
    def limits(self) -> tuple[float, float]:
        """The actuator's limits, absolute."""
        return self.actuator.pair

    @property
    def program(self) -> "SampledProgram":
        """The chosen regulator as a discrete program with absolute limits."""
        return self.selected.program

    @property
    def running(self) -> "Running":
        """The program on the model: what it does, in numbers."""
        return self.selected.running

    @property
    def time_constant(self) -> float:
        """The process's time scale [s]: T of its step response, for an integrating process its apparent dead time."""
        data = self.model.step_data
        return getattr(data, "T", 0.0) or data.L or time_scale(self.model)

    @property
    def horizon(self) -> float:
        """A time [s] in which the chosen loop settles twice: after a reference and after a load step."""
        return horizon(self.recommendation.chosen, self.model, self.time_constant)

    @cached_property
    def steps(self) -> tuple[float, float]:
        """(reference [y], load [u]) of the final simulation: as given, or half of what the record saw, or 1 and 1/2.

        The reference goes the way that the record's input drove the output, which the limits taken from it allow.
        """
        reference, load = self.reference, self.load
        found = self.identified
        if found is not None:
            u = found.record.u - self.rest[0]
            furthest = float(u[np.argmax(np.abs(u))])
            way = self.model.gain * furthest if not self.model.integrating else math.copysign(
                found.chosen.answer, self.model.gain * furthest
            )  # fmt: skip
            return reference or way / 2, load or -furthest / 4
        return reference or 1.0, load or 0.5 * (reference or 1.0) / abs(self.model.gain)

    @property
    def simulation(self) -> "Simulation":
        """The program on the model within the limits, as deviations from rest."""
        return self.running.clean

    @property
    def best(self) -> list[evaluation.Evaluation]:
        """The recommended loop and the next best for the aim, five at most."""
        chosen = self.recommendation.chosen
        return [chosen, *[e for e in self.recommendation.admitted if e is not chosen][:4]]

    @cached_property
    def beyond(self) -> "list[Offer]":
        """What other structures would bring beside the best PID."""
        return offers(self)

    @property
    def line(self) -> str:
        """The record in one line: what was taken for what."""
        found = self.identified
        return f"model: {self.model.source}" if found is None else line(found.record, found.steps)

    @property
    def mind(self) -> list[str]:
        """What a user has to know, one sentence each."""
        return [*self.cautions, *self.recommendation.chosen.candidate.notes]

    @property
    def cautions(self) -> list[str]:
        """Of what to mind, what an engineer has to know at the plant: the record's and the limits', not the rules'."""
        warnings = self.identified.warnings if self.identified else ()
        lacks = [r for r in self.recommendation.reasons if r.startswith(("Mind", "No setting"))]
        return [*self.actuator.notes, *warnings, *lacks]

    def results(self) -> dict[str, Any]:
        """The design as plain data, see `loopbook.design.results`."""
        return results(self)
