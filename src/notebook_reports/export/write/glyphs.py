"""Characters that no font of a report has: emoji, Chinese, Japanese and Korean, and whatever the engine complains of.

In their place stands their name in angle quotes, ‹party popper›; in scripts whose characters have no telling names,
their code, ‹U+6C34›.
"""

import functools
import importlib.util
import re
import unicodedata
from pathlib import Path

ABSENT: dict[str, None] = {}
"""The characters that this process found to be absent, in the order of their finding."""
_VARIATION = re.compile("[\ufe00-\ufe0f\U0001f3fb-\U0001f3ff\u200d\u20e3\U000e0020-\U000e007f]")
_CODED = ("CJK UNIFIED", "CJK COMPATIBILITY IDEOGRAPH", "HANGUL SYLLABLE")


@functools.cache
def _of_the_widest_font() -> frozenset[int]:
    """The characters of DejaVu Sans, in which the engine looks last."""
    from fontTools.ttLib import TTFont

    spec = importlib.util.find_spec("matplotlib")
    if spec is None or spec.origin is None:
        return frozenset(range(128))
    file = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf" / "DejaVuSans.ttf"
    return frozenset(TTFont(file, lazy=True).getBestCmap())


def note_absent(text: str) -> bool:
    """Remember the characters of a text, which the engine cannot show, that no font has; was any of them not known?"""
    characters = [c for c in text if not c.isascii() and not c.isspace()]
    suspects = [c for c in characters if ord(c) not in _of_the_widest_font()] or characters
    fresh = [c for c in suspects if c not in ABSENT]
    ABSENT.update(dict.fromkeys(fresh))
    return bool(fresh)


def absent_in(text: str) -> list[str]:
    """The characters of a text known to be absent, each once."""
    if text.isascii() or not ABSENT:
        return []
    return [c for c in dict.fromkeys(text) if c in ABSENT]


def name_of(character: str) -> str:
    """What stands in the place of a character; nothing for one that only changes the look of its neighbour.

    >>> name_of("🎉"), name_of("水"), name_of("あ")
    ('‹party popper›', '‹U+6C34›', '‹hiragana letter a›')
    """
    if _VARIATION.match(character):
        return ""
    name = unicodedata.name(character, "")
    if not name or name.startswith(_CODED):
        return f"‹U+{ord(character):04X}›"
    return f"‹{name.lower()}›"


def is_east_asian(character: str) -> bool:
    """Is there a font to be had for it, see `more_fonts`?

    >>> is_east_asian("水"), is_east_asian("あ"), is_east_asian("🎉")
    (True, True, False)
    """
    return unicodedata.name(character, "").startswith(("CJK", "HIRAGANA", "KATAKANA", "HANGUL"))


def without_absent(text: str, stand_in: str = "") -> str:
    """The text with the names of absent characters, or with a stand-in, in their place."""
    found = absent_in(text)
    if not found:
        return text
    table = {ord(c): stand_in or name_of(c) for c in found}
    return text.translate(table)


def latex_without_absent(latex: str) -> str:
    """The same for a formula, where a name is text."""
    found = absent_in(latex)
    return latex.translate({ord(c): rf"\text{{{name_of(c)}}}" for c in found}) if found else latex
