"""The error that all errors of derivations and loopbook are."""


class LoopbookError(ValueError):
    """What was asked for has no answer as asked: its message says what is wrong, where, and how to mend it.

    >>> from derivations.algebra.delay_polynomials import DelayPolynomialError
    >>> issubclass(DelayPolynomialError, LoopbookError)
    True
    """
