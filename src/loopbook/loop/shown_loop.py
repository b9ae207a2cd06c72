"""How every loop shows itself: a table of what matters, its step, Bode and Nyquist diagrams."""

from typing import Any, ClassVar

import numpy as np

from loopbook.loop.loop_algebra import LoopAlgebra
from loopbook.loop.transfer import LoopError
from loopbook.plots.curves import curves
from loopbook.plots.frequency import Curve, bode_figure, nyquist_curves
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.plots.shown import shown_once
from loopbook.process.rows import ProcessError

DIAGRAMS = ("step", "bode", "nyquist")


class ShownLoop(LoopAlgebra, ShortRepr, ShownAsTable):
    """For a loop with `is_stable`, `margins`, `frequency_curve` and `reference_and_load`."""

    half_way: ClassVar[str] = "load"

    @property
    def is_stable(self) -> bool:
        """Is it?"""
        raise NotImplementedError

    def margins(self) -> Any:
        """Its margins."""
        raise NotImplementedError

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """Gain and phase of its loop transfer at w [rad/s], with its margins."""
        raise NotImplementedError

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)) after a unit step of the reference at 0 and one of the load at half the horizon [s]."""
        raise NotImplementedError

    def default_horizon(self) -> float:
        """How long [s] a plot of both steps is."""
        raise NotImplementedError

    def parts(self) -> list[list[Any]]:
        """Rows that say what the loop is made of."""
        return []

    def table(self) -> PlainTable:
        """What it is made of, and its margins where it has some."""
        rows = self.parts()
        if not self.is_stable:
            return PlainTable(["loop", ""], [*rows, ["stable", "no"]])
        rows.append(["stable", "yes"])
        try:
            m = self.margins()
        except LoopError as error:
            return PlainTable(["loop", ""], rows, [str(error)])
        rows += [["gain margin", m.gain], ["phase margin [°]", m.phase], ["delay margin [s]", m.delay]]
        rows += [["Ms", m.Ms.value], ["Mt", m.Mt.value]]
        return PlainTable(["loop", ""], rows)

    def plot(self, what: str = "step", horizon: float | None = None) -> Any:
        """A matplotlib figure: "step" (unit steps of the reference, at once, and of the load, half-way), "bode" with
        the margins, or "nyquist" with the circle that Ms stays out of. horizon [s]: of "step".

        Raises ProcessError for another name, LoopError for the steps of an unstable loop without a horizon.
        """
        if what not in DIAGRAMS:
            raise ProcessError(f"plot({what!r}): one of {', '.join(DIAGRAMS)}")
        if what == "bode":
            return shown_once(bode_figure({"loop transfer": self.frequency_curve()}, "Bode diagram"))
        if what == "nyquist":
            return shown_once(nyquist_curves({"loop transfer": self.frequency_curve()}, "Nyquist diagram"))
        y, u = self.reference_and_load(horizon or self.default_horizon())
        title = f"Unit steps of the reference (at once) and of the {self.half_way} (half-way)"
        return shown_once(curves({"output $y$": {"y": y}, "input $u$": {"u": u}}, title))


def said_of(part: Any) -> str:
    """One line on a process or a regulator."""
    text = str(part) if isinstance(part, int | float) else repr(part)
    return text if len(text) <= 100 else f"{text[:97]}..."
