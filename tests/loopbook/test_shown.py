"""What a person holds in a notebook shows itself: as a formula or a table, in one short line, as a figure."""

import matplotlib
import numpy as np
import pytest

import loopbook as lb
from loopbook.plots.short_repr import short

matplotlib.use("Agg")

P = lb.tf(2, [[10, 1], [4, 1]], 3)
LONG = lb.tf(np.arange(1.0, 30) / 7, np.arange(1.0, 40) / 7, 1 / 3)
TUNED = lb.tune(P, "simc", "PI")
LOOP = lb.Loop(P, TUNED)
SAMPLED = lb.sample(P, 0.5)
PLACED = lb.place(SAMPLED, 0.8)
IN_Z = lb.DiscreteLoop(lb.c2d(P.rational, 0.5, "tustin"), 0.5)
LAG, LATE = lb.tf(2, [10, 1], 1), lb.tf(3, [10, 1], 4)
PID_SETTINGS = lb.PidSettings(K=1.0, Ti=10.0, h=0.5)

SHOWN = {
    "process": P,
    "process of high order": LONG,
    "sum": P + lb.tf(1, [1, 1]),
    "closed loop": P.feedback(),
    "closed loop of high order": LONG.feedback(),
    "Padé": lb.pade(P, 3),
    "Thiran": lb.thiran(2.4, 1.0),
    "plant in z": lb.c2d(P.rational, 0.5, "tustin"),
    "sampled process": SAMPLED,
    "sampled process of high order": lb.sample(lb.tf(np.ones(9) / 7, np.poly(-np.arange(1.0, 11) / 7), 1 / 3), 0.5),
    "standard form": lb.PidStandard(2 / 3, 1 / 3, 1 / 7, N=5),
    "parallel form": lb.PidParallel(2 / 3, 1 / 3, 1 / 7, 5),
    "series form": lb.PidSeries(2 / 3, 1 / 3, 1 / 7, N=5),
    "regulator": TUNED.regulator(),
    "RST": PLACED.regulator,
    "placement": PLACED,
    "placement in s": lb.place(LAG.rational, -1.0),
    "tuning": TUNED,
    "tunings": lb.tune(P, ["simc", "lambda", "amigo"], "PI"),
    "loop": LOOP,
    "unstable loop": lb.Loop(P, 30.0),
    "sampled loop": lb.SampledLoop(P, PLACED.regulator),
    "loop in z": IN_Z,
    "general loop": lb.GeneralLoop(P.feedback(0.1), 0.3),
    "predictor": lb.SmithLoop(P, TUNED),
    "its robustness": lb.SmithLoop(P, TUNED).robustness(),
    "cascade": lb.CascadeLoop(lb.tf(2, [5, 1], 0.5), lb.tf(1, [40, 1], 4), 4.0, lb.PidStandard(3.0, 40.0)),
    "feedforward": lb.FeedforwardLoop(LAG, 0.5, LATE, lb.feedforward(LAG, LATE)),
    "margins": LOOP.margins(),
    "margins in z": IN_Z.margins(),
    "crossovers": lb.crossovers(LOOP),
    "poles": lb.poles(LOOP),
    "step": LOOP.step(),
    "step of an offset": lb.Loop(P, 0.5).step(),
    "metrics": LOOP.step().metrics(),
    "responses": lb.step_response({"P": P, "loop": LOOP, "sampled": SAMPLED}),
    "comparison": lb.compare(P, lb.tune(P, ["simc", "lambda"], "PI")),
    "simulation": lb.simulate(P, lb.Pid(PID_SETTINGS), 0.5, 100, reference=1.0),
    "polynomial equation": lb.diophantine([1, 2], [1], [1, 2, 3]),
}
WITHOUT_FIGURE = {
    *("standard form", "parallel form", "series form", "regulator", "RST", "placement", "placement in s", "tuning"),
    *("tunings", "its robustness", "margins", "margins in z", "crossovers", "poles", "metrics", "polynomial equation"),
}


