"""What leaves a design can be switched on: it starts without a bump, within limits that fit, or is refused."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from loopbook.design.model import ModelError
from loopbook.design.study import Study
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.records.record import RecordError
from tools import example_record as example

pytestmark = pytest.mark.long

OWN = Path(__file__).parent / "own_process"


@pytest.fixture(scope="module")
def example_file(tmp_path_factory):
    file = tmp_path_factory.mktemp("record") / "example.csv"
    file.write_text(example.text(), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def example_study(example_file):
    return Study(example_file)


def written(path: Path, time, u, y, head="time [s],u,y") -> Path:
    rows = [f"{t:.6g},{a:.8g},{b:.8g}" for t, a, b in zip(time, u, y, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    return path


def run_listing(listing: str, y: float, samples: int) -> list[float]:
    """The listing's own lines, run with the set-point and the measurement at y."""
    lines = [re.sub(r"\s+\(.*=.*\)$|\s+\(\d+\.\d+\)$", "", line) for line in listing.splitlines()]
    at = lines.index("repeat:")
    space = {"ysp": y, "y": y, "saturate": lambda v, low, high: min(max(v, low), high), "inf": float("inf")}
    for line in lines[:at]:
        if "=" in line and not line.endswith(":"):
            exec(line, space)
    found = []
    for _ in range(samples):
        for line in lines[at + 1 :]:
            if "=" in line:
                exec(line.strip(), space)
        found.append(space["u"])
    return found


TRUTH = {
    "glitch_first_sample_no_deadtime.csv": ({}, 4.6, (90, 35), 0),
    "index_and_two_word_names.csv": ({}, 4.6, (90, 35), 0),
    "no_time_column.csv": ({"interval": 1.0}, 2, (35,), 5),
    "dac_counts.csv": ({}, 1, (20,), 6),
    "date_and_time_columns.csv": ({}, 2, (35,), 5),
    "time_ms_suffix.csv": ({}, 3, (0.12,), 0),
    "up_fast_down_slow.csv": ({}, 2, (25,), 5),
    "no_dead_time.toml": ({}, 2, (10,), 0),
}


@pytest.fixture(scope="module")
def studies():
    return {name: Study(OWN / name, **told) for name, (told, *_) in TRUTH.items()}


@pytest.mark.parametrize("name", TRUTH)
def test_a_record_that_once_misled_gives_its_right_value(studies, name):
    _, gain, lags, delay = TRUTH[name]
    model = studies[name].model
    assert model.gain == pytest.approx(gain, rel=0.01)
    assert model.lags == pytest.approx(lags, rel=0.03)
    assert model.delay == pytest.approx(delay, abs=0.1)
    assert studies[name].running.overshoot < 15 and studies[name].running.Ms < 1.8


@pytest.mark.parametrize("name", TRUTH)
def test_the_emitted_program_keeps_the_input_that_it_finds(studies, name):
    study = studies[name]
    u0, y0 = study.rest
    run = np.array(run_listing(study.program.listing(), y0, 200))
    largest = max(abs(u0), abs(study.program.start["x"]) * 1e-2, abs(study.program.gains["p_2"] * y0) * 1e-2, 1e-300)
    assert np.abs(run - u0).max() <= 4 * np.spacing(largest) + 4 * np.spacing(abs(study.program.gains["p_2"] * y0))
    told = json.loads(json.dumps(study.results()))
    assert told["operating_point"] == {"u0": u0, "y0": y0} and told["start"]["I"] == study.program.start["I"]


def test_the_example_starts_at_forty_per_cent(example_study):
    study = example_study
    assert np.abs(np.array(run_listing(study.program.listing(), study.rest[1], 500)) - 40.0).max() < 1e-12
    assert "x = p4*y/(1 - p3)" in study.program.listing() and "I = u - p1*ysp - x + p2*y" in study.program.listing()


