"""The names of colours in LaTeX and on the web, in shades that can be read on white paper."""

import re

NAMES = {
    "black": "#000000",
    "gray": "#808080",
    "red": "#c00000",
    "green": "#007a33",
    "blue": "#0000c0",
    "cyan": "#007a8a",
    "magenta": "#a0007a",
    "orange": "#b45300",
    "purple": "#6a2c91",
    "brown": "#7a4a1e",
}
"""Those that the converter's errors name."""
_MORE = {
    **{"grey": "#808080", "darkgray": "#555555", "darkgrey": "#555555", "lightgray": "#8f8f8f", "white": "#767676"},
    **{"yellow": "#8a7000", "gold": "#8a7000", "goldenrod": "#8a6d0b", "olive": "#6b6b00", "lime": "#3f7a00"},
    **{"teal": "#007070", "turquoise": "#007a78", "aqua": "#007a8a", "skyblue": "#2a6f97", "navy": "#000080"},
    **{"darkblue": "#00008b", "mediumblue": "#0000b0", "royalblue": "#2746b0", "steelblue": "#2f6690"},
    **{"dodgerblue": "#1468b8", "lightblue": "#2a6f97", "cornflowerblue": "#3a5fae", "navyblue": "#003f8a"},
    **{"darkgreen": "#006400", "forestgreen": "#1b6e1b", "seagreen": "#246b44", "limegreen": "#1f7a1f"},
    **{"lightgreen": "#2f7a2f", "olivegreen": "#4b5a10", "darkred": "#8b0000", "maroon": "#800000"},
    **{"crimson": "#b0102f", "firebrick": "#a01f1f", "brickred": "#a0281e", "tomato": "#b23a24", "salmon": "#a8443a"},
    **{"coral": "#b0452a", "orangered": "#b83a00", "darkorange": "#a85a00", "pink": "#b0406a", "hotpink": "#b02a6a"},
    **{"deeppink": "#b0105f", "violet": "#8a2a8a", "darkviolet": "#7a00a8", "indigo": "#4b0082", "plum": "#7a3a7a"},
    **{
        "orchid": "#8a3a88",
        "fuchsia": "#a0007a",
        "rubinered": "#b0003f",
        "royalpurple": "#57329a",
        "mulberry": "#8a1f70",
    },
    **{"chocolate": "#8a4a14", "sienna": "#7a3f20", "silver": "#767676", "tan": "#7a6038", "periwinkle": "#4d4dab"},
    **{"cerulean": "#00708a", "processblue": "#00708a", "emerald": "#007a50", "junglegreen": "#007a60"},
    **{"blueviolet": "#5a20b0", "slateblue": "#4a3fa0", "midnightblue": "#191970", "slategray": "#566573"},
}


def colour(text: str, model: str = "") -> str | None:
    """A colour as "#rrggbb", None for one that is not known.

    >>> colour("Red"), colour("#abc"), colour("1, 0, 0.5", "rgb"), colour("no such")
    ('#c00000', '#aabbcc', '#ff0080', None)
    """
    name = text.strip().lower()
    name = name.partition("!")[0]
    if name in NAMES or name in _MORE:
        return NAMES.get(name) or _MORE[name]
    if re.fullmatch("#[0-9a-f]{6}", name):
        return name
    if re.fullmatch("#[0-9a-f]{3}", name):
        return "#" + "".join(2 * digit for digit in name[1:])
    if re.fullmatch("[0-9a-f]{6}", name) and model.lower() == "html":
        return "#" + name
    css = re.fullmatch(r"rgba?\((.*)\)", name)
    parts = re.findall(r"\d*\.?\d+", css[1] if css else name)
    if css or model in ("RGB", "rgb", "gray"):
        scale = 255 if model in ("rgb", "gray") else 1
        parts = parts * 3 if model == "gray" and len(parts) == 1 else parts
        if len(parts) >= 3:
            return "#" + "".join(f"{min(255, round(float(part) * scale)):02x}" for part in parts[:3])
    return None
