"""Fonts of other packages, where they are installed, for scripts that the usual fonts have not.

``pip install loopbook[cjk]`` brings one for Chinese, Japanese and Korean. What the families named in ``report.typ``
have is never taken from these, so a page that needs none of them does not change when they are there.
"""

import importlib.util
from pathlib import Path

PACKAGES = {
    "mplfonts": "fonts/NotoSansCJKsc-Regular.otf",
    "matplotlib_fontja": "fonts/ipaexg.ttf",
    "koreanize_matplotlib": "fonts/NanumGothic.ttf",
}
"""By package, the font in it."""


def more_fonts() -> list[Path]:
    """The fonts that are there, in a fixed order."""
    found = []
    for package, file in PACKAGES.items():
        spec = importlib.util.find_spec(package)
        if spec and spec.origin and (path := Path(spec.origin).parent / file).is_file():
            found.append(path)
    return found
