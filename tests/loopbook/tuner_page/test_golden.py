"""The page's core against Python: a share of the 500 golden loops (make prove-tuner: all of them)."""

import importlib.util
import sys
from pathlib import Path

import pytest

import loopbook as lb
from loopbook.controllers.pid_forms import PidStandard

GOLDEN = Path(__file__).parent / "golden"
SHARE = 20  # one loop in so many


@pytest.fixture(scope="module")
def compare():
    sys.path.insert(0, str(GOLDEN))
    try:
        spec = importlib.util.spec_from_file_location("compare", GOLDEN / "compare.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules["compare"] = module
        spec.loader.exec_module(module)
        yield module
    finally:
        sys.path.remove(str(GOLDEN))
        for name in ("compare", "loops"):
            sys.modules.pop(name, None)


@pytest.mark.long
def test_margins_peaks_responses_and_verdicts_are_those_of_python(compare, record_property):
    report = compare.survey(500, start=3, stride=SHARE + 1)  # one more: so that each kind comes
    record_property("table", report.table())
    assert compare.faults(report) == []
    counts = report.counts
    assert counts["loops"] >= 20 and counts["verdicts equal"] == counts["loops"]
    assert all(counts[kind] >= 3 for kind in compare.KINDS)


@pytest.mark.long
def test_the_500_are_of_every_kind(compare):
    """At least 100 each: unstable processes, integrating ones, dead times over three time constants."""
    all_of_them = list(compare.cases())
    poles = [case.process.poles for case in all_of_them]
    unstable = sum(bool((p.real > 0).any()) for p in poles)
    integrating = sum(bool((abs(p) == 0).any()) for p in poles)
    slow = [max((1 / abs(q.real) for q in p if q.real), default=0.0) for p in poles]
    long = sum(case.process.delay > 3 * T for case, T in zip(all_of_them, slow, strict=True))
    assert len(all_of_them) == 500 and min(unstable, integrating, long) >= 100


def test_a_wrong_core_is_found_out(compare):
    """The comparison sees a margin that is off by a billionth and a response that is off by a hundred-millionth."""
    report = compare.Report()
    report.differ("Ms", 1.5, 1.5 * (1 + 2e-9), "here")
    report.differ("y, load", 0.0, 2e-8, "there", 1.0)
    assert len(compare.faults(report)) == 2


AT_ONCE = {  # processes that act at once, with dead time: their curve goes around a circle for ever
    "nearly 1": (lb.tf([-1.046, -1.0239], [4.6827, 1], 0.0055), PidStandard(-0.0396, 2.7065, 0.3042, N=100)),
    "slow": (lb.tf([0.7397, 0.465], [4.633, 1], 3.6911), PidStandard(0.2305, 140.74, 3.2299, b=0, N=20)),
}
ASKED = """(num, den, delay) => {
    const begun = Date.now(), { Ms, Mt, gain } = page.margins(new page.LoopTransfer(num, den, delay));
    return { Ms: Ms.value, Mt: Mt.value, gain, took: Date.now() - begun };
}"""


@pytest.mark.parametrize("name", AT_ONCE)
def test_a_curve_that_goes_around_for_ever_is_not_followed_for_ever(ask, name):
    loop = lb.Loop(*AT_ONCE[name])
    ours, transfer = loop.margins(), loop.transfer
    found = ask(ASKED, [float(c) for c in transfer.num], [float(c) for c in transfer.den], transfer.delay)
    assert [found["Ms"], found["Mt"]] == pytest.approx([ours.Ms.value, ours.Mt.value], rel=1e-9)
    assert found["gain"] == pytest.approx(ours.gain, rel=1e-9)
    assert found["took"] < 1000  # ms; a hundred times that when each turn is looked at
