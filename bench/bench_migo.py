"""The optimum on the whole batch, and the two-lag equations by bracketing beside 100,000 values of alpha."""

import time
from collections.abc import Callable

from loopbook.documents.pid_report.batch.processes import batch
from loopbook.experiments import combination
from loopbook.experiments.data import FrequencyData, StepData
from loopbook.tuning import migo

STEP, POINT = StepData(Kp=1, T=1.04, L=0.075), FrequencyData(K180=0.0091, T180=0.199)


def _fastest(work: Callable, times: int) -> tuple[float, object]:
    seconds, outcome = [], None
    for _ in range(times):
        start = time.perf_counter()
        outcome = work()
        seconds.append(time.perf_counter() - start)
    return min(seconds), outcome


def rows() -> list[tuple[str, float, str]]:
    """(what, seconds, remark); the fastest of a few."""
    members = batch()
    migo.pid(members[0].process)  # derivation and compilation of the branch, once a process
    pi, _ = _fastest(lambda: [migo.pi(m.process) for m in members], 3)
    pid, settings = _fastest(lambda: [migo.pid(m.process) for m in members], 2)
    stable = sum(s.stable for s in settings)
    bracket, found = _fastest(lambda: combination.solve(STEP, POINT, tail=0.37), 20)
    grid, walked = _fastest(lambda: combination.grid(STEP, POINT), 5)
    left = abs(combination.residual(found.T2 / found.T1, STEP, POINT, tail=0.37))
    off = abs(walked.alpha - found.T2 / found.T1)
    return [
        (f"PI MIGO, {len(members)} processes", pi, f"{pi / len(members) * 1e3:.1f} ms each"),
        (f"PID MIGO, {len(members)} processes", pid, f"{pid / len(members) * 1e3:.1f} ms each, {stable} loops stable"),
        ("T1, T2, L1 by bracketing", bracket, f"residual {left:.1e}"),
        (
            f"T1, T2, L1 by {walked.tried} values of alpha",
            grid,
            f"residual {walked.error:.1e}, alpha off by {off:.1e}, {grid / bracket:.0f} times as long",
        ),
    ]


if __name__ == "__main__":
    for what, seconds, remark in rows():
        print(f"{what:<45} {seconds:8.4f} s   {remark}")
