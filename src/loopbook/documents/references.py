"""References of a document resolved against what its numbered things are: figures by transcription, equations derived.

``cited.toml`` in a document's folder says what stands under each figure's number, in our words. A reference in a
printed or corrected text is looked up there, and holds where what is found is what the sentence speaks of.
"""

import re
from collections.abc import Mapping
from functools import cache

from loopbook.documents import equation_numbers
from loopbook.documents import open as documents
from notebook_reports.project.toml import read_toml

LABEL = re.compile(r"\b(figure|equation)\s+(\d+\.\d+)|\b([FE])(\d+\.\d+)", re.IGNORECASE)
KINDS = {"f": "figure", "e": "equation"}


@cache
def transcribed(document: str) -> Mapping[str, Mapping[str, str]]:
    """What `cited.toml` of a document holds, by kind and label.

    >>> transcribed("pid-report")["figure"]["3.4"]
    'integral of the error with positive and negative parts'
    """
    return read_toml(documents.FOLDER / document.replace("-", "_") / "cited.toml")


def label(text: str) -> tuple[str, str] | None:
    """(kind, number) of the first figure or equation that a text refers to, or None where it names none.

    >>> label("the line in figure 3.9"), label("E4.15"), label("E.13")
    (('figure', '3.9'), ('equation', '4.15'), None)
    """
    found = LABEL.search(text)
    return (KINDS[(found[1] or found[3])[0].lower()], found[2] or found[4]) if found else None


def stands_for(document: str, text: str) -> str:
    """What the thing is that a text refers to: of a figure our words, of an equation its left side; "" for nothing.

    >>> stands_for("pid-report", "E4.15"), stands_for("pid-report", "4.20 for v")
    ('x', '')
    """
    found = label(text)
    if not found:
        return ""
    if found[0] == "figure":
        return transcribed(document)["figure"].get(found[1], "")
    return equation_numbers.plain(equation_numbers.derived(document, found[1])).split(" = ")[0]


def resolves(document: str, id: str, subject: str) -> tuple[bool, bool]:
    """Do the printed and the corrected reference of a misprint lead to what its sentence speaks of?

    >>> resolves("pid-report", "chord-figure", "A and B")
    (False, True)
    """
    item = documents.printed(document).misprints[id]
    leads_to = (stands_for(document, text) for text in (item.printed, item.corrected))
    printed, corrected = (bool(re.search(rf"\b{re.escape(subject)}", found)) for found in leads_to)
    return printed, corrected
