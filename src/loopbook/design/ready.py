"""What every design derives alike: done once, where many designs are forked from one process."""

import numpy as np

from loopbook.design import running, speed
from loopbook.design.candidates import candidates
from loopbook.design.evaluation import evaluate
from loopbook.design.model import Model
from loopbook.design.program import sampled_program
from loopbook.identification import choice, graphical
from loopbook.identification.models import FIRST_ORDER
from loopbook.records.record import Record


def derive() -> None:
    """Make one small design of each kind, so that what it derives and compiles stays in the caches of the functions.

    All of that is pure: a design gives the same report whether it finds it done or does it itself.
    """
    time = np.linspace(0.0, 20.0, 101)
    response = FIRST_ORDER.response(time, [(1.0, 1.0)], (2.0,), 1.0)
    record = Record(time, np.where(time >= 1.0, 1.0, 0.0), response)
    choice.identify(record)
    graphical.graphical_readings(record)
    for model in (Model(1.0, (1.0, 0.5), 0.5), Model(1.0, (), 1.0, integrating=True), Model(1.0, (2.0,), 1.0)):
        found, _ = candidates(model)
        candidates(model, speed.rules(model, speed.at_speed(model, 0.5)))
    program = sampled_program(evaluate(model, found[-1]), 2.0)
    program.listing()
    brief = running.Running(model, program, 4 * float(program.settings.h), 1.0, 0.1, 0.01, (0.0, 0.0))
    assert brief.expected
