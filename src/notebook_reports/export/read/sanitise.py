"""Drawings that come from outputs and files, parsed by a hardened parser and written again from a list of what may be.

A drawing is data. It is read as XML by defusedxml (no entities, nothing fetched), and what goes on is written anew: the
elements and attributes of static SVG, styles without addresses, no comment, no CDATA, no other vocabulary. What would
be lost by that and seen by a reader is refused by name: scripts, animations, HTML inside, other files. What nobody sees
(an editor's notes, metadata, ARIA) is left out.

HTML needs no such list. It is read into the blocks of a report (`read.html`), and a page is written from those.
"""

import re
from collections.abc import Iterator
from xml.etree.ElementTree import Element, ParseError

from notebook_reports.export.errors import CannotShow

SVG, XLINK, XML = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink", "http://www.w3.org/XML/1998/namespace"
XHTML = "http://www.w3.org/1999/xhtml"
DEEPEST = 200

SHAPES = "svg g defs symbol use a switch path rect circle ellipse line polyline polygon text tspan textPath image"
PAINTS = "marker linearGradient radialGradient stop pattern clipPath mask filter title desc style view"
FILTERS = (
    "feBlend feColorMatrix feComponentTransfer feComposite feConvolveMatrix feDiffuseLighting feDisplacementMap "
    "feDistantLight feDropShadow feFlood feFuncA feFuncB feFuncG feFuncR feGaussianBlur feMerge feMergeNode "
    "feMorphology feOffset fePointLight feSpecularLighting feSpotLight feTile feTurbulence"
)
ELEMENTS = frozenset(f"{SHAPES} {PAINTS} {FILTERS}".split())
UNSEEN = frozenset({"metadata"})

PLACES = (
    "id class style lang transform viewBox preserveAspectRatio version x y x1 y1 x2 y2 width height cx cy r rx ry "
    "fx fy fr d points pathLength dx dy rotate textLength lengthAdjust startOffset method spacing refX refY orient "
    "markerWidth markerHeight markerUnits offset gradientUnits gradientTransform spreadMethod patternUnits "
    "patternContentUnits patternTransform clipPathUnits maskUnits maskContentUnits filterUnits primitiveUnits"
)
LOOKS = (
    "fill fill-opacity fill-rule stroke stroke-width stroke-opacity stroke-linecap stroke-linejoin stroke-miterlimit "
    "stroke-dasharray stroke-dashoffset opacity color display visibility overflow clip clip-path clip-rule mask filter "
    "marker marker-start marker-mid marker-end stop-color stop-opacity flood-color flood-opacity lighting-color "
    "color-interpolation color-interpolation-filters color-rendering shape-rendering text-rendering image-rendering "
    "paint-order vector-effect mix-blend-mode isolation transform-origin transform-box font font-family font-size "
    "font-size-adjust font-stretch font-style font-variant font-weight letter-spacing word-spacing text-anchor "
    "text-decoration dominant-baseline alignment-baseline baseline-shift writing-mode direction unicode-bidi "
    "white-space line-height text-align kerning pointer-events"
)
EFFECTS = (
    "in in2 result mode type values operator k1 k2 k3 k4 order kernelMatrix divisor bias targetX targetY edgeMode "
    "preserveAlpha surfaceScale diffuseConstant specularConstant specularExponent scale xChannelSelector "
    "yChannelSelector azimuth elevation stdDeviation radius baseFrequency numOctaves seed stitchTiles pointsAtX "
    "pointsAtY pointsAtZ limitingConeAngle tableValues slope intercept amplitude exponent z"
)
ATTRIBUTES = frozenset(f"{PLACES} {LOOKS} {EFFECTS}".split())
PROPERTIES = frozenset(LOOKS.split())
FUNCTIONS = frozenset(
    "rgb rgba hsl hsla calc matrix translate translateX translateY rotate scale scaleX scaleY skewX skewY blur "
    "brightness contrast drop-shadow grayscale hue-rotate invert opacity saturate sepia".lower().split()
)
_FUNCTION = re.compile(r"([A-Za-z-]*)\s*\(\s*([\"']?)(.?)")
_DATA = re.compile(r"data:image/(?:png|jpeg|gif|webp);base64,[A-Za-z0-9+/=\s]*")
_SELECTOR = re.compile(r"[\w\s.#*,>:=\"'\[\]()+~-]+")
_ADDRESS = re.compile(r"(?:https?|mailto):[^\x00-\x20]*", re.IGNORECASE)


def drawing(data: bytes) -> bytes:
    """The drawing, written again. Raises CannotShow where it is no SVG, or holds what no page can show."""
    import defusedxml.ElementTree as xml
    from defusedxml.common import DefusedXmlException

    try:
        root = xml.fromstring(data.decode("utf-8-sig").lstrip())
    except DefusedXmlException:
        raise _refused("an SVG image with entities of its own, which are not expanded") from None
    except (UnicodeDecodeError, ParseError, ValueError) as error:
        raise _refused(f"an SVG image that cannot be read: {error}") from None
    if _name(root) != "svg":
        raise _refused(f"an SVG image whose first element is <{_name(root) or root.tag}>")
    return "".join(_written(root, 0)).encode()


