"""The table of manual tuning on single loops, and the saturated P loop against the relay."""

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.documents.pid_article import manual_tuning as manual
from loopbook.documents.pid_article.manual_tuning import Behaviour
from loopbook.documents.pid_article.saturated_gain import NoLimitCycle, limit_cycle
from loopbook.loop.continuous import Loop
from loopbook.loop.without_dead_time import metrics, reference_to_output
from loopbook.process.transfer_function import Process, ProcessError

THIRD = Process([3], [2, 5, 2, 1])


def test_there_are_at_least_twelve_stable_loops_of_five_kinds():
    examples = manual.examples()
    assert len(examples) == 19
    assert {e.kind for e in examples} == {"lags", "dead time", "zero on the right", "oscillatory", "integrating"}
    assert all(e.loop.is_stable for e in examples)
    assert len({e.name for e in examples}) == 19


def test_on_a_dead_time_loop_more_gain_slows_settling_and_more_derivative_destabilises():
    (loop,) = [e.loop for e in manual.examples() if e.name == "exp(-s)/(1+s)"]
    found = manual.cells(loop, 2.0)
    assert found["K", "stability"] and found["K", "overshoot"] and not found["K", "settling"]
    assert not found["Td", "stability"] and found["Ti", "overshoot"]


def test_cells_are_judged_by_their_definitions():
    before, after = Behaviour(2.0, 20.0, 10.0), Behaviour(1.8, 10.0, 9.5)
    plain = Behaviour(1.9, 15.0, 9.0)
    judged = {cell: manual.holds(cell, before, after, plain) for cell in manual.CELLS}
    false = {("K", "stability"), ("K", "overshoot")}
    assert {cell for cell, holds in judged.items() if not holds} == false
    assert not manual.holds(("Td", "settling"), before, Behaviour(2, 20, 8.0), plain), "more than the plain change"


def test_behaviour_is_that_of_the_exact_metrics():
    loop = Loop(THIRD, PidStandard(0.8, 3.15, 0.76, c=1.0, N=10))
    found, exact = manual.behaviour(loop), loop.step().metrics()
    assert found.overshoot == pytest.approx(exact.overshoot, abs=0.01)
    assert found.settling == pytest.approx(exact.settling, rel=1e-4)
    assert found.Ms == pytest.approx(loop.margins().Ms.value, rel=1e-12)


def test_an_unstable_change_is_worse_and_not_little():
    gone = Behaviour(*[float("inf")] * 3)
    before, plain = Behaviour(2, 20, 10), Behaviour(2, 20, 5)
    assert manual.holds(("K", "stability"), before, gone, plain)
    assert not manual.holds(("K", "settling"), before, gone, plain)
    assert manual.behaviour(Loop(THIRD, 2.0)) == gone
    with pytest.raises(ValueError, match="this one is unstable"):
        manual.cells(Loop(THIRD, PidStandard(2.0)), 1.1)


@pytest.mark.long
def test_survey_counts_cells_rows_and_kinds():
    found = manual.survey(2.0)
    assert found.count(("Ti", "overshoot")) == len(found.examples) == 19
    assert found.count() <= found.row("Td") <= found.count(("Td", "stability"))
    kinds = found.by_kind(("Td", "stability"))
    assert kinds["dead time"] == (0, 3) and sum(n for _, n in kinds.values()) == 19


def test_recipe_needs_its_derivative_and_is_lost_on_dead_time():
    assert manual.recipe(THIRD, 1.0, 0.0) == float("inf")
    assert manual.recipe(THIRD, 1.0, 0.2) < 2
    assert manual.recipe(Process.fopdt(1, 1, 1), 1.0, 0.2) == float("inf")


def test_change_multiplies_one_setting_and_keeps_the_filter():
    pid = PidStandard(1.0, 2.0, 0.5, c=1.0, N=10)
    other = manual.changed(pid, "Td", 2.0)
    assert (other.Td, other.Tf, other.K, other.Ti) == (1.0, pid.Tf, 1.0, 2.0)
    with pytest.raises(ValueError, match="one of K, Ti, Td"):
        manual.changed(pid, "N", 2.0)


def test_minimal_closed_loop_agrees_with_the_loop_where_both_exist():
    pid = PidStandard(2.0, 5.4, 0.4, c=1.0, Tf=0.05)
    closed, loop = reference_to_output(Process([2], [6, 5, 1]), pid), Loop(Process([2], [6, 5, 1]), pid)
    t = np.linspace(0, 20, 101)
    assert closed.step(t) == pytest.approx(loop.step("reference").y(t), abs=1e-11)
    assert metrics(closed).overshoot == pytest.approx(loop.step().metrics().overshoot, abs=1e-7)


def test_minimal_closed_loop_refuses_dead_time_and_instability():
    with pytest.raises(ProcessError, match=r"use loopbook\.loop\.continuous\.Loop"):
        reference_to_output(Process([1], [1, 1], 1), 1.0)
    with pytest.raises(ProcessError, match="does not settle"):
        metrics(reference_to_output(THIRD, 2.0))


def test_high_saturated_gain_oscillates_like_a_relay():
    from loopbook.experiments import relay
    from loopbook.experiments.plant import Plant

    cycle = limit_cycle(THIRD, 1000, 1.0, 2 * np.pi)
    data = relay.estimate(relay.apply_relay(Plant(THIRD))).data
    assert cycle.at_limit > 0.99
    # the sampled loop switches up to one interval, a 400th of the period, late
    assert cycle.period == pytest.approx(data.T180, rel=0.01)
    assert cycle.ultimate_gain(1.0) == pytest.approx(1 / data.K180, rel=0.02)


def test_below_the_ultimate_gain_there_is_no_limit_cycle():
    with pytest.raises(NoLimitCycle, match="dies out"):
        limit_cycle(THIRD, 1.2, 1.0, 2 * np.pi)
