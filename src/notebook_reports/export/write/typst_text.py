"""Text as it enters Typst source: string literals, and places where a line may end."""

import re

LONGEST_WORD, LONGEST_CODE_IN_A_TABLE = 44, 16
"""Characters of a word that is never broken."""


def literal(text: str) -> str:
    r"""A Typst string literal.

    >>> print(literal('a "b" \\ #c'))
    "a \"b\" \\ #c"
    """
    text = text.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "").replace("\n", "\\n").replace("\t", "\\t")
    return f'"{text}"'


def breakable(text: str, longest: int = LONGEST_WORD) -> str:
    """Give words too long for a line places to break, after punctuation or each 20 characters (zero width spaces)."""

    def mend(found: re.Match[str]) -> str:
        word = found[0]
        if len(word) <= longest:
            return word
        if re.match(r"https?://", word):
            return re.sub(r"(?<=[/?&=_.-])(?=[^/])", "\u200b", word)
        word = re.sub(r"(?<=[,;:/_.=()\[\]{}|*+-])(?=[\w(%])", "\u200b", word)
        return re.sub(r"[^\u200b]{20}(?=[^\u200b])", lambda m: m[0] + "\u200b", word)

    return re.sub(r"\S+", mend, text)
