"""What the table of a check is called: the place, what stands there, and what became of it."""

import re
from collections import Counter
from collections.abc import Sequence

from notebook_reports.display import literal

MOST_PLACES = 3
_FILE = re.compile(r"\S*[._]\w")
"""A place that is a file: its name stays as it is."""
NAMES = {"value": ("printed value", "printed values"), "claim": ("statement", "statements")}


def caption(table: str, places: Sequence[str], verdicts: Sequence[str], order: Sequence[str]) -> str:
    """For values and statements. order: of the verdicts.

    >>> caption("claim", ["section 4.2", "section 4.2"], ["holds", "fails"], ("holds", "fails"))
    'Section 4.2: 2 statements, 1 holds, 1 fails'
    >>> caption("value", ["Table 5"], ["reproduced"], ("reproduced",))
    'Table 5: 1 printed value, reproduced'
    >>> caption("claim", ["section 4.2", "figure 3"], ["holds", "holds"], ("holds", "fails"))
    'Section 4.2 and figure 3: 2 statements, both hold'
    """
    counts = Counter(verdicts)
    number = len(verdicts)
    parts = [(counts[verdict], verdict) for verdict in order if counts[verdict]]
    if len(parts) == 1:
        every = {1: "", 2: "both "}.get(number, "all ")
        found = every + verb_of(parts[0][1], number)
    else:
        found = ", ".join(f"{count} {verb_of(verdict, count)}" for count, verdict in parts)
    return f"{where(places)}: {number} {NAMES[table][number > 1]}, {found}"


def of_misprints(places: Sequence[str], misleads: Sequence[bool]) -> str:
    """For misprints.

    >>> of_misprints(["figure 4.1"], [True]), of_misprints(["figure 4.1"] * 3, [True, False, False])
    ('Figure 4.1: 1 misprint, which misleads', 'Figure 4.1: 3 misprints, of which 1 misleads')
    """
    number, bad = len(misleads), sum(misleads)
    if number == 1:
        found = "which misleads" if bad else "which misleads nobody"
    else:
        found = "none of which misleads" if not bad else f"of which {bad} mislead{'s' if bad == 1 else ''}"
        found = "which mislead" if bad == number else found
    return f"{where(places)}: {number} misprint{'s' if number > 1 else ''}, {found}"


def where(places: Sequence[str]) -> str:
    """The places by name, or how many they are.

    >>> where(["figure 4.1", "Table 2", "figure 4.1"]), where(["a", "b", "c", "d"])
    ('Figure 4.1 and Table 2', '4 places')
    """
    named = list(dict.fromkeys(places))
    if len(named) > MOST_PLACES:
        return f"{len(named)} places"
    *front, last = named
    text = f"{', '.join(front)} and {last}" if front else last
    return literal(text if _FILE.match(text) else text[:1].upper() + text[1:])


def verb_of(verdict: str, number: int) -> str:
    """The verdict as the verb of a number.

    >>> verb_of("holds partly", 2), verb_of("fails", 1), verb_of("reproduced", 3)
    ('hold partly', 'fails', 'reproduced')
    """
    words = verdict.split()
    verb = words[0] in ("holds", "fails", "differs") and number != 1
    return " ".join([words[0].removesuffix("s"), *words[1:]]) if verb else verdict
