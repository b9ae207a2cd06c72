"""A PI controller for a wanted phase margin at a wanted crossover frequency, exact with dead time.

Formulas: `derivations.tuning.pi_by_margin`. A PI controller lags by 0 to 90 degrees: where the process and the margin
ask for anything else, one of its gains would be negative, and nothing is returned.
"""

import math
from functools import cache
from typing import Any

import numpy as np

from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidStandard
from loopbook.lazy import late
from loopbook.numerics.real_numbers import positive, real
from loopbook.printed.store import kept_for, lambda_text, run_text
from loopbook.process.transfer_function import Process
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule

pi_by_margin = late("derivations.tuning.pi_by_margin")

SOURCE = (
    "phase and magnitude at the crossover frequency; Åström and Hägglund, Advanced PID Control (2006), loop shaping"
)


@cache
def _formulas() -> Any:
    return run_text(_text(), "math")


@kept_for()
def _text() -> str:
    letters = [pi_by_margin.w, pi_by_margin.g, pi_by_margin.phase, pi_by_margin.margin]
    return lambda_text(letters, list(pi_by_margin.gains().values()), "math")


def gains(process: Process, w: float, phase_margin: float) -> tuple[float, float]:
    """P and I of the P + I/s with |L(jw)| = 1 and this phase margin [degrees] at w [rad/s], whatever their signs.

    >>> [round(gain, 7) for gain in gains(Process([1], [1, 4, 6, 4, 1]), 0.8, 60)]
    [2.2128613, -1.2230305]
    """
    w, margin = positive(w, "w", RuleDoesNotApply), real(phase_margin, "phase_margin", RuleDoesNotApply)
    value = complex(process(1j * w))
    if not value:
        raise RuleDoesNotApply(f"the process blocks the frequency {w:.6g} rad/s: no gain gives a crossover there")
    P, I = _formulas()(w, abs(value), float(np.angle(value)), math.radians(margin))
    return P, I


def _settings(data: ProcessData, w: float, phase_margin: float) -> Tuning:
    process = data.upright()
    P, I = gains(process, w, phase_margin)
    if not (P > 0 and I > 0):
        turned = math.degrees(math.atan2(-I / float(w), P))
        raise RuleDoesNotApply(
            f"a phase margin of {float(phase_margin):.6g} degrees at {float(w):.6g} rad/s asks for a controller that "
            f"turns the phase by {turned:.4g} degrees, P = {P:.5g}, I = {I:.5g}; a PI controller turns it by -90 to 0: "
            f"take {'a lower' if I < 0 < P else 'another'} frequency, or a PID controller",
            "use phase-margin-pid",
        )
    return Tuning(PidStandard(P, P / I), "phase-margin-pi", SOURCE)


def computed() -> tuple[TuningRule, ...]:
    """The rule of the family."""
    options = {"w": "the crossover frequency [rad/s]", "phase_margin": "there [degrees]"}
    aim = "a phase margin at a crossover frequency"
    return (
        TuningRule(
            *("phase-margin-pi", "phase margin, PI", Takes.PROCESS, "PI", None, aim, None, SOURCE),
            _settings,
            options,
            ("w", "phase_margin"),
            text="C(s) G(s) has magnitude 1 and the phase margin at i w, exact with dead time",
        ),
    )
