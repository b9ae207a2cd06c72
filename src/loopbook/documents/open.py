"""The documents of the book, opened: their printed data, their checks, their terms.

>>> open_document("double-tank").value("rise-q0.3")
Fraction(7327, 2000)
"""

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from derivations.algebra.rational import vanishes
from notebook_reports.display import Table
from notebook_reports.ledger import glossary as terms_of
from notebook_reports.ledger.document import Document
from notebook_reports.ledger.printed_data import PrintedDocument, documents, load

FOLDER = Path(__file__).parent
GLOSSARY = FOLDER / "glossary.toml"


def names() -> list[str]:
    """The ids of all documents.

    >>> "double-tank" in names()
    True
    """
    return documents(FOLDER)


@cache
def printed(id: str) -> PrintedDocument:
    """What a document prints: by its id.

    Raises PrintedDataError for another name and where a file is malformed.

    >>> printed("double-tank").values["rise-q0.3"].printed
    '3.6635'
    """
    return load(id, FOLDER)


def open_document(id: str, compare: bool = True, given: Mapping[str, float] | None = None) -> Document:
    """A document, ready to be checked; misprints are proved by multiplying out.

    compare: False where the notebook's parameters are not the document's own: tables then give no verdict. given: the
    parameters by the id of the printed number that each one is, so that this is found out.
    Raises PrintedDataError for a name that no document has.

    >>> [open_document("double-tank", given={"V1": volume}).compare for volume in (10.0, 9.0)]
    [True, False]
    """
    return Document(printed(id), compare, _same, given)


def _same(one: Any, other: Any) -> bool:
    return vanishes(one - other)


def variables(table: str) -> tuple[terms_of.Term, ...]:
    """The variables of one table of pid-report: "3.1", "4.1" or "5.1".

    >>> [term.symbol for term in variables("3.1")]
    ['$y$', '$u$', '$y_{sp}$', '$e$']
    """
    return terms_of.variables(GLOSSARY, table)


def glossary(table: str = "") -> Table:
    """The glossary as a table, whole or for the variables of one table of pid-report."""
    return terms_of.glossary(GLOSSARY, table)
