"""Design for many synthetic records and run each recommended loop on its true process, with noise and limits.

    python tests/loopbook/design/acceptance/prove_design.py 300 [first seed] [workers]

A record is designed or refused; a designed loop holds if it is stable and overshoots within 5 points of what was said.
"""

import os
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")
sys.path.insert(0, str(Path(__file__).parent))

import numpy as np  # noqa: E402
from processes import closed  # noqa: E402
from synthetic import Made, make  # noqa: E402

POINTS = 5.0  # how far the overshoot may be from what was stated [%]
ABSURD = 100.0  # loop gain at rest, or its like for an integrator, that no record supports


@dataclass
class Result:
    """What came of a record. verdict: held, overshoot, unstable, absurd, refused or error."""

    made: Made
    verdict: str
    stated: float = np.nan
    seen: float = np.nan
    why: str = ""

    def __str__(self) -> str:
        return f"{self.verdict:10} stated {self.stated:.1f} % seen {self.seen:.1f} % | {self.made} | {self.why}"


def judge(made: Made) -> Result:
    """One record through the design and onto its true process."""
    from loopbook.design.model import ModelError
    from loopbook.design.recommendation import AimError
    from loopbook.design.study import Study
    from loopbook.records.record import RecordError

    try:
        found = Study(made.file, **made.told).results()
    except (RecordError, ModelError, AimError) as error:
        return Result(made, "refused", why=str(error))
    p, e = made.process, found["expected"]
    model = found["process"]
    why = f"{found['rule']}: {model['gain']:.3g} {model['time_constants']} {model['delay']:.3g}"
    gain = abs(found["settings"]["K"] * p.gain)
    gain *= (sum(p.lags) + p.delay + found["settings"]["h"]) if p.integrating else 1.0
    if not np.isfinite(gain) or gain > ABSURD:
        return Result(made, "absurd", why=f"loop gain {gain:.3g}, {why}")
    reference, stated = e["reference_step"], e["overshoot"]
    horizon = 3 * (e["settling"] or 40 * (p.slowest + p.delay)) + 6 * (p.slowest + p.delay)
    at = made.y_rest
    _time, y, _u = closed(p, found, at, made.noise, made.quantum, horizon, made.seed)
    goal = found["operating_point"]["y0"] - at + reference
    later = y[2 * len(y) // 3 :]
    off = abs(float(later.mean()) - goal) / abs(reference)
    swing = float(np.ptp(later)) / abs(reference)
    allowed = 0.1 + 20 * made.noise / abs(reference)
    if not np.isfinite(y).all() or off > 0.1 + 2 * made.noise / abs(reference) or swing > allowed:
        return Result(made, "unstable", stated, np.nan, f"off {off:.2f}, swing {swing:.2f}, {why}")
    # what the noise alone moves: less than its own size in a loop that is well damped, whatever this one does
    steady = min(float(later.std()), made.noise) / abs(reference) * 100
    rising = (y / goal if goal else y)[: 2 * len(y) // 3]
    seen = max(float(rising.max()) - 1, 0.0) * 100
    within = abs(seen - stated) <= POINTS or (seen > stated and seen - stated <= POINTS + 2 * steady)
    return Result(made, "held" if within else "overshoot", stated, seen, why)


def prove(seeds, folder: Path) -> list[Result]:
    return [_one(seed, folder) for seed in seeds]


def _one(seed: int, folder: Path) -> Result:
    made = make(seed, folder)
    try:
        return judge(made)
    except Exception as error:
        import traceback

        last = traceback.extract_tb(error.__traceback__)[-1]
        return Result(made, "error", why=f"{type(error).__name__}: {error} ({Path(last.filename).name}:{last.lineno})")


def summary(results: list[Result]) -> str:
    counts = Counter(r.verdict for r in results)
    designed = [r for r in results if r.verdict in ("held", "overshoot", "unstable", "absurd")]
    good = [r for r in results if r.made.good]
    made = sum(r.verdict in ("held", "overshoot", "unstable") for r in good)
    held = 100 * counts["held"] / max(len(designed), 1)
    return (
        f"{len(results)} records: {dict(sorted(counts.items()))}; {held:.1f} % of the designed loops hold; "
        f"{made} of {len(good)} good records designed ({100 * made / max(len(good), 1):.1f} %)"
    )


if __name__ == "__main__":
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    workers = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    with tempfile.TemporaryDirectory() as temporary:
        from multiprocessing import Pool

        with Pool(workers) as pool:
            jobs = [(seed, Path(temporary)) for seed in range(first, first + number)]
            results = pool.starmap(_one, jobs, chunksize=2)
    for r in results:
        if r.verdict != "held" and (r.verdict != "refused" or r.made.good):
            print(r)
    print(summary(results))
    held = [r for r in results if r.verdict == "held"]
    designed = [r for r in results if r.verdict not in ("refused",)]
    good = [r for r in results if r.made.good]
    done = [r for r in good if r.verdict in ("held", "overshoot", "unstable")]
    bad = any(r.verdict in ("absurd", "error") for r in results)
    sys.exit(0 if not bad and len(held) >= 0.95 * len(designed) and len(done) >= 0.9 * len(good) else 1)
