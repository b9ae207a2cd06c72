"""Sampled loops of the page against Python: sampling, margins on the circle, the program that runs, placed poles."""

import math

import numpy as np
import pytest

from loopbook.code import controller, pid_block
from loopbook.controllers.rst import Rst
from loopbook.controllers.settings import PidSettings
from loopbook.loop.sampled import SampledLoop
from loopbook.pole_placement.place import place
from loopbook.process.construct import tf
from loopbook.process.sampled import sample
from loopbook.response.simulation import simulate

PROCESSES = {
    "two lags": tf(2, [[40, 1], [12, 1]], 8),
    "a fraction of a sample": tf(1, [10, 1], 3.7),
    "integrating": tf(0.1, [[1, 0], [5, 1]], 2.5),
    "complex poles": tf(1, [16, 2, 1], 3),
    "equal lags": tf(1, [1, 3, 3, 1], 0.4),
    "unstable": tf(1, [20, -1], 1),
    "a zero": tf([-2, 1], [[10, 1], [3, 1]], 1),
}
SHARES = (0.15, 0.8)  # of the process's time: sampling intervals
SETTINGS = {
    "two lags": (0.65, 45, 6, 2),
    "a fraction of a sample": (1.2, 9, 0, 0),
    "integrating": (0.8, 60, 4, 0.8),
    "complex poles": (0.1, 1.5, 0, 0),
    "equal lags": (1.5, 2.5, 0.5, 0.1),
    "unstable": (6.0, 30, 0.3, 0.1),
    "a zero": (0.8, 12, 1, 0.2),
}
TIMES = {
    "two lags": 20,
    "a fraction of a sample": 5,
    "integrating": 5,
    "complex poles": 4,
    "equal lags": 1,
    "unstable": 2,
}


def given(process):
    """The process as the page has it: with its lags where knobs tell them."""
    data = {"num": list(process.num), "den": list(process.den), "delay": process.delay}
    return data | ({"lags": [1.0, 1.0, 1.0]} if process is PROCESSES["equal lags"] else {})


def numbers(name, h):
    K, Ti, Td, Tf = SETTINGS[name]
    return {
        "K": K,
        "Ti": Ti,
        "Td": Td,
        "Tf": Tf,
        "b": 0.7,
        "c": 0.2,
        "h": h,
        "u_low": -math.inf,
        "u_high": math.inf,
        "rate": 0.0,
    }


def cases():
    return [(name, share * TIMES.get(name, 3)) for name in PROCESSES for share in SHARES]


@pytest.mark.parametrize(("name", "h"), cases())
def test_a_process_is_sampled_exactly(ask, name, h):
    process = PROCESSES[name]
    found = ask("(process, h) => page.pulseTransfer(page.sample(process, h))", given(process), h)
    B, A = sample(process, h).polynomials
    assert found["A"] == pytest.approx(A, rel=1e-9, abs=1e-12)
    assert found["B"] == pytest.approx(B, rel=1e-8, abs=1e-10 * abs(B).max())


def rst_of(name, h):
    """The PID that the program runs, as polynomials: from its gains, by hand."""
    n = numbers(name, h)
    K, Ti, Td, Tf = n["K"], n["Ti"], n["Td"], n["Tf"]
    p3, p4 = Tf / (Tf + h), K * Td * h / (Tf + h) ** 2
    p1, p2, p5 = K * n["b"] + K * Td * n["c"] / (Tf + h), K + K * Td / (Tf + h), K * h / Ti
    whole, lag = np.array([1.0, -1.0]), np.array([1.0, -p3])
    R = np.convolve(whole, lag)
    late = lambda p: np.append(0.0, p)  # noqa: E731
    S = p2 * R + p5 * late(lag) - p4 * late(whole)
    T = p1 * R + p5 * late(lag) - p4 * n["c"] * late(whole)
    return Rst(tuple(R), tuple(S), tuple(T), h)


MARGINS = """(process, h, settings) => {
    const law = page.emittedLaw({ ...settings, Tt: Infinity });
    const { R, S, T } = page.pidPolynomials(law.state), { B, A, modes } = page.pulseTransfer(page.sample(process, h));
    const convolve = (p, q) => {
        const r = new Array(p.length + q.length - 1).fill(0);
        p.forEach((a, i) => q.forEach((b, j) => { r[i + j] += a * b; }));
        return r;
    };
    const zeros = [...page.zerosOf(S), ...page.zerosOf(B)], poles = [...page.zerosOf(R), ...modes];
    const circle = new page.CircleTransfer(convolve(S, B), convolve(R, A), zeros, poles);
    const count = circle.unstableRoots;
    return { R, S, T, count, margins: count ? null : page.sampledMargins(circle, h) };
}"""


GAINS = (1.0, 4.0)  # times the process's


