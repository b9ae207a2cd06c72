"""Simulated plants of every kind, identified: the stated intervals hold the truth in at least nine of ten.

    python tests/loopbook/identification/acceptance/prove_identification.py [seeds] [kind...]

A refusal and a wrong structure count as a miss of every parameter. The plants are made by `plants`, which shares no
code with the package.
"""

import sys
from collections import defaultdict
from dataclasses import dataclass
from multiprocessing import Pool

from plants import KINDS, Case, make

LEAST = 0.9
POINT = 0.05  # of K180 and T180 of a relay record


@dataclass
class Outcome:
    case: Case
    held: dict[str, bool]
    said: str


def judge(kind: str, seed: int) -> Outcome:
    """One case through the package."""
    from loopbook.identification.choice import identify
    from loopbook.identification.pooled import identify_together
    from loopbook.loop.ultimate_point import ultimate
    from loopbook.records.record import Record, RecordError

    case = make(kind, seed)
    records = [Record(r[0], r[1], r[2], setpoint=r[3] if len(r) > 3 else None) for r in case.records]
    missed = dict.fromkeys(case.truth, False)
    try:
        found = identify_together(records) if len(records) > 1 else identify(records[0])
    except RecordError as error:
        return Outcome(case, missed, f"refused: {error}")
    fit = found.chosen
    if not fit.structure.name.startswith(case.structure):
        return Outcome(case, missed, fit.structure.name)
    held = {p.name: p.interval[0] <= case.truth[p.name] <= p.interval[1] for p in fit.parameters}
    if case.point:
        point = ultimate(found.process)
        held["K180"] = abs(point.K180 / case.point[0] - 1) < POINT
        held["T180"] = abs(point.T180 / case.point[1] - 1) < POINT
    told = ", ".join(f"{p.name} {p.value:.4g} ± {p.half_width:.2g} ({case.truth[p.name]:.4g})" for p in fit.parameters)
    return Outcome(case, held, told)


def shares(outcomes: list[Outcome]) -> dict[str, float]:
    """By parameter, in how many of the cases the interval holds the truth."""
    names = dict.fromkeys(name for o in outcomes for name in o.held)
    return {name: sum(o.held.get(name, False) for o in outcomes) / len(outcomes) for name in names}


if __name__ == "__main__":
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    kinds = sys.argv[2:] or list(KINDS)
    with Pool(2) as pool:
        outcomes = pool.starmap(judge, [(kind, seed) for kind in kinds for seed in range(seeds)], chunksize=2)
    by_kind = defaultdict(list)
    for o in outcomes:
        by_kind[o.case.kind].append(o)
        if not all(o.held.values()):
            missed = [name for name, held in o.held.items() if not held]
            print(f"{o.case.kind} {o.case.seed}: {', '.join(missed)}: {o.said}")
    good = True
    for kind, found in by_kind.items():
        told = shares(found)
        good = good and min(told.values()) >= LEAST
        print(f"{kind:16} {len(found)} seeds: " + ", ".join(f"{name} {share:.0%}" for name, share in told.items()))
    sys.exit(0 if good else 1)
