"""One sample of the whole PID controller, from the measurement to the states of the next sample."""

from sympy import Expr

from derivations.programs import pid_code as code
from derivations.programs import start
from derivations.programs.form import BOOL, Assign, Do, If, Operation, Statement, Variable
from derivations.programs.frozen import (
    FALSE,
    TRUE,
    Both,
    Condition,
    Either,
    Minus,
    Plus,
    Unless,
    all_of,
    any_of,
    finite,
    freeze,
    relation,
)
from derivations.programs.pid_variables import (
    MOMENTARY,
    SIGNALS,
    ZERO,
    I,
    I_lost,
    I_next,
    I_sum,
    arriving,
    bad_measurement,
    conditional,
    e,
    held,
    increment,
    lost_next,
    manual,
    outward,
    overflow,
    r,
    rate_limited,
    rate_step,
    started,
    u,
    u_ff,
    u_last,
    u_manual,
    v,
    v_next,
    x,
    x_next,
    x_now,
    y,
    y_last,
    ysp,
    ysp_last,
)
from derivations.programs.shared_operations import lowered, measured


def law() -> tuple[Assign, Assign]:
    """r, which is v without I, and the derivative state at rest."""
    return Assign(r, freeze(start.all_but_integral()), "4.20"), Assign(
        x, freeze(start.derivative_state_short()), "rest"
    )


def integral_for(output: Expr) -> Expr:
    """The I for which v is this output, from r: output - r, equal to the derived one."""
    tree = Minus(output, r)
    wanted = start.integral_from(output)
    if (output - start.all_but_integral() - wanted).expand() != 0:
        raise ArithmeticError(f"I = {tree} is not {wanted}")
    return tree


def begin_again() -> tuple[Assign, ...]:
    """States beyond the machine's range: the next good sample starts from rest and keeps the output."""
    values = ((I, ZERO), (x, ZERO), (started, FALSE), (arriving, TRUE))
    return tuple(Assign(state, value) for state, value in values)


def step(compensated: bool) -> Operation:
    value, rest = law()
    update = code.weighted().assigned(x)
    tracked = code.weighted().assigned(I)
    used = (
        If(started, (Assign(x_now, x),), (Assign(x_now, rest.value, rest.equation),)),
        Assign(r, value.value.xreplace({x: x_now}), value.equation),
        Assign(v_next, Plus(r, I), "4.20"),
        Assign(x_next, freeze(update).xreplace({x: x_now}), "4.16"),
        If(Unless(finite(v_next, x_next)), (Assign(overflow, TRUE), Assign(held, TRUE))),
    )
    kept = If(Either(held, arriving), (Assign(v_next, u_last),))
    fast = If(
        relation(u, ">", Plus(u_last, rate_step)),
        (Assign(u, Plus(u_last, rate_step)), Assign(rate_limited, TRUE)),
        (
            If(
                relation(u, "<", Minus(u_last, rate_step)),
                (Assign(u, Minus(u_last, rate_step)), Assign(rate_limited, TRUE)),
            ),
        ),
    )
    limited_rate = If(all_of(relation(rate_step, ">", 0), Unless(manual), Unless(held)), (fast,))
    return Operation(
        "step",
        "One sample: reads the measurement, returns the output.",
        (
            *lowered(*MOMENTARY),
            Assign(u_last, u),
            *measured(y, ysp, u_ff),
            Assign(held, bad_measurement),
            *(Assign(local, ZERO) for local in (r, x_next, v_next)),
            If(Unless(held), used),
            If(manual, (Assign(v_next, u_manual),), (kept,)),
            Assign(u, v_next),
            limited_rate,
            Do("limit"),
            If(Unless(held), _after(tracked, compensated)),
            Assign(arriving, Either(manual, Both(arriving, held))),
        ),
        arguments=(SIGNALS[ysp], SIGNALS[y], SIGNALS[u_ff]),
        locals=(
            Variable(held, BOOL),
            Variable(outward, BOOL),
            *(Variable(s) for s in (u_last, r, x_now, x_next, v_next, I_next, increment)),
            *((Variable(lost_next), Variable(I_sum)) if compensated else ()),
        ),
        result=u,
    )


def _after(tracked: Expr, compensated: bool) -> tuple[Statement, ...]:
    """What moves once the output is set: the integral, the derivative's state, what is remembered."""
    step = freeze((tracked - I).xreplace({v: v_next}))
    lost = (Assign(lost_next, ZERO),) if compensated else ()
    beyond: Condition = any_of(
        Both(relation(v_next, ">", u), relation(increment, ">", 0)),
        Both(relation(v_next, "<", u), relation(increment, "<", 0)),
    )
    automatic = (
        If(arriving, (Assign(I_next, integral_for(v_next)),), (Assign(I_next, I),)),
        Assign(increment, step, "4.5"),
        Assign(outward, beyond),
        If(Both(conditional, outward), (Assign(increment, ZERO),)),
        *(_compensated_sum() if compensated else (Assign(I_next, Plus(I_next, increment), "4.5"),)),
    )
    commit = (
        Assign(x, x_next),
        Assign(I, I_next),
        Assign(v, v_next),
        Assign(y_last, y),
        Assign(ysp_last, ysp),
        Assign(e, freeze(ysp - y)),
        Assign(started, TRUE),
        *((Assign(I_lost, lost_next),) if compensated else ()),
    )
    return (
        If(manual, (Assign(I_next, integral_for(u)), *lost), automatic),
        If(finite(I_next), commit, (Assign(overflow, TRUE), Assign(held, TRUE))),
    )


def _compensated_sum() -> tuple[Statement, ...]:
    """I + increment with what rounding lost remembered for the next sample (Kahan, 1965)."""
    return (
        If(arriving, (Assign(I_lost, ZERO),)),
        Assign(increment, Minus(increment, I_lost)),
        Assign(I_sum, Plus(I_next, increment), "4.5"),
        Assign(lost_next, Minus(Minus(I_sum, I_next), increment)),
        Assign(I_next, I_sum),
    )
