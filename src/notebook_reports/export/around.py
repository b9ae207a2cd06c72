"""What stands around a report on the screen: the page that lists all, its neighbours, its other forms, its tools."""

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


@dataclass(frozen=True)
class Tools:
    """What a page has beside its text: markup above it, and the script that makes it work."""

    markup: str
    script: str
