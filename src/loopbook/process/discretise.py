"""From continuous to sampled time, by the name of the method; what is an approximation knows its error.

The methods are

    zoh        u constant between the samples: exact for a held input, the dead time included, any fraction of h
    foh        u linear between the samples: exact for such an input, the dead time included
    tustin     s = (2/h) (z - 1)/(z + 1), or s = w/tan(wh/2) (z - 1)/(z + 1), which is exact at w = `prewarp`
    matched    each pole and zero to exp(s h); of the zeros at infinity all but one to z = -1; the static gain stays
    euler      s = (z - 1)/h            backward   s = (z - 1)/(z h)

with z = exp(s h).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from loopbook.numerics.real_numbers import positive, real
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.rows import ProcessError
from loopbook.process.sampled import SampledProcess, sample
from loopbook.process.thiran import thiran
from loopbook.process.transfer_function import Process

WHOLE = 1e-9


def c2d(
    process: Process, h: float, method: str = "zoh", *, prewarp: float | None = None, fraction: int | None = None
) -> SampledProcess | DiscreteProcess:
    """A process sampled every h seconds.

    method: zoh (a `SampledProcess`), foh, tustin, matched, euler, backward (a `DiscreteProcess`; its `error` compares
    with the continuous process at every frequency). prewarp [rad/s]: of tustin. fraction: the order of Thiran's
    approximation of a dead time that is no whole number of samples, for methods that do not sample it exactly.
    Raises ProcessError for an unknown method, and for a fraction of a sample without `fraction`.

    >>> lag = Process([1], [1, 1])
    >>> [round(c, 8) for c in c2d(lag, 0.1, "foh").num]
    [0.04837418, 0.0467884]
    >>> c2d(lag, 0.1, "tustin").static_gain
    1.0
    """
    h = positive(h, "h", ProcessError, " s")
    if method not in (*EXACT, *METHODS):
        raise ProcessError(f"method = {method!r}; one of {', '.join((*EXACT, *METHODS))}")
    if prewarp is not None and method != "tustin":
        raise ProcessError(f"prewarp is an option of tustin, not of {method}")
    if method == "zoh":
        return sample(process, h)
    if method == "foh":
        return _first_order_hold(process, h)
    options = {} if prewarp is None else {"prewarp": real(prewarp, "prewarp", ProcessError, " rad/s")}
    num, den = METHODS[method](process, h, **options)
    whole, rest = _dead_time(process, h)
    name = f"tustin, exact at {prewarp:g} rad/s" if prewarp is not None else method
    if rest:
        if fraction is None:
            raise ProcessError(
                f"the dead time {process.delay:g} s is {process.delay / h:.6g} samples, and {method} has no form for a "
                "fraction: give the order of a Thiran approximation as fraction, or take zoh or foh, which are exact"
            )
        late = thiran(process.delay, h, fraction)
        num, den, whole = np.convolve(num, late.num), np.convolve(den, late.den), 0
        name = f"{name}, {late.method} for the dead time"
    return DiscreteProcess((0.0,) * whole + tuple(num), tuple(den), h, name, process)


def _dead_time(process: Process, h: float) -> tuple[int, bool]:
    """Whole samples, and whether a fraction is left."""
    ratio = process.delay / h
    whole = round(ratio)
    return (whole, False) if abs(ratio - whole) <= WHOLE * max(ratio, 1) else (math.floor(ratio), True)


def _first_order_hold(process: Process, h: float) -> DiscreteProcess:
    """(z - 1)/h times the zero-order hold of G/s: a ramp between the samples is a held slope, integrated."""
    B, A = sample(Process(process.num, (*process.den, 0.0), process.delay), h).polynomials
    return DiscreteProcess(tuple(B[1:] / h), tuple(np.cumsum(A)[:-1]), h, "foh", process)  # A has the factor 1 - z^-1


def _substituted(process: Process, above: tuple[float, float], below: tuple[float, float]) -> tuple[Any, Any]:
    """num, den in z^-1 with s = (above_0 + above_1 z^-1)/(below_0 + below_1 z^-1)."""
    n = process.order

    def row(p: Any) -> np.ndarray:
        total = np.zeros(n + 1)
        for i, c in enumerate(p):
            power = len(p) - 1 - i
            factor = np.ones(1)
            for _ in range(power):
                factor = np.convolve(factor, above)
            for _ in range(n - power):
                factor = np.convolve(factor, below)
            total += c * factor
        return total

    return row(process.num), row(process.den)


def _tustin(process: Process, h: float, prewarp: float | None = None) -> tuple[Any, Any]:
    if prewarp is None:
        k = 2 / h
    elif 0 < prewarp < math.pi / h:
        k = prewarp / math.tan(prewarp * h / 2)
    else:
        raise ProcessError(f"prewarp = {prewarp:g} rad/s must lie between 0 and pi/h = {math.pi / h:.6g} rad/s")
    return _substituted(process, (k, -k), (1.0, 1.0))


def _euler(process: Process, h: float) -> tuple[Any, Any]:
    num, den = _substituted(process, (1 / h, -1 / h), (0.0, 1.0))
    return num, den


def _backward(process: Process, h: float) -> tuple[Any, Any]:
    return _substituted(process, (1 / h, -1 / h), (1.0, 0.0))


def _matched(process: Process, h: float) -> tuple[Any, Any]:
    poles, zeros = np.exp(process.poles * h), np.exp(process.zeros * h)
    more = max(process.relative_degree - 1, 0)
    num, den = (np.atleast_1d(np.real(np.poly(r))) for r in (np.append(zeros, -np.ones(more)), poles))
    delay = 1 if process.relative_degree else 0
    s = 0.0 if math.isfinite(process.static_gain) and process.static_gain else _beside(process)
    z = np.exp(-s * h)
    here = process.rational(s).real
    gain = here / (np.polyval(num[::-1], z) * z**delay / np.polyval(den[::-1], z))
    return np.concatenate([np.zeros(delay), gain * num]), den


def _beside(process: Process) -> float:
    """A real s > 0 [1/s] slower than every pole and zero that is not 0, where the gains are made equal instead."""
    sizes = [abs(r) for r in (*process.poles, *process.zeros) if abs(r) > 0]
    return 1e-3 * float(min(sizes, default=1.0))


EXACT = ("zoh", "foh")
METHODS: dict[str, Callable[..., tuple[Any, Any]]] = {
    "tustin": _tustin,
    "matched": _matched,
    "euler": _euler,
    "backward": _backward,
}
