"""Records that oscillate: the point is the process's own, K180 and T180 follow, a model comes along."""

import numpy as np
import pytest

from loopbook.design.study import Study
from loopbook.identification.choice import identify
from loopbook.identification.oscillation import find_oscillation
from loopbook.loop.continuous import Loop
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.transfer_function import Process
from loopbook.records.record import Record

pytestmark = pytest.mark.long

PROCESS = Process([2.0], np.polymul([20, 1], [5, 1]).tolist(), 4.0)
POINT = ultimate(PROCESS)


def swung(control, seed: int = 0, sigma: float = 0.01, h: float = 0.5, n: int = 600, load: float = 0.0) -> Record:
    """Two lags and a dead time under a law u = control(y, u, k), by small Euler steps: none of the package's code."""
    random, fine, x1, x2, u = np.random.default_rng(seed), 20, 0.0, 0.0, 0.0
    late = [0.0] * (round(4.0 / (h / fine)) + 1)
    rows = []
    for k in range(n):
        y = x2 + sigma * random.normal()
        u = control(y, u, k)
        rows.append((k * h, u + 40, y + 20))
        for _ in range(fine):
            late.append(u + load)
            x1 += h / fine * (2 * late.pop(0) - x1) / 20
            x2 += h / fine * (x1 - x2) / 5
    return Record(*np.array(rows).T)


def relay(hysteresis: float):
    return lambda y, u, k: 0.0 if k < 20 else 1.0 if k == 20 or y < -hysteresis else -1.0 if y > hysteresis else u


@pytest.mark.parametrize(("hysteresis", "load"), [(0.0, 0.0), (0.1, 0.2), (0.2, 0.0)])
def test_the_point_is_that_of_the_process_whatever_the_relay(hysteresis, load):
    swing = find_oscillation(swung(relay(hysteresis), load=load))
    assert swing.kind == "relay"
    G = complex(PROCESS(2j * np.pi / swing.period))
    assert swing.gain == pytest.approx(abs(G), rel=0.03)
    assert swing.phase == pytest.approx(np.degrees(np.angle(G)) % -360, abs=2.0)


def test_a_relay_record_gives_its_ultimate_point_and_a_model(tmp_path):
    record = swung(relay(0.1), n=700)
    file = tmp_path / "relay.csv"
    rows = [f"{t:g},{u:g},{y:.6g}" for t, u, y in zip(record.time, record.u, record.y, strict=True)]
    file.write_text("\n".join(["time,u,y", *rows]), encoding="utf-8")
    study = Study(file)
    point = ultimate(study.identified.process)
    assert point.K180 == pytest.approx(POINT.K180, rel=0.03) and point.T180 == pytest.approx(POINT.T180, rel=0.03)
    assert any("At -180 degrees the model has" in reason for reason in study.identified.reasons)
    told = study.results()["oscillation"]
    assert told["kind"] == "relay" and told["K180"] == pytest.approx(POINT.K180, rel=0.03)
    loop = Loop(PROCESS, study.recommendation.chosen.candidate.pid)
    assert loop.is_stable and loop.margins().Ms.value < 2


def test_a_loop_on_the_edge_of_stability_gives_two_numbers_and_says_so():
    held = ultimate(Process([2.0], np.polymul([20, 1], [5, 1]).tolist(), 4.25))  # a sample's hold is half of it late
    record = swung(lambda y, u, k: (1.0 if k < 20 else 0.0) - y / held.K180, n=1400, sigma=0.002)
    late = Record(record.time[600:] - record.time[600], record.u[600:], record.y[600:])
    found = identify(late)
    assert found.oscillation.kind == "sustained"
    Kv, L = found.chosen.gain, found.chosen.delay
    assert 4 * L == pytest.approx(POINT.T180, rel=0.05) and Kv * 4 * L / (2 * np.pi) == pytest.approx(
        POINT.K180, rel=0.05
    )
    assert "two numbers" in found.warnings[0]


@pytest.mark.parametrize("seed", range(3))
def test_a_step_test_does_not_oscillate(seed):
    t = np.arange(0.0, 200.0, 0.5)
    u = np.where(t >= 10, 1.0, 0.0)
    y = PROCESS.step(t - 10.0) + np.random.default_rng(seed).normal(0, 0.02, len(t))
    assert find_oscillation(Record(t, u, y)) is None
    up_and_down = np.where((t >= 10) & (t < 80), 1.0, 0.0)
    y = PROCESS.step(t - 10.0) - PROCESS.step(t - 80.0)
    assert find_oscillation(Record(t, up_and_down, y)) is None
