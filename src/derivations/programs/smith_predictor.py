"""A Smith predictor as a program: the PID controller acts on what the process would show without its dead time.

    y_seen = y + x_m(k) - x_m(t - L)

where x_m is the output of the model Kp/(1 + s T) without dead time, computed from the outputs that were set.

The delayed value is exact for any dead time L, whole samples or not: with d = ceil(L/h) and what is over, d h - L,

    x_m(t_k - L) = q x_m(k - d) + Kp (1 - q) u(k - d),    q = exp(-(d h - L)/T)

so that one number a sample goes into a ring buffer of d places. The model works in deviations from the output at rest.
"""

from functools import cache

from sympy import Eq, Expr, Function, Integer, Symbol, dsolve, exp, symbols

from derivations.programs import full_pid
from derivations.programs import shared_operations as shared
from derivations.programs.form import COUNT, Assign, BlockProgram, Fill, If, Operation, Statement, Variable
from derivations.programs.frozen import Both, Element, Minus, Plus, Unless, Whole, finite, freeze, relation
from derivations.programs.pid_variables import SETTINGS, ZERO, bad_measurement, e, held, u, y, ysp

model_gain, model_pole, model_part = (Symbol(n) for n in ("model_gain", "model_pole", "model_part"))
x_model, u_rest, line, place, y_seen, u_moved = (
    Symbol(n) for n in ("x_model", "u_rest", "line", "place", "y_seen", "u_moved")
)
MODEL = (
    Variable(model_gain, about="static gain of the model, y per u"),
    Variable(model_pole, about="exp(-h/T) of the model's time constant T, 0..1"),
    Variable(model_part, about="exp(-(d h - L)/T), 1 for a dead time L of d whole samples"),
)
STATES = (
    Variable(x_model, about="output of the model without dead time, from rest"),
    Variable(u_rest, about="output at rest"),
    Variable(place, COUNT, "where the oldest value is"),
)


@cache
def held_lag() -> Expr:
    """x after a time with pole p = exp(-time/T) under a constant u: p x + Kp (1 - p) u, from T x' = Kp u - x.

    >>> held_lag()
    model_gain*u_moved*(1 - model_pole) + model_pole*x_model
    """
    t, T = symbols("t T", positive=True)
    state = Function("x")
    equation = Eq(T * state(t).diff(t), model_gain * u_moved - state(t))
    solved = dsolve(equation, state(t), ics={state(0): x_model}).rhs.expand()
    return solved.subs(exp(-t / T), model_pole).expand().collect(model_gain * u_moved)


def replaced(body: tuple[Statement, ...], old: Symbol, new: Symbol) -> tuple[Statement, ...]:
    """Statements that read one variable in place of another."""
    return tuple(_replaced(statement, {old: new}) for statement in body)


def _replaced(statement: Statement, names: dict[Symbol, Symbol]) -> Statement:
    if isinstance(statement, Assign):
        return Assign(statement.target, statement.value.xreplace(names), statement.equation)
    if isinstance(statement, If):
        then, otherwise = (tuple(_replaced(s, names) for s in part) for part in (statement.then, statement.otherwise))
        return If(statement.test.xreplace(names), then, otherwise)
    return statement


def _forget() -> tuple[Statement, ...]:
    return Assign(x_model, ZERO), Fill(line, ZERO), Assign(place, Whole(Integer(0)))


def _step(plain: Operation, places: int) -> Operation:
    last = Whole(Integer(places))
    model = (
        Assign(u_moved, Minus(u, u_rest)),
        Assign(Element(line, place), freeze(held_lag().subs(model_pole, model_part)), "model, delayed"),
        Assign(x_model, freeze(held_lag()), "model"),
        Assign(place, Plus(place, Whole(Integer(1)))),
        If(relation(place, ">=", last), (Assign(place, Whole(Integer(0))),)),
    )
    return Operation(
        plain.name,
        plain.about,
        (
            Assign(y_seen, Plus(y, Minus(x_model, Element(line, place))), "Smith predictor"),
            *replaced(plain.body, y, y_seen),
            If(Unless(held), (Assign(e, freeze(ysp - y)),)),
            *model,
        ),
        arguments=plain.arguments,
        locals=(*plain.locals, Variable(y_seen), Variable(u_moved)),
        result=u,
    )


def _extended(operation: Operation, *more: Statement) -> Operation:
    values = {name: getattr(operation, name) for name in operation.__dataclass_fields__}
    return Operation(**values | {"body": (*operation.body, *more)})


@cache
def program(places: int, compensated: bool = False) -> BlockProgram:
    """The controller with a dead time of this many samples, one at least."""
    if places < 1:
        raise ValueError(f"places = {places}: a ring buffer has one place at least")
    plain = full_pid.program(compensated)
    settings = (*SETTINGS, *MODEL)
    gain, pole, part = (m.new for m in MODEL)
    ranges = (
        *full_pid.ranges(),
        finite(gain),
        Both(relation(pole, ">=", 0), relation(pole, "<", 1)),
        Both(relation(part, ">", 0), relation(part, "<=", 1)),
    )
    at_rest = If(Unless(bad_measurement), (Assign(u_rest, u), *_forget()))
    changed = {
        "in_range": shared.in_range(*ranges),
        "adopt": shared.adopt(settings, *full_pid.gains()),
        "reset": _extended(plain.operation("reset"), Assign(u_rest, ZERO), *_forget()),
        "start": _extended(plain.operation("start"), at_rest),
        "step": _step(plain.operation("step"), places),
    }
    return BlockProgram(
        f"PID controller with a Smith predictor, dead time of {places} samples",
        plain.about,
        settings,
        plain.gains,
        (*plain.states, *STATES, Variable(line, about="values of the model on their way", size=places)),
        plain.flags,
        tuple(changed.get(o.name, o) for o in plain.operations),
        u,
        defaults=plain.defaults,
    )
