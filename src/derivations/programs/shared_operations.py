"""Operations that every controller has: limits, the operator's output, the cycle, what a bad measurement is."""

from sympy import Basic, Integer, Symbol

from derivations.programs.form import BOOL, COUNT, Assign, Do, If, Operation, Variable
from derivations.programs.frozen import FALSE, TRUE, Both, Either, Plus, Times, Unless, finite, relation
from derivations.programs.pid_variables import (
    ZERO,
    bad_measurement,
    elapsed,
    h,
    limited_high,
    limited_low,
    manual,
    on,
    u,
    u_high,
    u_low,
    u_manual,
    u_wanted,
    valid,
    wrong_cycle,
)


def in_range(*ranges: Basic) -> Operation:
    """New settings are within these ranges; NaN is in none, because no comparison holds for it."""
    first, *rest = ranges
    body = (Assign(valid, first), *(Assign(valid, Both(valid, inside)) for inside in rest))
    return Operation(
        "in_range",
        "Are new settings within their ranges?",
        body,
        locals=(Variable(valid, BOOL),),
        result=valid,
        takes_settings=True,
        public=False,
        pure=True,
    )


def positive_and_finite(time: Symbol) -> Basic:
    return Both(finite(time), relation(time, ">", 0))


def adopt(settings: tuple[Variable, ...], *gains: Assign | If | Do) -> Operation:
    """Settings are taken and the gains computed."""
    taken = (Assign(s.symbol, s.new) for s in settings)
    return Operation(
        "adopt", "Takes settings and computes the gains.", (*taken, *gains), takes_settings=True, public=False
    )


def limit() -> Operation:
    high = (Assign(u, u_high), Assign(limited_high, TRUE))
    low = (Assign(u, u_low), Assign(limited_low, TRUE))
    body = (If(relation(u, ">", u_high), high, (If(relation(u, "<", u_low), low),)),)
    return Operation("limit", "Keeps u within its limits (eq. 4.2).", body, public=False)


def lowered(*flags: Symbol) -> tuple[Assign, ...]:
    """These flags are down."""
    return tuple(Assign(flag, FALSE) for flag in flags)


def measured(*signals: Symbol) -> tuple[Assign, ...]:
    """bad_measurement: one of the signals is no finite number."""
    first, *rest = signals
    more = (Assign(bad_measurement, Either(bad_measurement, Unless(finite(signal)))) for signal in rest)
    return Assign(bad_measurement, Unless(finite(first))), *more


def reset(states: tuple[Variable, ...], flags: tuple[Variable, ...], *more: Assign | Do, about: str) -> Operation:
    """All states and flags as at the first moment, then whatever else."""
    zeros = (Assign(s.symbol, FALSE if s.type == BOOL else ZERO) for s in states if s.type != COUNT and not s.size)
    return Operation("reset", about, (*zeros, *lowered(*(f.symbol for f in flags)), *more))


def init() -> Operation:
    return Operation(
        "init",
        "Takes the settings and resets. False: settings out of range, nothing is touched.",
        (Do("in_range"), If(valid, (Do("adopt"), Do("reset")))),
        result=valid,
        takes_settings=True,
    )


def set_manual() -> Operation:
    """An output that is no number leaves the actuator where it is."""
    take = If(finite(u_wanted), (Assign(u_manual, u_wanted),), (Assign(u_manual, u),))
    return Operation(
        "manual",
        "The operator sets the output (NaN: where it is); back in automatic the first step keeps it.",
        (If(on, (Assign(manual, TRUE), take), (Assign(manual, FALSE),)),),
        arguments=(Variable(on, BOOL, "manual or automatic"), Variable(u_wanted, about="output in manual")),
    )


def cycle() -> Operation:
    """Right is more than half of h and less than one and a half: the sample that was meant, not its neighbour."""
    double, triple = Plus(elapsed, elapsed), Times(Integer(3), h)
    right = Both(relation(double, ">", h), relation(double, "<", triple))
    return Operation(
        "cycle",
        "Compares the measured time since the last step with h.",
        (Assign(wrong_cycle, Both(relation(elapsed, "!=", 0), Unless(right))),),
        arguments=(Variable(elapsed, about="measured time since the last step, s; 0: not measured"),),
    )
