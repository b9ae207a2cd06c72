"""The emitted controllers of a design in a simulated loop: still at rest, then as the report's last figure shows."""

from pathlib import Path

import numpy as np
import pytest

from loopbook.code import controller, regulator_from_json, states_at_rest
from loopbook.design.study import Study
from loopbook.process.sampled import sample

pytestmark = pytest.mark.builds

RECORD = Path(__file__).parents[3] / "notebooks" / "own_process" / "example.csv"


@pytest.fixture(scope="module")
def study():
    return Study(RECORD, u_low=0.0, u_high=100.0)


@pytest.fixture(scope="module")
def block(study):
    return regulator_from_json(study.results())


class Plant:
    """The identified model between samples, exact, as deviations from the record's rest."""

    def __init__(self, study: Study):
        B, A = sample(study.model.process, float(study.program.settings.h)).polynomials
        self.B, self.A = np.asarray(B), np.asarray(A)
        self.u, self.y = np.zeros(len(B)), np.zeros(len(A) - 1)

    def output(self) -> float:
        """y(k), from the inputs before k."""
        return float(self.B[1:] @ self.u[: len(self.B) - 1] - self.A[1:] @ self.y)

    def move(self, u: float, y: float) -> None:
        self.u = np.append(u, self.u[:-1])
        self.y = np.append(y, self.y[:-1])


def run(study: Study, block, number: type, samples: int, reference: float, load: np.ndarray) -> tuple:
    u0, y0 = study.rest
    loop, plant = controller(block, number), Plant(study)
    loop.start(number(y0), number(y0), number(u0), number(0))
    ys, us = [], []
    for k in range(samples):
        y = plant.output()
        u = float(loop.step(number(y0 + reference), number(y0 + y), number(0)))
        plant.move(u - u0 + load[k], y)
        ys.append(y)
        us.append(u - u0)
    return np.array(ys), np.array(us)


@pytest.mark.parametrize("number", [float, np.float32])
def test_at_the_records_rest_the_output_stands_still(study, block, number):
    y, u = run(study, block, number, 2000, 0.0, np.zeros(2000))
    few = 1e-9 if number is float else 2e-3
    assert abs(u).max() < few and abs(y).max() < 3 * few
    assert u[0] == float(number(study.rest[0])) - study.rest[0], "the first output is the actuator's, bit by bit"


def test_a_start_from_zeros_would_shut_the_valve(study, block):
    u0, y0 = study.rest
    loop = controller(block)
    assert abs(loop.step(y0, y0, 0.0) - u0) > 30


@pytest.mark.parametrize("number", [float, np.float32])
def test_it_follows_the_reports_figure(study, block, number):
    figure = study.simulation
    reference, load = study.steps
    samples = len(figure.t) - 1
    loads = np.where(np.arange(samples) >= samples // 2, load, 0.0)
    y, _ = run(study, block, number, samples, reference, loads)
    height = abs(figure.y).max()
    few = 1e-6 if number is float else 2e-4
    assert np.abs(y - np.interp(np.arange(samples), np.arange(len(figure.y)), figure.y)).max() < few * height


def test_the_states_of_the_json_are_those_of_the_start(study, block):
    begin = study.results()["start"]
    assert (begin["u"], begin["y"]) == study.rest == block.rest
    loop = controller(block)
    loop.start(begin["y"], begin["y"], begin["u"], 0.0)
    assert (loop.x, loop.I) == pytest.approx((begin["x"], begin["I"]), rel=1e-12)
    assert begin["x"] != 0 and begin["I"] != 0
    assert states_at_rest(study.program.settings, *study.rest) == pytest.approx({k: begin[k] for k in "xI"})


def test_the_emitted_controller_is_the_librarys_own(study):
    """Same settings, same signals: the Pid that the library runs, in the features that both have."""
    from loopbook.controllers.pid import Pid

    settings = study.program.settings
    ours = controller(regulator_from_json({k: v for k, v in study.results().items() if k != "start"}))
    theirs = Pid(settings)
    draw = np.random.default_rng(1)
    for k in range(500):
        y, sp = float(20 + draw.normal()), float(20 + k // 100)
        assert ours.step(sp, y, 0.0) == pytest.approx(theirs.step(y, sp), rel=1e-12, abs=1e-12)
