"""Gain scheduling from records at several operating points: a PID for each, checked on every point and between them.

K, 1/Ti and Td between two points are interpolated along the measurement; the process between them has gains, lags and
dead time half-way in proportion
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design import candidates as rules
from loopbook.design import evaluation
from loopbook.design.beyond.offer import Offer, best_pid
from loopbook.design.evaluation import Evaluation
from loopbook.design.model import Model
from loopbook.loop.continuous import Loop
from loopbook.loop.sensitivity_peaks import sensitivity_peak

NAME = "gain scheduling"
BETWEEN = (0.25, 0.5, 0.75)


def schedule_offer(points: Sequence[tuple[float, Model]], Ms: float) -> Offer:
    """points: (measurement at rest, model) of each operating point, two at least.

    The one PID that is compared is the best of those designed for a point that keeps Ms at every point; the errors are
    those after a load step at the point where they differ most.
    """
    if len(points) < 2:
        return Offer(NAME, refused="records at two operating points at least are needed")
    ordered = sorted(points, key=lambda p: p[0])
    if len({len(m.lags) for _, m in ordered}) > 1 or not all(m.of_lags for _, m in ordered):
        return Offer(NAME, refused="the models of the operating points have different structures: fix one with --model")
    if len({m.sign for _, m in ordered}) > 1:
        return Offer(NAME, refused="the gain changes its sign between the operating points: no schedule crosses that")
    loops = [[evaluation.evaluate(m, c) for c in rules.candidates(m)[0]] for _, m in ordered]
    found = _by_one_rule(loops, Ms)
    if found is None:
        return Offer(NAME, refused=f"no rule keeps Ms = {Ms:g} at every operating point")
    own = [e.candidate.pid for e in found]
    worst, where = max(_between(ordered, own))
    if worst > 1.25 * Ms:
        return Offer(
            NAME, refused=f"between the operating points, at {where:.4g}, Ms would be {worst:.2f}; record there too"
        )
    one = _one_for_all([m for _, m in ordered], loops, Ms)
    numbers = [
        (f"{name} at {y:.6g}", value)
        for (y, _), pid in zip(ordered, own, strict=True)
        for name, value in (("K", pid.K), ("Ti", pid.Ti), ("Td", pid.Td))
    ]
    says = [
        f"{found[0].candidate.name} for each operating point; between them, {len(BETWEEN)} steps each, Ms is at most "
        f"{worst:.2f} (at {where:.4g})."
    ]
    if one is None:
        says.append(f"No single PID of the rules keeps Ms = {Ms:g} at every operating point.")
        return Offer(NAME, "a load step", 0.0, math.inf, tuple(numbers), tuple(says))
    triples = zip(one, found, ordered, strict=True)
    ratios = [(e1.iae_load / e2.iae_load, e2.iae_load, e1.iae_load, y) for e1, e2, (y, _) in triples]
    _, scheduled, single, y = max(ratios)
    says.append(f"The errors are those at {y:.6g}, where the single PID ({one[0].candidate.name}) does worst.")
    return Offer(NAME, f"a load step at {y:.6g}", scheduled, single, tuple(numbers), tuple(says))


def _by_one_rule(loops: Sequence[Sequence[Evaluation]], Ms: float) -> list[Evaluation] | None:
    """The loops of the rule that keeps Ms at every point and does best there altogether."""
    named = [{e.candidate.name: e for e in at_point if e.stable and e.Ms <= Ms} for at_point in loops]
    common = set(named[0]).intersection(*named[1:])
    best = [best_pid(list(one.values()), Ms) for one in named]
    if not common or any(e is None for e in best):
        return None
    cost = lambda name: sum(math.log(one[name].iae_load) for one in named)  # noqa: E731
    chosen = min(sorted(common), key=cost)
    return [one[chosen] for one in named]


def _one_for_all(models: Sequence[Model], loops: Sequence[Sequence[Evaluation]], Ms: float) -> list[Evaluation] | None:
    """The single PID, of those that a rule gives for one point, that keeps Ms everywhere and is best at its worst."""
    best: tuple[float, list[Evaluation]] | None = None
    for at_point in loops:
        for e in at_point:
            if not (e.stable and e.Ms <= Ms):
                continue
            if any(_peak(model, e.candidate.pid) > Ms for model in models):
                continue
            everywhere = [evaluation.evaluate(model, e.candidate) for model in models]
            cost = max(one.iae_load for one in everywhere)
            if best is None or cost < best[0]:
                best = cost, everywhere
    return best[1] if best else None


def _between(points: Sequence[tuple[float, Model]], own: Sequence[PidStandard]) -> list[tuple[float, float]]:
    """(Ms, where) of the interpolated regulator on the process half-way, between every two neighbours."""
    found = []
    for (y1, m1), (y2, m2), a, b in zip(points, points[1:], own, own[1:], strict=False):
        for share in BETWEEN:
            model, pid = model_between(m1, m2, share), pid_between(a, b, share)
            found.append((_peak(model, pid), y1 + share * (y2 - y1)))
    return found


def _peak(model: Model, pid: PidStandard) -> float:
    """Ms, infinite for an unstable loop."""
    loop = Loop(model.process, pid)
    return float(sensitivity_peak(loop.transfer).value) if loop.is_stable else math.inf


def model_between(a: Model, b: Model, share: float) -> Model:
    """The process between two: gain, lags and dead time in proportion (a dead time of zero linearly)."""
    mix = lambda x, y: x ** (1 - share) * y**share if x > 0 and y > 0 else (1 - share) * x + share * y  # noqa: E731
    gain = a.sign * mix(abs(a.gain), abs(b.gain))
    return replace(a, gain=gain, lags=tuple(map(mix, a.lags, b.lags)), delay=mix(a.delay, b.delay), covariance=None)


def pid_between(a: PidStandard, b: PidStandard, share: float) -> PidStandard:
    """What a schedule enters between two points: K, 1/Ti and Td interpolated."""
    line = lambda x, y: (1 - share) * x + share * y  # noqa: E731
    Td = line(a.Td, b.Td)
    return PidStandard(line(a.K, b.K), 1 / line(1 / a.Ti, 1 / b.Ti), Td, b=line(a.b, b.b), c=0.0, Tf=line(a.Tf, b.Tf))
