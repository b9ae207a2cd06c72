"""The words of a statement that a test reads: numbers, formulas and directions, kept as fields beside the sentence.

    says = "The steady error {error:grows|falls} with $K_p$; it is ${formula}$."
    error = "down"
    formula = "1/(1 + K_p*k)"

``{name}`` stands for the field's text, ``{name:one|other}`` for the first choice where the field is "up" and for the
second where it is "down". So a sentence cannot say anything else than what its test looks at.
"""

import re
from collections.abc import Mapping

from notebook_reports.errors import PressError

UP, DOWN = "up", "down"
_FIELD = re.compile(r"\{([a-zA-Z]\w*)(?::([^{}|]*)\|([^{}|]*))?\}")


class WordsError(PressError, ValueError):
    """A sentence and its fields do not fit together."""


def told(says: str, fields: Mapping[str, str]) -> str:
    """The sentence with its fields in it.

    >>> told("It {way:rises|falls} by {much} %, $T_{63}$.", {"way": "down", "much": "20"})
    'It falls by 20 %, $T_{63}$.'

    Raises WordsError for a field that the sentence does not use, and for a direction that is neither up nor down.
    """
    used = set()

    def word(match: re.Match[str]) -> str:
        name, up, down = match.groups()
        if name not in fields:
            if up is None:
                return match[0]  # braces of a formula
            raise WordsError(f"the sentence needs a field {name}")
        used.add(name)
        if up is None:
            return fields[name]
        if fields[name] not in (UP, DOWN):
            raise WordsError(f"{name} = {fields[name]!r}; a direction is {UP!r} or {DOWN!r}")
        return up if fields[name] == UP else down

    text = _FIELD.sub(word, says)
    if idle := set(fields) - used:
        raise WordsError(f"the sentence does not use its field {', '.join(sorted(idle))}")
    return text


def shown(outcome: object, text: str, otherwise: str = "") -> str:
    """Evidence that is not a number: the text where the outcome is true, its opposite where it is not.

    >>> shown(1 + 1 == 2, "the two are equal"), shown(1 + 1 == 3, "the two are equal")
    ('the two are equal', 'not so: the two are equal')
    >>> shown(False, "equal", "different")
    'different'
    """
    return text if outcome else otherwise or f"not so: {text}"