def test_limits_come_from_the_record_and_are_said(studies):
    dac = studies["dac_counts.csv"]
    assert dac.limits == (1241.0, 2482.0) and not dac.actuator.confirmed
    assert "uhigh = 2482.0" in dac.program.listing() and any("confirm" in text for text in dac.mind)


@pytest.mark.parametrize(
    ("low", "high", "message"),
    [
        (0.0, 100.0, "runs from 1241 to 2482, outside the limits 0 to 100"),
        (1500.0, 4095.0, "outside the limits"),
        (0.0, 1e6, "different scales"),
    ],
)
def test_limits_that_do_not_fit_the_record_are_refused(low, high, message):
    with pytest.raises(ModelError, match=message):
        _ = Study(OWN / "dac_counts.csv", u_low=low, u_high=high).limits


def test_a_valve_from_zero_to_one_is_not_limited_to_a_hundred(tmp_path):
    t = np.arange(0, 200, 0.5)
    u = np.where(t >= 20, 0.8, 0.2)
    y = 10 + 60 * Process.fopdt(0.6, 15, 3).step(t - 20)
    file = written(tmp_path / "v.csv", t, u, y + np.random.default_rng(0).normal(0, 0.1, len(t)))
    assert Study(file).limits == (0.2, 0.8)
    with pytest.raises(ModelError, match="different scales"):
        _ = Study(file, u_low=0.0, u_high=100.0).limits


def test_what_is_expected_is_what_the_sampled_program_does(example_file, example_study):
    coarse = Study(example_file, h=10.0).results()["expected"]
    assert coarse["overshoot"] == pytest.approx(20.5, abs=0.05)
    assert coarse["measurement_noise"] == pytest.approx(0.14, abs=0.02) and coarse["input_noise"] > 0
    fine = example_study.results()["expected"]
    assert fine["overshoot"] < 12 and 0 <= fine["share_at_limit"] <= 1


def test_the_noise_of_the_input_is_that_of_a_long_noisy_run(example_file):
    running = Study(example_file, u_low=-np.inf, u_high=np.inf).running
    noisy = running._run(0.0, False, running.noise)
    assert np.std(noisy.u[20:]) == pytest.approx(running.input_noise, rel=0.25)


def test_a_coarse_noisy_sensor_does_not_shake_the_heater(tmp_path):
    time = 0.79 * np.arange(1100)
    y = (
        20.9
        + 50 * Process.fopdt(0.68, 150.0, 18.0).step(time - time[40])
        + np.random.default_rng(0).normal(0, 0.1, 1100)
    )
    file = written(tmp_path / "h.csv", time, np.where(np.arange(1100) >= 40, 50.0, 0.0), np.round(y / 0.32) * 0.32)
    study = Study(file)
    assert study.running.input_noise < 0.05 * 50 and float(study.program.settings.h) >= 0.5
    assert abs(study.program.gains["p_2"]) * 0.32 < 0.1 * 50


def _noise(n, size, seed=1):
    return np.random.default_rng(seed).normal(0, size, n)


T = np.arange(0.0, 300.0, 1.0)
STEP = np.where(T >= 50, 1.0, 0.0)
LAG = Process.fopdt(2.0, 20.0, 5.0).step(T - 50)


def _pi_loop():
    """A process under PI, disturbed: what a record shows that was not made in manual."""
    y, I, states, u_all, y_all = 0.0, 0.0, [0.0] * 6, [], []
    noise = _noise(len(T), 0.05)
    for k in range(len(T)):
        seen = y + noise[k]
        u = 0.8 * (0.0 - seen) + I
        I += 0.8 / 20 * (0.0 - seen)
        states.append(u)
        y += (2 * states[-6] + (0.5 if k > 100 else 0.0) - y) / 20
        u_all.append(u)
        y_all.append(seen)
    return np.array(u_all), np.array(y_all)


def _ringing():
    s = np.maximum(T - 50, 0)
    return 2 * (1 - np.exp(-0.03 * s) * (np.cos(0.2 * s) + 0.15 * np.sin(0.2 * s)))


