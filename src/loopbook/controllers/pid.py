"""The discrete PID controller: one sample at a time, or many at once.

    v = p1 y_sp - p2 y + I + x                   before the output is set (pid-report, eq. 4.20)
    u = v limited to [u_low, u_high] and in rate                  (eq. 4.2)
    x = p3 x + p4 (y - c y_sp)                   after it         (eq. 4.16)
    I = I + p5 (y_sp - y) + p6 (u - v)           with tracking    (eq. 4.5)

The functions that run are written from the derived expressions, see `loopbook.controllers.generated`.
"""

import warnings
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.controllers import generated
from loopbook.controllers.parallel_settings import ParallelSettings
from loopbook.controllers.settings import PidSettings, SettingError
from loopbook.numerics.real_numbers import Number, plain_number

AUTO, MANUAL = "auto", "manual"


class BadMeasurement(LoopbookError):
    """y or y_sp is not a finite number; the state is as before that sample. ``output``: the last output, to be held."""

    def __init__(self, name: str, value: Any, output: Any, sample: int | None = None):
        self.name, self.value, self.output, self.sample = name, value, output, sample
        where = "" if sample is None else f" at sample {sample}"
        super().__init__(f"{name} = {value!r}{where} is not a finite number; state kept, last output {output!r}")


class BadMeasurementWarning(UserWarning):
    """A measurement was skipped and the last output held (``on_bad="hold"``)."""


def _numbers(name: str, signal: Any) -> list[int | float | Fraction]:
    values = signal.tolist() if isinstance(signal, np.ndarray) else list(signal)
    if not {type(value) for value in values} <= {int, float, Fraction}:
        if np.ndim(signal) != 1:
            raise ValueError(f"{name} has {np.ndim(signal)} dimensions: a row of numbers is expected")
        values = [plain_number(value) for value in values]
    return values


