"""The text of a comment on a change, from what its build said.

    python tools/review_comment.py FILE [--pictures URL] > comment.md

What a change's own build wrote is not trusted: it stands in a code fence that nothing inside can close, so it is no
markup, no link, no mention; it is cut where it is long.
"""

import re
import sys
from pathlib import Path

LONGEST = 50_000  # characters; a comment takes 65,536


def comment(text: str, pictures: str = "") -> str:
    """The comment. pictures: where the run is whose artifact has the pictures of the changed pages.

    >>> print(comment("two rows moved"))
    What this change does to the ledger:
    <BLANKLINE>
    ```text
    two rows moved
    ```
    """
    plain = "".join(c if c == "\n" or c.isprintable() else " " for c in text).strip()
    if len(plain) > LONGEST:
        plain = plain[:LONGEST].rsplit("\n", 1)[0] + f"\n... cut; {len(plain)} characters in all"
    longest = max((len(run) for run in re.findall("`+", plain)), default=0)
    fence = "`" * max(3, longest + 1)
    where = (
        f"\n\nThe changed pages, before and after: the artifact `difference` of [this run]({pictures})."
        if pictures
        else ""
    )
    return f"What this change does to the ledger:\n\n{fence}text\n{plain}\n{fence}{where}"


def number(text: str) -> int:
    """The number of a pull request: digits and nothing else. Raises ValueError."""
    if not re.fullmatch(r"[1-9][0-9]{0,8}\n?", text):
        raise ValueError(f"{text[:40]!r} is no number of a pull request")
    return int(text)


if __name__ == "__main__":
    if len(sys.argv) == 3 and sys.argv[1] == "--number":
        print(number(Path(sys.argv[2]).read_text(encoding="utf-8")))
    else:
        pictures = sys.argv[3] if sys.argv[2:3] == ["--pictures"] else ""
        print(comment(Path(sys.argv[1]).read_text(encoding="utf-8", errors="replace"), pictures))
