"""A short pulse on an integrating process (pid-report, section 5.3.7.2): it answers as a stable one does to a step.

A pulse of width w and height area/w makes Kv e^(-L1 s)/(s (1 + s T2)) answer, for w -> 0, with area times the step
response of Kv e^(-L1 s)/(1 + s T2) (`derivations.experiments.reaction_curve.short_pulse_response`). So the
constructions of a step give Kv, T2 and L1. The pulse should be shorter than a tenth of L1 and of T2.
"""

import numpy as np

from loopbook.experiments import step
from loopbook.experiments.data import IntegratingPulseData
from loopbook.experiments.plant import Estimate, ExperimentError, Plant, sum_of_lags
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record


def apply_pulse(plant: Plant, width: float, area: float = 1.0, horizon: float | None = None) -> Record:
    """Make the experiment: height area/width for `width` seconds. An actuator limit makes the pulse smaller."""
    if not np.isinf(plant.process.static_gain):
        raise ExperimentError("the process does not integrate: its pulse response returns to zero; use step.apply_step")
    if not width > 0:
        raise ExperimentError(f"width = {width!r} s: a pulse lasts some time")
    lags = sum_of_lags(plant.process)
    horizon = horizon or 2 * plant.process.delay + 12 * lags + 5 * width
    start = horizon / 19
    return plant.play([(start, area / width), (start + width, 0.0)], horizon * 20 / 19)


def pulse_data(process: Process) -> IntegratingPulseData:
    """What an infinitely short pulse tells: the step data of s G(s).

    >>> found = pulse_data(Process.integrating(2.0, 1.0, 0.5))
    >>> found.Kv, round(found.T2, 9), round(found.L1, 9)
    (2.0, 0.5, 1.0)
    """
    if process.den[-1] != 0:
        raise ExperimentError("the process does not integrate: use step.step_data")
    found = step.step_data(Process(process.num, process.den[:-1], process.delay)) if process.order > 1 else None
    if found is None:
        return IntegratingPulseData(process.num[-1] / process.den[-2], 0.0, process.delay)
    return IntegratingPulseData(found.Kp, found.T, found.L)


def estimate(record: Record, window: int | None = None) -> Estimate:
    """Kv, T2 and L1 from a recorded pulse, by the tangent and 63 % of the response.

    Raises ExperimentError where the input is no single pulse or the output has not settled.
    """
    changes = np.flatnonzero(np.diff(record.u))
    if len(changes) != 2 or record.u[0] != record.u[-1]:
        raise ExperimentError(f"the input changes {len(changes)} times; a pulse rises once and returns")
    begin, end = record.time[changes + 1]
    height = float(record.u[changes[0] + 1] - record.u[0])
    area = height * float(end - begin)
    as_step = np.where(record.time >= begin, area, 0.0)
    found = step.estimate(Record(record.time, as_step, record.y), window)
    width = float(end - begin)
    data = IntegratingPulseData(found.data.Kp, found.data.T, found.data.L)
    shortest = min(x for x in (data.T2, data.L1) if x > 0)
    fits = "shorter" if width <= shortest / 10 else "longer"
    assumed = (
        "the response to the pulse is read as the step response of the process without its integrator",
        f"the pulse of {width:.3g} s is {fits} than a tenth of the smaller of T2 and L1, {shortest / 10:.3g} s",
    )
    return Estimate(data, {**found.marks, "width": width, "area": area}, assumed, record)
