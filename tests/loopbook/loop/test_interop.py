"""To python-control and back: round trips of everything that is exact, a sentence for everything that is not."""

import control
import numpy as np
import pytest

from loopbook.controllers.as_pid import as_pid
from loopbook.controllers.pid_forms import FormError, PidParallel, PidSeries, PidStandard
from loopbook.controllers.regulator import Regulator
from loopbook.controllers.rst import Rst
from loopbook.loop.cascade import CascadeLoop
from loopbook.loop.continuous import Loop
from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.interop import from_control, to_control
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.smith import SmithLoop
from loopbook.process.construct import tf
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process, ProcessError

S = np.array([0.3j, 0.1 + 1j, -0.4 + 0.2j])
Z = np.exp(0.7 * S)
PROCESS = Process([2, 1], [10, 7, 1])
RST = Rst((1, -1), (2.0, -1.7), (0.3,), 0.5)
PID = PidParallel(2.0, 1.0, 0.5, 10)


@pytest.mark.parametrize("form", ["tf", "ss"])
@pytest.mark.parametrize(
    "system",
    [
        PROCESS,
        Process([1], [1, 0]),
        sample(PROCESS, 0.5),
        sample(PROCESS.delayed(1.2), 0.5),
        tf([0.5, 0.1], [1, -0.5, 0.2], h=0.1),
    ],
)
def test_there_and_back(system, form):
    theirs = to_control(system, form)
    assert isinstance(theirs, control.TransferFunction if form == "tf" else control.StateSpace)
    back, at = from_control(theirs), S if isinstance(system, Process) else Z
    assert np.allclose(back(at), system(at), rtol=1e-10) and np.allclose(theirs(at), system(at), rtol=1e-10)
    if form == "tf" and isinstance(system, Process):
        assert back == system
    assert getattr(back, "h", None) == getattr(system, "h", None)


@pytest.mark.parametrize(("source", "output"), [(a, b) for a in ("reference", "load", "noise") for b in "yu"])
def test_closed_loops_of_every_kind(source, output):
    loops = {
        "continuous": (Loop(PROCESS, PID), S),
        "sampled": (SampledLoop(PROCESS.delayed(0.7), RST), Z),
        "in z": (DiscreteLoop(sample(PROCESS, 0.5), RST), Z),
        "predictor": (SmithLoop(PROCESS, PID, model=Process([1], [5, 1])), S),
    }
    for name, (loop, at) in loops.items():
        theirs = to_control(loop, source=source, output=output)
        if name == "sampled":
            run = loop.step(source, 30)
            expected = run.y if output == "y" else run.u
            assert np.allclose(control.step_response(theirs, np.arange(31) * 0.5).outputs, expected, atol=1e-10)
        else:
            assert np.allclose(theirs(at), loop.closed(source, output)(at), rtol=1e-10), name


def test_python_control_closes_the_same_loop():
    P, C = to_control(PROCESS), to_control(PID)
    assert np.allclose(control.feedback(P * C, 1)(S), to_control(Loop(PROCESS, PID))(S), rtol=1e-10)
    assert np.allclose(to_control(Loop(PROCESS, PID), "ss")(S), to_control(Loop(PROCESS, PID))(S), rtol=1e-9)


@pytest.mark.parametrize(
    "pid",
    [
        PidParallel(2.0, 1.0, 0.5, 10),
        PidParallel(0.0, 1.0),
        PidParallel(3.0),
        PidParallel(0.0, 0.0, 2.0, 5.0),
        PidParallel(1.5, 0.0, 2.0, 5.0),
        PidParallel(1.5, 0.2, 2.0),
        PidStandard(2.0, 4.0, 1.0, c=1.0, N=8),
        PidSeries(2.0, 4.0, 1.0, N=8),
    ],
)
def test_pid_controllers_there_and_back(pid):
    found, expected = as_pid(to_control(pid)), pid.parallel()
    for name in ("P", "I", "D"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-12, abs=1e-14)
    assert not expected.D or found.N == pytest.approx(expected.N, rel=1e-12)
    assert as_pid(Regulator.one_dof(*pid.transfer())) == found
    filtered = pid.parallel().N < float("inf") and pid.parallel().D
    if filtered or not pid.parallel().D:
        assert np.allclose(to_control(pid, "ss")(S), pid(S), rtol=1e-9)


def test_what_is_no_pid_is_said():
    for num, den, says in (
        ([1], [1, 3, 2], "poles at"),
        ([1], [1, -2], "poles at"),
        ([1, 2, 3, 4], [1, 0], "3 zeros and 1 poles"),
        ([1, 2, 3], [1, 2], "2 zeros and 1 poles"),
    ):
        with pytest.raises(FormError, match=says):
            as_pid(Regulator.one_dof(num, den))
    with pytest.raises(FormError, match="another way"):
        as_pid(PidStandard(2.0, 4.0, b=0.5).regulator())


def test_dead_times_are_refused_or_approximated_on_request():
    late = PROCESS.delayed(0.3)
    loop = Loop(late, PID)
    for system in (late, late + PROCESS, loop, late.feedback(), CascadeLoop(late, PROCESS, 1.0, 0.5)):
        with pytest.raises(ProcessError, match="cannot hold"):
            to_control(system)
        exact = system.closed() if hasattr(system, "closed") else system
        assert np.allclose(to_control(system, pade=6)(0.5j), exact(0.5j), rtol=1e-6)


def test_differentiators_are_transfer_functions_without_states():
    s = tf("s")
    assert np.allclose(to_control(2 * s + 1)(S), 2 * S + 1)
    assert from_control(control.tf([2, 1], [1])) == 2 * s + 1
    for system in (2 * s + 1, PidParallel(1.0, 1.0, 1.0)):
        with pytest.raises(ProcessError, match="it differentiates"):
            to_control(system, "ss")


def test_what_has_no_counterpart_is_said():
    two = control.ss(-np.eye(2), np.eye(2), np.eye(2), np.zeros((2, 2)))
    for system, says in (
        (two, "one input and one output, not 2 and 2"),
        (control.tf([1], [1, 0.5], True), "dt = True"),
        (control.frd([1, 0.5], [1.0, 2.0]), "FrequencyResponseData"),
        ("x", "got a str"),
    ):
        with pytest.raises(ProcessError, match=says):
            from_control(system)
    with pytest.raises(ProcessError, match="power of z"):
        from_control(control.tf([1], [1, 0.5], 0.1), delay=1)
    with pytest.raises(ProcessError, match="one of tf, ss"):
        to_control(PROCESS, "zpk")
    with pytest.raises(ProcessError, match="no regulator"):
        to_control("x")
    with pytest.raises(ProcessError, match="from reference"):
        to_control(SampledLoop(PROCESS, RST), source="x")
