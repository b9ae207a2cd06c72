"""Siemens: PID_Compact of the S7-1200 and S7-1500."""

from sympy import Integer, symbols

from derivations.vendors.block import PERCENT_OUT, Entry, K, Manual, PidBlock, Su, Td, Tf, Ti, b, c, s


def blocks() -> list[PidBlock]:
    Kp, TI, TD, a, bw = symbols("K_p T_I T_D a b_w", positive=True)
    D = TD * s / (a * TD * s + 1)
    return [
        PidBlock(
            "siemens-pid-compact",
            "Siemens PID_Compact (S7-1200, S7-1500)",
            Manual(
                "SIMATIC S7-1200 Programmable controller, System Manual (two editions); PID control, Function Manual",
                "04/2012, A5E02486680-06; 09/2016, A5E02486680-AK; 03/2017, A5E35300227-AC",
                "350; 645; 246, 257, 260, 261",
            ),
            (
                Entry("Retain.CtrlParams.Gain", "%/y", Kp, 100 * K / Su, low=Integer(0)),
                Entry("Retain.CtrlParams.Ti", "s", TI, Ti, low=Integer(0), high=Integer(100000)),
                Entry("Retain.CtrlParams.Td", "s", TD, Td, True, Integer(0), Integer(100000)),
                Entry("Retain.CtrlParams.TdFiltRatio", "", a, Tf / Td, True, Integer(0)),
                Entry("Retain.CtrlParams.PWeighting", "", bw, b, low=Integer(0), high=Integer(1)),
            ),
            Kp * (1 + 1 / (TI * s) + D),
            Kp * (bw + 1 / (TI * s) + c * D),
            PERCENT_OUT,
            "Config.InvertControl = FALSE",
            "Config.InvertControl = TRUE, the gain stays positive",
            filter=Tf,
            selections=("Retain.CtrlParams.DWeighting = 0.0 (derivative on the process value)",),
            does=(
                "Output is in % from Config.OutputLowerLimit to Config.OutputUpperLimit (0 to 100 unless changed).",
                "The derivative is delayed by TdFiltRatio times Td; 0.2 unless changed.",
                "CtrlParams.Cycle is the sampling time of the PID algorithm, a multiple of the call's.",
            ),
        )
    ]
