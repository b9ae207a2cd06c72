"""Run difference equations as they were derived: sample by sample, exactly with fractions or fast with floats.

    y(k) = -a1 y(k-1) - a2 y(k-2) + b3 u(k-3) + b4 u(k-4)

comes as a SymPy equation; `recursion` puts numbers in and `simulate` runs several of them in the order given, with
every signal zero before the first sample.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivations.errors import LoopbookError
from loopbook.numerics.rational_numbers import function


class DifferenceEquationError(LoopbookError):
    """A difference equation cannot be run; the message names the signal or the symbol."""


@dataclass(frozen=True)
class Recursion:
    """target(k) = sum of gain * signal(k - delay); terms: (signal, delay, gain), gains of one number type."""

    target: str
    terms: tuple[tuple[str, int, Any], ...]


def recursion(equation: Any, values: Mapping[str, Any], number: Callable | None = None) -> Recursion:
    """Put numbers into a difference equation.

    equation: SymPy Eq with target(k) on the left and a linear combination of signal(k - i), i >= 0, on the right.
    values: symbol name -> int, Fraction or float; fractions stay exact. number: the type of the gains, for example
    float to run fast; default as they come. Raises DifferenceEquationError for a
    symbol without a value, a term that is not linear, and a future sample.

    >>> import sympy
    >>> k, a = sympy.symbols("k a"); y, u = sympy.Function("y"), sympy.Function("u")
    >>> recursion(sympy.Eq(y(k), -a * y(k - 1) + a * u(k - 2)), {"a": 3})
    Recursion(target='y', terms=(('u', 2, 3), ('y', 1, -3)))
    """
    from sympy import expand
    from sympy.core.function import AppliedUndef

    target, now = equation.lhs.func.__name__, equation.lhs.args[0]
    right = expand(equation.rhs)
    samples = sorted(right.atoms(AppliedUndef), key=lambda s: (s.func.__name__, now - s.args[0]))
    gains = [right.coeff(s) for s in samples]
    rest = expand(right - sum(g * s for g, s in zip(gains, samples, strict=True)))
    if rest != 0 or any(g.has(AppliedUndef) for g in gains):
        raise DifferenceEquationError(
            f"{target}: the right side must be linear in its samples without a constant; {rest} is not"
        )
    names = sorted({x.name for g in gains for x in g.free_symbols})
    if missing := [n for n in names if n not in values]:
        raise DifferenceEquationError(
            f"{target}: no value for {', '.join(missing)}; given: {', '.join(values) or 'none'}"
        )
    delays = [now - s.args[0] for s in samples]
    for s, delay in zip(samples, delays, strict=True):
        if not delay.is_Integer or delay < 0:
            raise DifferenceEquationError(f"{target}: {s} is no present or earlier sample of {now}")
    symbols = sorted({x for g in gains for x in g.free_symbols}, key=lambda x: x.name)
    numbers = function(symbols, gains)(*(values[x.name] for x in symbols))
    parts = zip(samples, delays, map(number, numbers) if number else numbers, strict=True)
    return Recursion(target, tuple((s.func.__name__, int(d), g) for s, d, g in parts))


def run_recursion(equations: Sequence[Recursion], inputs: Mapping[str, Sequence[Any]], steps: int) -> dict[str, list]:
    """Run the recursions together for k = 0, ..., steps - 1; everything before k = 0 is zero.

    equations: in the order in which a regulator executes them (measure y, then compute u). inputs: the other signals
    as sequences of at least ``steps`` values. Returns every signal as a list. Raises DifferenceEquationError for a
    signal that nothing computes, a short input, and a present sample that is computed only later in the same step.

    >>> y = Recursion("y", (("y", 1, 0.5), ("r", 1, 0.5)))
    >>> run_recursion([y], {"r": [1] * 4}, 4)["y"]
    [0, 0.5, 0.75, 0.875]
    """
    order = [e.target for e in equations]
    known = set(inputs)
    for equation in equations:
        for signal, delay, _ in equation.terms:
            if signal not in inputs and signal not in order:
                raise DifferenceEquationError(
                    f"{equation.target} needs {signal}, which nothing computes and no input gives"
                )
            if delay == 0 and signal not in known:
                raise DifferenceEquationError(
                    f"{equation.target}(k) needs {signal}(k), which is computed later: an algebraic loop"
                )
        known.add(equation.target)
    for name, values in inputs.items():
        if len(values) < steps:
            raise DifferenceEquationError(f"input {name} has {len(values)} samples, {steps} are needed")
    signals: dict[str, list] = {name: list(values[:steps]) for name, values in inputs.items()}
    signals |= {name: [] for name in order}
    for k in range(steps):
        for equation in equations:
            past = (gain * signals[name][k - delay] for name, delay, gain in equation.terms if k >= delay)
            signals[equation.target].append(sum(past))
    return signals