def _refused(message: str) -> CannotShow:
    return CannotShow(message, "image", message.replace("an SVG image", "a drawing", 1))


def _name(element: Element) -> str:
    """The name in the vocabulary of SVG, "" for another vocabulary."""
    space, _, name = str(element.tag).rpartition("}")
    return name if space in ("", "{" + SVG) else ""


def _written(element: Element, depth: int) -> Iterator[str]:
    name = _name(element)
    if depth > DEEPEST:
        raise _refused(f"an SVG image nested deeper than {DEEPEST} elements")
    yield f"<{name}"
    if not depth:
        yield f' xmlns="{SVG}" xmlns:xlink="{XLINK}"'
    for key, value in element.attrib.items():
        yield from _attribute(name, key, value)
    inside = "".join(_inside(element, name, depth))
    yield f">{inside}</{name}>" if inside else "/>"


def _inside(element: Element, name: str, depth: int) -> Iterator[str]:
    if name == "style":
        yield _text(_style_sheet("".join(element.itertext())))
        return
    if name in ("title", "desc"):  # a browser takes what is inside for HTML
        yield _text("".join(element.itertext()))
        return
    yield _text(element.text or "")
    for child in element:
        kept = _name(child)
        if kept in ELEMENTS:
            yield from _written(child, depth + 1)
        elif kept not in UNSEEN and (kept or str(child.tag).startswith("{" + XHTML)):
            shown = kept or str(child.tag).rpartition("}")[2]
            raise _refused(f"an SVG image with <{shown}>, which a page cannot show")
        yield _text(child.tail or "")


def _attribute(element: str, key: str, value: str) -> Iterator[str]:
    space, _, name = key.rpartition("}")
    if name.lower().startswith("on") and not space:
        raise _refused(f"an SVG image with a script in {name}")
    if name.lower() == "href":
        yield f' xlink:href="{_value(_reference(element, value))}"'
    elif space == "{" + XML and name in ("space", "lang"):
        yield f' xml:{name}="{_value(value)}"'
    elif not space and name == "style":
        yield f' style="{_value(_declarations(value))}"'
    elif not space and name in ATTRIBUTES:
        if name in PROPERTIES or "(" in value:
            _check_value(value)
            value = value.replace('"', "'")
        yield f' {name}="{_value(value)}"'


def _text(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _value(text: str) -> str:
    return re.sub(r"[\t\r\n]", " ", _text(text)).replace('"', "&quot;")


def _reference(element: str, value: str) -> str:
    """Where an element leads: into the drawing; an image may be data, a link an address. Raises CannotShow."""
    value = value.strip()
    if value.startswith("#"):
        return value
    if element == "image" and _DATA.fullmatch(value):
        return value
    if element == "a" and _ADDRESS.fullmatch(value):
        return value
    what = "with a link" if element == "a" else "that needs another file"
    raise _refused(f"an SVG image {what}: {value[:80]}")


def _check_value(value: str) -> None:
    """Raises CannotShow for a value that names another file, or a function that is not one of looks."""
    if "\\" in value or "@" in value or "<" in value:
        raise _refused(f"an SVG image with a style that is not understood: {value[:80]}")
    for name, _, first in _FUNCTION.findall(value):
        name = name.lower()
        if name == "url" and first != "#":
            raise _refused(f"an SVG image that needs another file: {value[:80]}")
        if name not in FUNCTIONS and name != "url":
            raise _refused(f"an SVG image with a style that is not understood: {value[:80]}")


def _declarations(text: str) -> str:
    """The declarations of a style that a drawing may have, in their order; others are left out."""
    kept = []
    for declaration in re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL).split(";"):
        name, colon, value = declaration.partition(":")
        _check_value(value)
        if colon and name.strip().lower() in PROPERTIES:
            kept.append(f"{name.strip().lower()}: {' '.join(value.split())}".replace('"', "'"))
    return "; ".join(kept)


def _style_sheet(text: str) -> str:
    """The rules of a style sheet that a drawing may have. Raises CannotShow for anything but plain rules."""
    rules = []
    for rule in re.sub(r"/\*.*?\*/|<!--|-->", "", text, flags=re.DOTALL).split("}"):
        if not rule.strip():
            continue
        selector, brace, body = rule.partition("{")
        if not brace or "{" in body or not _SELECTOR.fullmatch(selector):
            raise _refused(f"an SVG image with a style that is not understood: {' '.join(rule.split())[:80]}")
        rules.append(f"{' '.join(selector.split())}{{{_declarations(body)}}}")
    return "".join(rules)
