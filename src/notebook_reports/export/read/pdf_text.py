"""The text of a PDF that Typst made, run by run in reading order, with its place on the page.

Only what Typst writes is read: plain objects, composite fonts with two bytes a glyph and a table to Unicode. It is how
a page is checked: that every word is there, and that none leaves the paper.
"""

import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

Matrix = tuple[float, float, float, float, float, float]
_IDENTITY: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


@dataclass(frozen=True)
class TextRun:
    """Characters in one font on one line. x0, x1, end, y: points from the left and the bottom of the page; x1 is where
    the last letter ends and end where the last space does; y is of the line. drawn: part of a picture."""

    page: int
    text: str
    x0: float
    x1: float
    end: float
    y: float
    size: float
    drawn: bool = False


@dataclass(frozen=True)
class Mark:
    """Something that stands on a page, from `low` to `high`, in points from the bottom."""

    page: int
    low: float
    high: float


@dataclass(frozen=True)
class _Font:
    characters: dict[int, str]
    widths: dict[int, float]
    usual: float


class PdfText:
    """The pages of one PDF. sizes: width and height of each in points."""

    def __init__(self, pdf: bytes):
        self._objects = {int(n): body for n, body in re.findall(rb"\n(\d+) 0 obj\n(.*?)\nendobj", pdf, re.DOTALL)}
        self._fonts: dict[int, _Font] = {}
        self._kinds: dict[int, bytes] = {}
        self.pages = self._kids(_number(rb"/Type/Catalog\b.*?/Pages (\d+) 0 R", pdf))
        boxes = [re.search(rb"/MediaBox\s*\[([^\]]*)\]", self._objects[page]) for page in self.pages]
        self.sizes = [tuple(float(v) for v in box[1].split()[2:]) for box in boxes if box]

    def _kids(self, number: int) -> list[int]:
        body = self._objects[number]
        kids = re.search(rb"/Kids\s*\[([^\]]*)\]", body)
        if not kids:
            return [number]
        return [page for kid in re.findall(rb"(\d+) 0 R", kids[1]) for page in self._kids(int(kid))]

    def runs(self) -> Iterator[TextRun]:
        """Every run of text, page by page."""
        return (found for found in self._found() if isinstance(found, TextRun))

    def marks(self) -> Iterator[Mark]:
        """What stands on the pages: runs of text, lines, areas and pictures."""
        for found in self._found():
            if isinstance(found, Mark):
                yield found
            elif found.text.strip():
                yield Mark(found.page, found.y - 0.25 * found.size, found.y + 0.75 * found.size)

    def _found(self) -> Iterator[TextRun | Mark]:
        for place, page in enumerate(self.pages, start=1):
            body = self._objects[page]
            content = re.search(rb"/Contents (\d+) 0 R", body)
            if content:
                resources = self._resources(body)
                yield from self._read(self._stream(int(content[1])), resources, _IDENTITY, place, False, 0)

    def _resources(self, body: bytes) -> dict[str, dict[str, int]]:
        found = re.search(rb"/Resources (\d+) 0 R", body)
        text = self._objects[int(found[1])] if found else body
        named: dict[str, dict[str, int]] = {}
        for kind in ("Font", "XObject", "Pattern"):
            table = re.search(rb"/" + kind.encode() + rb"\s*<<([^>]*)>>", text)
            pairs = re.findall(rb"/(\S+) (\d+) 0 R", table[1]) if table else []
            named[kind] = {name.decode(): int(number) for name, number in pairs}
        return named

    def _stream(self, number: int) -> bytes:
        body = self._objects[number]
        start = re.search(rb"stream\r?\n", body)
        if not start:
            return b""
        data = body[start.end() :]
        end = data.rfind(b"\nendstream")
        data = data[:end] if end >= 0 else data
        return zlib.decompressobj().decompress(data) if b"FlateDecode" in body[: start.start()] else data

    def _font(self, number: int) -> _Font:
        if number not in self._fonts:
            body = self._objects[number]
            table = self._stream(_number(rb"/ToUnicode (\d+) 0 R", body))
            below = self._objects[_number(rb"/DescendantFonts\s*\[(\d+) 0 R", body)]
            usual = re.search(rb"/DW ([\d.]+)", below)
            self._fonts[number] = _Font(_characters(table), _widths(below), float(usual[1]) if usual else 1000.0)
        return self._fonts[number]

    def _read(
        self,
        content: bytes,
        resources: dict[str, dict[str, int]],
        matrix: Matrix,
        page: int,
        drawn: bool,
        depth: int,
    ) -> Iterator[TextRun | Mark]:
        stack: list[Matrix] = []
        path: list[float] = []
        for found in _OPERATORS.finditer(content):
            match found.lastgroup:
                case "save":
                    stack.append(matrix)
                case "restore" if stack:
                    matrix = stack.pop()
                case "moved":
                    matrix = _times(_matrix(found["moved"]), matrix)
                case "text":
                    yield from self._text(found["text"], resources["Font"], matrix, page, drawn)
                case "points" | "corner":
                    path += _heights(found[found.lastgroup], matrix, found.lastgroup == "corner")
                case "painted":
                    if path:
                        yield Mark(page, min(path), max(path))
                    path = []
                case "clipped":
                    path = []
                case "drawing" if depth < 12:
                    number = resources["XObject"].get(found["drawing"].decode(), -1)
                    body = self._objects.get(number, b"")
                    if b"/Subtype/Image" in body:
                        yield Mark(page, *sorted((matrix[5], matrix[3] + matrix[5])))
                    if b"/Subtype/Form" in body:
                        own = re.search(rb"/Matrix\s*\[([^\]]*)\]", body)
                        inner = _times(_matrix(own[1]), matrix) if own else matrix
                        inside = self._resources(body[: body.find(b"stream")])
                        yield from self._read(self._stream(number), inside, inner, page, True, depth + 1)

    def _text(self, block: bytes, fonts: dict[str, int], matrix: Matrix, page: int, drawn: bool) -> Iterator[TextRun]:
        font, size, place, said = None, 0.0, _IDENTITY, None
        for found in _IN_TEXT.finditer(block):
            match found.lastgroup:
                case "said":
                    said = _said(found["said"].strip())
                case "end":
                    said = None
                case "font":
                    name, points = found["font"].split()
                    font, size = self._font(fonts[name[1:].decode()]), float(points)
                case "place":
                    place = _matrix(found["place"])
                case "shown" | "one" if font:
                    text, advance, inked = "", 0.0, 0.0
                    for piece in _PIECES.finditer(found[found.lastgroup]):
                        if piece["shift"]:
                            advance -= float(piece["shift"])
                            continue
                        data = (
                            bytes.fromhex(piece["hex"].decode()) if piece["hex"] is not None else _plain(piece["raw"])
                        )
                        for i in range(0, len(data) - 1, 2):
                            glyph = data[i] << 8 | data[i + 1]
                            character = font.characters.get(glyph, "")
                            text += character if said is None else ""
                            advance += font.widths.get(glyph, font.usual)
                            inked = inked if character.isspace() else advance
                    whole = _times(place, matrix)
                    x0, y = whole[4], whole[5]
                    text, said = (text, None) if said is None else (said, "")
                    end, after = (x0 + size * whole[0] * reach / 1000 for reach in (inked, advance))
                    yield TextRun(page, text, x0, end, after, y, size * abs(whole[3]), drawn)


