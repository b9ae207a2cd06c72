"""What stands around a report on the screen: the page that lists all, its neighbours, its other forms."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Door:
    """Where it leads, relative to the page, and its words as inline text."""

    url: str
    words: str


@dataclass(frozen=True)
class Around:
    """home: the page that lists all. before, after: the neighbours in the order of the book. files: other forms."""

    home: Door | None = None
    before: Door | None = None
    after: Door | None = None
    files: tuple[Door, ...] = ()
