"""PI and PID that give the loop the natural frequency w0 and the damping ratio zeta.

Formulas: `derivations.tuning.by_damping`; the loop's poles are these exactly, for a process of first order (PI) or of
second order (PID, with a third pole at -alpha w0) without zeros and without dead time.
"""

from functools import cache
from typing import Any

from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidStandard
from loopbook.lazy import late
from loopbook.numerics.real_numbers import positive
from loopbook.printed.store import kept_for, lambda_text, run_text
from loopbook.process.transfer_function import Process
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule

by_damping = late("derivations.tuning.by_damping")

SOURCE = "K. J. Åström and T. Hägglund, PID Controllers: Theory, Design, and Tuning (1995), section 4.4"
OPTIONS = {"w0": "the loop's natural frequency [rad/s]", "zeta": "its damping ratio"}
THIRD = {"alpha": "the third pole is at -alpha w0, default 1"}


@cache
def _formulas(order: int) -> Any:
    return run_text(_text(order), "math")


@kept_for((1,), (2,))
def _text(order: int) -> str:
    found = by_damping.pi() if order == 1 else by_damping.pid()
    letters = [by_damping.b, *(by_damping.a_2, by_damping.a_1, by_damping.a_0)[2 - order :]]
    letters += [by_damping.omega_0, by_damping.zeta, *([by_damping.alpha] if order == 2 else [])]
    return lambda_text(letters, list(found.values()), "math")


def gains(process: Process, w0: float, zeta: float, alpha: float = 1.0) -> tuple[float, float, float]:
    """P, I, D (0 for a process of first order) of P + I/s + D s, whatever their signs.

    w0 [rad/s], zeta, alpha > 0. Raises RuleDoesNotApply for a process with zeros, dead time or another order.

    >>> [round(gain, 12) for gain in gains(Process([1], [1, 1]), 2.0, 0.7)]
    [1.8, 4.0, 0.0]
    """
    w0, zeta, alpha = (positive(v, n, RuleDoesNotApply) for v, n in ((w0, "w0"), (zeta, "zeta"), (alpha, "alpha")))
    if process.delay:
        raise RuleDoesNotApply(
            f"the process has a dead time of {process.delay:.4g} s, and its loop infinitely many poles: ask for a "
            "phase margin instead",
            "use phase-margin-pi or phase-margin-pid",
        )
    if len(process.num) > 1 or process.order not in (1, 2):
        raise RuleDoesNotApply(
            f"a process of first or second order without zeros is expected; this one has order {process.order} and "
            f"{len(process.num) - 1} zeros",
            "use place",
        )
    if process.order == 1:
        P, I = _formulas(1)(process.num[0], *process.den, w0, zeta)
        return P, I, 0.0
    P, I, D = _formulas(2)(process.num[0], *process.den, w0, zeta, alpha)
    return P, I, D


def _settings(data: ProcessData, order: int, **options: float) -> Tuning:
    process = data.upright()
    if process.order != order and not process.delay:
        raise RuleDoesNotApply(
            f"the process has order {process.order}: {'PI' if order == 1 else 'PID'} places the poles of order {order}",
            f"use {'damping-pid' if order == 1 else 'damping-pi'}",
        )
    P, I, D = gains(process, **options)
    if not (P > 0 and I > 0 and D >= 0):
        raise RuleDoesNotApply(
            f"these poles need the gains P = {P:.5g}, I = {I:.5g}, D = {D:.5g}, not all of one sign: w0 is slower than "
            "the process itself, or zeta too small; ask for a faster loop"
        )
    return Tuning(PidStandard(P, P / I, D / P, c=1.0), f"damping-{'pi' if order == 1 else 'pid'}", SOURCE)


def computed() -> tuple[TuningRule, ...]:
    """The two rules of the family."""
    aim, required = "the loop's poles by frequency and damping", ("w0", "zeta")
    text = "the poles of the loop are those of s^2 + 2 zeta w0 s + w0^2"
    return (
        TuningRule(
            *("damping-pi", "poles by damping, PI", Takes.PROCESS, "PI", None, aim, 1995, SOURCE),
            lambda data, **options: _settings(data, 1, **options),
            OPTIONS,
            required,
            text=text,
        ),
        TuningRule(
            *("damping-pid", "poles by damping, PID", Takes.PROCESS, "PID", None, aim, 1995, SOURCE),
            lambda data, **options: _settings(data, 2, **options),
            OPTIONS | THIRD,
            required,
            text=f"{text}, and -alpha w0",
        ),
    )