@pytest.mark.parametrize("name", SHOWN)
def test_it_is_one_short_line_in_a_terminal(name):
    assert len(repr(SHOWN[name])) < 300 and "\n" not in repr(SHOWN[name])


@pytest.mark.parametrize("name", SHOWN)
def test_it_is_a_formula_or_a_table_in_a_notebook(name):
    thing = SHOWN[name]
    if hasattr(thing, "_repr_latex_"):
        text = thing._repr_latex_()
        assert text.startswith("$$") and text.endswith("$$") and len(text) > 5 and text.count("{") == text.count("}")
    else:
        text = thing._repr_html_()
        assert text.startswith("<table>") and text.count("<tr>") > 1 and "nan" not in text


@pytest.mark.parametrize(
    "name", [n for n in SHOWN if n not in WITHOUT_FIGURE and "unstable" not in n and "high" not in n]
)
def test_it_draws_itself_without_an_argument(name):
    """With a title and a unit on every axis of time or frequency, and the curves inside the axes."""
    figures = [SHOWN[name].plot()]
    if hasattr(SHOWN[name], "frequency_curve"):
        figures += [SHOWN[name].plot("bode"), SHOWN[name].plot("nyquist")]
    for figure in figures:
        assert figure.axes[0].get_title() and all(axis.get_ylabel() for axis in figure.axes)
        label = figure.axes[-1].get_xlabel()
        assert label in ("time $t$ [s]", r"frequency $\omega$ [rad/s]", "real part")
        assert all(len(axis.lines) and np.isfinite(axis.dataLim.bounds).all() for axis in figure.axes)
    matplotlib.pyplot.close("all")


def test_a_loop_says_what_it_is_made_of_and_whether_it_is_stable():
    assert "Process(num=(2.0,), den=(40.0, 14.0, 1.0), delay=3.0)" in str(LOOP) and "Ms" in str(LOOP)
    unstable = str(SHOWN["unstable loop"])
    assert "stable" in unstable and "no" in unstable and "Ms" not in unstable
    assert "model of the predictor" in str(SHOWN["predictor"]) and "inner regulator" in str(SHOWN["cascade"])


def test_laws_with_their_numbers():
    assert lb.PidStandard(2, 4, 1, b=0.5, N=10).latex() == (
        r"u = 2 \left[(0.5 r - y) + \frac{1}{4 s} (r - y) + \frac{s}{1 + 0.1 s} (-y)\right]"
    )
    assert lb.PidParallel(0, 0.5).latex() == r"u = \frac{0.5}{s} (r - y)"
    assert lb.PidParallel(2, -0.5).latex() == r"u = 2 (r - y) + \frac{-0.5}{s} (r - y)"
    assert lb.PidStandard(3).latex() == "u = 3 (r - y)"
    assert lb.PidSeries(2, 4, 1).latex() == r"u = 2 \left(1 + \frac{1}{4 s}\right) \left(1 + s\right) (r - y)"
    assert (
        lb.Regulator.one_dof([2, 1], [1, 0]).latex()
        == r"\begin{aligned} R &= s \\ S &= 2 s + 1 \\ T &= 2 s + 1 \end{aligned}"
    )


def test_a_settled_response_is_drawn_as_long_as_it_moves():
    chosen, asked = LOOP.step(), LOOP.step(horizon=200.0)
    drawn = [float(r.plot().axes[0].lines[0].get_xdata()[-1]) for r in (chosen, asked)]
    assert drawn[0] < chosen.horizon / 3 and drawn[1] == 200.0
    assert drawn[0] > chosen.metrics().settling
    matplotlib.pyplot.close("all")


def test_what_a_loop_cannot_draw_is_said():
    with pytest.raises(ValueError, match="one of step, bode, nyquist"):
        LOOP.plot("root locus")
    with pytest.raises(ValueError, match="not stable"):
        SHOWN["unstable loop"].plot()
    assert len(SHOWN["unstable loop"].plot(horizon=20.0).axes) == 2


def test_short_values():
    assert short(np.zeros(5)) == "[5 items]" and short(np.float64(1 / 3)) == "0.333333"
    assert short("a" * 100).endswith("...'") and short(()) == "()"
