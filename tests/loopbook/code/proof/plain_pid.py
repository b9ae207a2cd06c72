"""The PID controller as a textbook says it, one term at a time, in exact arithmetic.

    P = K (b y_sp - y)
    D = p D_before - K Td/(Tf + h) (s - s_before),    s = y - c y_sp,  p = Tf/(Tf + h)
    v = P + I + D + feedforward,    u = v within rate and limits
    I = I + K h/Ti e + h/Tt (u - v)

Neither the gains p1 ... p6 nor the state x of the emitted programs appear; that both are one controller is what the
comparison shows. All numbers are Fractions; Ti, Tt = None is infinite.
"""

from fractions import Fraction

Number = Fraction | int


class PlainPid:
    """One controller. Attributes after a step: u, I, v, e."""

    def __init__(self, **settings: Number | None):
        self.settings = settings
        self.reset()

    def reset(self) -> None:
        self.I = self.u = self.v = self.e = Fraction(0)
        self.coming = None  # D of the next sample if s stands still; None: no sample yet
        self.y = self.sp = self.wanted = Fraction(0)
        self.manual = self.keep = False
        self.u = self._within(self.u)

    def _within(self, u: Fraction) -> Fraction:
        return min(max(u, self.settings["u_low"]), self.settings["u_high"])

    def _s(self, y: Fraction, sp: Fraction) -> Fraction:
        return y - self.settings["c"] * sp

    def _p(self, y: Fraction, sp: Fraction) -> Fraction:
        return self.settings["K"] * (self.settings["b"] * sp - y)

    def start(self, y: Fraction, sp: Fraction, u: Fraction, ff: Fraction) -> None:
        self.u = self.v = self._within(u)
        self.coming, self.y, self.sp, self.e = Fraction(0), y, sp, sp - y
        self.I = self.u - self._p(y, sp) - ff
        self.manual, self.keep = False, True

    def set_manual(self, on: bool, u: Fraction) -> None:
        self.manual = on
        if on:
            self.wanted = u

    def change(self, **settings: Number | None) -> None:
        p_before = self._p(self.y, self.sp)
        self.settings = settings
        if self.coming is not None:
            self.I += p_before - self._p(self.y, self.sp)

    def step(self, sp: Fraction, y: Fraction, ff: Fraction) -> Fraction:
        q = self.settings
        slope = q["K"] * q["Td"] / (q["Tf"] + q["h"])
        if self.coming is None:
            D = Fraction(0)
        else:
            D = self.coming - slope * (self._s(y, sp) - self._s(self.y, self.sp))
        others = self._p(y, sp) + D + ff
        if self.manual:
            v, u = self.wanted, self.wanted
        else:
            if self.keep:
                self.I = self.u - others
            v = u = others + self.I
            if q["rate"]:
                most = q["rate"] * q["h"]
                u = min(max(u, self.u - most), self.u + most)
        u = self._within(u)
        if self.manual:
            self.I = u - others
        else:
            moved = q["K"] * q["h"] / q["Ti"] * (sp - y) if q["Ti"] else Fraction(0)
            if q["Tt"]:
                moved += q["h"] / q["Tt"] * (u - v)
            if q["Tt"] == 0 and moved * (v - u) > 0:
                moved = Fraction(0)
            self.I += moved
        self.coming = D * q["Tf"] / (q["Tf"] + q["h"])
        self.y, self.sp, self.e, self.u, self.v = y, sp, sp - y, u, v
        self.keep = self.manual
        return u
