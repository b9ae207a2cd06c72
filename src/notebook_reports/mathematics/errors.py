"""What the mathematics converter says when it does not understand a formula."""

import difflib
from collections.abc import Iterable

from notebook_reports.errors import PressError

WIDTH = 72


class MathError(PressError, ValueError):
    """A formula that cannot be converted: what is wrong, where, and how to mend it.

    latex: the formula. position: the 0-based index of the first character that is not understood.
    reason: the first line of the message, without the excerpt.

    >>> print(MathError("unknown command \\\\fracc: did you mean \\\\frac?", "x = \\\\fracc{1}{2}", 4))
    unknown command \\fracc: did you mean \\frac? (character 5)
      x = \\fracc{1}{2}
          ^
    """

    def __init__(self, reason: str, latex: str, position: int):
        self.reason = reason
        self.latex = latex
        self.position = max(0, min(position, len(latex)))
        super().__init__(f"{reason} (character {self.position + 1})\n{excerpt(latex, self.position)}")


def excerpt(latex: str, position: int) -> str:
    """The neighbourhood of a position on one line, with a caret below it."""
    start = max(0, min(position - WIDTH // 2, len(latex) - WIDTH))
    end = min(len(latex), start + WIDTH)
    left, right = ("…" if start else ""), ("…" if end < len(latex) else "")
    shown = "".join(c if c.isprintable() else " " for c in latex[start:end])
    return f"  {left}{shown}{right}\n  {' ' * (len(left) + position - start)}^"


def nearest(name: str, known: Iterable[str], prefix: str = "\\") -> str:
    """The end of a message about an unknown name: the known names closest to it, if any are close.

    >>> nearest("aplha", ["alpha", "beta"])
    ': did you mean \\\\alpha?'
    """
    close = difflib.get_close_matches(name, list(known), n=2, cutoff=0.65)
    return f": did you mean {' or '.join(prefix + c for c in close)}?" if close else ""
