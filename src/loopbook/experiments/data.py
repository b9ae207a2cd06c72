"""What an experiment tells about a process: the small sets of numbers that tuning rules start from.

Gains are positive (change the sign of u where the process turns it), times in s. Each set refuses numbers that no
process gives.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from loopbook.numerics.real_numbers import plain_number
from loopbook.refusal import Refusal


class DataError(Refusal):
    """Numbers that no experiment on a process of this kind can give."""


def _check(data: object, where: str, sizes: tuple[str, ...] = (), times: tuple[str, ...] = ()) -> None:
    """Make each named field a Python number, positive or a time of zero or longer."""
    for name in (*sizes, *times):
        object.__setattr__(data, name, _number(where, name, getattr(data, name), positive=name in sizes))


def _number(where: str, name: str, value: Any, positive: bool = True) -> float:
    try:
        number = plain_number(value)
    except TypeError as error:
        raise DataError(f"{where}: {name}: {error}") from None
    number = float(number) if isinstance(number, Fraction) else number
    if positive and not (math.isfinite(number) and number > 0):
        raise DataError(f"{where}: {name} = {number!r} must be a positive finite number")
    if not (math.isfinite(number) and number >= 0):
        raise DataError(f"{where}: {name} = {number!r} s must be zero or a positive time")
    return number


@dataclass(frozen=True)
class StepData:
    """A stable process from its step response: Kp [y/u], T [s] (63 % less dead time), L [s] (tangent).

    >>> StepData(Kp=1, T=1.04, L=0.075).tau.__round__(4)
    0.0673
    """

    Kp: float
    T: float
    L: float

    def __post_init__(self) -> None:
        _check(self, "step data", ("Kp",), ("T", "L"))
        if self.T + self.L == 0:
            raise DataError("step data: T = L = 0: the output follows the input at once, there is nothing to tune")

    @property
    def tau(self) -> float:
        """The relative dead time L/(L + T), 0 to 1."""
        return self.L / (self.L + self.T)

    @property
    def T63(self) -> float:
        """The instant at which 63 % of the step are reached, L + T [s]."""
        return self.L + self.T


@dataclass(frozen=True)
class IntegratingStepData:
    """An integrating process from its step response: Kv [y/(u s)], L [s] where the final tangent starts.

    >>> IntegratingStepData(Kv=0.2, L=3)
    IntegratingStepData(Kv=0.2, L=3)
    """

    Kv: float
    L: float

    def __post_init__(self) -> None:
        _check(self, "step data of an integrating process", ("Kv",), ("L",))


@dataclass(frozen=True)
class FrequencyData:
    """The process where its phase is -180 degrees: K180 = |G| [y/u] and the period T180 [s].

    >>> FrequencyData(K180=0.0091, T180=0.199).Ku.__round__(1)
    109.9
    """

    K180: float
    T180: float

    def __post_init__(self) -> None:
        _check(self, "frequency data", ("K180", "T180"))

    @classmethod
    def from_ultimate(cls, Ku: float, Tu: float) -> "FrequencyData":
        """From the gain [u/y] and the period [s] at which a proportional loop just keeps oscillating.

        >>> FrequencyData.from_ultimate(Ku=4, Tu=2)
        FrequencyData(K180=0.25, T180=2)
        """
        return cls(1 / _number("the ultimate point", "Ku", Ku), _number("the ultimate point", "Tu", Tu))

    @property
    def Ku(self) -> float:
        """The ultimate gain 1/K180 [u/y]."""
        return 1 / self.K180

    @property
    def w180(self) -> float:
        """The ultimate frequency 2 pi/T180 [rad/s]."""
        return 2 * math.pi / self.T180

    def kappa(self, Kp: float) -> float:
        """The gain ratio K180/Kp; Kp = inf (an integrating process) gives 0."""
        return self.K180 / Kp


@dataclass(frozen=True)
class TwoLagData:
    """Kp e^(-L1 s)/((1 + s T1)(1 + s T2)), T2 <= T1, from a step and a frequency experiment together.

    >>> TwoLagData(Kp=2, T1=10, T2=4, L1=3).T2
    4
    """

    Kp: float
    T1: float
    T2: float
    L1: float

    def __post_init__(self) -> None:
        _check(self, "two-lag data", ("Kp",), ("T1", "T2", "L1"))


@dataclass(frozen=True)
class IntegratingPulseData:
    """Kv e^(-L1 s)/(s (1 + s T2)) from the response to a short pulse: Kv [y/(u s)], T2 [s], L1 [s].

    >>> IntegratingPulseData(Kv=0.2, T2=4, L1=3).step
    IntegratingStepData(Kv=0.2, L=7)
    """

    Kv: float
    T2: float
    L1: float

    def __post_init__(self) -> None:
        _check(self, "pulse data", ("Kv",), ("T2", "L1"))

    @property
    def step(self) -> IntegratingStepData:
        """What a step experiment sees of the same process: its L is L1 + T2."""
        return IntegratingStepData(self.Kv, self.L1 + self.T2)
