"""An RST regulator as a program: R u = T y_sp - S y in deviations from rest, with the observer form against windup.

    A_o v = T r - S y + (A_o - R) u,    u = v within the limits       (`derivations.pole_placement.rst_law`)

All signals are deviations from a point of rest (y_rest, u_rest) that `start` sets: with all past deviations zero, the
output stays where it is found for y = y_sp = y_rest, whether R holds an integrator or not. The past is a row of states
that moves on by one at each sample.
"""

from functools import cache

from sympy import Expr, Symbol
from sympy.core.function import AppliedUndef

from derivations.algebra.delay_polynomials import K as SAMPLE
from derivations.pole_placement.rst_law import law
from derivations.programs import shared_operations as shared
from derivations.programs.form import BOOL, Assign, BlockProgram, Do, If, Operation, Statement, Variable
from derivations.programs.frozen import FALSE, TRUE, Minus, Plus, Unless, finite, freeze, relation
from derivations.programs.pid_variables import (
    FLAGS,
    SIGNALS,
    STATES,
    ZERO,
    bad_measurement,
    e,
    h,
    held,
    limited_high,
    limited_low,
    manual,
    overflow,
    rate_limited,
    refused,
    u,
    u_high,
    u_low,
    u_manual,
    valid,
    y,
    y_last,
    ysp,
)
from derivations.programs.pid_variables import (
    SETTINGS as PID_SETTINGS,
)

y_rest, u_rest, y_now, sp_now, v_now, u_0 = (
    Symbol(n) for n in ("y_rest", "u_rest", "y_now", "y_sp_now", "v_now", "u_0")
)
ABOUT = {"r": "coefficient of R", "s": "coefficient of S", "t": "coefficient of T", "o": "coefficient of A_o"}
NOW = {"y": y_now, "r": sp_now, "v": v_now}
PAST = {"y": "y", "r": "y_sp", "u": "u", "v": "v"}


def past(signal: str, delay: int) -> Symbol:
    """The deviation of a signal, this many samples ago."""
    return Symbol(f"{PAST[signal]}_{delay}")


def _in_states(expr: Expr) -> tuple[Expr, dict[str, int]]:
    """The law with states for its samples, and how far back each signal goes."""
    longest: dict[str, int] = {}
    names: dict[Expr, Symbol] = {}
    for sample in expr.atoms(AppliedUndef):
        signal, delay = sample.func.__name__, int(SAMPLE - sample.args[0])
        longest[signal] = max(longest.get(signal, 0), delay)
        names[sample] = past(signal, delay) if delay else NOW[signal]
    return expr.xreplace(names), longest


@cache
def program(r: int, s: int, t: int, o: int = 0) -> BlockProgram:
    """For polynomials of these degrees, R and A_o starting with 1."""
    value, longest = _in_states(law(r, s, t, o).rhs)
    coefficients = [(letter, i) for letter, first, last in (("r", 1, r), ("s", 0, s), ("t", 0, t), ("o", 1, o))
                    for i in range(first, last + 1)]  # fmt: skip
    settings = (
        *(Variable(Symbol(f"{letter}_{i}"), about=f"{ABOUT[letter]}, {i} samples ago") for letter, i in coefficients),
        *(v for v in PID_SETTINGS if v.symbol in (h, u_low, u_high)),
    )
    rows = {signal: [past(signal, i) for i in range(1, last + 1)] for signal, last in longest.items()}
    states = (
        *(v for v in STATES if v.symbol in (u, e, y_last, u_manual, manual)),
        Variable(y_rest, about="measurement at rest"),
        Variable(u_rest, about="output at rest"),
        *(Variable(one, about=f"{PAST[n]} less its rest, {i} samples ago") for n, row in rows.items()
          for i, one in enumerate(row, 1)),
    )  # fmt: skip
    flags = tuple(f for f in FLAGS if f.symbol is not rate_limited)
    zeros = tuple(Assign(one, ZERO) for row in rows.values() for one in row)
    return BlockProgram(
        "RST regulator",
        "R u = T y_sp - S y in deviations from rest, limited, with the observer form against windup.",
        settings,
        (),
        states,
        flags,
        (
            shared.in_range(*_ranges(settings)),
            shared.adopt(settings),
            shared.limit(),
            shared.reset(states, flags, Do("limit"), about="As after init: all signals were zero, flags down."),
            shared.init(),
            _start(zeros),
            shared.set_manual(),
            _change(zeros),
            shared.cycle(),
            _step(value, rows),
        ),
        u,
    )


def _ranges(settings: tuple[Variable, ...]) -> tuple:
    bounds = {low.symbol: low.new for low in settings if low.symbol in (u_low, u_high)}
    coefficients = (finite(s.new) for s in settings if s.symbol not in (h, u_low, u_high))
    step = next(s.new for s in settings if s.symbol == h)
    return (*coefficients, shared.positive_and_finite(step), relation(bounds[u_low], "<", bounds[u_high]))


def _start(zeros: tuple[Assign, ...]) -> Operation:
    moved: tuple[Statement, ...] = (
        Assign(u, u_0),
        Do("limit"),
        Assign(y_rest, y),
        Assign(u_rest, u),
        Assign(y_last, y),
        Assign(manual, FALSE),
        *zeros,
    )
    return Operation(
        "start",
        "Starts from rest at y and u0: at y_sp = y the output stays.",
        (
            *shared.lowered(limited_low, limited_high, overflow),
            *shared.measured(y, u_0),
            If(Unless(bad_measurement), moved),
        ),
        arguments=(SIGNALS[y], Variable(u_0, about="where the actuator stands")),
    )


def _change(zeros: tuple[Assign, ...]) -> Operation:
    """The last measurement and output become the point of rest: no jump where the process stands still."""
    return Operation(
        "change",
        "Takes new settings; no jump where the process stands still. False: out of range, the old ones are kept.",
        (
            Do("in_range"),
            If(valid, (Do("adopt"), Assign(y_rest, y_last), Assign(u_rest, u), *zeros)),
            Assign(refused, Unless(valid)),
        ),
        result=valid,
        takes_settings=True,
    )


def _step(value: Expr, rows: dict[str, list[Symbol]]) -> Operation:
    computed = (
        Assign(y_now, Minus(y, y_rest)),
        Assign(sp_now, Minus(ysp, y_rest)),
        Assign(v_now, freeze(value), "R u = T r - S y"),
        If(Unless(finite(v_now)), (Assign(overflow, TRUE), Assign(held, TRUE))),
    )
    newest = {"y": y_now, "r": sp_now, "u": Minus(u, u_rest), "v": v_now}
    moved = [
        Assign(row[i], row[i - 1] if i else newest[signal])
        for signal, row in rows.items()
        for i in reversed(range(len(row)))
    ]
    return Operation(
        "step",
        "One sample: reads the measurement, returns the output.",
        (
            *shared.lowered(limited_low, limited_high, overflow),
            *shared.measured(y, ysp),
            Assign(held, bad_measurement),
            *(Assign(local, ZERO) for local in (y_now, sp_now, v_now)),
            If(Unless(held), computed),
            If(manual, (Assign(u, u_manual),), (If(Unless(held), (Assign(u, Plus(u_rest, v_now)),)),)),
            Do("limit"),
            If(Unless(held), (Assign(e, freeze(ysp - y)), Assign(y_last, y), *moved)),
        ),
        arguments=(SIGNALS[ysp], SIGNALS[y]),
        locals=(Variable(held, BOOL), *(Variable(s) for s in (y_now, sp_now, v_now))),
        result=u,
    )
