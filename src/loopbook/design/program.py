"""The regulator as it goes into a controller: sampling interval, filter, coefficients, listing, JSON."""

import math
from dataclasses import dataclass
from typing import Any

from loopbook.controllers.generated import program_gains
from loopbook.controllers.settings import PidSettings
from loopbook.design.evaluation import Evaluation
from loopbook.design.start_state import program_lines, rest_state, start_formulas

PER_CROSSOVER = 0.15  # h times the gain crossover frequency: the usual upper end of what costs little phase
GAINS = {
    "p_1": "set-point gain",
    "p_2": "gain of the measurement",
    "p_3": "filter",
    "p_4": "derivative state",
    "p_5": "integral gain",
    "p_6": "tracking gain",
}


@dataclass(frozen=True)
class SampledProgram:
    """One discrete PID, pid-report's figure 4.13 with the numbers of a design.

    settings: checked settings with h and the limits. gains: p_1 to p_6 from the derived equations. why: how h was
    chosen, one sentence each. delay_margin_left: the share of the loop's delay margin that the sampling (h/2 of
    added dead time) leaves, 1 = all. rest: (u, y) at which the listing starts, with the set-point at y.
    """

    settings: PidSettings
    gains: dict[str, float]
    why: tuple[str, ...]
    delay_margin_left: float
    rest: tuple[float, float] = (0.0, 0.0)

    @property
    def start(self) -> dict[str, float]:
        """x and I for which the first output is u of the rest: nothing moves when the program is switched on."""
        u0, y0 = self.rest
        g = self.gains
        x, exact = rest_state()(*(g[f"p_{i}"] for i in (1, 2, 3, 4)), y0, u0)
        I = exact
        for _ in range(4):  # the last digits, as the program itself rounds them
            I += u0 - (g["p_1"] * y0 - g["p_2"] * y0 + I + x)
        return {"x": x, "I": I}

    def listing(self) -> str:
        """The program, generated from the derived difference equations, with the numbers of this design."""
        lines = program_lines()
        body = lines[lines.index("repeat:") :]
        numbers = [f"{name.replace('_', '')} = {value!r}" for name, value in self.gains.items()]
        limits = [f"ulow = {self.settings.u_low!r}", f"uhigh = {self.settings.u_high!r}", ""]
        limits += [f"start at rest, with the set-point at y (here y = {self.rest[1]!r}, u = {self.rest[0]!r}):"]
        limits += [
            f"x = {self.start['x']!r}    ({start_formulas()[0]})",
            f"I = {self.start['I']!r}    ({start_formulas()[1]})",
        ]
        return "\n".join([*numbers, *limits, *body])

    def data(self) -> dict[str, Any]:
        """Everything as plain data; an infinite limit is null."""
        s = self.settings
        names = ("K", "Ti", "Td", "Tf", "b", "h", "Tt")
        numbers = {name: float(getattr(s, name)) for name in names if getattr(s, name) is not None}
        limits = {n: (float(v) if math.isfinite(v) else None) for n, v in (("u_low", s.u_low), ("u_high", s.u_high))}
        point = {"u0": self.rest[0], "y0": self.rest[1]}
        formulas = dict(zip(("x", "I"), start_formulas(), strict=True))
        return {
            "form": "standard",
            "settings": numbers,
            "limits": limits,
            "gains": self.gains,
            "operating_point": point,
            "start": {"u": self.rest[0], "y": self.rest[1], **self.start, "formulas": formulas},
        }


def round_down(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that does not exceed the value.

    >>> round_down(0.37), round_down(7.1), round_down(0.1)
    (0.2, 5.0, 0.1)
    """
    power = 10.0 ** math.floor(math.log10(value) + 1e-12)
    return float(f"{next(step * power for step in (5, 2, 1) if step * power <= value * (1 + 1e-9)):.12g}")


def sampling_interval(chosen: Evaluation, time_constant: float, logged: float = 0.0) -> tuple[float, tuple[str, ...]]:
    """A sampling interval [s] for a design, and the rules it follows.

    h < T/5 (pid-report, section 5.1); h <= Tf/2, so that the derivative's filter is more than one sample;
    h wc <= 0.15 at the gain crossover, so that sampling costs little phase. logged [s]: the record's interval; where
    the loop does not need it, the program does not run faster than the measurement was taken.
    """
    pid = chosen.candidate.pid
    bounds = {"a fifth of the process's time constant": time_constant / 5}
    crossovers = [c.w for c in chosen.loop.margins().gain_crossovers]
    if crossovers:
        bounds["0.15 over the gain crossover frequency"] = PER_CROSSOVER / max(crossovers)
    needed = min(bounds.values())
    if pid.Td:
        bounds["half the filter's time constant"] = pid.Tf / 2
    why = tuple(f"{name.capitalize()} is {bound:.3g} s." for name, bound in bounds.items())
    h = round_down(min(bounds.values()))
    floor = min(logged, needed)
    if floor > h:
        h = round_down(floor)
        why = (
            *why,
            f"The record was taken every {logged:.3g} s: faster readings would bring more noise, not more news.",
        )
        return h, (*why, f"h = {h:g} s.")
    return h, (*why, f"The shortest of these, rounded down: h = {h:g} s.")


def sampled_program(
    chosen: Evaluation,
    time_constant: float,
    h: float = 0.0,
    limits: tuple[float, float] = (-math.inf, math.inf),
    rest: tuple[float, float] = (0.0, 0.0),
    logged: float = 0.0,
    finer: int = 1,
) -> SampledProgram:
    """The discrete PID of a design. h [s]: 0 has it chosen by `sampling_interval`, divided by `finer`. rest: (u, y).

    Raises SettingError for limits out of order or h < 0.
    """
    why: tuple[str, ...] = ("h was given.",)
    if h == 0:
        h, why = sampling_interval(chosen, time_constant, logged)
        if finer > 1:
            h = round_down(h / finer)
            why = (*why, f"To keep its robustness it is sampled faster than that: h = {h:g} s.")
    settings = PidSettings.of(chosen.candidate.pid, h=h, u_low=limits[0], u_high=limits[1])
    infinite = float("inf")
    numbers = (settings.K, settings.Ti or infinite, settings.Td, settings.Tf, settings.b, h, settings.Tt or infinite)
    gains = {name: float(value) for name, value in program_gains("4.13")(*numbers).items()}
    left = 1 - h / 2 / chosen.delay_margin if math.isfinite(chosen.delay_margin) else 1.0
    return SampledProgram(settings, gains, why, left, rest)