def _heights(operands: bytes, matrix: Matrix, corner: bool) -> list[float]:
    """Where points lie above the bottom of the page: x y of some, or x y width height of a rectangle."""
    values = [float(v) for v in operands.split()]
    if corner:
        x, y, width, height = values
        values = [x, y, x + width, y + height, x, y + height, x + width, y]
    return [matrix[1] * x + matrix[3] * y + matrix[5] for x, y in zip(values[::2], values[1::2], strict=True)]


def _number(pattern: bytes, text: bytes) -> int:
    found = re.search(pattern, text, re.DOTALL)
    if found is None:
        raise ValueError(f"no {pattern.decode()} in the PDF")
    return int(found[1])


def _matrix(text: bytes) -> Matrix:
    a, b, c, d, e, f = (float(v) for v in text.split()[:6])
    return a, b, c, d, e, f


_NUMBERS = rb"(?:-?[\d.]+\s+){6}"
_STRING = rb"\((?:\\.|[^\\()]|\((?:\\.|[^\\()]|\((?:\\.|[^\\()])*\))*\))*\)"
_OPERATORS = re.compile(
    rb"(?P<text>\bBT(?=[\s/]).*?\sET\b)|(?P<moved>" + _NUMBERS + rb"cm\b)|(?P<drawing>(?<=/)[^\s/]+(?=\s+Do\b))"
    rb"|(?P<save>(?<![^\s])q(?=\s))|(?P<restore>(?<![^\s])Q(?=\s|$))"
    rb"|(?P<corner>(?:-?[\d.]+\s+){4})re(?=\s)|(?P<points>(?:(?:-?[\d.]+\s+){2}){1,3})[mlc](?=\s)"
    rb"|(?P<painted>(?<![^\s])[fFSsBb]\*?(?=\s))|(?P<clipped>(?<![^\s])n(?=\s))",
    re.DOTALL,
)
_IN_TEXT = re.compile(
    rb"(?P<said>(?<=/ActualText)\s*(?:"
    + _STRING
    + rb"|<[0-9A-Fa-f]*>))|(?P<end>\bEMC\b)|(?P<font>/\S+ [\d.]+(?= Tf))|(?P<place>"
    + _NUMBERS
    + rb"Tm)"
    rb"|(?P<shown>\[(?:" + _STRING + rb"|[^\]()])*\](?=\s*TJ))|(?P<one>(?:" + _STRING + rb"|<[0-9A-Fa-f]*>)(?=\s*Tj))",
    re.DOTALL,
)
_PIECES = re.compile(rb"(?P<raw>" + _STRING + rb")|<(?P<hex>[0-9A-Fa-f]*)>|(?P<shift>-?[\d.]+)", re.DOTALL)
_ESCAPE = re.compile(rb"\\([0-7]{1,3}|\r?\n|.)", re.DOTALL)
_NAMED = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