def _beside(gain_slow, slow, gain_fast, fast):
    """Two paths with gains of their own, from a step at 50 s."""
    s = np.maximum(T - 50, 0)
    return gain_slow * (1 - np.exp(-s / slow)) + gain_fast * (1 - np.exp(-s / fast))


REFUSED = {
    "no excitation": (np.ones(len(T)), LAG, "no step found"),
    "no answer": (STEP, _noise(len(T), 1.0), "does not answer|lost in the noise|not determined"),
    "drift": (STEP, 0.02 * T + _noise(len(T), 0.02), "a drift explains"),
    "closed loop": (*_pi_loop(), "closed loop"),
    "a zero that overshoots": (
        STEP,
        _beside(-1.0, 30.0, 3.0, 8.0) + _noise(len(T), 0.01),
        "comes back without ringing",
    ),
    "a random walk": (STEP, np.cumsum(_noise(len(T), 0.3, 5)), "something else|drift|does not answer|not determined"),
    "a parabola": (STEP, 1e-4 * T**2 + _noise(len(T), 0.05), "a drift explains"),
    "the output moves first": (
        np.where(T >= 80, 1.0, 0.0),
        LAG + _noise(len(T), 0.01),
        "not determined|not at rest|else",
    ),
    "saturated": (STEP, np.minimum(LAG, 0.02), "saturated|not determined|below|shorter"),
    "saturated in noise": (STEP, np.minimum(LAG + _noise(len(T), 0.05), 0.06), "saturated"),
    "faster than the samples": (STEP, 2 * STEP + _noise(len(T), 0.001), "shorter than the sampling interval"),
    "asymmetric": (
        np.where((T >= 50) & (T < 170), 1.0, np.where(T >= 170, -1.0, 0.0)),
        2 * Process.fopdt(1.0, 15.0, 3.0).step(T - 50) - 2.9 * Process.fopdt(1.0, 15.0, 3.0).step(T - 170),
        "asymmetric: its gain is",
    ),
}


@pytest.mark.parametrize("why", REFUSED)
def test_a_record_that_gives_no_regulator_is_refused_with_the_true_reason(tmp_path, why):
    u, y, message = REFUSED[why]
    with pytest.raises(RecordError, match=message) as refused:
        Study(written(tmp_path / "r.csv", T, u, y)).results()
    assert "leaves 0 %" not in str(refused.value)


def test_a_process_that_rings_gets_a_regulator_that_does_not(tmp_path):
    file = written(tmp_path / "r.csv", T, STEP, _ringing() + _noise(len(T), 0.01))
    study = Study(file)
    assert study.model.damping == pytest.approx(0.148, abs=0.01)
    assert study.results()["process"]["damping"] == study.model.damping
    truth = Process([2.0 * (0.2**2 + 0.03**2)], [1.0, 0.06, 0.2**2 + 0.03**2])
    loop = Loop(truth, study.recommendation.chosen.candidate.pid)
    assert loop.is_stable and loop.margins().Ms.value < 2
    with pytest.raises(RecordError, match="underdamped: its response rings with a period of 31"):
        Study(file, known="T=20").results()


def test_a_process_that_starts_the_wrong_way_is_seen_and_kept_slow(tmp_path):
    truth = Process([-12.0, 2.0], [50.0, 15.0, 1.0], 2.0)
    file = written(tmp_path / "r.csv", T, STEP, truth.step(T - 50) + _noise(len(T), 0.02))
    study = Study(file)
    assert study.model.zero == pytest.approx(6.0, rel=0.15)
    assert study.results()["process"]["zero"] == study.model.zero
    loop = Loop(truth, study.recommendation.chosen.candidate.pid)
    assert loop.is_stable and loop.margins().Ms.value < 2


def test_two_equal_lags_are_determined(tmp_path):
    s = np.maximum(T - 50, 0)
    y = 2 * (1 - (1 + s / 15) * np.exp(-s / 15)) + _noise(len(T), 0.02)
    model = Study(written(tmp_path / "r.csv", T, STEP, y)).model
    assert (
        model.gain == pytest.approx(2, rel=0.02) and model.lags == pytest.approx((15, 15), rel=0.1) and model.delay < 1
    )


