"""The drawings of double-tank as data: figures 1, 2, 4, 7 and 9, whose pictures the text extraction has lost.

Each is drawn from what the document says of it; nothing of its layout is the document's.
"""

from loopbook.plots.block_diagram import Box, Diagram, Port, Shape, Sum, Tap, Wire

_WATER, _GLASS = "#d7e8f5", "#ffffff"

TANKS = Diagram(
    {
        "pipe": Shape([(2.6, 1.62), (4.5, 0.92), (5.2, 0.92), (5.2, 0.74), (4.46, 0.74), (2.6, 1.42)], _WATER),
        "water of tank 1": Shape([(0.6, 1.4), (2.6, 1.4), (2.6, 2.6), (0.6, 2.6)], _WATER),
        "water of tank 2": Shape([(5.2, 0), (7.2, 0), (7.2, 1.2), (5.2, 1.2)], _WATER),
        "wall of tank 1": Shape([(0.6, 2.72), (0.6, 1.4), (2.6, 1.4), (2.6, 2.95)], open=True),
        "wall of tank 2": Shape([(5.2, 1.55), (5.2, 0), (7.2, 0), (7.2, 1.55)], open=True),
        "heater": Shape(
            [(1.6, 3.1), *((1.6 + dx, 2.3 - 0.1 * i) for i, dx in enumerate((0, 0.2, -0.2, 0.2, -0.2, 0)))],
            open=True,
        ),
        "heating power": Port("heating power $u$ [W]", 1.6, 3.4),
        "water comes in": Port("inlet, $v$ [K]", 0, 2.8, "N"),
        "into tank 1": Port("", 0.6, 2.8),
        "tank 1": Port("tank 1, $V_1$", 1.12, 1.6),
        "pipe's name": Port("pipe, $V_r$", 3.95, 1.5),
        "tank 2": Port("tank 2, $V_2$", 6.2, 0.4),
        "thermometer": Box("T", 6.2, 1.75, 0.4, 0.36, _GLASS),
        "bulb": Tap(6.2, 0.95),
        "temperature": Port("temperature $y$ [K]", 8.05, 1.75, "N"),
        "temperature's end": Port("", 8.75, 1.75),
        "out of tank 2": Port("", 7.2, 0.3),
        "water goes out": Port("flow $Q$ [m³/s]", 8.05, 0.3, "N"),
        "outlet's end": Port("", 8.75, 0.3),
    },
    [
        Wire("water comes in", "into tank 1"),
        Wire("thermometer", "bulb", arrow=False),
        Wire("thermometer.E", "temperature's end"),
        Wire("out of tank 2", "outlet's end"),
    ],
    "Figure 1 of the document, drawn anew: two stirred tanks, joined by a pipe. The heater's power is the input, the "
    "temperature at the outlet is the output.",
    "Water flows into tank 1, which holds a heater, through a pipe into tank 2, where a thermometer reads its "
    "temperature, and out.",
)

_PATH = {
    "tank 1": Box(r"$\dfrac{1}{1+sV_1/Q}$", 3.1, 0, 1.35, 0.8),
    "pipe": Box(r"$\exp(-sV_r/Q)$", 4.9, 0, 1.4, 0.8),
    "tank 2": Box(r"$\dfrac{1}{1+sV_2/Q}$", 6.7, 0, 1.35, 0.8),
}

MODEL = Diagram(
    {
        "heating power": Port("$U$ [W]", 0, 0, "W"),
        "heating gain": Box("$K_u$", 0.9, 0, 0.8),
        "inlet temperature": Port("$V$ [K]", 0, 0.95, "W"),
        "inlet gain": Box("$K_v$", 0.9, 0.95, 0.8),
        "sum": Sum(1.9, 0),
        **_PATH,
        "outlet temperature": Port("$Y$ [K]", 7.8, 0, "E"),
    },
    [
        Wire("heating power", "heating gain"),
        Wire("heating gain", "sum"),
        Wire("inlet temperature", "inlet gain"),
        Wire("inlet gain", "sum.N"),
        Wire("sum", "tank 1"),
        Wire("tank 1", "pipe"),
        Wire("pipe", "tank 2"),
        Wire("tank 2", "outlet temperature"),
    ],
    "Figure 2 of the document, drawn anew: heating power and inlet temperature enter at the same place.",
)


