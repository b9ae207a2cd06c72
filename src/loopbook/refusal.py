"""A question without a sound answer, refused in words for readers of a report and with advice for programmers."""

from derivations.errors import LoopbookError


class Refusal(LoopbookError):
    """reason: what is wrong and what to do, in the field's words. advice: the function or option that does it.

    The message has both.

    >>> error = Refusal("the process integrates: take the final tangent", "use integrating_step")
    >>> print(error)
    the process integrates: take the final tangent (use integrating_step)
    >>> print(error.reason)
    the process integrates: take the final tangent
    >>> print(error.advice)
    use integrating_step
    """

    def __init__(self, reason: str, advice: str = ""):
        super().__init__(f"{reason} ({advice})" if advice else reason)
        self.reason, self.advice = reason, advice
