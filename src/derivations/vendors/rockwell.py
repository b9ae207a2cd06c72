"""Rockwell: PIDE of Logix 5000 and its PID instruction, with independent and with dependent gains."""

from sympy import Expr, Integer, Symbol, symbols

from derivations.vendors.block import PERCENT_OF_RANGES, Entry, K, Manual, PidBlock, Su, Sy, Td, Ti, b, c, s

PIDE = Manual(
    "Logix 5000 Advanced Process Control and Drives Instructions, Reference Manual 1756-RM006K-EN-P",
    "November 2018",
    "79 to 81",
    "the terms with their units, what makes each of them and the repeat that defines TI; the equations are pictures",
)
PID = Manual(
    "Logix5000 Controllers General Instructions, Reference Manual 1756-RM003N-EN-P", "October 2011", "512, 517, 519"
)
PERCENT = K * Sy / Su
SMOOTHING = (
    "Derivative smoothing (DSmoothing) may be switched on; the manual gives no time constant for it.",
    "The error is in percent of the span of PV, CV in percent.",
)


def independent(P: Symbol, I: Symbol, D: Symbol, unit: Integer) -> tuple[Expr, Expr]:
    """(feedback, set-point) of P E + I int E dt + D dPV/dt, I per `unit` seconds, D in as many."""
    return P + I / (unit * s) + unit * D * s, b * P + I / (unit * s) + c * unit * D * s


def dependent(Kc: Symbol, TI: Symbol, TD: Symbol, names: tuple[str, str, str]) -> tuple[Entry, ...]:
    """Controller gain, reset and rate under the names of an instruction."""
    values = (("%/%", Kc, PERCENT), ("min/repeat", TI, Ti / 60), ("min", TD, Td / 60))
    return tuple(
        Entry(name, unit, symbol, value, derivative=symbol is TD)
        for name, (unit, symbol, value) in zip(names, values, strict=True)
    )


def blocks() -> list[PidBlock]:
    Kp, Ki, Kd, Kc, TI, TD = symbols("K_P K_I K_D K_c T_I T_D", positive=True)
    isa = Kc * (1 + 1 / (60 * TI * s) + 60 * TD * s), Kc * (b + 1 / (60 * TI * s) + c * 60 * TD * s)
    in_minutes = (
        Entry("PGain", "%/%", Kp, PERCENT),
        Entry("IGain", "1/min", Ki, 60 * PERCENT / Ti),
        Entry("DGain", "min", Kd, PERCENT * Td / 60, True),
    )
    in_seconds = (
        Entry(".KP", "%/%", Kp, PERCENT),
        Entry(".KI", "1/s", Ki, PERCENT / Ti),
        Entry(".KD", "s", Kd, PERCENT * Td, True),
    )
    way = "ControlAction cleared", "ControlAction set (E and PV are negated)"
    weights = {1: "PVEProportional cleared", 0: "PVEProportional set"}
    pv = "PVEDerivative set (derivative of PV)"
    ways = ".CA: E = SP - PV", ".CA: E = PV - SP"
    of_pv = ".DOE: derivative of PV"
    limits = ("The output is limited to .MINO and .MAXO; .NDF switches the derivative's smoothing off.",)
    return [
        PidBlock("rockwell-pide-independent", "Rockwell PIDE, independent gains", PIDE, in_minutes,
              *independent(Kp, Ki, Kd, Integer(60)), PERCENT_OF_RANGES, *way, weights,
              selections=("DependIndepend cleared", pv), does=SMOOTHING),
        PidBlock("rockwell-pide-dependent", "Rockwell PIDE, dependent gains", PIDE,
              dependent(Kc, TI, TD, ("PGain", "IGain", "DGain")), *isa, PERCENT_OF_RANGES, *way, weights,
              selections=("DependIndepend set", pv), does=SMOOTHING),
        PidBlock("rockwell-pid-independent", "Rockwell PID instruction, independent gains", PID, in_seconds,
              *independent(Kp, Ki, Kd, Integer(1)), PERCENT_OF_RANGES, *ways, {1: ""},
              selections=(".PE: independent gains", of_pv), does=limits),
        PidBlock("rockwell-pid-dependent", "Rockwell PID instruction, dependent gains (ISA)", PID,
              dependent(Kc, TI, TD, (".KP", ".KI", ".KD")), *isa, PERCENT_OF_RANGES, *ways, {1: ""},
              selections=(".PE: dependent gains", of_pv), does=limits),
    ]  # fmt: skip
