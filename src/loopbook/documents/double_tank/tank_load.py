"""The two tanks in numbers, and their disturbance."""

from collections.abc import Mapping
from fractions import Fraction

from derivations.plants import heated_tanks as tanks
from loopbook.numerics.rational_numbers import decimal
from loopbook.process.from_symbols import process_of
from loopbook.process.transfer_function import Process


def tank_disturbance(process: Process) -> float:
    """The load step [u] that acts like a unit step at the inlet: 1 / static gain, as both pass the same path."""
    return 1 / process.static_gain


def processes(given: Mapping[str, Fraction]) -> tuple[Process, Process]:
    """(heating power [W] to outlet [K], inlet [K] to outlet [K]) from Table 2, volumes and flow in litres.

    >>> heating, inlet = processes({"V1": 10, "Vr": 4, "V2": 14, "Q": 2, "c": 4180, "rho": 1000})
    >>> heating.delay, round(1 / heating.static_gain), inlet.static_gain
    (2.0, 8360, 1.0)
    """
    litres = {tanks.V1: "V1", tanks.Vr: "Vr", tanks.V2: "V2", tanks.Q: "Q"}
    values = {symbol: Fraction(given[name]) / 1000 for symbol, name in litres.items()}
    values |= {tanks.c: given["c"], tanks.rho: given["rho"]}
    heating, inlet = (process_of(tanks.path(source), values) for source in (tanks.U, tanks.V))
    return heating, inlet


def exact_numbers(V1: float, Vr: float, V2: float, Q: float, c: float, rho: float) -> tuple[Fraction, ...]:
    """(T1 [s], T2 [s], gain [K/W], dead time [s]) of tanks and pipe; a float is the decimal that it is written as.

    V1, Vr, V2: volumes [m³]. Q: flow [m³/s]. c: heat capacity [J/(kg K)]. rho: density [kg/m³].

    >>> exact_numbers(0.010, 0.004, 0.014, 0.002, 4180, 1000)
    (Fraction(5, 1), Fraction(7, 1), Fraction(1, 8360), Fraction(2, 1))
    """
    first, pipe, second, flow, heat, density = map(decimal, (V1, Vr, V2, Q, c, rho))
    return first / flow, second / flow, 1 / (flow * heat * density), pipe / flow
