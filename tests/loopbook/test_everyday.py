"""The twelve everyday tasks: three lines each, and what they give is right by a second way."""

import ast
import math
import re
from pathlib import Path

import matplotlib
import numpy as np
import pytest

import loopbook as lb

matplotlib.use("Agg")

TEXT = (Path(__file__).parent / "everyday.md").read_text(encoding="utf-8")
TASKS = dict(re.findall(r"^## (\d+)\. .*\n\n((?:    .*\n)+)", TEXT, re.M))


@pytest.fixture(scope="module")
def done():
    """What each task's last line gives, by number, and all names; the tasks run once, in order."""
    t = np.arange(0.0, 90.0, 0.5)
    u = np.where(t >= 5, 1.0, 0.0)
    noise = 0.01 * np.random.default_rng(1).standard_normal(len(t))
    names = {"lb": lb, "t": t, "u": u, "y": lb.tf(2, [10, 1], 3).step(t - 5) + noise}
    last = {}
    for number, code in TASKS.items():
        *body, end = ast.parse(re.sub(r"^    ", "", code, flags=re.M)).body
        exec(compile(ast.Module(body, []), f"task {number}", "exec"), names)
        if isinstance(end, ast.Expr):
            last[number] = eval(compile(ast.Expression(end.value), f"task {number}", "eval"), names)
        else:
            exec(compile(ast.Module([end], []), f"task {number}", "exec"), names)
    return names, last


def test_there_are_twelve_of_three_lines():
    assert list(TASKS) == [str(n) for n in range(1, 13)]
    assert all(len(code.splitlines()) <= 3 for code in TASKS.values())


def test_the_process_shows_its_formula(done):
    names, last = done
    assert last["1"]._repr_latex_() == r"$$\frac{2}{(10 s + 1) (4 s + 1)} e^{-3 s}$$"
    s = 0.3j
    assert complex(names["P"](s)) == pytest.approx(2 * np.exp(-3 * s) / ((10 * s + 1) * (4 * s + 1)))


def test_responses_of_y_and_u_are_drawn(done):
    _, last = done
    y, u = last["2"].axes
    t, drawn = y.lines[0].get_data()
    assert {"output $y$", "input $u$"} == {y.get_ylabel(), u.get_ylabel()} and t[0] == 0
    half = len(t) // 2
    assert drawn[half - 5] == pytest.approx(1, abs=0.02) and drawn[-1] == pytest.approx(1, abs=0.02)
    assert drawn[half:].max() > 1.2  # the load is felt
    assert u.lines[0].get_ydata()[half - 5] == pytest.approx(0.5, abs=0.02)


def test_margins_are_a_table_and_are_drawn(done):
    names, last = done
    loop, html = names["loop"], names["lb"].margins(names["loop"])._repr_html_()
    margins = loop.margins()
    assert f"{margins.Ms.value:.4g}" in html and f"{margins.phase:.4g}" in html
    w = np.geomspace(0.01, 10, 20001)
    assert margins.Ms.value == pytest.approx(abs(1 / (1 + loop.transfer(1j * w))).max(), rel=1e-4)
    legend = [text.get_text() for text in last["3"].axes[0].get_legend().get_texts()]
    assert any(f"{margins.gain:.3g}" in text for text in legend) and any("M_s" in text for text in legend)
    drawn = [text.get_text() for axis in lb.bode(loop).axes for text in axis.texts]
    assert any(f"{margins.gain:.3g}" in text for text in drawn) and any(
        f"{margins.phase:.3g}" in text for text in drawn
    )


def test_step_metrics_by_both_conventions(done):
    names, _ = done
    for exact, sampled in (names["of_process"], names["of_loop"]):
        assert (exact.convention, sampled.convention) == ("exact", "sampled")
        assert sampled.rise == pytest.approx(exact.rise, rel=0.02)
        assert sampled.settling == pytest.approx(exact.settling, rel=0.02)
        assert sampled.overshoot == pytest.approx(exact.overshoot, abs=0.5)
    t = np.linspace(0, 100, 200001)
    y = names["P"].step(t) / 2
    assert names["of_process"][0].settling == pytest.approx(t[np.flatnonzero(abs(y - 1) > 0.02)[-1]], abs=1e-3)


