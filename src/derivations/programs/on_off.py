"""On-off control with hysteresis as a program: two outputs, and the last one stays while |e| <= hysteresis.

Source of the law: pid-report, chapter 2.
"""

from functools import cache

from sympy import Symbol

from derivations.programs import shared_operations as shared
from derivations.programs.form import Assign, BlockProgram, Do, If, Operation, Variable
from derivations.programs.frozen import Both, Negative, Unless, finite, freeze, relation
from derivations.programs.pid_variables import (
    FLAGS,
    SIGNALS,
    STATES,
    ZERO,
    bad_measurement,
    e,
    limited_high,
    limited_low,
    manual,
    refused,
    u,
    u_high,
    u_low,
    u_manual,
    valid,
    y,
    ysp,
)

hysteresis, u_0 = Symbol("hysteresis"), Symbol("u_0", real=True)
SETTINGS = (
    Variable(hysteresis, about="half width of the band of e in which the output stays, >= 0"),
    Variable(u_low, about="output for e < -hysteresis"),
    Variable(u_high, about="output for e > hysteresis, above u_low"),
)


def step() -> Operation:
    """Manual, held, or switched by the error."""
    switch = (
        Assign(e, freeze(ysp - y)),
        If(
            relation(e, ">", hysteresis),
            (Assign(u, u_high),),
            (If(relation(e, "<", Negative(hysteresis)), (Assign(u, u_low),)),),
        ),
    )
    return Operation(
        "step",
        "One sample: reads the measurement, returns the output.",
        (
            *shared.lowered(limited_low, limited_high),
            *shared.measured(y, ysp),
            If(manual, (Assign(u, u_manual),), (If(Unless(bad_measurement), switch),)),
            Do("limit"),
        ),
        arguments=(SIGNALS[ysp], SIGNALS[y]),
        result=u,
    )


def begin() -> Operation:
    """The output that is found stays until the error leaves the band."""
    return Operation(
        "start",
        "Starts with the output that is found; it stays until the error leaves the band.",
        (
            *shared.lowered(limited_low, limited_high),
            *shared.measured(u_0),
            If(Unless(bad_measurement), (Assign(u, u_0), Do("limit"))),
        ),
        arguments=(Variable(u_0, about="where the actuator stands"),),
    )


@cache
def program() -> BlockProgram:
    """The controller with all its operations."""
    states = tuple(v for v in STATES if v.symbol in (u, e, u_manual, manual))
    flags = tuple(f for f in FLAGS if f.symbol in (limited_low, limited_high, bad_measurement, refused))
    ranges = (
        Both(finite(SETTINGS[0].new), relation(SETTINGS[0].new, ">=", 0)),
        Both(finite(SETTINGS[1].new, SETTINGS[2].new), relation(SETTINGS[1].new, "<", SETTINGS[2].new)),
    )
    change = Operation(
        "change",
        "Takes new settings. False: out of range, the old ones are kept.",
        (Do("in_range"), If(valid, (Do("adopt"),)), Assign(refused, Unless(valid))),
        result=valid,
        takes_settings=True,
    )
    return BlockProgram(
        "on-off controller",
        "u = u_high for e > hysteresis, u_low for e < -hysteresis, as it was between (pid-report, chapter 2).",
        SETTINGS,
        (),
        states,
        flags,
        (
            shared.in_range(*ranges),
            shared.adopt(SETTINGS),
            shared.limit(),
            shared.reset(states[1:], flags, Assign(u, u_low), about="As after init: the lower output, flags down."),
            shared.init(),
            begin(),
            shared.set_manual(),
            change,
            step(),
        ),
        u,
        defaults={hysteresis.name: ZERO},
    )
