"""The forms that textbooks and data sheets name: ideal, parallel, series; proportional band, minutes and repeats."""

from sympy import Expr, Integer, Symbol, sqrt, symbols

from derivations.vendors.block import (
    PERCENT_OF_RANGES,
    UNITS,
    Entry,
    K,
    Manual,
    Need,
    PidBlock,
    Su,
    Sy,
    Td,
    Tf,
    Ti,
    b,
    c,
    s,
)

UP, DOWN = "reverse acting (more measurement, less output)", "direct acting (more measurement, more output)"
REPORT = Manual("J. Wahlfrid, pid-report", "2007", "section 3.2")


def interacting(ratio: Expr) -> tuple[Expr, Expr, Expr, Need]:
    """(gain, Ti, Td) of K' (1 + 1/(s Ti'))(1 + s Td')/(1 + s ratio Td') for a standard form with Tf = ratio Td'.

        (1 - ratio) Td'^2 - (1 - ratio) Ti Td' + Ti Td = 0,   Ti' = Ti - (1 - ratio) Td',   K' = K Ti'/Ti

    the smaller root; real where (1 - ratio) Ti >= 4 Td. From the equality of the numerators.
    """
    kept = 1 - ratio
    series_Td = Ti / 2 - sqrt(Ti**2 / 4 - Ti * Td / kept)
    series_Ti = Ti - kept * series_Td
    need = Need(
        kept * Ti - 4 * Td,
        "a series (interacting) form has real zeros: it needs Ti >= 4 Td"
        + (f" times {1 / kept} with its filter" if ratio else "")
        + "; take a setting with a shorter derivative time, a PI, or a controller with the ideal form",
    )
    return K * series_Ti / Ti, series_Ti, series_Td, need


def blocks() -> list[PidBlock]:
    P, I, D, Kc, TI, TD, F, PB, R = symbols("P I D K_c T_I T_D F PB R", positive=True)
    D_part = TD * s / (1 + F * s)
    filter_ = Entry("Tf", "s", F, Tf, derivative=True)
    ideal = PidBlock(
        "ideal",
        "ideal (standard, ISA)",
        REPORT,
        (Entry("K", "u/y", Kc, K), Entry("Ti", "s", TI, Ti), Entry("Td", "s", TD, Td, True), filter_),
        Kc * (1 + 1 / (TI * s) + D_part),
        Kc * (b + 1 / (TI * s) + c * D_part),
        UNITS,
        UP,
        DOWN,
        filter=Tf,
    )
    parallel = PidBlock(
        "parallel",
        "parallel (independent gains)",
        REPORT,
        (Entry("P", "u/y", P, K), Entry("I", "u/(y s)", I, K / Ti), Entry("D", "u s/y", D, K * Td, True), filter_),
        P + I / s + D * s / (1 + F * s),
        b * P + I / s + c * D * s / (1 + F * s),
        UNITS,
        UP,
        DOWN,
        filter=Tf,
    )
    gain, series_Ti, series_Td, real = interacting(Integer(0))
    product = Kc * (1 + 1 / (TI * s)) * (1 + TD * s)
    series = PidBlock(
        "series",
        "series (interacting), no filter",
        REPORT,
        (Entry("K", "u/y", Kc, gain), Entry("Ti", "s", TI, series_Ti), Entry("Td", "s", TD, series_Td, True)),
        product,
        product,
        UNITS,
        UP,
        DOWN,
        weights={1: ""},
        on_error=True,
        needs=(real,),
    )
    return [ideal, parallel, series, _band(PB, TI, TD, F), _repeats(Kc, R, TD, F)]


def _band(PB: Symbol, TI: Symbol, TD: Symbol, F: Symbol) -> PidBlock:
    D = TD * 60 * s / (1 + F * s)
    return PidBlock(
        "proportional-band",
        "proportional band [%], minutes per repeat",
        Manual(
            "PID Tutorial, application note CCUT-G-02A (Yokogawa)",
            "01-01",
            "1",
            "output = error 100/PB, both in % of their ranges, with the example 5 % of 0 to 1000",
        ),
        (
            Entry("PB", "%", PB, 100 * PERCENT_OF_RANGES / K),
            Entry("reset", "min/repeat", TI, Ti / 60),
            Entry("rate", "min", TD, Td / 60, True),
            Entry("filter", "s", F, Tf, True),
        ),
        100 / PB * (1 + 1 / (TI * 60 * s) + D),
        100 / PB * (b + 1 / (TI * 60 * s) + c * D),
        PERCENT_OF_RANGES,
        UP,
        DOWN,
        filter=Tf,
        does=("A smaller band is a higher gain: 100 % is a gain of 1 in % per %.",),
    )


def _repeats(Kc: Symbol, R: Symbol, TD: Symbol, F: Symbol) -> PidBlock:
    D = TD * 60 * s / (1 + F * s)
    return PidBlock(
        "percent-repeats",
        "gain in % per %, repeats per minute",
        Manual(
            "UDC 3300 Process Controller Product Manual (Honeywell)",
            "4/00",
            "123",
            "gain = 100 %/PB %, repeats per minute as the inverse of minutes per repeat, with 20 and 0.05",
        ),
        (
            Entry("gain", "%/%", Kc, K * Sy / Su),
            Entry("reset", "repeats/min", R, 60 / Ti),
            Entry("rate", "min", TD, Td / 60, True),
            Entry("filter", "s", F, Tf, True),
        ),
        Kc * (1 + R / (60 * s) + D),
        Kc * (b + R / (60 * s) + c * D),
        PERCENT_OF_RANGES,
        UP,
        DOWN,
        filter=Tf,
    )