@pytest.mark.parametrize("gain", GAINS)
@pytest.mark.parametrize(("name", "h"), cases())
def test_the_margins_of_the_sampled_loop(ask, name, h, gain):
    process, regulator = PROCESSES[name], rst_of(name, h)
    data = given(process)
    found = ask(MARGINS, {**data, "num": [gain * c for c in data["num"]]}, h, numbers(name, h))
    for key in "RST":
        assert np.trim_zeros(found[key], "b") == pytest.approx(list(getattr(regulator, key)), rel=1e-12)
    process = process * gain
    loop = SampledLoop(process, regulator)
    assert (found["count"] == 0) == loop.is_stable
    if not loop.is_stable:
        return
    ours, theirs = loop.margins(), found["margins"]
    assert theirs["gain"] == pytest.approx(ours.gain, rel=1e-7)
    assert theirs["gainLow"] == pytest.approx(ours.gain_low, rel=1e-7, abs=1e-12)
    assert theirs["phase"] == pytest.approx(ours.phase, rel=1e-7)
    assert theirs["Ms"]["value"] == pytest.approx(ours.Ms.value, rel=1e-7)
    assert theirs["Mt"]["value"] == pytest.approx(ours.Mt.value, rel=1e-7)


def test_there_are_stable_and_unstable_sampled_loops():
    stable = [SampledLoop(PROCESSES[n] * g, rst_of(n, h)).is_stable for n, h in cases() for g in GAINS]
    assert stable.count(True) >= 8 and stable.count(False) >= 4


RUN = """(process, h, settings, steps, size, load) => {
    const law = page.emittedLaw(settings);
    law.start(0, 0, 0, 0);
    law.state.arriving = false;
    const program = { step: (r, y) => law.step(r, y, 0) };
    const half = Math.round(steps / 2) * h;
    const signals = { reference: () => size, load: (t) => (t >= half - h / 1e6 ? load : 0), points: 1 };
    return page.simulate(page.sample(process, h), program, steps, signals);
}"""


@pytest.mark.parametrize("windup", [True, False], ids=["anti-windup", "none"])
@pytest.mark.parametrize(("name", "h"), [case for case in cases() if case[0] not in ("complex poles", "unstable")])
def test_the_program_runs_within_its_limits_as_in_python(ask, name, h, windup):
    process, steps, size, load = PROCESSES[name], 120, 1.0, 0.3
    settings = numbers(name, h) | {"u_low": -0.2, "u_high": 0.9}
    settings["Tt"] = max(math.sqrt(settings["Ti"] * settings["Td"]) or settings["Ti"] / 2, h) if windup else math.inf
    found = ask(RUN, given(process), h, settings, steps, size, load)
    law = controller(pid_block(PidSettings(K=1.0, Ti=1.0, h=h)), **settings)
    law.start(0.0, 0.0, 0.0, 0.0)
    law.arriving = False

    class Program:
        def step(self, y, r):
            return law.step(r, y, 0.0)

    half = round(steps / 2)
    run = simulate(process, Program(), h, steps, reference=size, load=[0.0] * half + [load] * (steps + 1 - half))
    assert np.array(found["y"])[: steps + 1] == pytest.approx(run.y, abs=1e-8 * abs(run.y).max())
    assert np.array(found["u"])[: steps + 1] == pytest.approx(run.u, abs=1e-8)
    if name == "a zero":
        assert run.u.max() == pytest.approx(0.9)  # the limit is reached


@pytest.mark.parametrize(("name", "h"), [("two lags", 4.0), ("a fraction of a sample", 1.0), ("integrating", 1.0)])
def test_poles_are_placed_as_in_python(ask, name, h):
    process = PROCESSES[name]
    sampled = sample(process, h)
    B, A = sampled.polynomials
    z = [0.7 + 0.1j, 0.7 - 0.1j, *[0.6] * (process.order - 1)]
    ours = place(sampled, z, observer=[0.4]).regulator
    P = np.real(np.poly(z))
    found = ask("(B, A, P, O) => page.place(B, A, P, O, 1)", B.tolist(), A.tolist(), P.tolist(), [1.0, -0.4])
    for key in "RST":
        assert found[key] == pytest.approx(list(getattr(ours, key)), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", ["two lags", "a fraction of a sample", "a zero"])
def test_a_record_is_played_through_the_model(ask, name):
    process = PROCESSES[name]
    t = np.sort(np.random.default_rng(5).uniform(0, 60, 80))
    u = np.where(t > 5, 1.0, 0.0) + np.where(t > 30, -0.6, 0.0)
    at = [t[t > 5][0], t[t > 30][0]]
    y = ask("page.replay", given(process), t.tolist(), u.tolist())
    exact = process.step(t - at[0]) - 0.6 * process.step(t - at[1])
    assert y == pytest.approx(exact, abs=1e-9)
    assert ask("page.fitOf", exact.tolist(), y) == pytest.approx(100.0)
