"""A notebook opens a document of its project."""

from collections.abc import Mapping

from notebook_reports.ledger.document import Document
from notebook_reports.ledger.printed_data import load
from notebook_reports.project.project import find_project


def open_document(id: str, compare: bool = True, given: Mapping[str, float] | None = None) -> Document:
    """A document of the project around the working folder, ready to be checked.

    compare: False where the notebook's parameters are not the document's own: tables then give no verdict. given: the
    parameters by the id of the printed number that each one is, so that this is found out.
    Raises PrintedDataError for a name that no document has.
    """
    return Document(load(id, find_project().documents), compare, given=given)
