"""How far an answer may lie from the key."""

import math
import re
from dataclasses import dataclass

from loopbook.course.errors import SheetError

_PERCENT = re.compile(r"\s*(\d+(?:\.\d+)?)\s*%\s*")
DIGITS = 3


@dataclass(frozen=True)
class Tolerance:
    """relative: to the key; absolute: in its unit; digits: where it was said in digits. One of the first two is 0."""

    relative: float = 0.0
    absolute: float = 0.0
    digits: int = 0

    def width(self, key: float, scale: float = 0.0) -> float:
        """The largest error that is no error; scale: the key counts as at least so large."""
        return self.absolute + self.relative * max(abs(key), scale)

    def within(self, given: float, key: float, widths: float = 1.0, scale: float = 0.0) -> bool:
        """Does an answer lie within so many tolerances of the key?

        >>> three = read_tolerance(digits=3)
        >>> three.within(0.654, 0.65432), three.within(0.65, 0.65432), three.within(0.65, 0.65432, widths=3)
        (True, False, True)
        """
        return math.isfinite(given) and abs(given - key) <= widths * self.width(key, scale) * (1 + 1e-9)

    def __str__(self) -> str:
        if self.digits:
            return f"{self.digits} digits"
        return f"± {100 * self.relative:g} %" if self.relative else f"± {self.absolute:g}"

    @property
    def shown_digits(self) -> int:
        """The significant digits with which a key is shown."""
        return self.digits or (max(2, 1 - math.floor(math.log10(self.relative))) if self.relative else 4)


def read_tolerance(digits: int | None = None, tolerance: str | float | None = None) -> Tolerance:
    """From what an author writes: ``digits=3`` (the default), ``tolerance="3 %"`` or ``tolerance=0.5`` in the unit.

    n digits are half a unit of the n-th digit of a key that begins with 1: relative 5·10^-n, the same for every key.
    Raises SheetError for both at once and for what is none of these.
    """
    if digits is not None and tolerance is not None:
        raise SheetError("an answer has digits=... or tolerance=..., not both")
    if tolerance is None:
        digits = DIGITS if digits is None else digits
        if type(digits) is not int or not 2 <= digits <= 12:
            raise SheetError(f"digits is a whole number from 2 to 12, got {digits!r}")
        return Tolerance(relative=5 * 10.0**-digits, digits=digits)
    if isinstance(tolerance, str):
        found = _PERCENT.fullmatch(tolerance)
        if not found or not 0 < float(found[1]) <= 50:
            raise SheetError(
                f'tolerance is written "3 %", from above 0 to 50 %, or a number in the unit; got {tolerance!r}'
            )
        return Tolerance(relative=float(found[1]) / 100)
    if not 0 < float(tolerance) < math.inf:
        raise SheetError(f"a tolerance is above 0, got {tolerance!r}")
    return Tolerance(absolute=float(tolerance))
