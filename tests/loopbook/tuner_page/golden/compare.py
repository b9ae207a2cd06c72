"""The page's core, in V8, against Python: margins, Ms, responses and verdicts of golden loops.

python tests/loopbook/tuner_page/golden/compare.py [how many]      (make prove-tuner: all 500)
"""

import json
import math
import sys
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from loops import COUNT, KINDS, Case, cases
from py_mini_racer import MiniRacer

from loopbook.loop.continuous import Loop
from loopbook.loop.stability import BorderError
from loopbook.loop.transfer import LoopError
from loopbook.numerics.signals import HorizonError
from loopbook.response.closed_loop import ResponseError
from loopbook.response.step_metrics import StepMetricsError
from loopbook.tuner_page.bundle import bundle

__all__ = ["COUNT", "KINDS", "Report", "cases", "faults", "survey"]
TIMES = 200
BESIDE = 1e-3
PATIENCE = 60_000

SCRIPT = """
const plain = (value) => JSON.stringify(value, (_, x) => (x === Infinity ? "inf" : x === -Infinity ? "-inf" : x));
function answer(process, pid, horizon, times, final) {
    const { core } = golden, found = {}, loop = core.loopTransfer(process, pid);
    const tried = (name, compute) => {
        try { found[name] = compute(); } catch (error) { found[name] = String(error); }
    };
    tried("unstable", () => core.unstableRoots(loop));
    tried("stable", () => core.isStable(loop));
    tried("margins", () => core.margins(loop));
    tried("decay", () => core.decayRate(loop));
    tried("responses", () => {
        const { reference, load } = core.stepResponses(process, pid, horizon);
        const signals = [reference.y, reference.u, load.y, load.u];
        found.variation = core.inputMeasures(reference.u).variation;
        if (final) {
            found.step = core.stepMeasures(reference.y, final);
            found.iae = core.absoluteError(load.y, 0, core.finalValues(process, pid).load.y);
        }
        return signals.map((signal) => Array.from(signal.at(times)));
    });
    return plain(found);
}
const verdict = (process, pid) => golden.core.isStable(golden.core.loopTransfer(process, pid));
"""


def engine() -> MiniRacer:
    """V8 with the page's core."""
    machine = MiniRacer()
    machine.eval(bundle("core/index.js", returned="golden") + SCRIPT, timeout=PATIENCE)
    return machine


def given(case: Case, factor: float = 1.0) -> str:
    """process and regulator as the core takes them; factor: of the process's gain."""
    p, c = case.process, case.pid.parallel()
    process = {"num": [factor * x for x in p.num], "den": p.den, "delay": p.delay}
    pid = {"P": c.P, "I": c.I, "D": c.D, "Tf": c.Tf if c.D else 0.0, "b": c.b, "c": c.c}
    return f"{json.dumps(process)}, {json.dumps(pid)}"


def _number(value: Any) -> Any:
    return float(value) if value in ("inf", "-inf") else value


@dataclass
class Report:
    """The largest differences, where they were, and what went wrong."""

    largest: dict[str, tuple[float, str]] = field(default_factory=dict)
    wrong: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)

    def differ(self, what: str, ours: float, theirs: float, where: str, size: float | None = None) -> None:
        if ours == theirs:
            difference = 0.0
        elif not (math.isfinite(ours) and math.isfinite(theirs)):
            difference = math.inf
        else:
            difference = abs(ours - theirs) / ((abs(ours) if size is None else size) or 1.0)
        if not difference <= self.largest.get(what, (-1.0, ""))[0]:
            self.largest[what] = difference, where

    def count(self, what: str, yes: bool = True) -> None:
        self.counts[what] = self.counts.get(what, 0) + bool(yes)

    def table(self) -> str:
        lines = [f"{what:34}{difference:10.1e}   {where}" for what, (difference, where) in self.largest.items()]
        lines += [f"{what:34}{count:10d}" for what, count in self.counts.items()]
        return "\n".join([*lines, *(f"WRONG {text}" for text in self.wrong)])


def horizon_of(case: Case, stable: bool) -> float:
    """A time [s] in which the loop settles; for an unstable one, or a very slow one, some of its own times."""
    time = case.process.delay + sum(1 / abs(p.real) for p in case.process.poles if p.real) or 1.0
    if not stable:
        return float(4 * time)
    return float(min(case.loop.settling_horizon(), 60 * time + 40 * case.process.delay))


def compare(case: Case, name: str, machine: MiniRacer, report: Report) -> None:
    """One loop in Python and in V8."""
    loop = case.loop
    try:
        stable = loop.is_stable
        unstable: float | None = loop.unstable_roots
    except BorderError:
        unstable = None
    except LoopError as error:
        report.wrong.append(f"{name}: {error}")
        return
    horizon = horizon_of(case, stable)
    times = np.linspace(0.0, horizon, TIMES, endpoint=False)
    final = loop.final_values("reference")[0] if stable else 0.0
    call = f"answer({given(case)}, {horizon!r}, {json.dumps(times.tolist())}, {final!r})"
    found = json.loads(machine.eval(call, timeout=PATIENCE))
    report.count("loops")
    report.count(case.kind)
    slowest = max((1 / abs(p.real) for p in case.process.poles if p.real), default=0.0)
    report.count("dead time over 3 T", case.process.delay > 3 * slowest)
    report.count("unstable loops", not stable)
    report.count("verdicts equal", found["stable"] is stable)
    if found["stable"] is not stable or (unstable is not None and _number(found["unstable"]) != unstable):
        report.wrong.append(f"{name}: Python counts {unstable}, the page {found['unstable']}")
    if stable:
        _margins(loop, found, name, report)
        _borders(case, name, machine, report)
    _responses(loop, found, horizon, times, name, report)


