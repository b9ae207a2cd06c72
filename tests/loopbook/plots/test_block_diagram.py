"""A block diagram is what its data says: every part with its label, every wire from edge to edge, the same in words."""

import warnings

import matplotlib
import pytest

matplotlib.use("Agg")

from loopbook.plots import circuit
from loopbook.plots.block_diagram import Box, Diagram, Port, Shape, Sum, Tap, Wire, drawn

LOOP = Diagram(
    {
        "set point": Port("$r$", 0, 0, "W"),
        "comparison": Sum(1, 0),
        "process": Box("$G$", 3, 0),
        "tap": Tap(4, 0),
        "output": Port("$y$", 5, 0, "E"),
        "floor": Shape([(0, -2), (5, -2), (5, -1.9)], "#cccccc"),
    },
    [
        Wire("set point", "comparison"),
        Wire("comparison", "process", "$e$"),
        Wire("process", "tap", arrow=False),
        Wire("tap", "output"),
        Wire("tap.S", "comparison.S", sign="−", via=-1),
    ],
)


def words(fig):
    return [text.get_text() for axis in fig.axes for text in axis.texts]


def test_all_labels_and_signs_are_drawn():
    import matplotlib.pyplot as plt

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fig = drawn(LOOP)
    assert sorted(words(fig)) == sorted(["$r$", "$G$", "$y$", "$e$", "−"])
    plt.close(fig)


def test_wires_go_from_edge_to_edge():
    straight, back = LOOP.wires[1], LOOP.wires[4]
    assert LOOP.corners(straight) == [(1.16, 0), (2.5, 0)]
    assert LOOP.corners(back) == [(4, 0), (4, -1), (1, -1), (1, -0.16)]
    parts = {"a": Box("a", 0, 0), "b": Box("b", 3, 1)}
    assert Diagram(parts, [stepped := Wire("a", "b")]).corners(stepped) == [(0.5, 0), (1.5, 0), (1.5, 1), (2.5, 1)]
    assert Diagram(parts, [turned := Wire("a.N", "b.W")]).corners(turned) == [(0, 0.35), (0, 1), (2.5, 1)]


def test_the_words_follow_signals_through_taps():
    assert LOOP.told() == (
        "Block diagram: comparison takes set point and minus process; process takes comparison; output takes process."
    )


@pytest.mark.parametrize("end", ["proces", "process.U"])
def test_a_wire_to_nowhere_is_an_error(end):
    with pytest.raises(ValueError, match=r"a wire at 'proces.*name one of set point, comparison"):
        Diagram(LOOP.parts, [Wire("set point", end)])


def test_a_circuit_has_its_labels():
    import matplotlib.pyplot as plt

    pieces = (circuit.Piece("Dot", open=True), circuit.Piece("Resistor", "right", "$R$"))
    fig = circuit.drawn(circuit.Circuit(pieces, "A caption.", "A resistor."))
    assert words(fig) == ["$R$"]
    plt.close(fig)
