"""Honeywell: the UDC controllers (gain or proportional band, minutes or repeats) and the fieldbus PID block."""

from sympy import Integer, Rational, symbols

from derivations.vendors.block import PERCENT_OF_RANGES, Entry, K, Manual, PidBlock, Su, Sy, Td, Ti, b, c, s

UDC = Manual(
    "UDC 3300 Process Controller Product Manual; HC900 Hybrid Control Designer Function Block Reference Guide",
    "4/00; Revision 11, 2/07",
    "93, 123, 275; 273, 418",
    "gain as output change over measurement change in % of their ranges, PB = 100/gain, reset as repeats of the "
    "proportional action; no equation of the rate",
)
RMA = Manual(
    "SmartLine RMA800, Foundation Fieldbus RMA803 Remote Indicator User's Guide",
    "Revision 4",
    "55 to 57, 62",
    "ideal: non-interactive, three terms, types A, B, C by what acts on the error; in words, not as an equation",
)
WAYS = "REVERSE control action", "DIRECT control action"
NO_RATE = (
    "the manual does not say whether rate and reset interact, so the rate that equals Td is not known; "
    "take a PI setting for this controller"
)


def blocks() -> list[PidBlock]:
    G, PB, RM, RPM, reset, rate = symbols("G PB R_M R_P RESET RATE", positive=True)
    types = {1: "PID A", 0: "PID B"}
    band = 100 / PB
    ideal = G * (1 + 1 / (reset * s) + rate * s)
    return [
        PidBlock(
            "honeywell-udc-gain",
            "Honeywell UDC, HC900: gain, minutes per repeat",
            UDC,
            (
                Entry("GAIN", "%/%", G, K * Sy / Su, low=Rational(1, 10), high=Integer(1000)),
                Entry("RSET MIN", "min/repeat", RM, Ti / 60, low=Rational(2, 100), high=Integer(50)),
            ),
            G * (1 + 1 / (60 * RM * s)),
            G * (b + 1 / (60 * RM * s)),
            PERCENT_OF_RANGES,
            *WAYS,
            weights=types,
            derivative=NO_RATE,
            does=("With PID B a set-point step moves the output through the integral only.",),
        ),
        PidBlock(
            "honeywell-udc-band",
            "Honeywell UDC, HC900: proportional band, repeats per minute",
            UDC,
            (
                Entry("PROP BD", "%", PB, 100 * Su / (K * Sy), low=Rational(1, 10), high=Integer(1000)),
                Entry("RSET RPM", "repeats/min", RPM, 60 / Ti, low=Rational(2, 100), high=Integer(50)),
            ),
            band * (1 + RPM / (60 * s)),
            band * (b + RPM / (60 * s)),
            PERCENT_OF_RANGES,
            *WAYS,
            weights=types,
            derivative=NO_RATE,
            does=("With PID B a set-point step moves the output through the integral only.",),
        ),
        PidBlock(
            "honeywell-fieldbus-ideal",
            "Honeywell fieldbus PID, PID_FORM = IDEAL",
            RMA,
            (
                Entry("GAIN", "%/%", G, K * Sy / Su, low=Rational(4, 1000), high=Integer(250)),
                Entry("RESET", "s", reset, Ti, low=Rational(1, 4), high=Integer(7500)),
                Entry("RATE", "s", rate, Td, True, Integer(4), Integer(7500)),
            ),
            ideal,
            G * (b + 1 / (reset * s) + c * rate * s),
            PERCENT_OF_RANGES,
            "the pages name no value for the direction",
            "the pages name no value for the direction",
            weights={1: "ALGO_TYPE B", 0: "ALGO_TYPE C"},
            selections=("PID_FORM = IDEAL PID",),
            does=(
                "A lag of the output is fixed with RATE (pages 56 and 62: a ratio of 16) and cannot be set; the "
                "entries are those without it.",
                "RESET is 2 block executions at least, RATE 32, with executions of 0.125 s.",
            ),
        ),
    ]
