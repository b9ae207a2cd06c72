"""Names and values from data in sentences and table cells: always text, never markup."""

from loopbook.identification.choice import Identified
from notebook_reports.display import literal, number
from notebook_reports.project.printable import printable


def as_plain_text(text: str) -> str:
    """Text from a file as inline text that shows it as it is; what does not print as Python writes it.

    >>> as_plain_text("cost [$]")
    'cost [\\\\$]'
    """
    return literal(printable(str(text)))


class Units:
    """The names and units of a record's signals; of a model "u" and "y" without units."""

    def __init__(self, found: Identified | None):
        record = found.record if found else None
        self.u = as_plain_text(record.input_name) if record else "u"
        self.y = as_plain_text(record.output_name) if record else "y"
        self._u, self._y = (record.input_unit, record.output_unit) if record else ("", "")

    def input(self, value: float, digits: int = 4) -> str:
        return f"{number(value, digits)} {as_plain_text(self._u)}".rstrip()

    def output(self, value: float, digits: int = 4) -> str:
        return f"{number(value, digits)} {as_plain_text(self._y)}".rstrip()
