"""A program that waits at the end of each pass, on a clock of its own: when it samples, and what that does to D.

Source: pid-report, Table 4.1 and figures 4.7 to 4.13, which end with wait(h).
"""

from dataclasses import dataclass

from loopbook.controllers.settings import PidSettings
from loopbook.documents.pid_report.printed_programs import ProgramController


@dataclass
class Clock:
    """Time [s] that passes only when something takes it."""

    now: float = 0.0

    def take(self, seconds: float) -> None:
        self.now += seconds


@dataclass(frozen=True)
class Passes:
    """The instants [s] at which the measurement was read, and the slope that D finds in a ramp of one unit a second."""

    instants: tuple[float, ...]
    slope: float

    @property
    def interval(self) -> float:
        """Between the last two samples [s]."""
        return self.instants[-1] - self.instants[-2]


def run_passes(settings: PidSettings, wait: float, spent: float, passes: int = 20) -> Passes:
    """Passes of the program of figure 4.9 on the measurement y = t: each takes `spent` seconds, then waits `wait`.

    settings: with the h that the gains are computed for, Td > 0, no filter and no limits in reach. The slope is what
    the D part of the last pass says it is, -D/(K Td).
    """
    clock, program, instants, D = Clock(), ProgramController("4.9", settings), [], 0.0
    for _ in range(passes):
        instants.append(clock.now)
        past = program.states["I"]
        D = program.step(clock.now, 0.0) - past + settings.K * clock.now
        clock.take(spent)
        clock.take(wait)
    return Passes(tuple(instants), -D / (settings.K * settings.Td))
