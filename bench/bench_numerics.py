"""What a control engineer asks all day: loops, margins, responses, sampled models, rules; beside the figures of before.

CPU time of one call, the least of many. The figures of before stand in docs/performance.md with the commit and the
machine they were taken on; measured together there, so that only their ratio to each other travels.
"""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import sympy

from derivations.sampling.zero_order_hold import S, zero_order_hold
from loopbook.controllers import Pid, PidSettings
from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.rst import Rst, with_zeros
from loopbook.experiments import combination
from loopbook.experiments.data import FrequencyData, StepData
from loopbook.experiments.step import step_data
from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.ultimate_point import ultimate
from loopbook.pole_placement.numeric import place_numerically
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process
from loopbook.tuning import migo

TABLE = Path(__file__).parents[1] / "docs" / "performance.md"
LAGS = np.poly([-1.0, -1.0, -1.0, -1.0]).tolist()
TANK, PI, PID = Process([1], [35, 12, 1], 2), PidStandard(3, 12), PidStandard(5, 12, 2, N=10)
FOUR = Process([1], LAGS)
SLOW, CREEP = Process([25], [1, 2, 1]), PidStandard(1, 1000)
REGULATOR = Rst((1, -1), (2.0, -1.8), (0.2,), 1.0)
STEP, POINT = StepData(Kp=1, T=1.04, L=0.075), FrequencyData(K180=0.0091, T180=0.199)
MEASURED = np.sin(0.01 * np.arange(20_000))
SETTINGS = PidSettings(K=2.0, Ti=4.0, Td=0.5, Tf=0.1, h=0.1, u_low=-10.0, u_high=10.0)

WORK: dict[str, Callable[[], object]] = {
    "a process and its poles": lambda: Process([1], [35, 12, 1], 2).poles,
    "a loop, stable or not, with dead time": lambda: Loop(TANK, PI).is_stable,
    "a loop, stable or not, without": lambda: Loop(FOUR, PI).is_stable,
    "margins and peaks, with dead time": lambda: Loop(TANK, PID).margins(),
    "margins and peaks, without": lambda: Loop(FOUR, PidStandard(0.5, 3)).margins(),
    "decay rate, with dead time": lambda: Loop(TANK, PI).decay_rate,
    "step response until settled, with dead time": lambda: Loop(TANK, PID).step(),
    "step response until settled, without": lambda: Loop(FOUR, PidStandard(0.5, 3)).step(),
    "step metrics of it": lambda: Loop(TANK, PID).step().metrics(),
    "step metrics with a slow creep": lambda: Loop(SLOW, CREEP).step(horizon=2000.0).metrics(),
    "IAE after a load": lambda: Loop(TANK, PID).step("load").iae(),
    "a sampled model with dead time": lambda: sample(TANK, 0.7).polynomials,
    "a sampled model of four lags": lambda: sample(FOUR, 0.5).polynomials,
    "margins of a sampled loop, delay margin too": lambda: SampledLoop(TANK, REGULATOR).margins(),
    "a sampled loop, stable or not": lambda: SampledLoop(TANK, REGULATOR).is_stable,
    "the ultimate point": lambda: ultimate(FOUR),
    "the ultimate point with dead time": lambda: ultimate(TANK),
    "step data of the exact response": lambda: step_data(FOUR),
    "PI by MIGO": lambda: migo.pi(FOUR),
    "PID by MIGO": lambda: migo.pid(FOUR),
    "two lags from step and frequency data": lambda: combination.solve(STEP, POINT),
    "a placed regulator": lambda: place_numerically([0, 0.3, 0.2], [1, -1.5, 0.6], with_zeros([0.5, 0.4, 0.3]), h=1.0),
    "a form and its regulator": lambda: PidStandard(5, 12, 2, N=10).regulator(),
    "20,000 samples of the discrete PID": lambda: Pid(SETTINGS).run(MEASURED, 0.5),
    "lags sampled in symbols": lambda: zero_order_hold(1 / ((S + 1) * (S + 2)), sympy.Rational(1, 10), 1),
}


def least(work: Callable[[], object], patience: float = 0.4) -> float:
    """CPU seconds of one call: the least of as many as fit into `patience`, three at least."""
    work()
    found: list[float] = []
    while len(found) < 3 or (sum(found) < patience and len(found) < 2000):
        start = time.process_time_ns()
        work()
        found.append((time.process_time_ns() - start) * 1e-9)
    return min(found)


def before() -> dict[str, str]:
    """Of each row in docs/performance.md: the figure before and the one now."""
    cells = (line.strip().strip("|").split("|") for line in TABLE.read_text(encoding="utf-8").splitlines())
    return {row[0].strip(): f"{row[1].strip()} before, {row[2].strip()} now" for row in cells if len(row) == 4}


def rows() -> list[tuple[str, float, str]]:
    """(what, CPU seconds, the figures kept)."""
    kept = before()
    return [(what, least(work), f"kept: {kept.get(what, 'none')}") for what, work in WORK.items()]
