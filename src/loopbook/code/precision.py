"""What single precision costs a controller: the error it no longer sees, the error of a run, the converters' steps.

The integral moves by K h/Ti e at each sample. Where that is less than half the distance between neighbouring numbers
at I, the sum is I again, and the loop rests at an error that it never removes:

    dead error = ulp(I)/2 Ti/(K h)

With I = 50 in single precision ulp(I) is 3.8e-6: an increment of 1e-7 moves nothing, however long it is added.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from derivations.programs import full_pid
from loopbook.code.block import Block, CodeError
from loopbook.code.running import controller

TYPES = {"float": np.float32, "double": np.float64}
SHARE = 1e-4
"""The dead error that is borne without a word, as a share of the measurement's span."""
BITS = 12


def dead_error(block: Block, integral: float, real: str = "float") -> float:
    """The largest |e| that does not move an integral of this size [y]; 0 without integral action.

    integral: I [u]. real: "float" or "double".

    >>> from loopbook.code import pid_block
    >>> round(dead_error(pid_block(K=1.0, Ti=1000.0, h=0.01), 50.0), 3)
    0.191
    """
    s = block.settings()
    if not s["Ti"] or math.isinf(s["Ti"]):
        return 0.0
    ulp = float(np.spacing(np.asarray(abs(integral), TYPES[real])))
    return ulp / 2 * s["Ti"] / (abs(s["K"]) * s["h"])


def longer_interval(block: Block, integral: float, bearable: float, real: str = "float") -> float:
    """The sampling interval [s] from which on the dead error is at most ``bearable`` [y]."""
    return dead_error(block, integral, real) / bearable * block.settings()["h"]


def run_error(
    block: Block, y: Sequence[float], y_sp: Sequence[float], start: tuple[float, float], real: str = "float"
) -> float:
    """The largest |u - exact u| [u] where the controller sees these measurements, from rest at (u, y).

    The exact run uses fractions for the same settings and signals, rounded once to the type. Its numbers grow with
    every sample: a few hundred samples take about a second.
    """
    number: Callable[[float], Any] = TYPES[real]
    finite = dict(block.settings())
    if math.isinf(finite["Ti"]):
        finite["Ti"] = 0.0
    rounded = {n: number(v) for n, v in finite.items()}
    exact: dict[str, Fraction | float] = {
        n: Fraction(float(v)) if math.isfinite(v) else float(v) for n, v in rounded.items()
    }
    loops: list[tuple[Any, Any]] = [
        (controller(block, number, **rounded), number),
        (controller(block, lambda v: v, **exact), Fraction),
    ]
    largest = 0.0
    u0, y0 = number(start[0]), number(start[1])
    for loop, kind in loops:
        loop.start(*(kind(float(v)) for v in (y0, y0, u0)), kind(0))
    for measured, wanted in zip(y, y_sp, strict=True):
        values = float(number(wanted)), float(number(measured))
        seen, true = (loop.step(kind(values[0]), kind(values[1]), kind(0)) for loop, kind in loops)
        largest = max(largest, abs(float(Fraction(float(seen)) - Fraction(true))))
    return largest


@dataclass(frozen=True)
class Cost:
    """What a controller pays for its precision.

    dead, run: see `dead_error`, `run_error`; run is None where no run was given. y_step, u_step: one step of the
    converters [y, u]; u_of_y_step: what one step of y moves u by at once. advice: sentences, empty where single
    precision is enough.
    """

    real: str
    integral: float
    span: float
    dead: float
    run: float | None
    y_step: float
    u_step: float
    u_of_y_step: float
    advice: tuple[str, ...]

    def rows(self) -> list[tuple[str, str, str]]:
        """(what, value, unit), ready for a table."""
        found = [("error that no longer moves I", f"{self.dead:.3g}", "y")]
        if self.span:
            found.append(("share of the measurement's span", f"{100 * self.dead / self.span:.2g}", "%"))
        if self.run is not None:
            found.append(("largest error of u in the run, against exact arithmetic", f"{self.run:.2g}", "u"))
        found += [
            ("one step of the converter of y", f"{self.y_step:.3g}", "y"),
            ("what that step moves u by at once", f"{self.u_of_y_step:.3g}", "u"),
            ("one step of the converter of u", f"{self.u_step:.3g}", "u"),
        ]
        return found


def cost(
    block: Block,
    span: float,
    *,
    integral: float | None = None,
    run: tuple[Sequence[float], Sequence[float]] | None = None,
    bits: int = BITS,
    real: str = "float",
) -> Cost:
    """What single or double precision costs this controller.

    span: of the measurement [y] > 0. integral: I [u] at the working point; default that of the block's start, or the
    larger limit of u. run: (y, y_sp) to run through, needs the block's ``rest``. bits: of the converters.
    Raises CodeError for a span that is not positive or a run without a point of rest.
    """
    if not (span > 0 and math.isfinite(span)):
        raise CodeError(f"span = {span}: a positive width of the measurement is expected")
    if run is not None and block.rest is None:
        raise CodeError("a run starts from rest: the block does not know where that is")
    s = block.settings()
    loop = controller(block)
    if block.rest is not None:
        loop.start(block.rest[1], block.rest[1], block.rest[0], 0.0)
    limits = [abs(s[n]) for n in ("u_low", "u_high") if math.isfinite(s[n])]
    if integral is None:
        integral = loop.I if block.rest is not None else max(limits, default=1.0)
    dead = dead_error(block, integral, real)
    width = s["u_high"] - s["u_low"] if len(limits) == 2 else math.nan
    found = run_error(block, *run, block.rest, real) if run and block.rest else None
    steps = 2**bits - 1
    advice: tuple[str, ...] = ()
    if dead > SHARE * span and block.program.has("step"):
        h = longer_interval(block, integral, SHARE * span, real)
        advice = (
            f"Errors below {dead:.3g} ({100 * dead / span:.2g} % of the span) do not move the integral: "
            f"take LREAL or double, the compensated sum, or h of at least {h:.3g} s.",
        )
    return Cost(real, integral, span, dead, found, span / steps, width / steps, abs(loop.p2) * span / steps, advice)


def creeping(block: Block, error: float, samples: int) -> dict[str, np.ndarray]:
    """I - I(0) under a small constant error, from the block's rest: in single precision, compensated, in double.

    error [y]; a value for each of ``samples`` steps. Raises CodeError where the block does not know its rest.
    """
    if block.rest is None:
        raise CodeError("a run starts from rest: the block does not know where that is")
    kinds: dict[str, tuple[bool, type]] = {
        "single precision": (False, np.float32),
        "single, compensated": (True, np.float32),
        "double precision": (False, np.float64),
    }
    return {name: _integrals(block, block.rest, error, samples, *kind) for name, kind in kinds.items()}


def _integrals(
    block: Block, rest: tuple[float, float], error: float, samples: int, compensated: bool, number: type
) -> np.ndarray:
    loop = controller(replace(block, program=full_pid.program(compensated)), number)
    u, y = (number(v) for v in rest)
    zero = number(0)
    loop.start(y, y, u, zero)
    loop.step(y, y, zero)
    found, first = [], loop.I
    for _ in range(samples):
        loop.step(y, y - number(error), zero)
        found.append(float(loop.I) - float(first))
    return np.array(found)
