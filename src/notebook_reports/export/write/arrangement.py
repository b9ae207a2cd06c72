"""What is known of a report's pages only when they are set, and is then settled by setting them again.

A table too wide for a page is turned onto a landscape one. A figure that would have to leave the rest of its page empty
floats instead: it stands at the head of the next page, and the text after it goes on where it would have stood.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby

MARGIN_TOP = 2.7 * 72 / 2.54
"""Points between the upper edge of a page and its text, as in ``report.typ``."""


@dataclass(frozen=True)
class Arrangement:
    """turned: the tables on landscape pages; floating: the figures that float; both by the writer's names for them."""

    turned: frozenset[str] = frozenset()
    floating: frozenset[str] = frozenset()


AS_IT_COMES = Arrangement()


@dataclass(frozen=True)
class Place:
    """Where a figure with a caption stands. id: "a/b 3 1f0c", its notebook, its count there and its content.
    top: points from the upper edge of the page."""

    id: str
    page: int
    top: float

    @property
    def notebook(self) -> str:
        return self.id.rsplit(" ", 2)[0]

    @property
    def count(self) -> int:
        return int(self.id.rsplit(" ", 2)[1])


def to_float(places: Iterable[Place], floating: frozenset[str]) -> set[str]:
    """The figures that have to float as well: those that begin a page, and those that a later one has overtaken."""
    in_order = sorted(places, key=lambda place: (place.notebook, place.count))
    found: set[str] = set()
    for _, figures in groupby(in_order, key=lambda place: place.notebook):
        earliest = (10**9, 0.0)
        for figure in reversed(list(figures)):
            here = (figure.page, figure.top)
            begins_a_page = figure.page > 1 and figure.top < MARGIN_TOP + 1
            if begins_a_page or here > earliest:
                found.add(figure.id)
            earliest = min(earliest, here)
    return found - floating
