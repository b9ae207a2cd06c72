"""Block diagrams from data: parts at places of a grid, wires between them, drawn by schemdraw.

    loop = Diagram(
        {
            "set point": Port("$r$", 0, 0),
            "comparison": Sum(1, 0),
            "regulator": Box("$F$", 2.2, 0),
            "process": Box("$G$", 4, 0),
            "tap": Tap(5.2, 0),
            "output": Port("$y$", 6, 0),
        },
        [
            Wire("set point", "comparison"),
            Wire("comparison", "regulator", "$e$"),
            Wire("regulator", "process", "$u$"),
            Wire("process", "tap"),
            Wire("tap", "output"),
            Wire("tap.S", "comparison.S", sign="−", via=-1.2),
        ],
    )

A part's name is a word that a listener understands: `Diagram.told` says in words what is connected with what, so that
the description of a drawing comes from the data that it is drawn from.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from loopbook.extras import needed

SIDES = {"E": (1, 0), "W": (-1, 0), "N": (0, 1), "S": (0, -1)}
UNIT = 0.72
"""Inches of one step of the grid."""
TEXT = 9.5
Point = tuple[float, float]


@dataclass(frozen=True)
class Box:
    """A box with its label in it, at its centre (x, y) in steps of the grid."""

    label: str
    x: float
    y: float
    width: float = 1.0
    height: float = 0.7
    fill: str = ""

    @property
    def reach(self) -> Point:
        """From the centre to the edges."""
        return self.width / 2, self.height / 2


@dataclass(frozen=True)
class Sum:
    """A circle in which signals meet; their signs stand at the wires."""

    x: float
    y: float
    reach = (0.16, 0.16)


@dataclass(frozen=True)
class Tap:
    """A dot where a signal goes on two ways."""

    x: float
    y: float
    reach = (0.0, 0.0)


@dataclass(frozen=True)
class Port:
    """The label of a signal that comes from outside or leaves. side: where the label stands from (x, y)."""

    label: str
    x: float
    y: float
    side: str = ""
    reach = (0.0, 0.0)


@dataclass(frozen=True)
class Shape:
    """What a picture shows beside its blocks: a line through points, filled, or open. width: of the line."""

    points: Sequence[Point]
    fill: str = ""
    open: bool = False
    width: float = 1.1
    x = y = 0.0
    reach = (0.0, 0.0)


Part = Box | Sum | Tap | Port | Shape


@dataclass(frozen=True)
class Wire:
    """An arrow from one part to another, "name" or "name.side" with a side of E, W, N, S.

    label: of the signal. sign: + or − at its end. via: the height of the middle stretch of a wire that leaves and
    arrives at N or S, or the x of one that leaves and arrives at E or W on different heights.
    """

    start: str
    end: str
    label: str = ""
    sign: str = ""
    via: float | None = None
    arrow: bool = True


@dataclass(frozen=True)
class Diagram:
    """Parts by name, and wires between them. Raises ValueError for a wire to a part that is not there.

    caption: a sentence below the drawing. words: what it shows, for those who do not see it, where more than `told`.
    """

    parts: Mapping[str, Part]
    wires: Sequence[Wire]
    caption: str = ""
    words: str = ""

    def __post_init__(self) -> None:
        for end in (e for wire in self.wires for e in (wire.start, wire.end)):
            name, _, side = end.partition(".")
            if name not in self.parts or side not in ("", *SIDES):
                known = ", ".join(self.parts)
                raise ValueError(f"a wire at {end!r}: name one of {known}, and a side of {', '.join(SIDES)}")

    def told(self) -> str:
        """What is connected with what, in words; or the words that the data gives.

        >>> parts = {"set point": Port("$r$", 0, 0), "sum": Sum(1, 0), "output": Port("$y$", 2, 0)}
        >>> Diagram(parts, [Wire("set point", "sum"), Wire("output", "sum", sign="−")]).told()
        'Block diagram: sum takes set point and minus output.'
        """
        if self.words:
            return self.words
        takes: dict[str, list[str]] = {}
        for wire in self.wires:
            end = wire.end.partition(".")[0]
            if not isinstance(self.parts[end], Tap):
                minus = "minus " if wire.sign == "−" else ""
                takes.setdefault(end, []).append(minus + self._source(wire.start.partition(".")[0]))
        ordered = [name for name in self.parts if name in takes]
        return "Block diagram: " + "; ".join(f"{name} takes {_listed(takes[name])}" for name in ordered) + "."

    def _source(self, name: str) -> str:
        """The part that a signal comes from, through taps."""
        while isinstance(self.parts[name], Tap):
            name = next(w.start for w in self.wires if w.end.partition(".")[0] == name).partition(".")[0]
        return name

    def corners(self, wire: Wire) -> list[Point]:
        """The points of a wire: straight, or round one or two corners.

        >>> parts = {"a": Box("a", 0, 0), "b": Box("b", 3, 1)}
        >>> Diagram(parts, [wire := Wire("a", "b.S")]).corners(wire)
        [(0.5, 0.0), (3.0, 0.0), (3.0, 0.65)]
        """
        (x, y), start = self._port(wire.start, wire.end)
        (u, v), end = self._port(wire.end, wire.start)
        upright, arrives_upright = (side in "NS" for side in (start, end))
        if upright and arrives_upright and (x != u or wire.via is not None):
            middle = (y + v) / 2 if wire.via is None else wire.via
            between = [(x, middle), (u, middle)]
        elif not upright and not arrives_upright and y != v:
            middle = (x + u) / 2 if wire.via is None else wire.via
            between = [(middle, y), (middle, v)]
        elif upright != arrives_upright:
            between = [(x, v) if upright else (u, y)]
        else:
            between = []
        return [(x, y), *between, (u, v)]

    def _port(self, end: str, other: str) -> tuple[Point, str]:
        name, _, side = end.partition(".")
        part, towards = self.parts[name], self.parts[other.partition(".")[0]]
        if not side and part.x == towards.x:
            side = "N" if towards.y > part.y else "S"
        side = side or ("E" if towards.x > part.x else "W")
        (across, up), (right, high) = SIDES[side], part.reach
        return (part.x + across * right, part.y + up * high), side


def _listed(words: Sequence[str]) -> str:
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def drawn(diagram: Diagram) -> Any:
    """The diagram as a matplotlib figure. Raises ModuleNotFoundError that names the extra without schemdraw."""
    needed("schemdraw", "reports")
    from schemdraw import elements as elm

    parts = [_element(part, elm) for part in diagram.parts.values()]
    return picture([*parts, *(_arrow(diagram.corners(wire), wire, elm) for wire in diagram.wires)])


def picture(elements: Sequence[Any], unit: float = 1.0) -> Any:
    """Elements of schemdraw as a matplotlib figure, as large as they are. unit: length of an element with two ends."""
    import matplotlib.pyplot as plt
    import schemdraw

    drawing = schemdraw.Drawing(canvas="matplotlib", show=False)
    drawing.config(unit=unit, inches_per_unit=UNIT, fontsize=TEXT, font="DejaVu Sans", lw=1.1, margin=0.05)
    for element in elements:
        drawing += element
    with plt.rc_context({"figure.constrained_layout.use": False}):
        return drawing.draw(show=False).getfig()


def _element(part: Part, elm: Any) -> Any:
    """A part as an element of schemdraw: segments around its place."""
    from schemdraw.segments import Segment, SegmentCircle, SegmentPoly, SegmentText

    element = elm.Element().at((part.x, part.y))
    right, high = part.reach
    match part:
        case Box(label):
            corners = [(-right, -high), (right, -high), (right, high), (-right, high)]
            element.segments += [SegmentPoly(corners, fill=part.fill or None), _text(SegmentText, (0, 0), label)]
        case Sum():
            element.segments.append(SegmentCircle((0, 0), right))
        case Tap():
            element.segments.append(SegmentCircle((0, 0), 0.045, fill="black"))
        case Port(label):
            across, up = SIDES.get(part.side, (0, 0))
            element.segments += [_text(SegmentText, (0.1 * across, 0.1 * up), label, part.side)] if label else []
        case Shape():
            kind = (
                Segment(part.points) if part.open else SegmentPoly(part.points, fill=part.fill or None, lw=part.width)
            )
            element.segments.append(kind)
    return element


def _arrow(corners: Sequence[Point], wire: Wire, elm: Any) -> Any:
    from schemdraw.segments import Segment, SegmentText

    element = elm.Element().at((0, 0))
    element.segments.append(Segment(corners, arrow="->" if wire.arrow else None, arrowwidth=0.13, arrowlength=0.17))
    if wire.label:
        (x, y), (u, v) = max(pairwise(corners), key=_length)
        level = y == v
        place = ((x + u) / 2, y + 0.08) if level else (x + 0.1, (y + v) / 2)
        element.segments.append(_text(SegmentText, place, wire.label, "N" if level else "E"))
    if wire.sign:
        (x, y), (u, v) = corners[-2:]
        place = (u - 0.12, v + 0.2) if y == v else (u - 0.17, v + (0.12 if y > v else -0.12))
        element.segments.append(_text(SegmentText, place, wire.sign))
    return element


def _length(stretch: tuple[Point, Point]) -> float:
    (x, y), (u, v) = stretch
    return abs(u - x) + 0.5 * abs(v - y)


def _text(kind: Any, place: Point, label: str, side: str = "") -> Any:
    """Words at a place, or beside it on one side."""
    across = {"E": "left", "W": "right"}.get(side, "center")
    up = {"N": "bottom", "S": "top"}.get(side, "center")
    return kind(place, label, align=(across, up), fontsize=TEXT)