def _fed_back(parts: dict, wires: list[Wire], caption: str, x: float, back: tuple[str, ...], below: float) -> Diagram:
    """A loop round the tanks: what comes before, the process with its load, and the way back from the output at x."""
    process = {
        "heating gain": Box("$K_u$", x, 0, 0.8),
        "inlet temperature": Port("$V$ [K]", x + 0.9, 0.85, "N"),
        "load": Sum(x + 0.9, 0),
        "tanks and pipe": Box("$G_p(s)$", x + 1.95, 0, 1.1),
        "output's tap": Tap(x + 2.85, 0),
        "outlet temperature": Port("$Y$ [K]", x + 3.3, 0, "E"),
    }
    forward = [
        Wire("heating gain", "load"),
        Wire("inlet temperature", "load"),
        Wire("load", "tanks and pipe"),
        Wire("tanks and pipe", "output's tap", arrow=False),
        Wire("output's tap", "outlet temperature"),
    ]
    first, last = back[0], back[-1]
    if len(back) == 1:
        home = [Wire("output's tap.S", f"{first}.S", sign="−", via=below)]
    else:
        home = [Wire("output's tap.S", f"{first}.E"), *map(Wire, back, back[1:])]
        home[-1] = Wire(back[-2], f"{last}.S", sign="−")
    return Diagram(parts | process, [*wires, *forward, *home], caption)


PID_LOOP = _fed_back(
    {
        "set point": Port("$R$", 0, 0, "W"),
        "comparison": Sum(0.7, 0),
        "PID regulator": Box(r"$P+\dfrac{I}{s}+D\,\dfrac{N}{1+N/s}$", 2.35, 0, 2.1, 0.8),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "PID regulator", "$E$"),
        Wire("PID regulator", "heating gain", "$U$"),
    ],
    "Figure 4 of the document, drawn anew: the PID regulator acts on the error; the inlet temperature is a load at the "
    "input of the tanks.",
    4.3,
    ("comparison",),
    -0.85,
)

POLE_PLACEMENT = Diagram(
    {
        "set point": Port("$R$", 0, 0, "W"),
        "set-point gain": Box("$K_r$", 0.8, 0, 0.7),
        "comparison": Sum(1.75, 0),
        "regulator's poles": Box(r"$\dfrac{1}{C(z)}$", 2.85, 0, 0.9, 0.8),
        "process": Box(r"$\dfrac{B(z)}{A(z)}$", 4.5, 0, 0.9, 0.8),
        "output's tap": Tap(5.5, 0),
        "outlet temperature": Port("$Y$", 6, 0, "E"),
        "feedback": Box("$D(z)$", 3.65, -1.05, 0.9, 0.6),
    },
    [
        Wire("set point", "set-point gain"),
        Wire("set-point gain", "comparison"),
        Wire("comparison", "regulator's poles"),
        Wire("regulator's poles", "process", "$U$"),
        Wire("process", "output's tap", arrow=False),
        Wire("output's tap", "outlet temperature"),
        Wire("output's tap.S", "feedback.E"),
        Wire("feedback", "comparison.S", sign="−"),
    ],
    "Figure 7 of the document, drawn anew: the regulator is the three polynomials that are to be found.",
)

SAMPLED_LOOP = _fed_back(
    {
        "set point": Port("$R$", 0, 0, "W"),
        "set-point gain": Box("$K_r$", 0.75, 0, 0.7),
        "comparison": Sum(1.6, 0),
        "regulator's poles": Box(r"$\dfrac{1}{C(z)}$", 2.5, 0, 0.9, 0.8),
        "hold": Box("hold", 3.65, 0, 0.7, 0.55),
        "feedback": Box("$D(z)$", 3.4, -1.1, 0.9, 0.6),
        "sampler": Box("sample", 5.4, -1.1, 0.9, 0.55),
    },
    [
        Wire("set point", "set-point gain"),
        Wire("set-point gain", "comparison"),
        Wire("comparison", "regulator's poles"),
        Wire("regulator's poles", "hold"),
        Wire("hold", "heating gain", "$U$"),
    ],
    "Figure 9 of the document, drawn anew: the sampled regulator on the continuous process.",
    4.8,
    ("sampler", "feedback", "comparison"),
    -1.1,
)
