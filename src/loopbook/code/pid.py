"""PID controllers ready to be written out."""

import math
from typing import Any

from derivations.programs import full_pid, pid_code, start
from loopbook.code.block import Block, BlockSignal
from loopbook.controllers import generated
from loopbook.controllers.settings import PidSettings
from loopbook.numerics.rational_numbers import function

NAMES = {"K": "K", "Ti": "T_i", "Td": "T_d", "Tf": "T_f", "b": "b", "c": "c", "Tt": "T_t", "h": "h"}
UNNAMED = BlockSignal()


def pid_block(
    settings: PidSettings | None = None,
    *,
    name: str = "pid",
    y: BlockSignal = UNNAMED,
    u: BlockSignal = UNNAMED,
    rest: tuple[float, float] | None = None,
    notes: tuple[str, ...] = (),
    compensated: bool = False,
    **numbers: Any,
) -> Block:
    """The PID controller with its numbers: `PidSettings`, or the same as keywords.

    rest: (u, y) where the process stood still. compensated: the integral keeps what rounding takes from it.
    Raises SettingError for a number out of its range.

    >>> pid_block(K=2.0, Ti=10.0, h=0.5).settings()["Tt"]
    5.0
    """
    chosen = settings or PidSettings(**numbers)
    return Block(full_pid.program(compensated), name, pid_numbers(chosen), y, u, rest, notes)


def pid_numbers(s: PidSettings) -> dict[str, float]:
    """Checked settings as the numbers of the program: what it does without is 0, what is unlimited infinite."""
    values = {symbol: getattr(s, field) for field, symbol in NAMES.items()}
    values["T_i"] = 0.0 if s.Ti is None else s.Ti
    conditional = s.anti_windup in ("conditional", "conditional-safe")
    values["T_t"] = 0.0 if conditional else math.inf if s.Tt is None or s.anti_windup == "none" else s.Tt
    values |= {"u_low": s.u_low, "u_high": s.u_high, "rate": 0.0 if s.rate is None else s.rate}
    return {key: float(value) for key, value in values.items()}


def states_at_rest(settings: PidSettings, u: float, y: float, y_sp: float | None = None) -> dict[str, float]:
    """x and I with which the program keeps u where the process stands still at y, from `derivations.programs.start`.

    y_sp: default y. A program that begins with x = I = 0 instead moves the actuator by I at its first sample.

    >>> states_at_rest(PidSettings(K=2.0, Ti=10.0, h=0.5), u=35.0, y=20.0)
    {'x': 0.0, 'I': 35.0}
    """
    values = dict(zip(generated.GAINS, _gains(settings), strict=True))
    at = {"y": y, "y_sp": y if y_sp is None else y_sp, "u_0": u, "feedforward": 0.0, **values}
    states = start.rest()
    symbols = sorted(set().union(*(e.free_symbols for e in states.values())), key=str)
    x, integral = function(symbols, [states[pid_code.x], states[pid_code.I]])(*(at[s.name] for s in symbols))
    return {"x": float(x), "I": float(integral)}


def _gains(s: PidSettings) -> tuple[float, ...]:
    return generated.gains()(s.K, s.Ti, s.Td, s.Tf, s.b, s.c, s.h, math.inf if s.Tt is None else s.Tt)
