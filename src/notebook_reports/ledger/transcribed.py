"""The documents of a project, as transcribed."""

from notebook_reports.ledger.printed_data import PrintedDocument, documents, load
from notebook_reports.project.project import Project


def printed_documents(project: Project) -> list[PrintedDocument]:
    """What the project holds of printed data, read anew, in the order of the book. Raises PrintedDataError."""
    order = project.parts()
    found = sorted(
        documents(project.documents),
        key=lambda id: (order.index(f) if (f := id.replace("-", "_")) in order else len(order), id),
    )
    return [load(id, project.documents) for id in found]
