"""To python-control and back, wherever that is exact; a plain refusal elsewhere.

python-control holds no dead time inside a continuous system: one is refused, or approximated on request by Padé. A
sampled process is exact there, dead time included, as a delay of any length is a power of z^-1 and a zero. Of loops it
gets the closed loop's transfer function.
"""

from typing import Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.extras import needed
from loopbook.loop.sampled import SampledLoop
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.state_space_in import ss
from loopbook.process.transfer_function import DelayedSum, Process, ProcessError, simplest

FORMS = ("tf", "ss")


def to_control(
    system: Any, form: str = "tf", pade: int | None = None, *, source: str = "reference", output: str = "y"
) -> Any:
    """As a `control.TransferFunction` ("tf") or `control.StateSpace` ("ss").

    system: a transfer function; a sampled process or plant in z (dt = h); anything that regulates, as its feedback path
    -u/y; a loop of any kind, as the closed loop from source to output. pade: the order of the Padé approximation of
    continuous dead times; without it they are refused.
    Raises ProcessError for another form, for an improper system as "ss", and where python-control has none for it.

    >>> to_control(Process([2], [10, 1])).den[0][0].tolist()
    [10.0, 1.0]
    """
    if form not in FORMS:
        raise ProcessError(f"form = {form!r}; one of {', '.join(FORMS)}")
    control = needed("control", "control")
    if isinstance(system, SampledLoop):
        system = _closed_in_z(system, source, output)
    elif hasattr(system, "closed"):
        system = system.closed(source, output)
    if isinstance(system, TransferAlgebra):
        found = _continuous(control, system, pade)
    elif hasattr(system, "num") and hasattr(system, "h"):
        found = control.TransferFunction(*_aligned(system.num, system.den), system.h)
    elif hasattr(system, "R") and hasattr(system, "h"):
        found = control.TransferFunction(*_aligned(system.S, system.R), system.h)
    else:
        regulator = Regulator.of(system)
        found = control.TransferFunction(list(regulator.S), list(regulator.R))
    if form == "tf":
        return found
    if len(found.num[0][0]) > len(found.den[0][0]):
        raise ProcessError("it differentiates: a system with more zeros than poles has no state space; filter it")
    return control.tf2ss(found)


def _continuous(control: Any, system: TransferAlgebra, pade: int | None) -> Any:
    if isinstance(system, Process):
        return system.to_control(pade)
    if isinstance(system, DelayedSum):
        return sum((term.to_control(pade) for term in system.terms[1:]), system.terms[0].to_control(pade))
    num, den = system.fraction
    if num.delays == den.delays == (0.0,):
        return control.tf(*(list(f.terms[0][1]) for f in (num, den)))
    if pade is None:
        raise ProcessError(
            f"python-control cannot hold dead times inside a loop ({max((*num.delays, *den.delays)):g} s): ask for "
            "pade=order, or take the answers here, which are exact"
        )
    whole = [_without_delays(control, f, pade) for f in (num, den)]
    return control.minreal(whole[0] / whole[1], verbose=False)


def _without_delays(control: Any, f: ExponentialPolynomial, pade: int) -> Any:
    total = control.tf([0.0], [1.0])
    for delay, p in f.terms:
        if delay < 0:
            raise ProcessError(f"the output precedes the input by {-delay:g} s: no system does")
        turn = control.tf(*control.pade(delay, pade)) if delay else 1.0
        total = total + control.tf(list(p), [1.0]) * turn
    return total


def _closed_in_z(loop: SampledLoop, source: str, output: str) -> DiscreteProcess:
    n, d = loop.transfer
    below = np.zeros(max(len(n), len(d)))
    below[: len(n)] += n
    below[: len(d)] += d
    c, (B, A) = loop.regulator, loop.sampled.polynomials
    above = {
        ("reference", "y"): np.convolve(c.T, B),
        ("reference", "u"): np.convolve(c.T, A),
        ("load", "y"): np.convolve(c.R, B),
        ("load", "u"): -np.convolve(c.S, B),
        ("noise", "y"): -np.convolve(c.S, B),
        ("noise", "u"): -np.convolve(c.S, A),
    }.get((source, output))
    if above is None:
        raise ProcessError(f"from {source!r} to {output!r}: from reference, load, noise, to y or u")
    return DiscreteProcess(tuple(above), tuple(below), c.h)


def from_control(system: Any, delay: float = 0.0) -> Any:
    """From a `control.TransferFunction` or `control.StateSpace` with one input and one output.

    Continuous: a `Process` with the dead time delay [s], which the system itself cannot hold, or a `TransferFunction`
    where it has more zeros than poles. With a sampling interval: a `DiscreteProcess`.
    Raises ProcessError for several inputs or outputs, an unspecified sampling interval, and what is no linear system.

    >>> import control
    >>> from_control(control.ss([[-0.1]], [[1.0]], [[0.2]], [[0.0]]), delay=3).static_gain.__round__(12)
    2.0
    >>> from_control(control.tf([0.5], [1, -0.5], 0.1))
    DiscreteProcess(num=(0.0, 0.5), den=(1.0, -0.5), h=0.1)
    """
    control = needed("control", "control")
    if not isinstance(system, control.TransferFunction | control.StateSpace):
        raise ProcessError(
            f"from_control takes a TransferFunction or a StateSpace, got a {type(system).__name__}, which has no poles "
            "and zeros to be read"
        )
    if system.ninputs != 1 or system.noutputs != 1:
        many = f"{system.ninputs} and {system.noutputs}"
        raise ProcessError(f"from_control takes a system with one input and one output, not {many}")
    h = system.dt if system.dt else None
    if h is True:
        raise ProcessError("dt = True says that it is sampled, not how often: give it a sampling interval")
    if h is not None and delay:
        raise ProcessError("a dead time in the z domain is a power of z: multiply by it")
    if isinstance(system, control.StateSpace):
        A, B, C, D = (getattr(system, name) for name in "ABCD")
        return ss(A, B, C, D, delay, h=h)
    num, den = (list(map(float, rows[0][0])) for rows in (system.num, system.den))
    if h is not None:
        return DiscreteProcess.in_z(num, den, float(h))
    of = ExponentialPolynomial.of
    found = simplest(of(num, delay), of(den))
    return Process(num, den, delay) if isinstance(found, Process) and any(num) else found


def _aligned(num: Any, den: Any) -> tuple[list[float], list[float]]:
    """Rows in z^-1 as rows in z: of one length."""
    length = max(len(num), len(den))
    rows = [[float(c) for c in row] + [0.0] * (length - len(row)) for row in (num, den)]
    return rows[0], rows[1]
