"""CODESYS: PID and PID_FIXCYCLE of the library Util."""

from sympy import symbols

from derivations.vendors.block import UNITS, Entry, K, Manual, PidBlock, Td, Ti, s


def blocks() -> list[PidBlock]:
    KP, TN, TV = symbols("KP TN TV", positive=True)
    law = KP * (1 + 1 / (TN * s) + TV * s)
    return [
        PidBlock(
            "codesys-pid",
            "CODESYS PID, PID_FIXCYCLE (library Util)",
            Manual(
                "CODESYS Online Help, library Util, Controller; Automation Builder 2.2 help, util.lib (ABB)",
                "Util 3.5.21.0; 2.2",
                "PD (FB), PID (FB), PID_FIXCYCLE (FB)",
                "Y = KP (e + TV de/dt) + Y_OFFSET of PD in full, of PID what it has beyond that: TN, the reset time in "
                "s, reciprocal gain of the I part; the picture of the PID equation was not in the text",
            ),
            (Entry("KP", "u/y", KP, K), Entry("TN", "s", TN, Ti), Entry("TV", "s", TV, Td, True)),
            law,
            law,
            UNITS,
            "SET_POINT and ACTUAL as they are",
            "the pages name no switch: exchange SET_POINT and ACTUAL, which turns e round",
            weights={1: ""},
            on_error=True,
            does=(
                "There is no filter of the derivative: a noisy measurement is filtered before ACTUAL.",
                "Y is kept within Y_MIN and Y_MAX where Y_MIN < Y_MAX; both 0 is no limit.",
                "PID measures the time between its calls in ms; for short cycles PID_FIXCYCLE takes CYCLE in s.",
                "New parameters take effect at a start, a reset or on the change from manual.",
            ),
        )
    ]
