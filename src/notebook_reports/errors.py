"""The error that all errors of the press are; it stands alone, and so has its own."""


class PressError(Exception):
    """A notebook, its data or its machine does not allow what was asked; the message names it and how to mend it.

    >>> from notebook_reports.formula.read import FormulaError
    >>> issubclass(FormulaError, PressError)
    True
    """