def test_the_sampled_process_answers_as_the_continuous_one_at_the_instants(done):
    names, last = done
    assert names["S"].tau == pytest.approx(0.2) and len(names["S"].num) == 8
    assert last["5"] == pytest.approx(names["P"].step(0.7 * np.arange(60)), abs=1e-10)
    assert "z^{-5}" in names["S"]._repr_latex_()


def test_three_rules_in_one_table(done):
    names, last = done
    assert list(last["6"].values) == ["simc-pi", "amigo-step-pi", "lambda-pi"]
    for name, iae in last["6"].column("IAE, load").items():
        loop = lb.Loop(names["P"], lb.tune(names["P"], name))
        assert iae == pytest.approx(loop.step("load").iae()) and iae >= loop.regulator.Ti / loop.regulator.K - 1e-9
    assert "Ms" in last["6"]._repr_html_()


def test_the_phase_margin_is_had(done):
    _, last = done
    assert last["7"].phase == pytest.approx(60, abs=1e-6)
    assert last["7"].gain_crossovers[0].w == pytest.approx(0.2, rel=1e-9)


def test_the_poles_are_placed_in_letters_and_in_numbers(done):
    names, last = done
    placed, letters = last["8"][0], names["letters"]
    loop = lb.SampledLoop(names["P"], placed)
    assert loop.is_stable
    B, A = names["S"].polynomials
    total = np.convolve(A, placed.R) + np.convolve(B, placed.S)
    assert np.trim_zeros(np.round(total, 9), "b") == pytest.approx(np.poly([0.8] * 3), abs=1e-8)
    values = {f"a_{i}": a for i, a in enumerate(A)} | {f"b_{i}": b for i, b in enumerate(B)}
    d_0 = float(letters.parameters["d_0"].subs(values))
    assert d_0 == pytest.approx(placed.S[0], rel=1e-6)
    assert float(letters.parameters["K_r"].subs(values)) == pytest.approx(placed.T[0], rel=1e-9)
    assert placed._repr_latex_().count("&=") == 3


def test_anti_windup_overshoots_less(done):
    _, last = done
    over = last["9"].column("overshoot [%]")
    assert over["tracking"] < over["none"] - 5
    assert last["9"].column("largest u") == {"tracking": 1.0, "none": 1.0}
    assert len(last["9"].plot().axes[0].lines) >= 2


def test_python_control_and_back(done):
    names, _ = done
    control = pytest.importorskip("control")
    s = 0.05j
    assert complex(names["G"](s)) == pytest.approx(complex(names["P"](s)), rel=1e-6)
    assert isinstance(names["X"], control.StateSpace) and names["X"].dt == 0.7
    z = np.exp(0.1j)
    assert complex(names["X"](z)) == pytest.approx(complex(names["S"](z)), rel=1e-9)
    assert names["back"].delay == 3 and names["back"].den == pytest.approx((1.0, 0.35, 0.025), rel=1e-12)
    assert names["back"].num == pytest.approx((0.05,), rel=1e-12)


def test_the_relay_finds_the_ultimate_point_and_tunes(done):
    names, _ = done
    from loopbook.loop.ultimate_point import ultimate

    point = ultimate(names["P"])
    assert names["seen"].data.T180 == pytest.approx(point.T180, rel=0.05)
    assert names["by_relay"].K == pytest.approx(0.6 * names["seen"].data.Ku)
    assert lb.Loop(names["P"], names["by_relay"]).is_stable


def test_the_model_is_printed_with_its_uncertainty(done, capsys):
    names, _ = done
    text = str(names["model"])
    assert "first order with dead time" in text and "95 %" in text
    for name, true in (("Kp", 2), ("T", 10), ("L", 3)):
        found = names["model"].parameter(name)
        assert abs(found.value - true) < 2 * found.half_width and 0 < found.half_width < 0.1 * true
        assert math.isfinite(found.value)
