"""ABB: the process PID of its drives, and the PID of the KNX logic controller, with an integral time of its own."""

from sympy import Integer, Rational, symbols

from derivations.vendors.block import PERCENT_OF_RANGES, UNITS, Entry, K, Manual, PidBlock, Su, Sy, Td, Ti, s


def blocks() -> list[PidBlock]:
    P, I, D, G, TI = symbols("P I D G T_I", positive=True)
    own = P + 1 / (I * s) + D * s
    drive = G * (1 + 1 / (TI * s))
    return [
        PidBlock(
            "abb-drive",
            "ABB drives, process PID (ACS320, ACQ80)",
            Manual(
                "ACS320 User's Manual; ACQ80 standard pump control program, Firmware manual",
                "no edition on the pages",
                "230; 195",
                "integration time as the time in which a constant error is repeated, with an example; the derivative's "
                "increment without the gain, as it would stand at the output",
            ),
            (
                Entry("GAIN", "%/%", G, K * Sy / Su, low=Rational(1, 100), high=Integer(100)),
                Entry("INTEGRATION TIME", "s", TI, Ti, low=Rational(1, 10), high=Integer(3600)),
            ),
            drive,
            drive,
            PERCENT_OF_RANGES,
            "the error is reference less feedback",
            "the pages name no switch for the direction",
            weights={1: ""},
            derivative="the manual does not say whether the gain multiplies the derivation time; take a PI setting",
            does=("Integration time 0 switches the integral off.",),
        ),
        PidBlock(
            "abb-knx",
            "ABB i-bus KNX logic controller ABA/S 1.2.1",
            Manual("ABB i-bus KNX, ABA/S 1.2.1 Logic Controller, Product Manual 2CDC509086D0201", "D0201", "93"),
            (
                Entry("ProportionalCoefficient", "u/y", P, K),
                Entry("IntegralTime", "s y/u", I, Ti / K),
                Entry("DerivativeTime", "s u/y", D, K * Td, True),
            ),
            own,
            own,
            UNITS,
            "set-point and measurement as they are",
            "the page names no switch: exchange set-point and measurement",
            weights={1: ""},
            on_error=True,
            does=(
                "The integral and the derivative are not multiplied by the coefficient: IntegralTime is Ti/K.",
                "There is no filter; the deviation is differenced over the cycle (usually 0.2 s).",
                "At a limit the integral is reduced.",
            ),
        ),
    ]
