"""Emerson: the PID block of its fieldbus devices, FORM standard and series."""

from sympy import Rational, symbols

from derivations.vendors.block import PERCENT_OF_RANGES, Entry, K, Manual, PidBlock, Su, Sy, Td, Ti, b, c, s
from derivations.vendors.textbook import interacting

MANUALS = (
    "Rosemount 8742C Reference Manual 00809-0100-4793; OCX8800A Manual 00809-0500-4880",
    "Rev CA, August 2004; December 2022",
    "4-4; 168, 180",
)
ALPHA = Rational(1, 10)
WAYS = "CONTROL_OPTS: Direct Acting not set", "CONTROL_OPTS: Direct Acting set"
DOES = (
    "The derivative is smoothed by a fixed factor: a filter of 0.1 times RATE.",
    "GAIN is taken as percent of OUT_SCALE per percent of PV_SCALE; the pages speak of signal scaling only.",
    "RESET = 0 makes an integrator alone.",
)


def blocks() -> list[PidBlock]:
    G, tr, td = symbols("GAIN tau_r tau_d", positive=True)
    D = td * s / (ALPHA * td * s + 1)
    standard = PidBlock(
        "emerson-standard",
        "Emerson fieldbus PID, FORM = Standard",
        Manual(
            *MANUALS,
            "the equation, with 1/(tau_r s + 1) for the integral, which would not integrate; taken as 1/(tau_r s), as "
            "the same page has it in the series form",
        ),
        (
            Entry("GAIN", "%/%", G, K * Sy / Su),
            Entry("RESET", "s", tr, Ti),
            Entry("RATE", "s", td, Td, True),
        ),
        G * (1 + 1 / (tr * s) + D),
        G * (b + 1 / (tr * s) + c * D),
        PERCENT_OF_RANGES,
        *WAYS,
        weights={
            1: "STRUCTURE: PI action on error, D action on PV",
            0: "STRUCTURE: I action on error, PD action on PV",
        },
        filter=ALPHA * Td,
        selections=("FORM = Standard",),
        does=DOES,
    )
    gain, series_Ti, series_Td, real = interacting(ALPHA)
    law = G * (1 + 1 / (tr * s)) * (td * s + 1) / (ALPHA * td * s + 1)
    series = PidBlock(
        "emerson-series",
        "Emerson fieldbus PID, FORM = Series",
        Manual(*MANUALS),
        (
            Entry("GAIN", "%/%", G, gain * Sy / Su),
            Entry("RESET", "s", tr, series_Ti),
            Entry("RATE", "s", td, series_Td, True),
        ),
        law,
        law,
        PERCENT_OF_RANGES,
        *WAYS,
        weights={1: ""},
        on_error=True,
        filter=ALPHA * series_Td,
        needs=(real,),
        selections=("FORM = Series", "STRUCTURE: PID action on error"),
        does=DOES,
    )
    return [standard, series]
