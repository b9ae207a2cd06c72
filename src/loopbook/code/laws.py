"""Other laws ready to be written out: RST, on-off, gain-scheduled PID, Smith predictor."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from derivations.programs import on_off, rst_program, scheduled_pid, smith_predictor
from loopbook.code.block import Block, CodeError
from loopbook.code.pid import pid_numbers
from loopbook.controllers.rst import Rst
from loopbook.controllers.settings import PidSettings


def rst_block(
    regulator: Rst, u_low: float = -math.inf, u_high: float = math.inf, *, name: str = "rst", **more: Any
) -> Block:
    """An RST regulator within limits, with its observer polynomial against windup.

    more: y, u, rest, notes of `Block`.

    >>> rst_block(Rst(R=(1, -1), S=(3, -1.6), T=(1.4,), h=1.0)).settings()["r1"]
    -1.0
    """
    rows = {"r": regulator.R[1:], "s": regulator.S, "t": regulator.T, "o": regulator.observer[1:]}
    degrees = (len(regulator.R) - 1, len(regulator.S) - 1, len(regulator.T) - 1, len(regulator.observer) - 1)
    numbers = {f"{n}_{i}": c for n, row in rows.items() for i, c in enumerate(row, 1 if n in "ro" else 0)}
    numbers |= {"h": regulator.h, "u_low": u_low, "u_high": u_high}
    return Block(rst_program.program(*degrees), name, numbers, **more)


def on_off_block(u_low: float, u_high: float, hysteresis: float = 0.0, *, name: str = "on_off", **more: Any) -> Block:
    """Two outputs; the last one stays while |e| <= hysteresis."""
    numbers = {"u_low": u_low, "u_high": u_high, "hysteresis": hysteresis}
    return Block(on_off.program(), name, numbers, **more)


def scheduled_block(
    zones: Sequence[Mapping[str, float | None]],
    edges: Sequence[float],
    hysteresis: float,
    settings: PidSettings,
    *,
    name: str = "scheduled_pid",
    compensated: bool = False,
    **more: Any,
) -> Block:
    """A PID controller whose K, Ti and Td follow a variable.

    zones: K, Ti, Td of each, in the order of the variable; edges: between them, ascending, one fewer. settings: what
    all zones share; its own K, Ti, Td are not used. Raises CodeError where the counts do not fit.
    """
    if len(zones) < 2 or len(edges) != len(zones) - 1:
        raise CodeError(f"{len(zones)} zones and {len(edges)} edges: two zones at least, and one edge fewer than zones")
    numbers = pid_numbers(settings)
    for key in ("K", "T_i", "T_d"):
        del numbers[key]
    for z, zone in enumerate(zones, 1):
        checked = PidSettings(K=zone["K"], Ti=zone.get("Ti"), Td=zone.get("Td") or 0.0, h=settings.h)
        numbers |= {f"K_{z}": checked.K, f"Ti_{z}": checked.Ti or 0.0, f"Td_{z}": checked.Td}
    numbers |= {f"edge_{z}": edge for z, edge in enumerate(edges, 1)} | {"hysteresis": hysteresis}
    return Block(scheduled_pid.program(len(zones), compensated), name, numbers, **more)


def smith_block(
    settings: PidSettings,
    gain: float,
    time_constant: float,
    delay: float,
    *,
    name: str = "smith_pid",
    compensated: bool = False,
    **more: Any,
) -> Block:
    """A PID controller with a Smith predictor for gain/(1 + s time_constant) e^(-s delay), exact for any delay.

    settings: of the controller, tuned for the process without its dead time. delay [s] > 0.
    """
    if not (time_constant > 0 and delay > 0 and math.isfinite(gain * time_constant * delay) and gain):
        raise CodeError(
            f"gain = {gain}, time_constant = {time_constant}, delay = {delay}: "
            "a gain that is not 0 and two positive times in s are expected"
        )
    h = float(settings.h)
    places = max(math.ceil(delay / h - 1e-9), 1)
    over = max(places * h - delay, 0.0)
    model = {"model_gain": gain, "model_pole": math.exp(-h / time_constant)}
    model["model_part"] = math.exp(-over / time_constant)
    numbers = pid_numbers(settings) | model
    return Block(smith_predictor.program(places, compensated), name, numbers, **more)
