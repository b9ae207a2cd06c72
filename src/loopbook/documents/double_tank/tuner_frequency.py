"""The range of crossover frequencies that the document's tuner offers."""

from fractions import Fraction
from typing import Any

from loopbook.process.transfer_function import Process
from loopbook.tuning.by_angles import parameters
from notebook_reports.ledger.verdicts import last_place


def crossover_range(
    process: Process, name: str, printed: str, near: float, phase_margin: Any, zero: Any, pole: Any
) -> tuple[Fraction, Fraction]:
    """The crossover frequencies [rad/s] (from, to) for which the parameter `name` rounds to its printed digits.

    By the parameter's slope at `near`, which must lie close (relative 1e-10).
    """
    w, step = Fraction(near), Fraction(near) / 10**10
    value, after = (parameters(process, x, phase_margin, zero, pole, digits=40)[name] for x in (w, w + step))
    slope = (after - value) / step
    half = last_place(printed) / 2
    ends = sorted(w + (Fraction(printed) + side * half - value) / slope for side in (-1, 1))
    return ends[0], ends[1]
