"""To python-control and back, where that is exact: it holds no dead time, so a continuous one is refused or asked for.

A sampled process is exact there, dead time included: a delay of any length is a power of z^-1 and a zero.
"""

from typing import Any

from loopbook.controllers.regulator import Regulator
from loopbook.extras import needed
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.sampled import SampledProcess
from loopbook.process.state_space_in import ss
from loopbook.process.transfer_function import Process, ProcessError

FORMS = ("tf", "ss")


def to_control(system: Any, form: str = "tf", pade: int | None = None) -> Any:
    """As a `control.TransferFunction` ("tf") or `control.StateSpace` ("ss").

    system: a `Process`, a `SampledProcess` (dt = h), or anything that regulates, as its feedback path -u/y: a PID form,
    a `Regulator`, an `Rst`. pade: the order of the Padé approximation of a continuous dead time; without it a process
    with dead time is refused.
    Raises ProcessError for another form, and where python-control has none for the system.

    >>> to_control(Process([2], [10, 1])).den[0][0].tolist()
    [10.0, 1.0]
    """
    if form not in FORMS:
        raise ProcessError(f"form = {form!r}; one of {', '.join(FORMS)}")
    control = needed("control", "control")
    if isinstance(system, Process):
        found = system.to_control(pade)
    elif isinstance(system, SampledProcess):
        found = control.TransferFunction(*_aligned(*system.polynomials), system.h)
    elif hasattr(system, "R") and hasattr(system, "h"):
        found = control.TransferFunction(*_aligned(system.S, system.R), system.h)
    else:
        regulator = Regulator.of(system)
        found = control.TransferFunction(list(regulator.S), list(regulator.R))
    return control.tf2ss(found) if form == "ss" else found


def from_control(system: Any, delay: float = 0.0) -> Process | DiscreteProcess:
    """From a continuous `control.TransferFunction` or `control.StateSpace` with one input and one output.

    delay [s]: the dead time, which the system itself cannot hold.

    >>> import control
    >>> from_control(control.ss([[-0.1]], [[1.0]], [[0.2]], [[0.0]]), delay=3).static_gain.__round__(12)
    2.0
    """
    control = needed("control", "control")
    if isinstance(system, control.StateSpace):
        if system.ninputs != 1 or system.noutputs != 1:
            raise ProcessError("from_control takes a system with one input and one output")
        if system.dt not in (0, None):
            raise ProcessError(f"from_control takes a continuous system, got one with dt = {system.dt}")
        A, B, C, D = (getattr(system, name) for name in "ABCD")
        return ss(A, B, C, D, delay)
    return Process.from_control(system, delay)


def _aligned(num: Any, den: Any) -> tuple[list[float], list[float]]:
    """Rows in z^-1 as rows in z: of one length."""
    length = max(len(num), len(den))
    rows = [[float(c) for c in row] + [0.0] * (length - len(row)) for row in (num, den)]
    return rows[0], rows[1]