class Pid:
    """A PID controller with its state.

    settings: `PidSettings` or `ParallelSettings`, all numbers floats or all exact (int, Fraction). I: start value of
    the integral part [u]. x: start value of the derivative's state [u]; None: at the first sample the derivative starts
    from rest, D = 0.
    on_bad: "raise" raises `BadMeasurement` for a y or y_sp that is not finite; "hold" warns and holds the last output,
    before any sample I within the limits. Numbers of other types (NumPy, Decimal) are taken as Python's.
    Attributes: I, x, u (last output), v (last unlimited output), mode ("auto" or "manual"), settings.

    >>> pid = Pid(PidSettings(K=2.0, Ti=4.0, h=1.0, u_low=0.0, u_high=3.0))
    >>> [pid.step(y, 1.0) for y in (0.0, 0.5, 1.0)]
    [2.0, 1.5, 0.75]
    """

    _p_1: Number
    _p_2: Number
    _p_24: Number

    def __init__(
        self, settings: PidSettings | ParallelSettings, *, I: Number = 0, x: Number = None, on_bad: str = "raise"
    ):
        if on_bad not in ("raise", "hold"):
            raise SettingError("on_bad", on_bad, "raise or hold")
        self.on_bad = on_bad
        self.mode = AUTO
        self.I, self.x = plain_number(I), 0 if x is None else plain_number(x)
        self._started = x is not None
        self.u = self.v = None
        self._y_sp = self._y = None
        self._manual = self._arriving = None
        self._use(settings)

    def _use(self, settings: PidSettings | ParallelSettings) -> None:
        self.settings = s = settings
        values = s.gains()
        for name, value in zip(generated.GAINS, values, strict=True):
            setattr(self, f"_{name}", value)
        self._gains = values
        self._low, self._high = s.u_low, s.u_high
        self._step = None if s.rate is None else s.rate * s.h
        self._automatic = generated.step(s.anti_windup, s.rate is not None)
        self._followed = generated.step("tracking", False)

    def step(self, y: Number, y_sp: Number) -> Number:
        """One sample: the output u for the measurement and the set-point of this sample."""
        if type(y) is not float or type(y_sp) is not float:
            y, y_sp = plain_number(y), plain_number(y_sp)
        if y - y != y_sp - y_sp:  # 0 for numbers; NaN, which differs from all, for NaN and infinities
            return self._bad(y, y_sp)
        self._y_sp, self._y = y_sp, y
        if not self._started:
            self.x = self._p_24 * (y - self.settings.c * y_sp)
            self._started = True
        if self._arriving is not None:
            self._arrive(y, y_sp)
        if self.mode == MANUAL:
            return self._follow(y, y_sp)
        return self._automatic(self, y, y_sp)

    def _bad(self, y: Number, y_sp: Number) -> Number:
        name, value = ("y", y) if y - y != 0 else ("y_sp", y_sp)
        error = BadMeasurement(name, value, self.u)
        if self.on_bad == "raise":
            raise error
        if self.u is None:
            self.u = min(max(self.I, self._low), self._high)
            error = BadMeasurement(name, value, self.u)
        warnings.warn(str(error), BadMeasurementWarning, stacklevel=3)
        return self.u

    def _unlimited(self, y: Number, y_sp: Number) -> Number:
        return self._p_1 * y_sp - self._p_2 * y + self.I + self.x

    def _arrive(self, y: Number, y_sp: Number) -> None:
        """First automatic sample after an exact transfer: I is set so that v is the last manual output."""
        self.I += self._arriving - self._unlimited(y, y_sp)
        self._arriving = None

    def _follow(self, y: Number, y_sp: Number) -> Number:
        """A manual sample: the algorithm runs and tracks the operator's output."""
        low, high = self._low, self._high
        self._low = self._high = self._manual
        self._followed(self, y, y_sp)
        self._low, self._high = low, high
        return self.u

    def manual(self, u: Number = None) -> Number:
        """Switch to manual, or set another manual output. u: within the limits; default the last output (no jump)."""
        value = self.u if u is None else u
        if value is None:
            raise SettingError("u", u, f"{self._low} <= u <= {self._high}", "no sample has run yet: give u")
        if not self._low <= value <= self._high:
            raise SettingError("u", value, f"{self._low} <= u <= {self._high}")
        self.mode, self._manual, self._arriving = MANUAL, value, None
        return value

    def auto(self, transfer: str = "exact") -> None:
        """Switch to automatic.

        transfer: "exact" makes the first automatic output the last manual one, whatever the error is. "tracking"
        (pid-report, section 4.2.5) relies on what tracking did during manual: it leaves K Tt/Ti e.
        """
        if transfer not in ("exact", "tracking"):
            raise SettingError("transfer", transfer, "exact or tracking")
        if self.mode == MANUAL and transfer == "exact":
            self._arriving = self._manual
        self.mode = AUTO

    def change(self, bumpless: str = "exact", **settings: Any) -> PidSettings | ParallelSettings:
        """Change settings between two samples; returns the new ones.

        bumpless: "exact" keeps P + I and D at the last y and y_sp for any change of K, b, c, Td, Tf, h, Ti, Tt.
        "integral" is the document's eq. 4.10, which keeps P + I and lets D jump. "none" changes no state.
        Before the first sample there is nothing to keep. Raises SettingError and changes nothing where a setting is
        out of range.
        """
        if bumpless not in ("exact", "integral", "none"):
            raise SettingError("bumpless", bumpless, "exact, integral or none")
        old, p24_old = self.settings, self._p_24
        self._use(old.changed(**settings))
        if self._y is not None and bumpless != "none":
            new = self.settings
            x, self.I = generated.bumpless_change()(
                self.I, self.x, self._y, self._y_sp, old.K, old.b, old.c, p24_old, new.K, new.b, new.c, self._p_24
            )
            self.x = x if bumpless == "exact" else self.x
        return self.settings

    def run(self, y: Sequence[Number] | np.ndarray, y_sp: Number, out: Number = None) -> Number:
        """Many automatic samples over recorded signals, fast.

        y: measurements; y_sp: one set-point, or one per measurement. out: array or list to fill, default a new array
        where y is an array or an output is a float, else a list of exact numbers. Same results as `step` called for
        each, bit by bit.
        Raises ValueError in manual mode or for signals of different length; a bad measurement as `step` does.
        """
        if self.mode == MANUAL:
            raise ValueError("run() plays automatic samples; the controller is in manual: call auto() first")
        of_array = isinstance(y, np.ndarray)
        y = _numbers("y", y)
        y_sp = [plain_number(y_sp)] * len(y) if np.ndim(y_sp) == 0 else _numbers("y_sp", y_sp)
        if len(y_sp) != len(y):
            raise ValueError(f"{len(y_sp)} set-points for {len(y)} measurements: as many of both are needed")
        finite = np.isfinite(np.asarray(y, float)) & np.isfinite(np.asarray(y_sp, float))
        stops = [*np.flatnonzero(~finite).tolist(), len(y)]
        outputs: list[Number] = [None] * len(y)
        done = 0
        while done < len(y):
            try:
                outputs[done] = self.step(y[done], y_sp[done])  # first sample, arrival, bad measurements
            except BadMeasurement as bad:
                raise BadMeasurement(bad.name, bad.value, bad.output, done) from None
            stop = next(k for k in stops if k > done)
            self._play(y, y_sp, outputs, done + 1, stop)
            done = stop
        if out is None:
            return np.array(outputs) if of_array or any(isinstance(u, float) for u in outputs) else outputs
        out[:] = outputs
        return out

    def _play(self, y: list[Number], y_sp: list[Number], outputs: list[Number], start: int, stop: int) -> None:
        if start >= stop:
            return
        s = self.settings
        loop = generated.run_samples(s.anti_windup, s.rate is not None)
        numbers = (*self._gains, self._low, self._high, self._step)
        part = [None] * (stop - start)
        state = (self.I, self.x, self.v, self.u)
        self.I, self.x, self.v, self.u = loop(numbers, state, y[start:stop], y_sp[start:stop], part)
        outputs[start:stop] = part
        self._y_sp, self._y = y_sp[stop - 1], y[stop - 1]
