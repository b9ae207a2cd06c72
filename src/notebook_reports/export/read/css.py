"""How HTML asks its elements to look: style sheets, style attributes and the old attributes, as far as a page follows.

A page follows colours, weight, slope, alignment, sizes of pictures, and what is hidden; nothing else of CSS.
"""

import functools
import re
from dataclasses import dataclass, replace

from bs4 import BeautifulSoup, Tag

FOLLOWED = {"color", "background-color", "background", "font-weight", "font-style", "text-align", "display"}
FOLLOWED |= {"visibility", "width", "height", "max-width", "text-decoration", "text-decoration-line"}
MOST_SELECTORS = 300
"""Selectors other than of one element or one class that are looked up in one text."""

Rule = tuple[str, dict[str, str]]


@dataclass(frozen=True)
class Appearance:
    """ink, ground: "#rrggbb" or "". align: left, right, center or "". width, height: CSS pixels; share: of the room."""

    hidden: bool = False
    ink: str = ""
    ground: str = ""
    bold: bool = False
    italic: bool = False
    strike: bool = False
    align: str = ""
    width: float | None = None
    height: float | None = None
    share: float | None = None


PLAIN = Appearance()


class Looks:
    """The look of each element of a tree."""

    def __init__(self, tree: BeautifulSoup):
        self._asked: dict[int, dict[str, str]] = {}
        rules = [rule for sheet in tree.find_all("style") for rule in rules_of(sheet.get_text())]
        if not rules:
            return
        by_id = {str(tag["id"]): tag for tag in tree.find_all(id=True)}
        budget = MOST_SELECTORS
        for selector, declarations in sorted(rules, key=lambda rule: _weight(rule[0])):
            if re.fullmatch(r"#[\w-]+", selector):
                found = [by_id[selector[1:]]] if selector[1:] in by_id else []
            elif budget and ":" not in selector:
                budget -= 1
                found = _selected(tree, selector)
            else:
                continue
            for tag in found:
                self._asked.setdefault(id(tag), {}).update(declarations)

    def of(self, tag: Tag) -> Appearance:
        """The look of one element by itself; that of the elements around it is theirs."""
        asked = self._asked.get(id(tag), {})
        own = tag.attrs
        if not asked and not (own.keys() & {"style", "color", "bgcolor", "align", "width", "height", "hidden"}):
            return PLAIN
        return _look(
            tuple(sorted(asked.items())),
            str(own.get("style", "")),
            str(own.get("color", "")) if tag.name == "font" else "",
            str(own.get("bgcolor", "")),
            str(own.get("align", "")),
            str(own.get("width", "")),
            str(own.get("height", "")),
            "hidden" in own,
        )


@functools.lru_cache(maxsize=4000)
def _look(
    asked: tuple[tuple[str, str], ...],
    style: str,
    color: str,
    bgcolor: str,
    align: str,
    width: str,
    height: str,
    hidden: bool,
) -> Appearance:
    told = {"color": color, "background-color": bgcolor, "text-align": align, "width": width, "height": height}
    told |= {**dict(asked), **declarations(style)}
    ground = told.get("background-color") or told.get("background", "")
    wide = told["width"] if told["width"] not in ("", "auto") else told.get("max-width", "")
    share = re.fullmatch(r"\s*([\d.]+)\s*%\s*", wide)
    look = Appearance(
        hidden=hidden or told.get("display") == "none" or told.get("visibility") == "hidden",
        ink=color_of(told["color"]),
        ground=color_of(ground),
        bold=bool(re.match(r"bold|[6-9]00", told.get("font-weight", ""))),
        italic=told.get("font-style", "") in ("italic", "oblique"),
        strike="line-through" in told.get("text-decoration", "") + told.get("text-decoration-line", ""),
        width=None if share else pixels(wide),
        height=pixels(told["height"]),
        share=min(1.0, float(share[1]) / 100) if share and float(share[1]) > 0 else None,
    )
    wanted = told["text-align"].strip().lower()
    return replace(look, align=wanted if wanted in ("left", "right", "center") else "")


@functools.lru_cache(maxsize=500)
def rules_of(sheet: str) -> tuple[Rule, ...]:
    """The rules of a style sheet that ask for something a page follows, one a selector."""
    import tinycss2

    found: list[Rule] = []
    for rule in tinycss2.parse_stylesheet(sheet, skip_comments=True, skip_whitespace=True):
        if rule.type != "qualified-rule":
            continue
        asked = _declared(rule.content)
        if asked:
            selectors = tinycss2.serialize(rule.prelude).split(",")
            found += [(selector.strip(), asked) for selector in selectors if selector.strip()]
    return tuple(found)


def declarations(style: str) -> dict[str, str]:
    """The declarations of a style attribute that a page follows."""
    return _declared(style) if style else {}


def _declared(content: str | list) -> dict[str, str]:
    import tinycss2

    found: dict[str, str] = {}
    for declaration in tinycss2.parse_declaration_list(content, skip_comments=True, skip_whitespace=True):
        if declaration.type == "declaration" and declaration.lower_name in FOLLOWED:
            found[declaration.lower_name] = tinycss2.serialize(declaration.value).strip().lower()
    return found


def _weight(selector: str) -> tuple[int, int]:
    return selector.count("#"), len(re.findall(r"[.:\[]", selector))


def _selected(tree: BeautifulSoup, selector: str) -> list[Tag]:
    from soupsieve import SelectorSyntaxError

    try:
        return tree.select(selector)
    except (SelectorSyntaxError, NotImplementedError, ValueError):
        return []


@functools.lru_cache(maxsize=1000)
def color_of(text: str) -> str:
    """A CSS colour on white as "#rrggbb"; "" for none, a transparent one, or what is no colour.

    >>> color_of("red"), color_of("rgba(0, 0, 0, 0.5)"), color_of("var(--ink)")
    ('#ff0000', '#808080', '')
    """
    if not text:
        return ""
    from tinycss2.color3 import parse_color

    color = parse_color(text)
    if color is None or color == "currentColor" or color.alpha == 0:
        return ""
    shares = (1 - color.alpha + color.alpha * part for part in (color.red, color.green, color.blue))
    return "#" + "".join(f"{round(255 * min(1.0, max(0.0, share))):02x}" for share in shares)


_UNITS = {"": 1.0, "px": 1.0, "pt": 4 / 3, "pc": 16.0, "em": 16.0, "rem": 16.0, "ex": 8.0, "ch": 8.0, "in": 96.0}
_UNITS |= {"cm": 96 / 2.54, "mm": 9.6 / 2.54}


def pixels(text: str) -> float | None:
    """A CSS length in pixels, if it is one that does not depend on the window.

    >>> pixels("2in"), pixels("300"), pixels("80%")
    (192.0, 300.0, None)
    """
    found = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*([a-z]*)\s*(?:!important)?\s*", text.lower())
    value = float(found[1]) * _UNITS[found[2]] if found and found[2] in _UNITS else 0.0
    return value or None


def readable_on(ground: str) -> str:
    """Black or white, whichever can be read on a ground.

    >>> readable_on("#ffff00"), readable_on("#000080")
    ('#000000', '#ffffff')
    """
    red, green, blue = (int(ground[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return "#000000" if 0.2126 * red**2.2 + 0.7152 * green**2.2 + 0.0722 * blue**2.2 > 0.18 else "#ffffff"
