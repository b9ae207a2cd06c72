"""Manual tuning: what a change of one PID setting does to a loop, tested against the article's table of nine cells.

Each cell of that table (pid-article, section "Strojenie ręczne") says what increasing one of Kp, Ti, Td does to
stability, overshoot or settling time. "Stability" is measured by Ms, the peak of the sensitivity (its inverse is the
distance of the Nyquist curve from -1). "Little" is what the table itself sets it against: the settling time changes by
less, in relative terms, than the same increase of Ti changes it, the one cell of that column without the word.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from loopbook.controllers.pid_forms import LEFT_OUT, PidStandard
from loopbook.documents.open import printed
from loopbook.loop.continuous import Loop
from loopbook.loop.sensitivity_peaks import sensitivity_peak
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.transfer_function import Process
from loopbook.response.step_metrics import sampled_metrics
from loopbook.tuning.by_name import tune
from notebook_reports.ledger.printed_data import Claim

SETTINGS = ("K", "Ti", "Td")
SAME = 1e-6
POINTS, SETTLED = 4000, 0.005


@dataclass(frozen=True)
class Behaviour:
    """Ms [1], overshoot [%] and settling time [s] of the set-point response; all infinite for an unstable loop."""

    Ms: float
    overshoot: float
    settling: float


def peak_sensitivity(loop: Loop) -> float:
    """Ms of a stable loop, infinite for an unstable one."""
    return sensitivity_peak(loop.transfer).value if loop.is_stable else float("inf")


@cache
def behaviour(loop: Loop) -> Behaviour:
    """Ms from the exact frequency response; overshoot and settling time (2 %) of the exact step response.

    The response is taken at 4000 points over a horizon that is doubled until the second half stays within 0.5 % of the
    final value; convention `sampled` of step_metrics, but with the true final value and a band
    of 2 % of it.
    """
    if not loop.is_stable:
        return Behaviour(*[float("inf")] * 3)
    horizon = 10 * (loop.regulator.Ti + loop.process.delay)
    final = loop.final_values("reference")[0]
    while True:
        t = np.linspace(0.0, horizon, POINTS)
        y = loop.step("reference", horizon).y(t)
        if abs(y[POINTS // 2 :] - final).max() < SETTLED * abs(final):
            break
        horizon *= 2
    measured = sampled_metrics(y, t, final=final, band=0.02 * abs(final) / float(abs(y - final).max()))
    return Behaviour(peak_sensitivity(loop), measured.overshoot, measured.settling)


def _less(before: float, after: float, plain: float) -> bool:
    change, other = (abs(np.log(x / before)) for x in (after, plain))
    return bool(change < other)


MEASURES: dict[str, Callable[[Behaviour, Behaviour], float]] = {
    "stability": lambda a, b: 1 / b.Ms - 1 / a.Ms,
    "overshoot": lambda a, b: b.overshoot - a.overshoot,
    "settling": lambda a, b: b.settling - a.settling,
}
"""By quality: its change from before to after, above zero where there is more of it."""
CELLS: dict[tuple[str, str], str] = {
    (setting, quality): f"cell-{letter}-{quality}"
    for setting, letter in zip(SETTINGS, ("Kp", "Ti", "Td"), strict=True)
    for quality in MEASURES
}
"""By (setting, quality): the claim that holds what the article says, in its field `effect` and in its words."""


def said(cell: tuple[str, str]) -> Claim:
    """What the article says of a cell."""
    return printed("pid-article").claims[CELLS[cell]]


def holds(cell: tuple[str, str], before: Behaviour, after: Behaviour, plain: Behaviour) -> bool:
    """Does a cell hold for a change of its setting? plain: what the same change of Ti leads to.

    A loop that became unstable overshoots without end.
    """
    claim, quality = said(cell), cell[1]
    lost = float("inf") in (after.overshoot, after.settling) and quality != "stability"
    change = float("inf") if lost else MEASURES[quality](before, after)
    if quality == "overshoot" and abs(change) <= SAME:
        change = 0.0
    right = claim.agrees("effect", change) if "effect" in claim.fields else True
    if "size" not in claim.fields:
        return right
    little = _less(before.settling, after.settling, plain.settling)
    return right and little == claim.agrees("size", -1)


def changed(pid: PidStandard, setting: str, factor: float) -> PidStandard:
    """The regulator with one setting multiplied; the derivative filter keeps its time constant.

    Raises ValueError for another setting or a factor that is not positive.
    """
    if setting not in SETTINGS or not factor > 0:
        raise ValueError(
            f"setting = {setting!r}, factor = {factor}: one of {', '.join(SETTINGS)} and a positive factor"
        )
    return replace(pid, **{setting: factor * getattr(pid, setting)}, N=LEFT_OUT)


def cells(loop: Loop, factor: float) -> dict[tuple[str, str], bool]:
    """Which of the nine cells hold when each setting in turn is multiplied by `factor` > 1.

    loop: with a `PidStandard` that has integral action, and stable. Raises ValueError for an unstable loop, to which
    the table does not apply.
    """
    before = behaviour(loop)
    if before.Ms == float("inf"):
        raise ValueError("the table describes changes of a stable loop; this one is unstable")
    after = {s: behaviour(Loop(loop.process, changed(loop.regulator, s, factor))) for s in SETTINGS}
    return {cell: holds(cell, before, after[cell[0]], after["Ti"]) for cell in CELLS}


@dataclass(frozen=True)
class Example:
    """A stable loop to test rules of thumb on. kind: lags, dead time, zero on the right, oscillatory, integrating."""

    name: str
    kind: str
    loop: Loop


@dataclass(frozen=True)
class Survey:
    """The nine cells on every example, each setting in turn multiplied by `factor`."""

    factor: float
    examples: tuple[Example, ...]
    found: tuple[dict[tuple[str, str], bool], ...]

    def count(self, *chosen: tuple[str, str]) -> int:
        """In how many loops all the chosen cells hold; without any: all nine."""
        return sum(all(row[c] for c in chosen or CELLS) for row in self.found)

    def row(self, setting: str) -> int:
        """In how many loops the whole row of one setting holds."""
        return self.count(*(c for c in CELLS if c[0] == setting))

    def by_kind(self, cell: tuple[str, str]) -> dict[str, tuple[int, int]]:
        """Kind of process -> (loops in which the cell holds, loops)."""
        kinds = sorted({e.kind for e in self.examples})
        rows = {k: [r[cell] for e, r in zip(self.examples, self.found, strict=True) if e.kind == k] for k in kinds}
        return {kind: (sum(row), len(row)) for kind, row in rows.items()}


@cache
def survey(factor: float) -> Survey:
    """All nine cells on all `examples`, for one factor > 1."""
    return Survey(factor, examples(), tuple(cells(e.loop, factor) for e in examples()))


def recipe(process: Process, share: float, derivative: float) -> float:
    """Ms after the article's recipe: K = share Ku, Ti = Tu, Td = derivative Tu; infinite where the loop is unstable.

    Ku, Tu: ultimate gain and period of the process, which must have them. share, derivative >= 0: numbers.
    """
    point = ultimate(process)
    Td = derivative * point.T180
    return peak_sensitivity(Loop(process, PidStandard(share / point.K180, point.T180, Td, c=1.0, Tf=Td / 10)))


def _pid(K: float, Ti: float, Td: float) -> PidStandard:
    """On the error, the derivative filtered with Td/10."""
    return PidStandard(K, Ti, Td, c=1.0, N=10.0)


def _in_print(prefix: str) -> PidStandard:
    """The settings that the article prints under a name."""
    values = printed("pid-article").values
    return _pid(*(float(values[f"{prefix}-{name}"].fraction) for name in ("Kp", "Ti", "Td")))


def _ultimate(process: Process) -> PidStandard:
    tuning = tune(process, "zn-ultimate-pid-article")
    return _pid(tuning.K, tuning.Ti, tuning.Td)


@cache
def examples() -> tuple[Example, ...]:
    """The article's own loops and fourteen more that are tuned by its ultimate-gain table."""
    article = (
        ("2/((1+2s)(1+3s))", Process([2], [6, 5, 1]), _in_print("first")),
        ("3/(4s²+4s+1)", Process([3], [4, 4, 1]), _in_print("zs")),
        ("3/(2s³+5s²+2s+1)", Process([3], [2, 5, 2, 1]), _in_print("zu")),
        ("the same, tuned", Process([3], [2, 5, 2, 1]), _in_print("zu-tuned")),
        ("3/((1+2s)(1+3s))", Process([3], [6, 5, 1]), _in_print("c")),
    )
    triple = [1, 3, 3, 1]
    tuned = (
        ("1/(s+1)³", "lags", Process([1], triple)),
        ("1/(s+1)⁴", "lags", Process([1], [1, 4, 6, 4, 1])),
        ("1/(s+1)⁶", "lags", Process([1], [1, 6, 15, 20, 15, 6, 1])),
        ("1/((s+1)(0.2s+1)(0.04s+1))", "lags", Process([1], [0.008, 0.248, 1.24, 1])),
        ("exp(-s)/(1+s)", "dead time", Process.fopdt(1, 1, 1)),
        ("exp(-s)/(1+5s)", "dead time", Process.fopdt(1, 5, 1)),
        ("exp(-s)/(1+0.5s)²", "dead time", Process([1], [0.25, 1, 1], 1)),
        ("(1-0.5s)/(s+1)³", "zero on the right", Process([-0.5, 1], triple)),
        ("(1-s)/(s+1)³", "zero on the right", Process([-1, 1], triple)),
        ("1/((s+1)(s²+0.6s+1))", "oscillatory", Process([1], [1, 1.6, 1.6, 1])),
        ("1/((s+1)(s²+0.3s+1))", "oscillatory", Process([1], [1, 1.3, 1.3, 1])),
        ("exp(-0.3s)/(s²+s+1)", "oscillatory", Process([1], [1, 1, 1], 0.3)),
        ("exp(-s)/s", "integrating", Process.integrating(1, 1)),
        ("1/(s(s+1)²)", "integrating", Process([1], [1, 2, 1, 0])),
    )
    own = [Example(name, "lags", Loop(process, pid)) for name, process, pid in article]
    return (*own, *(Example(name, kind, Loop(process, _ultimate(process))) for name, kind, process in tuned))
