"""What `answer` and `require` belong to while a sheet runs: its author looking at it, a draw, or a judgement."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from loopbook.course.errors import Redraw, SheetError, Unreadable
from loopbook.course.question import Asked
from loopbook.course.shown import ShownAnswer


@dataclass
class Session:
    """One run of a sheet.

    own: a student's plain answers by name, where their work is judged: later cells go on with them. strict: numbers
    that make no exercise are a `Redraw`; a judgement is not strict. cell: that runs. show: what is called with each
    thing that is asked for.
    """

    own: Mapping[str, Any] = field(default_factory=dict)
    strict: bool = True
    cell: int = 0
    show: Callable[[Asked], None] | None = None
    again: bool = False
    asked: dict[str, Asked] = field(default_factory=dict)

    def require(self, condition: Any, why: str) -> None:
        if self.strict and not bool(condition):
            raise Redraw(why)

    def ask(self, asked: Asked) -> Any:
        """Note what is asked for; the value that later cells go on with."""
        asked.refuse_bad_names()
        if asked.name in self.asked and not self.again:
            raise SheetError(f"{asked.name} is asked for twice")
        if self.strict:
            asked.sees_to_itself()
        self.asked[asked.name] = asked
        if self.show is not None:
            self.show(asked)
        if self.own.get(asked.name) is None:
            return asked.value
        try:
            return asked.kind.handed(asked.kind.read(self.own[asked.name]), asked.value)
        except Unreadable:
            return asked.value


def _display(asked: Asked) -> None:
    from IPython.display import display

    display(ShownAnswer(asked))


_current = [Session(show=_display, again=True)]


def current() -> Session:
    """The session of the sheet that runs; its author's where none was begun."""
    return _current[-1]


@contextmanager
def during(session: Session) -> Iterator[Session]:
    """`answer` and `require` belong to this session inside the block."""
    _current.append(session)
    try:
        yield session
    finally:
        _current.pop()
