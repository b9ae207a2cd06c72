"""Footnotes whose text stands in another cell than the reference to them."""

import re
from collections.abc import Iterable

_TEXT = re.compile(r"^ {0,3}\[\^([^\]\s]+)\]:[ \t]*(.*(?:\n(?: {2,}|\t)\S.*|\n[ \t]*\n(?: {4}|\t)\S.*)*)", re.MULTILINE)
_REFERENCE = re.compile(r"\[\^([^\]\s]+)\](?!:)")
_FENCED = re.compile(r"^(```|~~~).*?^\1|`[^`\n]+`", re.MULTILINE | re.DOTALL)


def footnotes(sources: Iterable[str]) -> dict[str, str]:
    """The texts of all footnotes in Markdown by key; of a key with several, the first."""
    found: dict[str, str] = {}
    for source in sources:
        for key, text in _TEXT.findall(_FENCED.sub("", source)):
            found.setdefault(key, text)
    return found


def with_missing(source: str, known: dict[str, str]) -> tuple[str, frozenset[str]]:
    """The text with the footnotes that it refers to and another cell has, and the keys of these."""
    if not known or "[^" not in source:
        return source, frozenset()
    plain = _FENCED.sub("", source)
    own = {key for key, _ in _TEXT.findall(plain)}
    missing = dict.fromkeys(key for key in _REFERENCE.findall(plain) if key in known and key not in own)
    added = "".join(f"\n\n[^{key}]: {known[key]}" for key in missing)
    return source + added, frozenset(missing)


def unused(source: str, sources_refer: frozenset[str]) -> list[tuple[str, str]]:
    """The footnotes of a text that nothing refers to, with their keys."""
    return [(key, text) for key, text in _TEXT.findall(_FENCED.sub("", source)) if key not in sources_refer]


def references(sources: Iterable[str]) -> frozenset[str]:
    """The keys that any of the texts refers to."""
    return frozenset(key for source in sources for key in _REFERENCE.findall(_FENCED.sub("", source)))
