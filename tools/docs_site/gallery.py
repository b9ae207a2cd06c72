"""The gallery: the figures of the built reports, each a way into its chapter."""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from pathlib import Path

from notebook_reports.mathematics import latex_to_mathml

PER_CHAPTER = 3


@dataclass(frozen=True)
class Picture:
    """A figure of a chapter as SVG, with its words."""

    chapter: str
    svg: str
    words: str


def pictures(reports: Path) -> Iterator[Picture]:
    """The first figures of each executed chapter, in the order of the folders."""
    for notebook in sorted(reports.glob("*/*.ipynb")):
        chapter = notebook.relative_to(reports).with_suffix("").as_posix()
        content = json.loads(notebook.read_text(encoding="utf-8"))
        outputs = (o for c in content["cells"] for o in c.get("outputs", ()) if "image/svg+xml" in o.get("data", {}))
        for _, output in zip(range(PER_CHAPTER), outputs, strict=False):
            svg = output["data"]["image/svg+xml"]
            about = output["data"].get("application/vnd.loopbook.figure+json", {})
            words = about.get("caption") or about.get("alt") or chapter
            yield Picture(chapter, svg if isinstance(svg, str) else "".join(svg), words)


def words_shown(words: str) -> str:
    """A caption as HTML: text is text, what stands between dollars is a formula.

    >>> words_shown("a < b")
    'a &lt; b'
    >>> words_shown("after $t = 0$")[:11]
    'after <math'
    """
    parts = re.split(r"\$([^$]+)\$", words)
    return "".join(latex_to_mathml(p, display=False) if i % 2 else escape(p) for i, p in enumerate(parts))


def write(reports: Path, folder: Path) -> None:
    """gallery.md and the figures beside it."""
    (folder / "figures").mkdir(exist_ok=True)
    lines = ["# Gallery", "", "Figures of the reports; each leads to its chapter.", "", '<div class="gallery">']
    for i, picture in enumerate(pictures(reports)):
        (folder / "figures" / f"{i:03}.svg").write_text(picture.svg, encoding="utf-8")
        picture_of = f'<img src="figures/{i:03}.svg" alt="{escape(picture.words.replace("$", ""))}" loading="lazy">'
        words = f"{escape(picture.chapter)}: {words_shown(picture.words)}"
        lines += [f'<a href="reports/{picture.chapter}.html">{picture_of}<span>{words}</span></a>']
    lines += ["</div>", ""]
    (folder / "gallery.md").write_text("\n".join(lines), encoding="utf-8")
