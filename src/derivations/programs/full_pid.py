"""The whole PID controller as a program: limits, rate, anti-windup, manual, bumpless changes, bad measurements, flags.

The law is figure 4.13 of pid-report with a weight c on the derivative (`derivations.programs.pid_code.weighted`) and a
feedforward signal; the states after a change are those of `derivations.programs.bumpless`, those at rest of
`derivations.programs.start`. What is added here is the order in which things happen and what happens in which mode.

    Ti = 0 or infinite    no integral action: I is what the start, or the return from manual, left in it
    Tt = 0                conditional integration: I stands still where it would drive u further beyond its limit
    Tt infinite           no anti-windup
    rate = 0 or infinite  no limit of the rate
"""

from functools import cache

from sympy import Integer, Symbol

from derivations.programs import bumpless, pid_step, start
from derivations.programs import pid_code as code
from derivations.programs import shared_operations as shared
from derivations.programs.form import Assign, BlockProgram, Do, If, Operation, Variable
from derivations.programs.frozen import (
    FALSE,
    TRUE,
    Both,
    Condition,
    Either,
    Plus,
    Times,
    Unless,
    finite,
    freeze,
    relation,
)
from derivations.programs.pid_variables import (
    FLAGS,
    GAINS,
    MOMENTARY,
    SETTINGS,
    SIGNALS,
    STATES,
    ZERO,
    I,
    I_lost,
    I_next,
    K,
    Td,
    Tf,
    Ti,
    Tt,
    arriving,
    b,
    bad_measurement,
    c,
    conditional,
    e,
    h,
    manual,
    overflow,
    p1,
    p2,
    p3,
    p4,
    p5,
    p6,
    p24,
    r,
    rate,
    rate_step,
    refused,
    started,
    u,
    u_ff,
    v,
    valid,
    x,
    x_next,
    y,
    y_last,
    ysp,
    ysp_last,
)

RESET = "As after init: no sample seen, I = 0, flags down, u as near 0 as its limits allow."


def ranges() -> tuple[Condition, ...]:
    """What new settings must be."""
    k, ti, td, tf, weight_p, weight_d, tt, step, low, high, slope = (s.new for s in SETTINGS)
    return (
        Both(finite(k), Either(relation(k, ">", 0), relation(k, "<", 0))),
        relation(ti, ">=", 0),
        *(Both(finite(time), relation(time, ">=", 0)) for time in (td, tf)),
        *(Both(relation(weight, ">=", 0), relation(weight, "<=", 1)) for weight in (weight_p, weight_d)),
        shared.positive_and_finite(step),
        Either(relation(tt, "==", 0), relation(Plus(tt, tt), ">", step)),
        relation(low, "<", high),
        relation(slope, ">=", 0),
    )


def gains() -> tuple[Assign | If, ...]:
    """p_1 to p_6 and p_24 from the settings in force."""
    values = code.weighted().gain_values() | {p24: code.derivative_gain()}
    labels = {a.target: a.equation for a in code.weighted().gains} | {p24: "4.12"}

    def gain(symbol: Symbol) -> Assign:
        return Assign(symbol, freeze(values[symbol]), labels[symbol])

    def guarded(symbol: Symbol, time: Symbol) -> If:
        return If(relation(time, ">", 0), (gain(symbol),), (Assign(symbol, ZERO),))

    return (
        *(gain(symbol) for symbol in (p24, p1, p2, p3, p4)),
        guarded(p5, Ti),
        guarded(p6, Tt),
        Assign(rate_step, Times(rate, h)),
        Assign(conditional, relation(Tt, "==", 0)),
    )


def bumpless_change() -> tuple[tuple[Assign, ...], If]:
    """What to keep of the old gains, and x and I with the new ones: D and P + I of the last sample stay."""
    moved = bumpless.keep_both_parts()
    old = {Symbol("c_old", nonnegative=True): c, Symbol("p_24old"): p24, bumpless.OLD[K]: K, bumpless.OLD[b]: b}
    before = {symbol: Symbol(f"{setting.name.replace('_', '')}_old") for symbol, setting in old.items()}
    after = {
        bumpless.NEW[K]: K,
        bumpless.NEW[b]: b,
        Symbol("p_24new"): p24,
        Symbol("c_new", nonnegative=True): c,
        y: y_last,
        ysp: ysp_last,
    }

    def moved_by_change(target: Symbol, state: Symbol, equation: str) -> Assign:
        return Assign(target, freeze(moved[state].xreplace(before | after), first=state), equation)

    keep = tuple(Assign(symbol, old[known]) for known, symbol in before.items())
    shift = (
        moved_by_change(x_next, x, "bumpless"),
        moved_by_change(I_next, I, "4.10"),
        If(finite(x_next, I_next), (Assign(x, x_next), Assign(I, I_next)), pid_step.begin_again()),
    )
    return keep, If(started, shift)


def change_locals() -> tuple[Variable, ...]:
    """The locals of `bumpless_change`."""
    keep, _ = bumpless_change()
    return (*(Variable(a.target) for a in keep), Variable(x_next), Variable(I_next))


def change() -> Operation:
    keep, shift = bumpless_change()
    return Operation(
        "change",
        "Takes new settings without a jump of the output. False: out of range, the old ones are kept.",
        (Do("in_range"), If(valid, (*keep, Do("adopt"), shift)), Assign(refused, Unless(valid))),
        locals=change_locals(),
        result=valid,
        takes_settings=True,
    )


def begin(compensated: bool) -> Operation:
    value, rest = pid_step.law()
    moved = (
        Assign(u, start.u0),
        Do("limit"),
        rest,
        value,
        Assign(I, pid_step.integral_for(u), "rest"),
        *(Assign(target, s) for target, s in ((v, u), (y_last, y), (ysp_last, ysp))),
        Assign(e, freeze(ysp - y)),
        *(Assign(flag, state) for flag, state in ((manual, FALSE), (started, TRUE), (arriving, TRUE))),
        *((Assign(I_lost, ZERO),) if compensated else ()),
        If(Unless(finite(x, I)), (*pid_step.begin_again(), Assign(overflow, TRUE))),
    )
    return Operation(
        "start",
        "Starts from rest: the first step returns u0, whatever its error is.",
        (*shared.lowered(*MOMENTARY), *shared.measured(y, ysp, start.u0, u_ff), If(Unless(bad_measurement), moved)),
        arguments=(
            SIGNALS[y],
            SIGNALS[ysp],
            Variable(start.u0, about="where the actuator stands"),
            SIGNALS[u_ff],
        ),
        locals=(Variable(r),),
    )


DEFAULTS = {c.name: ZERO, b.name: Integer(1), Td.name: ZERO, Tf.name: ZERO, rate.name: ZERO}


@cache
def program(compensated: bool = False) -> BlockProgram:
    """The controller with all its operations. compensated: the integral remembers what rounding takes from it."""
    states = (*STATES, Variable(I_lost, about="what rounding added to I too much")) if compensated else STATES
    return BlockProgram(
        "PID controller",
        "u = K (b y_sp - y) + I + D + feedforward, limited; derivative filtered, sampled every h seconds.",
        SETTINGS,
        GAINS,
        states,
        FLAGS,
        (
            shared.in_range(*ranges()),
            shared.adopt(SETTINGS, *gains()),
            shared.limit(),
            shared.reset(states, FLAGS, Do("limit"), about=RESET),
            shared.init(),
            begin(compensated),
            shared.set_manual(),
            change(),
            shared.cycle(),
            pid_step.step(compensated),
        ),
        u,
        defaults=DEFAULTS,
    )