def _plain(raw: bytes) -> bytes:
    def named(found: re.Match[bytes]) -> bytes:
        code = found[1]
        if code[:1] in b"01234567":
            return bytes([int(code, 8) & 255])
        return b"" if code.endswith(b"\n") else _NAMED.get(code, code)

    return _ESCAPE.sub(named, raw[1:-1])


def _said(raw: bytes) -> str:
    """What stands for the glyphs of a piece of text."""
    data = bytes.fromhex(raw.strip(b"<>").decode()) if raw.startswith(b"<") else _plain(raw)
    return data[2:].decode("utf-16-be", errors="replace") if data.startswith(b"\xfe\xff") else data.decode("latin-1")


def _times(a: Matrix, b: Matrix) -> Matrix:
    return (
        a[0] * b[0] + a[1] * b[2],
        a[0] * b[1] + a[1] * b[3],
        a[2] * b[0] + a[3] * b[2],
        a[2] * b[1] + a[3] * b[3],
        a[4] * b[0] + a[5] * b[2] + b[4],
        a[4] * b[1] + a[5] * b[3] + b[5],
    )


def _characters(table: bytes) -> dict[int, str]:
    found: dict[int, str] = {}
    for block in re.findall(rb"beginbfchar(.*?)endbfchar", table, re.DOTALL):
        for glyph, text in re.findall(rb"<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]*)>", block):
            found[int(glyph, 16)] = bytes.fromhex(text.decode()).decode("utf-16-be", errors="replace")
    for block in re.findall(rb"beginbfrange(.*?)endbfrange", table, re.DOTALL):
        for first, last, text in re.findall(rb"<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]+)>", block):
            for glyph in range(int(first, 16), int(last, 16) + 1):
                found[glyph] = chr(int(text, 16) + glyph - int(first, 16))
    return found


def _widths(font: bytes) -> dict[int, float]:
    table = re.search(rb"/W\s*\[(.*)\]", font, re.DOTALL)
    found: dict[int, float] = {}
    tokens = re.findall(rb"\[|\]|[\d.]+", table[1]) if table else []
    i = 0
    while i < len(tokens):
        if i + 1 < len(tokens) and tokens[i + 1] == b"[":
            glyph, i = int(tokens[i]), i + 2
            while i < len(tokens) and tokens[i] != b"]":
                found[glyph] = float(tokens[i])
                glyph, i = glyph + 1, i + 1
            i += 1
        elif i + 2 < len(tokens):
            width = float(tokens[i + 2])
            found.update(dict.fromkeys(range(int(tokens[i]), int(tokens[i + 1]) + 1), width))
            i += 3
        else:
            break
    return found
