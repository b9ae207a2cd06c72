"""A drawing as part of an HTML page: its ids its own, no style of its own for the page."""

import re

_PLAIN_STYLE = re.compile(r"<style[^>]*>\s*\*\s*\{[^}]*\}\s*</style>")


def inside_page(svg: str, prefix: str, alt: str) -> str:
    """An SVG that may stand in an HTML page: its ids its own, no style of its own for the page; "" if it may not.

    matplotlib's drawings may: their one style rule, for line joins, becomes attributes of the drawing.
    """
    rules = _PLAIN_STYLE.findall(svg)
    svg = _PLAIN_STYLE.sub("", svg)
    if "<style" in svg or not svg.startswith("<svg"):
        return ""
    svg = re.sub(r"<!--.*?-->|<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    used = set(re.findall(r"(?:url\(#|href=\"#)([^)\"]+)", svg))

    def named(found: re.Match[str]) -> str:
        return f' id="{prefix}-{found[1]}"' if found[1] in used else ""

    svg = re.sub(r'\sid="([^"]*)"', named, svg)
    svg = re.sub(r"(url\(#|href=\"#)", rf"\g<1>{prefix}-", svg)
    joins = ' stroke-linejoin="round" stroke-linecap="butt"' if rules and "stroke-linejoin" in rules[0] else ""
    return f'<svg role="img" aria-label="{alt}"{joins}{svg[4:]}'
