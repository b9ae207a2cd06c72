"""TeX lengths."""

import re

from notebook_reports.mathematics import symbols

_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*(em|ex|mu|pt|mm|cm|in|pc)\s*")


def length_in_em(text: str) -> float | None:
    """The length in em of a 10 pt font, or None where the text is no length with a unit."""
    match = _LENGTH.fullmatch(text)
    return float(match[1]) * symbols.UNITS[match[2]] if match else None
