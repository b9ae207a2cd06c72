"""A linear continuous regulator with two degrees of freedom.

    R(s) u = T(s) r - S(s) y

One denominator R serves both paths, so that an integrator stands once and not once per path. With one degree of
freedom T = S. The discrete counterpart with the same three polynomials in z is `loopbook.controllers.rst`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from loopbook.numerics import polynomial_text
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.real_numbers import plain_number
from loopbook.process import formulas
from loopbook.process.transfer_function import Process, ProcessError, checked_coefficients

ON_AXIS = 1e-10


@dataclass(frozen=True)
class Regulator:
    """The polynomials T, S, R, descending real coefficients in s.

    S/R may have one zero more than poles (an ideal derivative); what that allows is said where it is used.
    Raises ProcessError where R is zero or a coefficient is not a finite real number.

    >>> pi = Regulator.one_dof([2, 1], [1, 0])
    >>> complex(pi.feedback(1j))
    (2-1j)
    """

    T: tuple[float, ...]
    S: tuple[float, ...]
    R: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("T", "S", "R"):
            object.__setattr__(self, name, checked_coefficients(getattr(self, name), name))
        if self.R == (0.0,):
            raise ProcessError("R is zero: a regulator needs a denominator")

    @classmethod
    def one_dof(cls, num: Sequence[float], den: Sequence[float]) -> "Regulator":
        """u = num/den (r - y)."""
        return cls(tuple(num), tuple(num), tuple(den))

    @classmethod
    def of(cls, regulator: Any) -> "Regulator":
        """From anything that regulates: a Regulator, a PID form, a `Process` without dead time, a number (P)."""
        if isinstance(regulator, cls):
            return regulator
        if hasattr(regulator, "regulator"):
            return regulator.regulator()
        if isinstance(regulator, Process):
            if regulator.delay:
                raise ProcessError(f"the regulator has a dead time of {regulator.delay} s: put it into the process")
            return cls.one_dof(regulator.num, regulator.den)
        if hasattr(regulator, "num") and hasattr(regulator, "ninputs"):
            return cls.of(Process.from_control(regulator))
        try:
            gain = float(plain_number(regulator))
        except TypeError:
            kind = type(regulator).__name__
            raise ProcessError(
                f"{kind} is no regulator: give a Regulator, a PID form of loopbook.controllers.pid_forms or a number"
            ) from None
        return cls.one_dof((gain,), (1.0,))

    def latex(self) -> str:
        """R, S and T in LaTeX, in descending powers of s."""
        rows = (f"{name} &= {polynomial_text.descending(getattr(self, name))}" for name in "RST")
        return r"\begin{aligned} " + r" \\ ".join(rows) + r" \end{aligned}"

    def _repr_latex_(self) -> str:
        return f"$${self.latex()}$$"

    def __repr__(self) -> str:
        return f"Regulator({', '.join(f'{n}={formulas.short_row(getattr(self, n))}' for n in 'TSR')})"

    @property
    def fraction(self) -> tuple[ExponentialPolynomial, ExponentialPolynomial]:
        """(S, R), which stands for it in products and sums with transfer functions: the feedback path -u/y."""
        return ExponentialPolynomial.of(self.S), ExponentialPolynomial.of(self.R)

    def feedback(self, s: Any) -> Any:
        """S/R at complex s: from the measurement, with the sign turned, to u."""
        return np.polyval(self.S, s) / np.polyval(self.R, s)

    def feedforward(self, s: Any) -> Any:
        """T/R at complex s: from the reference to u."""
        return np.polyval(self.T, s) / np.polyval(self.R, s)

    @property
    def excess(self) -> int:
        """Zeros less poles of S/R: 1 for an ideal derivative, 0 or less for what can be built."""
        return len(self.S) - len(self.R)

    @property
    def unstable_poles(self) -> np.ndarray:
        """The poles with a positive real part: not empty where the regulator by itself is unstable."""
        roots = np.roots(self.R).astype(complex)
        return roots[roots.real > ON_AXIS * abs(roots)]
