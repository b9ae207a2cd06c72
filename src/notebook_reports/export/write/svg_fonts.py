"""Fonts of a drawing: text in a font that is not there would vanish from the PDF without a word."""

import re

ROMAN_FONTS = ("DejaVu Sans", "DejaVu Serif", "DejaVu Sans Mono", "STIXGeneral", "Libertinus Serif", "cmr10", "cmmi10")
_FAMILY = re.compile(
    r"(?P<key>\bfont(?:-family)?\s*:\s*)(?P<names>[^;\"}<]+)|(?P<attr>\bfont-family\s*=\s*)(?P<quote>[\"'])(?P<list>.*?)(?P=quote)"
)


def with_known_fonts(svg: bytes) -> bytes:
    """The drawing, with a font we have wherever it names only others: text in a font that is not there would vanish."""
    text = svg.decode()

    def known(names: str) -> bool:
        return any(font.lower() in names.lower() for font in ROMAN_FONTS)

    def stand_in(names: str) -> str:
        if "mono" in names.lower() or "courier" in names.lower():
            return "DejaVu Sans Mono"
        return "Libertinus Serif" if re.search(r"times|georgia|(?<!sans-)serif", names, re.I) else "DejaVu Sans"

    def mend(found: re.Match[str]) -> str:
        names = found["names"] or found["list"]
        if known(names) or names.strip() in ("inherit", "normal"):
            return found[0]
        quote = "'" if found["quote"] != "'" else ""
        extra = f"{names.rstrip()}, {quote}{stand_in(names)}{quote}"
        return f"{found['key']}{extra}" if found["key"] else f"{found['attr']}{found['quote']}{extra}{found['quote']}"

    text = _FAMILY.sub(mend, text)
    root = re.match(r"(<(?:\w+:)?svg\b)[^>]*>", text)
    if root and "font-family" not in root[0]:
        at = root.end(1)
        text = f'{text[:at]} font-family="DejaVu Sans"{text[at:]}'
    return text.encode()
