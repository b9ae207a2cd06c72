"""The drawings of pid-report as data: figures 3.1, 3.11, 4.1, 4.4 and 5.6, whose pictures the text extraction has lost.

Each is drawn from what the report says of it; nothing of its layout is the report's.
"""

from loopbook.plots.block_diagram import Box, Diagram, Port, Shape, Sum, Tap, Wire
from loopbook.plots.circuit import Circuit, Piece

CRUISE_CONTROL = Diagram(
    {
        "set point": Port(r"$y_{sp}$ [km/h]", 0, 0, "W"),
        "comparison": Sum(0.8, 0),
        "regulator": Box("regulator", 2.1, 0, 1.2),
        "car": Box("car", 4.2, 0, 1.0),
        "speed's tap": Tap(5.4, 0),
        "speed": Port("$y$ [km/h]", 5.9, 0, "E"),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "regulator", "$e$"),
        Wire("regulator", "car", "$u$ [V]"),
        Wire("car", "speed's tap", arrow=False),
        Wire("speed's tap", "speed"),
        Wire("speed's tap.S", "comparison.S", sign="−", via=-0.85),
    ],
    "Figure 3.1 of the report, drawn anew: the cruise control. The regulator turns the error in speed into a voltage.",
)

PID_OF_THREE = Diagram(
    {
        "set point": Port(r"$y_{sp}$", 0, 0, "W"),
        "comparison": Sum(0.75, 0),
        "error's tap": Tap(1.6, 0),
        "proportional part": Box("$K\\,e$", 3, 1.05, 1.9, 0.75),
        "integral part": Box(r"$\dfrac{K}{T_i}\,\int_0^t e(\tau)\,d\tau$", 3, 0, 1.9, 0.8),
        "derivative part": Box(r"$K\,T_d\,\dfrac{de}{dt}$", 3, -1.05, 1.9, 0.8),
        "sum": Sum(4.7, 0),
        "car": Box("car", 6, 0, 0.9),
        "speed's tap": Tap(7, 0),
        "speed": Port("$y$", 7.5, 0, "E"),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "error's tap", "$e$", arrow=False),
        Wire("error's tap.N", "proportional part.W"),
        Wire("error's tap", "integral part"),
        Wire("error's tap.S", "derivative part.W"),
        Wire("proportional part.E", "sum.N"),
        Wire("integral part", "sum"),
        Wire("derivative part.E", "sum.S"),
        Wire("sum", "car", "$u$"),
        Wire("car", "speed's tap", arrow=False),
        Wire("speed's tap", "speed"),
        Wire("speed's tap.S", "comparison.S", sign="−", via=-1.8),
    ],
    "Figure 3.11 of the report, drawn anew: the output of the PID regulator is the sum of three parts.",
)

COMPUTER_CONTROL = Diagram(
    {
        "set point": Port(r"$y_{sp}$", 0, 0, "W"),
        "regulator in the computer": Box("regulator", 1.2, 0, 1.3),
        "D/A converter": Box("D/A", 2.9, 0, 0.8),
        "amplifier": Box("amplifier", 4.3, 0, 1.2),
        "car": Box("car", 5.9, 0, 0.9),
        "speed's tap": Tap(6.8, 0),
        "speed": Port("speed", 7.3, 0, "E"),
        "sensor": Box("sensor", 5.9, -1.1, 0.9, 0.6),
        "low-pass filter": Box("low-pass\nfilter", 4.3, -1.1, 1.2, 0.7),
        "A/D converter": Box("A/D", 2.9, -1.1, 0.8, 0.6),
    },
    [
        Wire("set point", "regulator in the computer"),
        Wire("regulator in the computer", "D/A converter", "$u$"),
        Wire("D/A converter", "amplifier"),
        Wire("amplifier", "car"),
        Wire("car", "speed's tap", arrow=False),
        Wire("speed's tap", "speed"),
        Wire("speed's tap.S", "sensor.E"),
        Wire("sensor", "low-pass filter"),
        Wire("low-pass filter", "A/D converter"),
        Wire("A/D converter", "regulator in the computer.S", "$y$"),
    ],
    "Figure 4.1 of the report, drawn anew: a cruise control in a computer. What is measured is filtered, then sampled.",
)

RC_FILTER = Circuit(
    (
        Piece("Dot", open=True),
        Piece("Gap", "up", ("−", r"$V_{in}$", "+")),
        Piece("Dot", open=True),
        Piece("Resistor", "right", "$R$"),
        Piece("Dot"),
        Piece("Line", "right", length=1.2),
        Piece("Dot", open=True),
        Piece("Gap", "down", ("+", "$V_{out}$", "−")),
        Piece("Dot", open=True),
        Piece("Line", "left", length=1.2),
        Piece("Dot"),
        Piece("Capacitor", "up", "$C$"),
        Piece("Gap", "down"),
        Piece("Line", "left"),
    ),
    "Figure 4.4 of the report, drawn anew: the simplest low-pass filter, a resistor and a capacitor.",
    "A circuit. The input voltage drives a current through a resistor R into a capacitor C; the voltage over the "
    "capacitor is the output.",
)

RELAY_EXPERIMENT = Diagram(
    {
        "set point": Port(r"$y_{sp}$", 0, 0, "W"),
        "comparison": Sum(0.8, 0),
        "relay with hysteresis": Box("", 2.4, 0, 1.3, 0.9),
        "relay's axis": Shape([(1.9, 0), (2.9, 0)], open=True, width=0.5),
        "relay's loop": Shape([(2.25, -0.28), (2.25, 0.28), (2.55, 0.28), (2.55, -0.28)]),
        "relay's lower level": Shape([(1.9, -0.28), (2.55, -0.28)], open=True),
        "relay's upper level": Shape([(2.25, 0.28), (2.9, 0.28)], open=True),
        "process": Box("$G(s)$", 4.6, 0, 1.1),
        "output's tap": Tap(5.8, 0),
        "output": Port("$y$", 6.3, 0, "E"),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "relay with hysteresis", "$e$"),
        Wire("relay with hysteresis", "process", "$u$"),
        Wire("process", "output's tap", arrow=False),
        Wire("output's tap", "output"),
        Wire("output's tap.S", "comparison.S", sign="−", via=-0.85),
    ],
    "Figure 5.6 of the report, drawn anew: a relay with hysteresis takes the place of the regulator.",
)
