"""Characters that no font of a report has: emoji, Chinese, Japanese and Korean, and whatever the engine complains of.

In their place stands their name in angle quotes, ‹party popper›; in scripts whose characters have no telling names,
their code, ‹U+6C34›.
"""

import re
import unicodedata

ABSENT: dict[str, None] = {}
"""The characters that this process found to be absent, in the order of their finding."""
_VARIATION = re.compile("[\ufe00-\ufe0f\U0001f3fb-\U0001f3ff\u200d\u20e3\U000e0020-\U000e007f]")
_CODED = ("CJK UNIFIED", "CJK COMPATIBILITY IDEOGRAPH", "HANGUL SYLLABLE")


def note_absent(characters: str) -> bool:
    """Remember characters that no font has; were any of them not known?"""
    fresh = [c for c in characters if c not in ABSENT and not c.isspace()]
    ABSENT.update(dict.fromkeys(fresh))
    return bool(fresh)


def absent_in(text: str) -> list[str]:
    """The characters of a text known to be absent, each once."""
    if text.isascii() or not ABSENT:
        return []
    return [c for c in dict.fromkeys(text) if c in ABSENT]


def name_of(character: str) -> str:
    """What stands in the place of a character.

    >>> name_of("🎉"), name_of("水"), name_of("あ")
    ('‹party popper›', '‹U+6C34›', '‹hiragana letter a›')
    """
    name = unicodedata.name(character, "")
    if not name or name.startswith(_CODED):
        return f"‹U+{ord(character):04X}›"
    return f"‹{name.lower()}›"


def without_absent(text: str, stand_in: str = "") -> str:
    """The text with the names of absent characters, or with a stand-in, in their place."""
    found = absent_in(text)
    if not found:
        return text
    table = {ord(c): stand_in or ("" if _VARIATION.match(c) else name_of(c)) for c in found}
    return text.translate(table)
