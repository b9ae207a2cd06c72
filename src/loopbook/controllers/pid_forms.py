"""The forms of a PID controller, each with its conventions in its name, and the exact conversions between them.

    standard    u = K (b r - y + 1/(s Ti) (r - y) + s Td/(1 + s Tf) (c r - y))       Tf = Td/N
    parallel    u = P (b r - y) + I/s (r - y) + D N s/(s + N) (c r - y)              N a pole in rad/s, Tf = 1/N
    series      u = K (1 + 1/(s Ti)) (1 + s Td/(1 + s Tf)) (r - y)

The three names N and Tf are never interchangeable: N *divides* Td in the standard form (a pure number) and *is the
pole* in the parallel form (rad/s, as Simulink has it). c = 0 differentiates the measurement, c = 1 the error; b
weighs the reference in the proportional part. Ti = inf means no integral action. All times in s, K and P in [u/y].
"""

import math
from dataclasses import dataclass, fields
from typing import Any, cast

import numpy as np

from derivations.errors import LoopbookError
from loopbook.controllers.pid_formulas import parallel_formula, series_formula, standard_formula
from loopbook.controllers.regulator import Regulator
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.real_numbers import plain_number


class FormError(LoopbookError):
    """Parameters that no controller of this form can have, or a conversion that does not exist."""


def _python_numbers(form: "PidParallel | PidStandard | PidSeries") -> None:
    """The parameters as Python's own numbers, whatever they came as; None stays."""
    for part in fields(form):
        value = getattr(form, part.name)
        if value is not None or part.default is not None:
            try:
                object.__setattr__(form, part.name, plain_number(value))
            except TypeError as error:
                raise FormError(f"{part.name}: {error}") from None


def _finite(**named: float) -> None:
    for name, value in named.items():
        if not math.isfinite(value):
            raise FormError(f"{name} = {value!r} must be a finite number")


def _time(name: str, value: float, infinite: bool = False) -> None:
    if math.isnan(value) or value < 0 or (math.isinf(value) and not infinite):
        raise FormError(f"{name} = {value!r} s must be a time, zero or longer{' or inf' if infinite else ''}")


LEFT_OUT = cast(float, None)
"""For N or Tf: it follows from the other one, and is a number as soon as the form is made."""


