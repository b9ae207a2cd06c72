"""Electrical circuits from data: pieces one after the other, drawn by schemdraw."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from loopbook.extras import needed
from loopbook.plots.block_diagram import picture


@dataclass(frozen=True)
class Piece:
    """An element of schemdraw by its name, from where the last one ended.

    direction: right, left, up or down; "" for a dot. label: beside it, or on the other side (below). length: in steps.
    """

    kind: str
    direction: str = ""
    label: str | tuple[str, ...] = ""
    length: float = 2.2
    below: bool = False
    open: bool = False


@dataclass(frozen=True)
class Circuit:
    """Pieces in a row. caption: a sentence below the drawing. words: what it shows, for those who do not see it."""

    pieces: Sequence[Piece]
    caption: str
    words: str

    def told(self) -> str:
        """What the drawing shows, in words."""
        return self.words


def drawn(circuit: Circuit) -> Any:
    """The circuit as a matplotlib figure. Raises ModuleNotFoundError that names the extra without schemdraw."""
    needed("schemdraw", "reports")
    from schemdraw import elements

    made = []
    for piece in circuit.pieces:
        element = getattr(elements, piece.kind)(**({"open": True} if piece.open else {}))
        if piece.direction:
            element = getattr(element, piece.direction)(piece.length)
        made.append(element.label(piece.label, loc="bottom" if piece.below else "top") if piece.label else element)
    return picture(made)
