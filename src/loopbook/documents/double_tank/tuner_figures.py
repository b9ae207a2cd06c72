"""The six figures that a PID tuning tool shows of a loop, computed exactly."""

import numpy as np

from loopbook.controllers.pid_forms import PidParallel, PidStandard
from loopbook.experiments.data import FrequencyData
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.tuning import tune
from notebook_reports.ledger.verdicts import last_place, rounds_to

NEARLY_IDEAL = 1e5
"""The pole [rad/s] of a derivative filter that stands for none."""
SHOWN = ("rise", "settling", "overshoot", "peak", "gain-margin", "phase-margin")


def displayed(loop: Loop) -> dict[str, float]:
    """rise [s], settling [s], overshoot [%], peak [y], gain-margin [dB], phase-margin [degrees] of a stable loop.

    The first four from the response to a unit step of the reference in continuous time, the band of the settling time
    2 %; the margins with the exact dead time.
    """
    step, margins = loop.step("reference").metrics(), loop.margins()
    found = (step.rise, step.settling, step.overshoot, step.peak, margins.gain_decibels, margins.phase)
    return dict(zip(SHOWN, found, strict=True))


def agreeing(found: dict[str, float], printed: dict[str, str]) -> int:
    """How many of the figures round to what is printed.

    >>> agreeing({"rise": 2.958, "peak": 1.44}, {"rise": "2.96", "peak": "1.4"})
    2
    """
    return sum(rounds_to(found[name], digits) for name, digits in printed.items())


def structures(as_read: PidStandard, exact: PidStandard, N: float, other: float) -> dict[str, PidParallel]:
    """What P + I/s + D N/(1 + N/s) may mean to a tool: the regulators that its figures may belong to, by description.

    as_read, exact: ideal settings from rounded and from exact data. N, other: two poles of the filter [rad/s].
    """
    zn, at_exact = as_read.parallel(), exact.parallel()
    return {
        f"on the error, pole $N = {N:g}$ rad/s": PidParallel(zn.P, zn.I, zn.D, N),
        "the same, exact $K_0$ and $T_0$": PidParallel(at_exact.P, at_exact.I, at_exact.D, N),
        "on the error, $N$ of Table 4": PidParallel(zn.P, zn.I, zn.D, other),
        "on the error, $N = 10^5$ (nearly ideal)": PidParallel(zn.P, zn.I, zn.D, NEARLY_IDEAL),
        f"on the error, $N = {N:g}$ as divisor of $T_d$": PidParallel(zn.P, zn.I, zn.D, N / as_read.Td),
        f"on the measurement, pole $N = {N:g}$ rad/s": PidParallel(zn.P, zn.I, zn.D, N, c=0.0),
        f"$P$ and $D$ on the measurement, $N = {N:g}$": PidParallel(zn.P, zn.I, zn.D, N, b=0.0, c=0.0),
    }


def reached(process: Process, gain: float, frequency: str, N: float, printed: dict[str, str]) -> dict[str, float]:
    """For each figure the nearest number to its print that readings lead to which round to the printed one.

    process: with dead time. gain: ultimate gain as printed [u/y]. frequency: digits of the ultimate frequency [rad/s];
    21 readings that round to them are tried, with the Ziegler-Nichols settings and the filter pole N [rad/s], and those
    are kept with which the other figures, settling time and overshoot left out, round to their prints.
    """
    free = ("settling", "overshoot")
    middle, half = float(frequency), float(last_place(frequency)) / 2
    kept = []
    for w in np.linspace(middle - half, middle + half, 21):
        form = tune(FrequencyData.from_ultimate(gain, 2 * np.pi / w), "zn-ultimate-pid").pid.parallel()
        found = displayed(Loop(process, PidParallel(form.P, form.I, form.D, N)))
        if all(rounds_to(found[name], digits) for name, digits in printed.items() if name not in free):
            kept.append(found)
    ends = {name: (min(f[name] for f in kept), max(f[name] for f in kept)) for name in printed}
    return {name: float(np.clip(float(printed[name]), *ends[name])) for name in free}
