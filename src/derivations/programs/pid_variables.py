"""The names of the whole PID controller: settings, gains, states, flags, signals, with their units."""

from sympy import Integer, Symbol

from derivations.algebra.differences import h
from derivations.pid.pid_laws import K, Td, Ti, Tt, b, c
from derivations.pid.rc_filter import Tf
from derivations.programs import pid_code as code
from derivations.programs import start
from derivations.programs.form import BOOL, Variable

I, x, v, u, e, y, ysp = code.I, code.x, code.v, code.u, code.error, code.y, code.ysp
p1, p2, p3, p4, p5, p6, p24 = code.p1, code.p2, code.p3, code.p4, code.p5, code.p6, code.p24
u_low, u_high, u_ff = code.u_low, code.u_high, start.u_ff
rate, rate_step, u_manual, y_last, ysp_last = (
    Symbol(n) for n in ("rate", "rate_step", "u_manual", "y_last", "y_sp_last")
)
started, arriving, manual, conditional = (Symbol(n) for n in ("started", "arriving", "manual", "conditional"))
limited_low, limited_high, rate_limited = (Symbol(n) for n in ("limited_low", "limited_high", "rate_limited"))
bad_measurement, wrong_cycle, overflow, refused = (
    Symbol(n) for n in ("bad_measurement", "wrong_cycle", "overflow", "refused")
)
valid, held, r, x_now, x_next, I_next, v_next, u_last, increment, elapsed, on, u_wanted, outward = (
    Symbol(n)
    for n in (
        *("valid", "held", "r", "x_now", "x_next", "I_next", "v_next"),
        *("u_last", "increment", "elapsed", "on", "u_wanted", "outward"),
    )
)
I_lost, lost_next, I_sum = (Symbol(n) for n in ("I_lost", "lost_next", "I_sum"))
ZERO = Integer(0)

SETTINGS = (
    Variable(K, about="gain, u per y; negative where y falls when u rises; not 0"),
    Variable(Ti, about="integral time, s; 0 or infinite: no integral action"),
    Variable(Td, about="derivative time, s; 0: no derivative"),
    Variable(Tf, about="time constant of the derivative's filter, s, >= 0"),
    Variable(b, about="set-point weight of P, 0..1"),
    Variable(c, about="set-point weight of D, 0..1; 0: derivative of the measurement alone"),
    Variable(Tt, about="tracking time, s, > h/2; 0: conditional integration instead"),
    Variable(h, about="time between two steps, s, > 0"),
    Variable(u_low, about="lower limit of u"),
    Variable(u_high, about="upper limit of u, above u_low"),
    Variable(rate, about="largest change of u, per s; 0: no limit"),
)
GAINS = (
    Variable(p1, about="set-point gain"),
    Variable(p2, about="gain of the measurement"),
    Variable(p3, about="filter"),
    Variable(p4, about="derivative state"),
    Variable(p5, about="integral gain"),
    Variable(p6, about="tracking gain"),
    Variable(p24, about="derivative gain"),
    Variable(rate_step, about="largest change of u in one step"),
    Variable(conditional, BOOL, "anti-windup by conditional integration"),
)
STATES = (
    Variable(I, about="integral part, unit of u"),
    Variable(x, about="state of the derivative, unit of u"),
    Variable(v, about="output before its limits"),
    Variable(u, about="output"),
    Variable(e, about="control error of the last good sample"),
    Variable(y_last, about="last good measurement"),
    Variable(ysp_last, about="set-point at that sample"),
    Variable(u_manual, about="output that the operator wants"),
    Variable(manual, BOOL, "the operator sets the output"),
    Variable(started, BOOL, "a good sample has been seen"),
    Variable(arriving, BOOL, "the next automatic sample keeps the output"),
)
FLAGS = (
    Variable(limited_low, BOOL, "output at its lower limit; always: the actuator is too small"),
    Variable(limited_high, BOOL, "output at its upper limit; always: the actuator is too small"),
    Variable(rate_limited, BOOL, "output moves as fast as it may; nothing to do"),
    Variable(bad_measurement, BOOL, "a signal is no finite number, output held: look at the sensor"),
    Variable(wrong_cycle, BOOL, "measured time between steps is not h: look at the task's period"),
    Variable(overflow, BOOL, "a number left the machine's range, output held: look at scaling"),
    Variable(refused, BOOL, "new settings out of range, the old ones kept: mend them"),
)
SIGNALS = {
    ysp: Variable(ysp, about="set-point"),
    y: Variable(y, about="measurement"),
    u_ff: Variable(u_ff, about="added to the output, unit of u; 0 where there is none"),
}
MOMENTARY = (limited_low, limited_high, rate_limited, overflow)
"""Flags that each sample raises anew."""