def test_a_sensor_that_freezes_for_a_while_is_said_and_left_out(tmp_path):
    y = LAG + _noise(len(T), 0.02)
    y[70:120] = y[70]
    study = Study(written(tmp_path / "r.csv", T, STEP, y))
    assert study.model.lags == pytest.approx((20,), rel=0.1) and any("stands still" in text for text in study.mind)


def test_parameters_that_the_user_knows_are_kept(tmp_path):
    file = written(tmp_path / "r.csv", T, STEP, LAG + _noise(len(T), 0.02))
    study = Study(file, known="K=2.1, L=4")
    assert study.model.gain == 2.1 and study.model.delay == 4.0 and study.model.lags[0] == pytest.approx(20, rel=0.2)
    assert study.identified.chosen.parameter("Kp").half_width == 0.0


@pytest.mark.parametrize("speed", [0.0, pytest.param(0.5, marks=pytest.mark.whole), 1.0])
def test_the_speed_is_what_the_loop_gets(example_file, speed):
    slow_to_fast = Study(example_file, speed=speed)
    name = slow_to_fast.recommendation.chosen.candidate.name
    assert "closed loop" in name or "M =" in name
    assert len(slow_to_fast.curve) >= 9


@pytest.mark.parametrize(
    ("text", "how"),
    [
        ("gain = 2.0\ntime_constants = [10.0]\ndelay = 0.0", {}),
        ("gain = 0.3\nintegrating = true\ndelay = 0.0", {}),
        ("gain = 0.3\nintegrating = true\ntime_constants = 5\ndelay = 0.0", {}),
        ("gain = 2.0\ntime_constants = [10.0]\ndelay = 0.0", {"closed_loop": 3.0}),
        ("gain = 2.0\ntime_constants = [10.0, 1.0]\ndelay = 0.0", {"speed": 0.8}),
        ("gain = 2.0\ntime_constants = LAGS\ndelay = 0.0", {}),
    ],
)
def test_processes_without_dead_time_and_of_high_order_are_designed_for(tmp_path, share, text, how):
    text = text.replace("LAGS", str([float(i) for i in range(1, share(13, 31))]))
    file = tmp_path / "p.toml"
    file.write_text(f"[process]\n{text}\n", encoding="utf-8")
    study = Study(file, **how)
    assert study.running.Ms < 2 and study.running.overshoot < 30 and study.model.latex()
    json.dumps(study.results(), allow_nan=False)
    assert study.running.input_noise == 0.0  # no record, no noise


def test_a_speed_that_the_process_does_not_allow_is_refused_and_what_lacks_is_in_the_data(example_file):
    for closed in (0.001, 1.0):
        with pytest.raises(ModelError, match="faster than the process allows"):
            _ = Study(example_file, closed_loop=closed).recommendation
    with pytest.raises(RecordError, match=r"closed loop of 0.001 s .*ask for a slower one"):
        _ = Study(OWN / "no_dead_time.toml", closed_loop=0.001).recommendation
    loud = Study(OWN / "time_ms_suffix.csv", speed=1.0).results()
    assert any("would shake the input" in text for text in loud["mind"])


UNUSUAL = {
    "rings in noise": (_ringing() + _noise(len(T), 0.3), "damping", 0.148, 0.1),
    "starts the wrong way": (_beside(4.0, 20.0, -3.0, 6.0) + _noise(len(T), 0.01), "zero", 36.0, 8.0),
}


@pytest.mark.parametrize("what", UNUSUAL)
def test_what_once_was_refused_for_its_shape_has_a_model_of_that_shape(tmp_path, what):
    y, name, value, off = UNUSUAL[what]
    model = Study(written(tmp_path / "r.csv", T, STEP, y)).model
    assert getattr(model, name) == pytest.approx(value, abs=off)
