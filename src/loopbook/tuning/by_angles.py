"""A PID controller for a wanted phase margin at a wanted crossover frequency, exact with dead time.

Formulas: `derivations.tuning.pid_by_angles`. The two angles that are left over, those of one zero and of the filter's
pole, are choices; what `double-tank` prints as the outcome of a tool has them at pi/4 and 0.00875 rad.
"""

from fractions import Fraction
from math import pi, radians
from typing import Any, NamedTuple

from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidParallel
from loopbook.lazy import late
from loopbook.loop.continuous import Loop
from loopbook.process.transfer_function import Process
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule

by_angles = late("derivations.tuning.pid_by_angles")

SOURCE = "a zero and a pole by their angles at the crossover frequency; double-tank, the fine-tuned PID"


def parameters(
    process: Process, w: Any, phase_margin: Any, zero: Any = None, pole: Any = 0, digits: int = 30
) -> dict[str, Fraction]:
    """P [u/y], I [u/(y s)], D [u s/y] and N [rad/s] of the parallel form, to `digits` significant digits.

    process: its num, den and delay are taken as the short fractions that the floats stand for (1/8360, not its
    nearest double). w: crossover frequency [rad/s] > 0. phase_margin, zero, pole: angles [rad]; zero defaults to
    pi/4. SymPy numbers (sympy.pi/3), fractions and decimals in quotes are exact, floats are what they are.
    With the phase phi_p of the process at w, the free angle is b = phase_margin - phi_p - pi/2 - zero + pole.
    Raises RuleDoesNotApply where b lies outside (0, pi/2): the regulator would need more lead than one zero gives, or
    lag.
    """
    import mpmath
    import sympy

    with mpmath.workdps(digits + 10):
        number = lambda v: mpmath.mpf(str(sympy.N(sympy.sympify(v, strict=True), digits + 10)))  # noqa: E731
        w, margin, f, a = (number(v) for v in (w, phase_margin, sympy.pi / 4 if zero is None else zero, pole))
        at = mpmath.mpc(0, w)
        num, den = ([_decimal(c) for c in row] for row in (process.num, process.den))
        value = mpmath.polyval(num, at) / mpmath.polyval(den, at)
        phase = mpmath.arg(value) - w * _decimal(process.delay)
        b = mpmath.mpf(
            sympy.lambdify([by_angles.phase, by_angles.margin, by_angles.f, by_angles.a], by_angles.lead(), "mpmath")(
                phase, margin, f, a
            )
        )
        if not 0 < b < mpmath.pi / 2:
            raise RuleDoesNotApply(
                f"a phase margin of {float(margin) * 180 / pi:.6g} degrees at {float(w):.6g} rad/s asks for the angle "
                f"{float(b) * 180 / pi:.6g} degrees of the second zero; a PID controller gives 0 to 90"
            )
        symbols = [by_angles.w, by_angles.k, by_angles.f, by_angles.b, by_angles.a]
        run = sympy.lambdify(symbols, list(by_angles.parallel().values()), "mpmath")
        found = run(w, 1 / abs(value), f, b, a)
        return {n: Fraction(mpmath.nstr(v, digits)) for n, v in zip(by_angles.parallel(), found, strict=True)}


def _decimal(value: float) -> Any:
    """The float as the short decimal or the simple fraction that it stands for."""
    import mpmath

    exact = Fraction(value).limit_denominator(10**7)
    if float(exact) != value:
        exact = Fraction(value)
    return mpmath.mpf(exact.numerator) / exact.denominator


def pid(process: Process, w: Any, phase_margin: Any, zero: Any = None, pole: Any = 0.01) -> PidParallel:
    """The same as a controller, all parts acting on the error.

    >>> from loopbook.loop.continuous import Loop
    >>> plant = Process.fopdt(1, 5, 2)
    >>> round(Loop(plant, pid(plant, 0.3, pi / 3)).margins().phase, 9)
    60.0
    """
    return PidParallel(
        **{name: float(value) for name, value in parameters(process, w, phase_margin, zero, pole).items()}
    )


class Angles(NamedTuple):
    """A controller read as angles at its crossover frequency: w [rad/s], margin, zero, lead, pole [rad], b = lead."""

    w: float
    margin: float
    zero: float
    lead: float
    pole: float


def angles_of(process: Process, controller: PidParallel) -> Angles:
    """The crossover frequency of the loop and the angles of the controller's zeros and pole there.

    zero is the smaller angle of the two zeros, lead the larger one. Raises RuleDoesNotApply where the zeros are
    complex or the loop has not exactly one crossover frequency.
    """
    import numpy as np

    crossovers = Loop(process, controller).margins().gain_crossovers
    zeros = np.roots(controller.transfer()[0])
    if len(crossovers) != 1 or len(zeros) != 2 or np.iscomplex(zeros).any() or (zeros.real >= 0).any():
        raise RuleDoesNotApply("angles are defined for two real negative zeros and one crossover frequency")
    w = crossovers[0].w
    zero, lead = sorted(float(x) for x in np.arctan(w / -zeros.real))
    return Angles(w, float(np.radians(crossovers[0].phase_margin)), zero, lead, float(np.arctan(w / controller.N)))


def _settings(data: ProcessData, w: float, phase_margin: float, zero: float = 45.0, pole: float = 0.6) -> Tuning:
    """The rule with angles in degrees, as margins are given."""
    found = pid(data.upright(), w, *(radians(angle) for angle in (phase_margin, zero, pole)))
    return Tuning(found.standard(), "phase-margin-pid", SOURCE)


def computed() -> tuple[TuningRule, ...]:
    """The rule of the family that has this margin at this frequency, with a filter in its settings."""
    options = {
        "w": "the crossover frequency [rad/s]",
        "phase_margin": "there [degrees]",
        "zero": "the angle of one zero there [degrees], default 45",
        "pole": "the angle of the filter's pole there [degrees], default 0.6",
    }
    return (
        TuningRule(
            "phase-margin-pid",
            "phase margin, PID",
            Takes.PROCESS,
            "PID",
            None,
            "a phase margin at a crossover frequency",
            None,
            SOURCE,
            _settings,
            options,
            ("w", "phase_margin"),
            text="C(s) G(s) has magnitude 1 and the phase margin at i w, exact with dead time",
        ),
    )