def _margins(loop: Loop, found: dict[str, Any], name: str, report: Report) -> None:
    theirs = found["margins"]
    try:
        ours = loop.margins()
    except LoopError as error:
        report.count("margins refused by both")
        if not isinstance(theirs, str):
            report.wrong.append(f"{name}: Python says {error}, the page has margins")
        return
    if isinstance(theirs, str):
        report.wrong.append(f"{name}: margins: {theirs}")
        return
    pairs = {"gain": "gain", "gain_low": "gainLow", "phase": "phase", "delay": "delay"}
    for here, there in pairs.items():
        report.differ(f"margin, {here}", getattr(ours, here), _number(theirs[there]), name)
    report.differ("Ms", ours.Ms.value, theirs["Ms"]["value"], name)
    report.differ("Mt", ours.Mt.value, theirs["Mt"]["value"], name)
    report.differ("decay rate", loop.decay_rate, found["decay"], name)
    if ours.gain_low > 0:
        report.count("conditionally stable")


def _borders(case: Case, name: str, machine: MiniRacer, report: Report) -> None:
    """A thousandth on either side of each gain at which the loop loses its stability."""
    try:
        margins = case.loop.margins()
    except LoopError:
        return
    for border in (margins.gain, margins.gain_low):
        if not (0 < border < math.inf):
            continue
        for factor in (border * (1 - BESIDE), border * (1 + BESIDE)):
            ours = Loop(case.process * factor, case.pid).is_stable
            theirs = machine.eval(f"verdict({given(case, factor)})", timeout=PATIENCE)
            report.count("verdicts beside the border")
            if ours is not theirs:
                report.wrong.append(f"{name}: at {factor!r} times the gain Python says {ours}, the page {theirs}")


def _responses(loop: Loop, found: dict[str, Any], horizon: float, times: np.ndarray, name: str, report: Report) -> None:
    try:
        reference, load = loop.step("reference", horizon), loop.step("load", horizon)
    except ResponseError as error:
        if not isinstance(found["responses"], str):
            report.wrong.append(f"{name}: Python says {error}, the page shows a response")
        report.count("responses refused by both")
        return
    if isinstance(found["responses"], str):
        report.wrong.append(f"{name}: {found['responses']}")
        return
    ours = [reference.y(times), reference.u(times), load.y(times), load.u(times)]
    for what, a, b in zip(
        ("y, set-point", "u, set-point", "y, load", "u, load"), ours, found["responses"], strict=True
    ):
        size = float(np.abs(a).max())
        report.differ(what, 0.0, float(np.abs(a - np.array(b)).max()), name, size)
    if found.get("step"):
        metrics = reference.metrics()
        report.differ("settling time", metrics.settling, found["step"]["settling"], name)
        report.differ("rise time", metrics.rise, found["step"]["rise"], name)
        report.differ("overshoot, parts", metrics.overshoot, found["step"]["overshoot"], name, 100.0)
    elif loop.is_stable and loop.final_values("reference")[0]:
        with suppress(StepMetricsError):
            reference.metrics()
            report.wrong.append(f"{name}: Python has step metrics, the page none")
    if found.get("iae") is not None:
        report.differ("IAE, load", loop.step("load").iae(), found["iae"], name)
    elif loop.is_stable:
        with suppress(LoopError, HorizonError):
            load.iae()
            report.wrong.append(f"{name}: Python has an IAE, the page none")


def survey(count: int = COUNT, start: int = 0, stride: int = 1) -> Report:
    """All cases of a share, compared."""
    machine, report = engine(), Report()
    for i, case in enumerate(cases(count, start, stride)):
        compare(case, f"loop {start + i * stride} ({case.kind})", machine, report)
    return report


LIMITS = {
    **dict.fromkeys(("margin, gain", "margin, gain_low", "margin, phase", "margin, delay", "Ms", "Mt"), 1e-9),
    **dict.fromkeys(("y, set-point", "u, set-point", "y, load", "u, load"), 1e-8),
    **dict.fromkeys(("settling time", "rise time", "overshoot, parts", "IAE, load"), 1e-6),
    "decay rate": 1e-5,
}


def faults(report: Report) -> list[str]:
    """What is not as it has to be."""
    over = [f"{what}: {d:.1e} in {where}" for what, (d, where) in report.largest.items() if not d <= LIMITS[what]]
    return [*report.wrong, *over]


if __name__ == "__main__":
    result = survey(int(sys.argv[1]) if len(sys.argv) > 1 else COUNT)
    print(result.table())
    sys.exit(1 if faults(result) else 0)
