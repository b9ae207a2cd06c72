"""Text as it enters Typst source: string literals, and places where a line may end."""

import re

LONGEST_WORD, LONGEST_CODE_IN_A_TABLE, LONGEST_IN_A_LISTING, LONGEST_ADDRESS = 44, 16, 60, 56
"""Characters of a word that is never broken."""


def typst_string(text: str) -> str:
    r"""A Typst string literal.

    >>> print(typst_string('a "b" \\ #c'))
    "a \"b\" \\ #c"
    """
    text = text.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "").replace("\n", "\\n").replace("\t", "\\t")
    return f'"{text}"'


_STARTS_NO_LINE = frozenset(",.:;!?/)]}、。，．：；！？）］｝」』】〉》％")
_ENDS_NO_LINE = frozenset("([{（［｛「『【〈《")
_QUOTES = frozenset("\"'«»“”‘’")
_TOKENS = re.compile(r"[^\s\u200b]+|\u200b|[^\S\u200b]+")

Piece = tuple[str, bool]
"""Characters, and whether they are put into a box, beside which a line may end whatever the characters are."""


def text_pieces(text: str, longest: int = LONGEST_WORD, stuck: int = LONGEST_WORD) -> list[Piece]:
    """Text in pieces between which a line may end, besides the places where the engine ends one by itself.

    A line does not end before a closing bracket or a mark such as : ; . , and ! nor after an opening one, even where
    spaces stand there; tokens that all begin so would never be broken. Where more than `stuck` characters stick
    together like that, such tokens stand in boxes. longest: characters of a word that is never broken.

    >>> text_pieces("a :b", stuck=2)
    [('a ', False), (':b', True)]
    """
    tokens = _TOKENS.findall(breakable(text, longest))
    boxed = _stuck(tokens, stuck)
    found: list[Piece] = []
    fresh = True
    for i, token in enumerate(tokens):
        if token == "\u200b":
            fresh = True
        elif i in boxed:
            found.append((token, True))
            fresh = True
        elif fresh or not found:
            found.append((token, False))
            fresh = False
        else:
            found[-1] = (found[-1][0] + token, False)
    return found


def _stuck(tokens: list[str], longest: int) -> set[int]:
    """The places of the tokens to be boxed."""
    boxed: set[int] = set()
    group: set[int] = set()
    length, before = 0, -1
    for i, token in enumerate([*tokens, "\u200b"]):
        if token.isspace():
            length += len(token)
            continue
        bound = before >= 0 and token != "\u200b" and _bound(tokens[before], token, i - before)
        if not bound:
            boxed |= group if length > longest else set()
            group, length = set(), 0
        elif token[0] in _STARTS_NO_LINE:
            group.add(i)
        else:
            group.add(before)
        length += len(token)
        before = -1 if token == "\u200b" else i
    return boxed


def _bound(before: str, token: str, steps: int) -> bool:
    """Does the engine keep two tokens with a space between them on one line?"""
    if steps < 2:
        return False
    quoted = before[-1] in _QUOTES and token[0] in _ENDS_NO_LINE
    return token[0] in _STARTS_NO_LINE or before[-1] in _ENDS_NO_LINE or quoted


def flowing(text: str, longest: int = LONGEST_WORD, stuck: int = LONGEST_WORD) -> str:
    """Markup that shows the text.

    >>> flowing("word")
    '#"word";'
    """
    code, before = "", True
    for piece, boxed in text_pieces(text, longest, stuck):
        code += "" if before or boxed else "#brk;"
        code += f"#box({typst_string(piece)});" if boxed else f"#{typst_string(piece)};"
        before = boxed
    return code


def breakable(text: str, longest: int = LONGEST_WORD) -> str:
    """Give words too long for a line places to break, after punctuation or each 20 characters (zero width spaces)."""

    def mend(found: re.Match[str]) -> str:
        word = found[0]
        if len(word) <= longest:
            return word
        if re.match(r"https?://", word) and len(word) < 400:
            return re.sub(r"(?<=[/?&=_.-])(?=[^/])", "\u200b", word)
        word = re.sub(r"(?<=[,;:/_.=()\[\]{}|*+-])(?=[\w(%])", "\u200b", word) if len(word) < 5_000 else word
        return re.sub(r"[^\u200b]{20}(?=[^\u200b])", lambda m: m[0] + "\u200b", word)

    return re.sub(r"\S+", mend, text)