class _Form:
    """What the three forms share: all of it follows from the parallel parameters."""

    def parallel(self) -> "PidParallel":
        raise NotImplementedError

    def regulator(self) -> Regulator:
        """The polynomials T, S, R of R u = T r - S y."""
        p = self.parallel()
        P, I, D, b_of_r, c_of_r = map(float, (p.P, p.I, p.D, p.b, p.c))
        Tf = float(p.Tf) if D else 0.0
        filter_, filter_s = np.array([0.0, Tf, 1.0]), np.array([Tf, 1.0, 0.0])
        R, s_R = (filter_s, np.array([1.0, 0.0, 0.0])) if I else (filter_, np.array([0.0, 1.0, 0.0]))

        def numerator(b: float, c: float) -> tuple[float, ...]:
            return tuple((b * P * R + I * filter_ + c * D * s_R).tolist())

        return Regulator(numerator(b_of_r, c_of_r), numerator(1.0, 1.0), tuple(R.tolist()))

    def transfer(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """(num, den) of the feedback path C(s) = -u/y, which is the error path too where b = c = 1.

        Descending coefficients in s. Improper (one zero more than poles) where D acts without a filter.
        """
        regulator = self.regulator()
        return regulator.S, regulator.R

    @property
    def fraction(self) -> tuple[ExponentialPolynomial, ExponentialPolynomial]:
        """What stands for it in products and sums with transfer functions: the feedback path C(s) = -u/y."""
        return self.regulator().fraction

    def reference_transfer(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """(num, den) of the path from the reference, u/r."""
        regulator = self.regulator()
        return regulator.T, regulator.R

    def latex(self) -> str:
        """The law with its numbers, in LaTeX."""
        p = self.parallel()
        return parallel_formula(p.P, p.I, p.D, p.Tf if p.D else 0.0, p.b, p.c)

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def __call__(self, s: Any) -> Any:
        """C(s) = -u/y at complex s."""
        return self.regulator().feedback(s)


@dataclass(frozen=True)
class PidParallel(_Form):
    """u = P (b r - y) + I/s (r - y) + D N s/(s + N) (c r - y): gains that add up, filter pole N [rad/s].

    P [u/y], I [u/(y s)], D [u s/y]; N = inf: no filter. Default: all parts act on the error (b = c = 1).
    D N/(1 + N/s), as Simulink writes it, is the same as D N s/(s + N).

    >>> PidParallel(2.0, 1.0, 0.5, 10).standard()
    PidStandard(K=2.0, Ti=2.0, Td=0.25, b=1.0, c=1.0, N=2.5, Tf=0.1)
    """

    P: float
    I: float = 0.0
    D: float = 0.0
    N: float = math.inf
    b: float = 1.0
    c: float = 1.0

    def __post_init__(self) -> None:
        _python_numbers(self)
        _finite(P=self.P, I=self.I, D=self.D, b=self.b, c=self.c)
        if not self.N > 0:
            raise FormError(f"N = {self.N!r} rad/s must be positive: it is the pole of the derivative's filter")

    @property
    def Tf(self) -> float:
        """The filter's time constant 1/N [s]; 0 without a filter."""
        return 1 / self.N

    def parallel(self) -> "PidParallel":
        return self

    def standard(self) -> "PidStandard":
        """K = P, Ti = P/I, Td = D/P, Tf = 1/N. Raises FormError where P = 0 and I or D is not."""
        if self.P == 0 and (self.I or self.D):
            raise FormError("P = 0 with integral or derivative action has no standard form: Ti = P/I and Td = D/P")
        Ti = self.P / self.I if self.I else math.inf
        if Ti < 0:
            raise FormError(f"P = {self.P} and I = {self.I} differ in sign: Ti = P/I would be negative")
        Td = self.D / self.P if self.P else 0.0
        if Td < 0:
            raise FormError(f"P = {self.P} and D = {self.D} differ in sign: Td = D/P would be negative")
        return PidStandard(self.P, Ti, Td, self.b, self.c, Tf=self.Tf)

    def series(self) -> "PidSeries":
        return self.standard().series()


@dataclass(frozen=True)
class PidStandard(_Form):
    """u = K (b r - y + 1/(s Ti) (r - y) + s Td/(1 + s Tf) (c r - y)), the form of textbooks and of AMIGO.

    K [u/y], Ti [s] > 0 or inf, Td [s] >= 0. The filter is given as Tf [s] or as N (a pure number) with Tf = Td/N, not
    both; neither means no filter. b, c: reference weights; default b = 1, c = 0 (derivative on the measurement).
    Both N and Tf are set afterwards, whichever was given.

    >>> PidStandard(2.0, 4.0, 1.0, N=10).Tf
    0.1
    """

    K: float
    Ti: float = math.inf
    Td: float = 0.0
    b: float = 1.0
    c: float = 0.0
    N: float = LEFT_OUT
    Tf: float = LEFT_OUT

    def __post_init__(self) -> None:
        _python_numbers(self)
        _finite(K=self.K, b=self.b, c=self.c)
        _time("Ti", self.Ti, infinite=True)
        _time("Td", self.Td)
        if self.Ti == 0:
            raise FormError("Ti = 0 s: an infinite integral gain; write Ti = inf for no integral action")
        N, Tf = self.N, self.Tf
        unfiltered = N == math.inf and Tf == 0
        if N is not None and Tf is not None and not unfiltered and not math.isclose(N * Tf, self.Td, rel_tol=1e-9):
            raise FormError(f"N = {N!r} and Tf = {Tf!r} s contradict each other (Tf = Td/N): give one of them")
        if Tf is None:
            N = math.inf if N is None else N
            if not N > 0:
                raise FormError(f"N = {N!r} must be positive: it divides Td to give the filter's time constant")
            Tf = self.Td / N
        else:
            _time("Tf", Tf)
            N = self.Td / Tf if Tf else math.inf
        object.__setattr__(self, "N", N)
        object.__setattr__(self, "Tf", Tf)

    def latex(self) -> str:
        """The law with its numbers, in LaTeX."""
        return standard_formula(self.K, self.Ti, self.Td, self.Tf, self.b, self.c)

    def parallel(self) -> PidParallel:
        """P = K, I = K/Ti, D = K Td, and the pole N = 1/Tf in rad/s."""
        pole = 1 / self.Tf if self.Tf else math.inf
        return PidParallel(self.K, self.K / self.Ti, self.K * self.Td, pole, self.b, self.c)

    def standard(self) -> "PidStandard":
        return self

    def series(self) -> "PidSeries":
        """The same feedback path as a product, filter included.

            (Ti' - a)(a - Tf) = Td' Ti',   Ti = a,  Td = Ti' - a,  K = K' a/Ti'       (primes: standard form)

        the larger root a. It exists only where the zeros are real: (Ti + Tf)^2 >= 4 Ti (Td + Tf), which without a
        filter is Ti >= 4 Td. Raises FormError otherwise, and for weights other than b = c = 1, which a series form
        cannot carry (derivative action on the measurement is lost; set them to 1 first if that is meant).
        """
        if self.Td and (self.b, self.c) != (1.0, 1.0):
            raise FormError(f"b = {self.b}, c = {self.c}: the series form acts on the error, that is b = c = 1")
        if math.isinf(self.Ti) or self.Td == 0:
            return PidSeries(self.K, self.Ti, self.Td, Tf=self.Tf)
        half = (self.Ti + self.Tf) / 2
        root = half**2 - self.Ti * (self.Td + self.Tf)
        if root < 0:
            raise FormError(
                f"Ti = {self.Ti} s, Td = {self.Td} s: the zeros are complex and a series form has real ones; "
                f"it needs (Ti + Tf)^2 >= 4 Ti (Td + Tf), without a filter Ti >= 4 Td"
            )
        a = half + math.sqrt(root)
        return PidSeries(self.K * a / self.Ti, a, self.Ti - a, Tf=self.Tf)


@dataclass(frozen=True)
class PidSeries(_Form):
    """u = K (1 + 1/(s Ti)) (1 + s Td/(1 + s Tf)) (r - y), the form of pneumatic controllers.

    K [u/y], Ti [s] > 0 or inf, Td [s] >= 0; filter Tf [s], or N with Tf = Td/N, or none.

    >>> PidSeries(1.0, 4.0, 1.0).standard()
    PidStandard(K=1.25, Ti=5.0, Td=0.8, b=1.0, c=1.0, N=inf, Tf=0.0)
    """

    K: float
    Ti: float = math.inf
    Td: float = 0.0
    N: float = LEFT_OUT
    Tf: float = LEFT_OUT

    def __post_init__(self) -> None:
        _python_numbers(self)
        checked = PidStandard(self.K, self.Ti, self.Td, N=self.N, Tf=self.Tf)
        object.__setattr__(self, "N", checked.N)
        object.__setattr__(self, "Tf", checked.Tf)

    def latex(self) -> str:
        """The law with its numbers, in LaTeX."""
        return series_formula(self.K, self.Ti, self.Td, self.Tf)

    def standard(self) -> PidStandard:
        """K' = K (1 + Td/Ti), Ti' = Ti + Td, Td' = Td (Ti - Tf)/(Ti + Td), the filter unchanged: exact with filter.

        Raises FormError where Tf > Ti (the product then has no derivative action to write down).
        """
        if math.isinf(self.Ti):
            return PidStandard(self.K, self.Ti, self.Td, 1.0, 1.0, Tf=self.Tf)
        if self.Td and self.Tf > self.Ti:
            raise FormError(f"Tf = {self.Tf} s > Ti = {self.Ti} s: the standard form's Td would be negative")
        Ti = self.Ti + self.Td
        Td = self.Td * (self.Ti - self.Tf) / Ti
        return PidStandard(self.K * Ti / self.Ti, Ti, Td, 1.0, 1.0, Tf=self.Tf)

    def parallel(self) -> PidParallel:
        return self.standard().parallel()

    def series(self) -> "PidSeries":
        return self
