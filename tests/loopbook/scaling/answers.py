"""What is asked of a case, without units: each answer divided by what it is measured in.

An answer is (name, values, size). Two agree where each value is the same to a relative 1e-9 of itself, or of `size`:
the step or the peak beside which it is small. A refusal is an answer too: the class of its error.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from cases import Case, Units

from loopbook.loop.step_info import step_info
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.sampled import sample
from loopbook.tuning import by_angles
from loopbook.tuning.by_name import tune

RELATIVE = 1e-9
Answer = tuple[str, list[float] | str, float]


def asked(question: Callable[[], Any]) -> Any:
    """The answer, or which refusal."""
    try:
        return question()
    except ValueError as error:
        return type(error).__name__


def of_loop(case: Case, units: Units) -> Iterator[Answer]:
    """Stability; of a stable loop margins, peaks, responses with their metrics and integrals."""
    k, gain, loop = units.k, units.y / units.u, case.loop(units)
    unstable = asked(lambda: [loop.unstable_roots])
    yield "unstable roots", unstable, 0
    if unstable != [0]:
        return
    margins = loop.margins()
    yield "margins", [margins.gain, margins.gain_low, margins.phase, margins.delay / k], 0
    yield "peaks", [margins.Ms.value, margins.Mt.value, margins.Ms.w * k], 0
    yield "crossovers", [c.w * k for c in margins.gain_crossovers], 0
    yield "decay", asked(lambda: [loop.decay_rate * k]), 0
    reference, load = asked(loop.step), asked(lambda: loop.step("load"))
    if isinstance(reference, str) or isinstance(load, str):
        yield "refused step", reference if isinstance(reference, str) else "", 0
        yield "refused load", load if isinstance(load, str) else "", 0
        return
    metrics = asked(reference.metrics)
    if isinstance(metrics, str):
        yield "metrics", metrics, 0
    else:
        yield "metrics", [metrics.rise / k, metrics.settling / k, metrics.peak], 0
        yield "swings", [metrics.overshoot, metrics.undershoot], 100  # in per cent of the step
        yield "peak time", [metrics.peak_time / k if metrics.overshoot > 0.01 else 0.0], 0
    yield "input", [reference.peak_input()[1] * gain], 0
    yield "integrals", asked(lambda: [reference.iae() / k, reference.ise() / k]), 0
    peak, (y, u) = load.y.peak()[1] / gain, loop.final_values("load")
    yield "load", [peak], 0
    yield "load's integral", asked(lambda: [load.iae() / k / gain]), 0
    yield "final output", [y / gain], abs(peak)
    yield "final input", [u], 1


def of_process(case: Case, units: Units) -> Iterator[Answer]:
    """Responses without a loop, the ultimate point, the sampled model."""
    k, gain, process = units.k, units.y / units.u, case.process(units)
    t = np.linspace(0.1, 8, 5) * k * (1 + case.delay)
    y = process.step(t) / gain
    yield "step", y.tolist(), float(abs(y).max())
    yield "metrics", asked(lambda: [step_info(process).settling / k, step_info(process).rise / k]), 0
    yield "ultimate", asked(lambda: [ultimate(process).K180 / gain, ultimate(process).T180 / k]), 0
    B, A = sample(process, case.h * k).polynomials
    yield "sampled", [*(B / gain).tolist(), *A.tolist()], 0


def of_sampled_loop(case: Case, units: Units) -> Iterator[Answer]:
    """Stability and margins under a sampled regulator."""
    k, loop = units.k, case.sampled_loop(units)
    yield "stable", [float(loop.is_stable)], 0
    if loop.is_stable:
        margins = asked(loop.margins)
        if isinstance(margins, str):
            yield "margins", margins, 0
            return
        yield "margins", [margins.gain, margins.gain_low, margins.phase, margins.delay / k], 0
        yield "peaks", [margins.Ms.value, margins.Mt.value], 0


def of_tuning(case: Case, units: Units) -> Iterator[Answer]:
    """Every rule of the family that applies, and its settings."""
    k, gain, process = units.k, units.y / units.u, case.process(units)
    found = tune(process, all=True, closed=0.7 * k)
    yield "rules", " ".join(sorted(found)), 0
    for name, tuning in found.items():
        yield name, [tuning.K * gain, tuning.Ti / k, tuning.Td / k, tuning.b], 0
    yield "angles", asked(lambda: [by_angles.pid(process, 0.4 / k, 1.0).P * gain]), 0


ASKED = (of_loop, of_process, of_sampled_loop, of_tuning)


def agree(first: list[float] | str, second: list[float] | str, size: float) -> bool:
    if isinstance(first, str) or isinstance(second, str):
        return first == second
    return len(first) == len(second) and all(
        a == b or abs(a - b) <= RELATIVE * max(abs(a), abs(b), size) for a, b in zip(first, second, strict=True)
    )


@dataclass
class Found:
    """What came of a case. border: left out. answers: how many were compared, refusals among them."""

    border: bool = False
    answers: int = 0
    refusals: int = 0
    stable: bool = False
    differences: list[str] = field(default_factory=list)


def compare(seed: int, questions: Sequence[Callable[[Case, Units], Iterator[Answer]]] = ASKED) -> Found:
    """The case of a seed in both units."""
    case, units, found = Case.seeded(seed), Units.seeded(seed), Found()
    if on_the_border(case):
        return Found(border=True)
    for question in questions:
        one, other = ({name: rest for name, *rest in question(case, each)} for each in (Units(), units))
        for name in {**one, **other}:
            (first, size), (second, _) = one.get(name, ["no answer", 0]), other.get(name, ["no answer", 0])
            found.answers += 1
            found.refusals += isinstance(first, str) and name != "rules"
            found.stable |= name == "unstable roots" and first == [0]
            if not agree(first, second, size):
                where = f"seed {seed} ({case.kind}, k = {units.k:.3g}) {question.__name__} {name}"
                found.differences.append(f"{where}: {first} and {second}")
    return found


def on_the_border(case: Case) -> bool:
    """So near a border of stability that a relative 1e-7 of the gain decides."""
    loop = case.loop(Units())
    counts = {asked(lambda shift=shift: loop.with_gain(1 + shift).unstable_roots) for shift in (-1e-7, 0.0, 1e-7)}
    return len(counts) > 1 or "BorderError" in counts
