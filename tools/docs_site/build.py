"""The documentation as a site, offline: `make docs` writes build/site/ from docs/, the docstrings and the reports.

Warnings are errors, and a link to a page or an anchor that is not there is one too.
"""

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote, urlsplit

from bs4 import BeautifulSoup
from docs_site import gallery, reference, rules
from sphinx.cmd.build import build_main

from notebook_reports.export.write.mathematics_font import font_face

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SOURCE = ROOT / "build" / "docs"
SITE = ROOT / "build" / "site"
REPORTS = ROOT / "reports"


def main() -> int:
    """Write the site; the exit code."""
    if not (REPORTS / "index.html").exists():
        print("the reports are not built: run make first")
        return 1
    write_sources()
    shutil.rmtree(SITE, ignore_errors=True)
    code = build_main(
        [
            "-q",
            "-W",
            "--keep-going",
            "-E",
            "-c",
            str(HERE),
            "-d",
            str(SOURCE.parent / "doctrees"),
            str(SOURCE),
            str(SITE),
        ]
    )
    if code:
        return code
    for page in SITE.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        if face := font_face(text):
            page.write_text(text.replace("</head>", f"<style>{face}</style></head>", 1), encoding="utf-8")
    shutil.copytree(REPORTS, SITE / "reports", dirs_exist_ok=True, ignore=shutil.ignore_patterns("custom"))
    shutil.copytree(SOURCE / "figures", SITE / "figures", dirs_exist_ok=True)
    dead = list(dead_links(SITE))
    for place, link in dead:
        print(f"{place}: {link} leads nowhere")
    if not dead:
        print(f"{SITE / 'index.html'}: {len(list(SITE.rglob('*.html')))} pages, no dead link")
    return int(bool(dead))


def write_sources() -> None:
    """docs/ and what is written for the site alone."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.copytree(ROOT / "docs", SOURCE)
    for name in ("CONTRIBUTING", "CHANGELOG"):
        text = (ROOT / f"{name}.md").read_text(encoding="utf-8").replace("](docs/", "](")
        (SOURCE / f"{name.lower()}.md").write_text(text, encoding="utf-8")
    reference.write(SOURCE / "reference")
    rules.write(SOURCE / "tuning-rules.md")
    gallery.write(REPORTS, SOURCE)
    decisions = sorted(p for p in (SOURCE / "decisions").glob("[0-9]*.md"))
    lines = [
        "# Decisions",
        "",
        "What was considered, and why things are as they are.",
        "",
        "```{toctree}",
        ":maxdepth: 1",
        "",
    ]
    (SOURCE / "decisions" / "index.md").write_text(
        "\n".join([*lines, *(p.stem for p in decisions), "```", ""]), encoding="utf-8"
    )


def dead_links(site: Path) -> Iterator[tuple[str, str]]:
    """(page, link) for each link inside the site whose file or anchor is not there."""
    anchors: dict[Path, set[str]] = {}

    def known(file: Path) -> set[str]:
        if file not in anchors:
            soup = BeautifulSoup(file.read_text(encoding="utf-8"), "html.parser")
            anchors[file] = {t[k] for t in soup.find_all(True) for k in ("id", "name") if t.has_attr(k)}
        return anchors[file]

    for page in sorted(site.rglob("*.html")):
        soup = BeautifulSoup(page.read_text(encoding="utf-8"), "html.parser")
        for tag, key in ((t, k) for t in soup.find_all(True) for k in ("href", "src") if t.has_attr(k)):
            parts = urlsplit(tag[key])
            if parts.scheme or parts.netloc:
                continue
            file = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            file = file / "index.html" if file.is_dir() else file
            if not file.is_file() or (
                parts.fragment and file.suffix == ".html" and unquote(parts.fragment) not in known(file)
            ):
                yield page.relative_to(site).as_posix(), tag[key]


if __name__ == "__main__":
    sys.exit(main())
