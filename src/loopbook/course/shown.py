"""How an answer is shown where its sheet is solved: in the book, in keys."""

from dataclasses import dataclass
from typing import Any

from loopbook.course.kinds.kind import Kind
from loopbook.course.question import Asked
from notebook_reports.display import literal

ANSWER_MIME = "application/vnd.loopbook.answer+json"


@dataclass(frozen=True)
class ShownAnswer:
    """One line of text, and the same facts as data."""

    asked: Asked

    def line(self) -> str:
        """What is asked for, its key, its worth, and what the named wrong methods give."""
        asked = self.asked
        tolerance = getattr(asked.kind, "tolerance", None)
        worth = [str(tolerance)] * (tolerance is not None and asked.holds is None) + [points(asked.points)]
        if asked.holds is None:
            text = f"`{asked.name}` = {bold(asked.kind.text(asked.key))} ({', '.join(worth)})"
        else:
            text = f"`{asked.name}`, for example {bold(asked.kind.text(asked.key))} ({', '.join(worth)}): "
            text += "; ".join(literal(condition) for condition in asked.conditions(asked.key))
        others = [f"*{literal(method)}*: {asked.kind.text(key)}" for method, key in asked.wrong.items()]
        return text + ("\n\nWrong: " + "; ".join(others) if others else "")

    def data(self) -> dict[str, Any]:
        """The content under `ANSWER_MIME`."""
        asked = self.asked
        return {"name": asked.name, "key": asked.kind.plain(asked.key), "unit": asked.kind.unit, "points": asked.points}

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        return {ANSWER_MIME: self.data(), "text/markdown": self.line(), "text/plain": self.line()}


def bold(text: str) -> str:
    """Text set bold, a formula as it is."""
    return text if text.startswith(("$", "`")) else f"**{text}**"


def points(number: float) -> str:
    """
    >>> points(1), points(2.5)
    ('1 point', '2.5 points')
    """
    return f"{number:g} point" + ("s" if number != 1 else "")


def wanted(kind: Kind, number: float) -> str:
    """What a student is asked to write, and what it is worth."""
    return f"{kind.wants()} ({points(number)})"
