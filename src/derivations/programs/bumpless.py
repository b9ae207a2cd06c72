"""What a change of a setting does to the output at once, for each program, and the state update that prevents it.

The jump is the difference between v computed with the new and with the old settings from the same states and the same
y and y_sp. Source: pid-report, section 4.2.6; it changes I so that P + I stays (eq. 4.10) and leaves D alone.
"""

from functools import cache

from sympy import Eq, Expr, Symbol, collect, symbols

from derivations.algebra.equality import equality
from derivations.algebra.rational import factored, solved_for, vanishes
from derivations.pid.pid_laws import K, Td, Ti, b
from derivations.pid.rc_filter import Tf
from derivations.programs import pid_code as code
from derivations.programs.equivalence import one_pass, states_from

I_old, I_new = Symbol("I_old", real=True), Symbol("I_new", real=True)
SETTINGS = {"K": K, "b": b, "Ti": Ti, "Td": Td, "Tf": Tf}
_TYPES = {"K": {"real": True}, "b": {"nonnegative": True}}
OLD = {s: Symbol(f"{s.name}_old", **_TYPES.get(n, {"positive": True})) for n, s in SETTINGS.items()}
NEW = {s: Symbol(f"{s.name}_new", **_TYPES.get(n, {"positive": True})) for n, s in SETTINGS.items()}


@cache
def same_p_plus_i() -> Eq:
    """What eq. 4.10 is solved from: P + I with the new K and b is P + I with the old."""
    proportional = code.separate().assigned(code.P)
    return equality(proportional.subs(NEW) + I_new, proportional.subs(OLD) + I_old)


@cache
def keep_p_plus_i() -> Eq:
    """Eq. 4.10: the I_new for which P + I is the same with the old and the new K and b."""
    return equality(I_new, collect(solved_for(I_new, *same_p_plus_i().args).expand(), [OLD[K], NEW[K]]))


def _changed(name: str, expr: Expr) -> Expr:
    setting = SETTINGS[name]
    return expr.subs(setting, NEW[setting])


def _corrected(name: str) -> Expr:
    """I after eq. 4.10 where one setting changes and the others stay."""
    setting = SETTINGS[name]
    keep = {symbol: s for s, symbol in OLD.items()} | {symbol: s for s, symbol in NEW.items() if s != setting}
    return keep_p_plus_i().rhs.subs(keep).subs(I_old, code.I)


@cache
def jump(figure: str, setting: str, steady: bool, correct: bool = True) -> Expr:
    """v with one setting new minus v with it old.

    figure: "4.9" ... "4.13". setting: "K", "b", "Ti", "Td" or "Tf". steady: the measurement has stood still, so that
    y_f = y; else y, y_fold and y_old differ. correct: I is changed by eq. 4.10 with the same y, as printed.
    """
    program = code.programs()[figure]
    filtered, measured = (code.y, code.y) if steady else (code.yf_old, code.y_old)
    states = states_from(figure, filtered, measured)
    before = one_pass(program, states)[code.v]
    gains = {p: _changed(setting, value) for p, value in program.gain_values().items()}
    values = {**states, code.I: _corrected(setting) if correct else code.I, code.u: code.u}
    symbols = {s: s for s in (code.y, code.ysp)} | {p: p for p in gains}
    equations = code.Program(
        program.figure,
        program.gains,
        tuple(code.Assignment(a.target, _changed(setting, a.value)) for a in program.before),
        (),
    )
    after = equations.run({**symbols, **values})[code.v].subs(gains)
    return factored(after - before)


@cache
def _filtered() -> Expr:
    """The filtered measurement that the new K, T_d and T_f would need for the same D, from D_new = D_old."""
    wanted = Symbol("y_fnew", real=True)
    gain_old, gain_new = code.derivative_gain().subs(OLD), code.derivative_gain().subs(NEW)
    return solved_for(wanted, gain_new * (wanted - code.y), gain_old * (code.yf_old - code.y))


@cache
def keep_derivative(figure: str) -> dict[Symbol, Expr]:
    """New states for which D is the same with new K, T_d and T_f, for the same y; with eq. 4.10 nothing jumps.

    Solved for the filtered measurement that the new settings would need. For the programs with the state x this is
    x + (p24_new - p24_old) y, without a division: it holds for any settings, also T_d = 0 or T_f = 0.
    In the others T_d_new must not be zero (figure 4.11: nor T_f_new).
    """
    wanted = Symbol("y_fnew", real=True)
    states = states_from(figure, wanted, code.y_old)
    new = {s: value.subs(NEW).subs(wanted, _filtered()) for s, value in states.items()}
    if figure in ("4.12", "4.13"):
        gain_old, gain_new = code.derivative_gain().subs(OLD), code.derivative_gain().subs(NEW)
        old_x = solved_for(code.yf_old, gain_old * code.yf_old, code.x)
        p24_old, p24_new = Symbol("p_24old"), Symbol("p_24new")
        in_x = new[code.x].subs(code.yf_old, old_x)
        shorter = code.x + (p24_new - p24_old) * code.y
        if not vanishes(in_x - shorter.subs({p24_old: gain_old, p24_new: gain_new})):
            raise ArithmeticError(f"figure {figure}: the update of x is {in_x}")
        return {code.x: shorter}
    return {s: factored(value) for s, value in new.items()}


@cache
def jump_after(figure: str) -> Expr:
    """The jump when K, b, T_d and T_f all change, with eq. 4.10 and `keep_derivative`: zero, also in motion."""
    program = code.programs()[figure]
    states = states_from(figure, code.yf_old, code.y_old)
    old = one_pass(program, states)[code.v].subs(OLD)
    new_states = dict(keep_derivative(figure))
    if figure in ("4.12", "4.13"):
        gains = {"p_24old": code.derivative_gain().subs(OLD), "p_24new": code.derivative_gain().subs(NEW)}
        new_states = {
            s: value.subs({Symbol(n): g for n, g in gains.items()}).subs(code.x, states[code.x].subs(OLD))
            for s, value in new_states.items()
        }
    placeholders = {s: Symbol(f"{s.name}_placed", real=True) for s in new_states}
    new = one_pass(program, placeholders)[code.v].subs(NEW)
    new = new.subs({placeholders[s]: value for s, value in new_states.items()})
    correction = keep_p_plus_i().rhs.subs(I_old, code.I)
    return factored(new.subs(code.I, correction) - old)


@cache
def late_correction() -> Expr:
    """Extra jump where eq. 4.10 uses the measurement of the sample before, as the code figures do: the step of P."""
    share = code.separate().assigned(code.P)
    change = _changed("K", share) - share
    return factored(change - change.subs(code.y, code.y_old))


@cache
def keep_both_parts() -> dict[Symbol, Expr]:
    """New x and I of the weighted program for which D and P + I are the same at the last y and y_sp.

    Solved from x_new - p24_new (y - c_new y_sp) = D and K_new (b_new y_sp - y) + I_new = P + I; nothing is divided by.
    """
    p24_old, p24_new = symbols("p_24old p_24new")
    c_old, c_new = symbols("c_old c_new", nonnegative=True)
    x_new = Symbol("x_new", real=True)
    slope_old = code.x - p24_old * (code.y - c_old * code.ysp)
    slope_new = x_new - p24_new * (code.y - c_new * code.ysp)
    x = collect(solved_for(x_new, slope_new, slope_old).expand(), [p24_old, p24_new])
    integral = keep_p_plus_i().rhs.subs(I_old, code.I)
    return {code.x: x, code.I: integral}
