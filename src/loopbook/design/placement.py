"""Pole placement for the sampled model: RST regulators for a range of speeds, with what each costs."""

import math
from dataclasses import dataclass

import numpy as np

from loopbook.controllers.rst import PlacementError, Rst, with_zeros
from loopbook.design.model import Model
from loopbook.design.speed import time_scale
from loopbook.loop.margins import Margins
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.transfer import LoopError
from loopbook.pole_placement.numeric import place_numerically
from loopbook.process.sampled import sample
from notebook_reports.display import Table, number

SPEEDS = (1.0, 0.5, 0.25)


@dataclass(frozen=True)
class Placed:
    """One pole placement. closed: wanted time constant [s]; q = exp(-h/closed): where the poles are put.

    margins: None where the regulator could not be found (reason) or the loop is unstable. regulator_stable: whether
    the regulator by itself is. settling [s]: after a reference step, sampled 2 % band; peak_input [u].
    """

    closed: float
    q: float
    regulator: Rst | None
    margins: Margins | None = None
    regulator_stable: bool = False
    settling: float = math.nan
    peak_input: float = math.nan
    iae_load: float = math.nan
    reason: str = ""


def interval(model: Model) -> float:
    """A sampling interval [s] for placement: a tenth of the slowest lag, or a fifth of the delay if that is longer."""
    slowest = max((*model.lags, model.delay / 2)) or time_scale(model)
    return float(f"{max(slowest / 10, model.delay / 5):.3g}")


def placed(model: Model, closed: float, h: float) -> Placed:
    """All poles of the loop at q = exp(-h/closed), as many as the sampled process has with one integrator."""
    q = math.exp(-h / closed)
    B, A = sample(model.process, h).polynomials
    try:
        regulator = place_numerically(B, A, with_zeros([q] * len(A)), h).regulator
    except PlacementError as error:
        return Placed(closed, q, None, reason=str(error))
    loop = SampledLoop(model.process, regulator)
    if not loop.is_stable:
        return Placed(closed, q, regulator, None, regulator.is_stable, reason="unstable by rounding")
    try:
        margins = loop.margins()
    except LoopError as error:
        return Placed(closed, q, regulator, None, regulator.is_stable, reason=f"its margins are not known: {error}")
    steps = math.ceil((20 * closed + 5 * model.delay) / h)
    response, load = loop.step("reference", steps), loop.step("load", steps)
    outside = np.flatnonzero(abs(response.y - 1) > 0.02)
    settling = float(response.t[min(outside[-1] + 1, steps)]) if outside.size else 0.0
    iae = float(np.sum(abs(load.y)) * h)
    peak = float(abs(response.u).max())
    return Placed(closed, q, regulator, margins, regulator.is_stable, settling, peak, iae)


def placements(model: Model, time_constant: float, h: float = 0.0) -> list[Placed]:
    """Placements with closed-loop time constants of 1, 1/2 and 1/4 of the process's. h [s]: 0 has it chosen."""
    return [placed(model, speed * time_constant, h or interval(model)) for speed in SPEEDS]


def polynomials(found: list[Placed]) -> Table:
    """The regulators to use: the coefficients of 1, z^-1, z^-2, ... in R u = T r - S y."""
    rows = [
        [number(p.closed, 3), letter, ",  ".join(number(c, 7) for c in getattr(p.regulator, letter.strip("$")))]
        for p in found
        if p.regulator
        for letter in ("$R$", "$S$", "$T$")
    ]
    heads = ["closed [s]", "", "coefficients of $1, z^{-1}, z^{-2}, ...$"]
    rows = rows or [["–", "–", "no placement was found"]]
    return Table(heads, rows, "The regulators $R u = T r - S y$", ["right", "left", "left"])


def table(found: list[Placed]) -> Table:
    """The placements side by side."""
    rows, marks = [], []
    for p in found:
        head = [number(p.closed, 3), number(p.q, 3)]
        if p.margins is None:
            rows.append([*head, *["–"] * 6, p.reason])
            marks.append("bad")
            continue
        m = p.margins
        cells = [m.Ms.value, m.gain, m.delay, p.settling, p.iae_load, p.peak_input]
        rows.append([*head, *[number(c, 3) for c in cells], "stable" if p.regulator_stable else "unstable by itself"])
        marks.append("good" if m.Ms.value <= 1.6 else "note" if m.Ms.value > 2 else "")
    heads = ["closed [s]", "$q$", "$M_s$", "gain margin", "delay margin [s]", "settling [s]", "IAE, load", "peak $u$",
             "regulator"]  # fmt: skip
    h = found[0].regulator.h if found and found[0].regulator else 0
    caption = f"Pole placement for the model sampled every {number(h, 3)} s"
    return Table(heads, rows, caption, ["right"] * 8 + ["left"], (), marks)
