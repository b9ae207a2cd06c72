"""Records of a regulator at work: recognised, identified from set-point steps, refused where only load acts."""

import numpy as np
import pytest

from loopbook.design import tables
from loopbook.design.study import Study
from loopbook.identification.choice import identify
from loopbook.identification.closed_loop import closed_steps, fit_closed, noise_model, recognised
from loopbook.identification.least_squares import fit_structure
from loopbook.identification.models import FIRST_ORDER
from loopbook.records.reading import read_record
from loopbook.records.record import Record, RecordError

pytestmark = pytest.mark.long

TRUE = (2.0, 20.0, 4.0)


def loop(seed: int, colour: float = 0.0, sigma: float = 0.03, aims=(1.0, -0.5), load: float = 0.0, n: int = 700):
    """A PI loop around a lag with dead time; noise of one colour at the output; a load half-way."""
    random, (Kp, T, L), h = np.random.default_rng(seed), TRUE, 0.5
    decay, late, x, w, integral = np.exp(-h / T), int(L / h), 0.0, 0.0, 0.0
    inputs, rows = [0.0] * (late + 1), []
    for k in range(n):
        aim = aims[1] if k >= 380 else aims[0] if k >= 60 else 0.0
        w = colour * w + sigma * np.sqrt(1 - colour**2) * random.normal()
        y = x + w
        u = 1.2 * (aim - y) + integral
        integral += 1.2 * h / 18 * (aim - y)
        rows.append((k * h, aim + 20, y + 20, u + 40))
        inputs.append(u + (load if k > n // 2 else 0.0))
        x = decay * x + (1 - decay) * Kp * inputs[-1 - late]
    t, r, y, u = np.array(rows).T
    return Record(t, u, y, setpoint=r)


def test_the_process_comes_out_of_its_own_loop_whatever_the_noise():
    hits = np.zeros(3)
    for seed in range(4):
        record = loop(seed, colour=0.9 if seed % 2 else 0.0)
        fit = fit_closed(record, FIRST_ORDER, closed_steps(record)[0])
        hits += [p.interval[0] <= v <= p.interval[1] for p, v in zip(fit.parameters, TRUE, strict=True)]
    assert (hits >= 3).all(), hits


def test_without_a_noise_model_coloured_noise_would_bias_the_dead_time():
    """The reason for prediction error: least squares on the response see the noise that the regulator fed back."""
    plain, white = [], []
    for seed in range(5):
        record = loop(seed, colour=0.95, sigma=0.1)
        steps = closed_steps(record)[0]
        plain.append(fit_structure(record, FIRST_ORDER, steps, "rest").delay)
        white.append(fit_closed(record, FIRST_ORDER, steps).delay)
    assert abs(np.mean(white) - TRUE[2]) < abs(np.mean(plain) - TRUE[2]) / 2


def test_the_noise_model_is_the_noise_s():
    random, w = np.random.default_rng(0), np.zeros(4000)
    for k in range(1, 4000):
        w[k] = 0.8 * w[k - 1] + random.normal()
    assert (
        noise_model(w)[:2] == pytest.approx([1.0, -0.8], abs=0.04) and len(noise_model(random.normal(size=4000))) == 1
    )


def test_a_log_of_sp_pv_op_is_recognised_and_designed_for(tmp_path):
    record = loop(3)
    file = tmp_path / "loop.csv"
    columns = (record.time, record.setpoint, record.y, record.u)
    rows = [f"{t:g},{r:.6g},{y:.6g},{u:.6g}" for t, r, y, u in zip(*columns, strict=True)]
    file.write_text("\n".join(["time,SP,PV,OP", *rows]), encoding="utf-8")
    read = read_record(file)
    assert np.allclose(read.setpoint, record.setpoint) and recognised(read)
    study = Study(file)
    assert tables.graphical(study).rows[0][0].startswith("no step that can be read")
    assert "from 2 set-point steps by prediction error" in study.identified.reasons[0]
    assert study.model.gain == pytest.approx(2.0, rel=0.03) and study.model.delay == pytest.approx(4.0, abs=0.3)
    assert study.identified.chosen.settled == pytest.approx((320 * 0.5 - 4) / 20, rel=0.1)


def test_a_loop_that_only_a_load_moves_is_refused():
    with pytest.raises(RecordError, match="only load moves it"):
        identify(loop(1, aims=(0.0, 0.0), load=0.5))


def test_a_set_point_in_the_log_of_a_step_test_is_no_closed_loop():
    t = np.arange(0.0, 100.0, 0.5)
    y = 20 + 2 * FIRST_ORDER.response(t, [(10.0, 1.0)], (15.0,), 3.0) + np.random.default_rng(0).normal(0, 0.02, len(t))
    record = Record(t, np.where(t >= 10, 1.0, 0.0), y, setpoint=np.full(len(t), 20.0))
    assert not recognised(record) and identify(record).chosen.structure is FIRST_ORDER


def test_samples_at_uneven_times_are_refused():
    record = loop(1)
    time = record.time.copy()
    time[200:] += 3.0
    with pytest.raises(RecordError, match="not evenly spaced"):
        identify(Record(time, record.u, record.y, setpoint=record.setpoint))
