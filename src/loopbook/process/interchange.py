"""A process to python-control and back: exact for what has no dead time, which python-control does not hold."""

from collections.abc import Sequence
from typing import Any, Self

from loopbook.extras import needed
from loopbook.process.rows import ProcessError


class Interchange:
    """The conversions of a `Process`."""

    num: Sequence[float]
    den: Sequence[float]
    delay: float

    @classmethod
    def from_control(cls, system: Any, delay: float = 0.0) -> Self:
        """From a continuous single-input single-output `control.TransferFunction`, which holds no dead time itself."""
        if getattr(system, "ninputs", None) != 1 or system.noutputs != 1:
            raise ProcessError("from_control takes a system with one input and one output")
        if system.dt not in (0, None):
            raise ProcessError(f"from_control takes a continuous system, got one with dt = {system.dt}")
        return cls(tuple(system.num[0][0]), tuple(system.den[0][0]), delay)  # type: ignore[call-arg]

    def to_control(self, pade: int | None = None) -> Any:
        """As a `control.TransferFunction`.

        pade: order of the Padé approximation of the dead time. Without it a process with dead time is refused, as
        python-control has no form for it.
        """
        control = needed("control", "control")
        rational = control.tf(list(self.num), list(self.den))
        if not self.delay:
            return rational
        if pade is None:
            raise ProcessError(
                f"python-control cannot hold the dead time {self.delay} s: ask for pade=order, or take .rational"
            )
        return rational * control.tf(*control.pade(self.delay, pade))
