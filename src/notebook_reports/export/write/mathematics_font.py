"""The font of formulas inside an HTML page: the part of New Computer Modern Math that the page's formulas need.

The font is the one that sets the formulas of the PDF; it is read out of the typst package, which carries it in its
library. Browsers draw MathML with it as they are; on a machine without a mathematics font it is what makes roots,
brackets and sums grow. License of the font: GUST Font License, named in the part too.
"""

import base64
import functools
import importlib.util
import io
import mmap
import re
import struct
from html import unescape
from pathlib import Path

from notebook_reports.mathematics.alphabets import styled

FAMILY = "Formulas of this page"
_NAME = b"NewComputerModernMath-Regular"
_PRIMES = frozenset("′″‴⁗‵")
"""These alone need the shapes for scripts: at their usual size they stand too high in one."""
_MATH = re.compile(r"<math\b.*?</math>", re.DOTALL)
_ROOT = re.compile(r"<m(sqrt|root)\b")
"""A root is an element; the browser draws its sign, which stands in no text."""


def font_face(page: str) -> str:
    """The CSS rule that brings the font for the formulas of an HTML page; nothing for a page without any."""
    found = _MATH.findall(page)
    formulas = "".join(re.sub(r"<[^>]*>", "", formula) for formula in found)
    if not formulas:
        return ""
    roots = frozenset("√" if any(map(_ROOT.search, found)) else "")
    data = _part(frozenset(unescape(formulas)) - {"\n", "\t"} | frozenset("0123456789 ") | roots)
    if not data:
        return ""
    return f'@font-face {{ font-family: "{FAMILY}"; src: url(data:font/otf;base64,{data}) format("opentype"); }}'


@functools.lru_cache(maxsize=32)
def _part(characters: frozenset[str]) -> str:
    """The part of the font for the characters, in base64. A letter alone is set in italics: these are added."""
    font = _whole()
    if not font:
        return ""
    from fontTools import subset
    from fontTools.ttLib import TTFont

    options = subset.Options()
    options.layout_features = ["dtls", *(["ssty"] if characters & _PRIMES else [])]
    options.name_IDs = [0, 13]
    options.hinting = False
    options.drop_tables += ["FFTM", "PfEd", "GPOS"]
    italic = {letter for c in characters if (letter := styled(c, "italic"))}
    part = TTFont(io.BytesIO(font), lazy=True, recalcTimestamp=False)
    subsetter = subset.Subsetter(options)
    subsetter.populate(text="".join(sorted(characters | italic)))
    subsetter.subset(part)
    written = io.BytesIO()
    part.save(written)
    return base64.b64encode(written.getvalue()).decode()


@functools.cache
def _whole() -> bytes:
    """The font's bytes, found in typst's library by its name; nothing where a later one has them otherwise."""
    spec = importlib.util.find_spec("typst")
    folder = Path(spec.origin).parent if spec and spec.origin else Path()
    for library in sorted([*folder.glob("*.so"), *folder.glob("*.pyd")]):
        with library.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            at = data.find(b"OTTO")
            while at >= 0:
                size = _size(data, at)
                if size and _NAME in data[at : at + size]:
                    return data[at : at + size]
                at = data.find(b"OTTO", at + 4)
    return b""


def _size(data: mmap.mmap, at: int) -> int:
    """The length of the font that begins here, if it is one for mathematics."""
    count = struct.unpack(">H", data[at + 4 : at + 6])[0]
    if not 8 <= count <= 40:
        return 0
    tables = [struct.unpack(">4s4xII", data[at + 12 + 16 * k : at + 28 + 16 * k]) for k in range(count)]
    named = {tag for tag, _, _ in tables}
    return max(start + length for _, start, length in tables) if {b"MATH", b"CFF "} <= named else 0
