"""The drawings of pid-article as data: its block diagrams and Simulink models, whose pictures are lost.

Each is drawn from what the text says of it; nothing of its layout is the article's.
"""

from loopbook.plots.block_diagram import Box, Diagram, Port, Sum, Tap, Wire

LOOP = Diagram(
    {
        "set point": Port("set point $w$", 0, 0, "W"),
        "comparison": Sum(0.75, 0),
        "regulator": Box("regulator", 2.0, 0, 1.2),
        "actuator": Box("actuator", 3.7, 0, 1.1),
        "load": Port("load $d$", 4.75, 0.9, "N"),
        "load's place": Sum(4.75, 0),
        "plant": Box("plant", 5.75, 0, 1.0),
        "output's tap": Tap(6.75, 0),
        "output": Port("output $y$", 7.25, 0, "E"),
        "sensor": Box("sensor", 3.7, -1.05, 1.0, 0.6),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "regulator", "$e$"),
        Wire("regulator", "actuator", "$u$"),
        Wire("actuator", "load's place"),
        Wire("load", "load's place"),
        Wire("load's place", "plant"),
        Wire("plant", "output's tap", arrow=False),
        Wire("output's tap", "output"),
        Wire("output's tap.S", "sensor.E"),
        Wire("sensor", "comparison.S", sign="−"),
    ],
    "The loop of the article, drawn from its description: what is measured is compared with what is wanted.",
)

THREE_TERMS = Diagram(
    {
        "error": Port("$e$", 0, 0, "W"),
        "gain": Box("$K_p$", 0.9, 0, 0.8),
        "tap": Tap(1.8, 0),
        "integral term": Box(r"$\dfrac{1}{T_i}\,\int_0^t e(x)\,dx$", 3.3, 0, 1.9, 0.8),
        "derivative term": Box(r"$T_d\,\dfrac{de}{dt}$", 3.3, -1.05, 1.9, 0.8),
        "sum": Sum(5.0, 0),
        "proportional term": Box("$e$", 3.3, 0.9, 1.9, 0.6),
        "control signal": Port("$u$", 5.7, 0, "E"),
    },
    [
        Wire("error", "gain"),
        Wire("gain", "tap", arrow=False),
        Wire("tap.N", "proportional term.W"),
        Wire("tap", "integral term"),
        Wire("tap.S", "derivative term.W"),
        Wire("proportional term.E", "sum.N"),
        Wire("integral term", "sum"),
        Wire("derivative term.E", "sum.S"),
        Wire("sum", "control signal"),
    ],
    "The three terms in the dependent structure: one gain before all of them.",
)

LAG_LOOP = Diagram(
    {
        "set point": Port("$w$", 0, 0, "W"),
        "comparison": Sum(0.7, 0),
        "PI regulator": Box(r"$K_p\left(1+\dfrac{1}{T_i s}\right)$", 2.25, 0, 1.7, 0.8),
        "load": Port("load $d$", 3.85, 0.85, "N"),
        "load's place": Sum(3.85, 0),
        "plant": Box(r"$\dfrac{k}{1+T s}$", 5.0, 0, 1.1, 0.8),
        "output's tap": Tap(6.1, 0),
        "output": Port("$y$", 6.6, 0, "E"),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "PI regulator", "$e$"),
        Wire("PI regulator", "load's place", "$u$"),
        Wire("load", "load's place"),
        Wire("load's place", "plant"),
        Wire("plant", "output's tap", arrow=False),
        Wire("output's tap", "output"),
        Wire("output's tap.S", "comparison.S", sign="−", via=-0.85),
    ],
    "A PI regulator and a plant with one lag.",
)

SCHEDULED = Diagram(
    {
        "set point": Port("$w$", 0, 0, "W"),
        "comparison": Sum(0.7, 0),
        "PID regulator": Box("PID", 2.0, 0, 1.1, 0.7),
        "plant": Box(r"$\ddot y=-\dot y-\sqrt{y}+u$", 4.3, 0, 2.1, 0.7),
        "output's tap": Tap(5.8, 0),
        "output": Port("$y$", 6.7, 0, "E"),
        "second tap": Tap(6.2, 0),
        "schedule": Box("settings of $y$", 4.3, 1.05, 1.7, 0.6),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "PID regulator", "$e$"),
        Wire("PID regulator", "plant", "$u$"),
        Wire("plant", "output's tap", arrow=False),
        Wire("output's tap", "second tap", arrow=False),
        Wire("second tap", "output"),
        Wire("second tap.N", "schedule.E"),
        Wire("schedule.W", "PID regulator.N", r"$K_p, T_i, T_d$"),
        Wire("output's tap.S", "comparison.S", sign="−", via=-0.8),
    ],
    "Gain scheduling: the output chooses the settings of the regulator that holds it.",
)
