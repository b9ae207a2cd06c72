"""Which pages of the PDF reports look otherwise than they did, with small pictures.

Pages are compared as they look, not as bytes. The pictures are drawn by PDFium (`pypdfium2`, in the extra `docs`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from notebook_reports.ledger.difference import as_plain_markdown
from notebook_reports.project.project import EnvironmentProblem

DOTS = 50  # per inch
FADED = 8  # of 255, what the eye does not see


@dataclass(frozen=True)
class Changed:
    """The pages of a report that changed, from 1. before, after: numbers of pages, 0 where there is no report."""

    report: str
    pages: tuple[int, ...]
    before: int
    after: int


def changed(before: Path, after: Path, pictures: Path | None = None) -> list[Changed]:
    """Every report with a page that looks otherwise, appeared or went.

    pictures: a folder for ``<report>-<page>.png``, before beside after. Raises EnvironmentProblem without PDFium.
    """
    names = sorted({p.relative_to(folder).as_posix() for folder in (before, after) for p in folder.rglob("*.pdf")})
    found = []
    for name in names:
        old, new = _pages(before / name), _pages(after / name)
        different = [i for i in range(max(len(old), len(new))) if not _same(old[i : i + 1], new[i : i + 1])]
        if different:
            found.append(Changed(name, tuple(i + 1 for i in different), len(old), len(new)))
        if pictures is not None:
            stem = name.removesuffix(".pdf").replace("/", "-")
            for i in different:
                _draw(old[i : i + 1], new[i : i + 1], pictures / f"{stem}-{i + 1}.png")
    return found


def changes_told(found: Sequence[Changed], form: str) -> str:
    """One line for each report."""
    lines = []
    for one in found:
        if not one.before or not one.after:
            lines.append(f"{one.report}: {'new' if one.after else 'gone'}")
            continue
        numbers = ", ".join(map(str, one.pages[:12])) + (
            f" and {len(one.pages) - 12} more" if len(one.pages) > 12 else ""
        )
        lines.append(f"{one.report}: pages {numbers} of {one.after} changed")
    lines = lines or ["no page of any report looks otherwise"]
    return "\n".join(f"- {as_plain_markdown(line)}" if form == "md" else line for line in lines)


def _pages(file: Path) -> list[np.ndarray]:
    """The pages of a PDF file as grey pictures; none where there is no file."""
    if not file.exists():
        return []
    try:
        import pypdfium2
    except ImportError:
        raise EnvironmentProblem("pages are drawn by pypdfium2: pip install 'loopbook[docs]'") from None
    document = pypdfium2.PdfDocument(file)
    try:
        return [page.render(scale=DOTS / 72, grayscale=True).to_numpy() for page in document]
    finally:
        document.close()


def _same(old: Sequence[np.ndarray], new: Sequence[np.ndarray]) -> bool:
    if not old or not new or old[0].shape != new[0].shape:
        return False
    return bool((np.abs(old[0].astype(int) - new[0]) <= FADED).all())


def _draw(old: Sequence[np.ndarray], new: Sequence[np.ndarray], file: Path) -> None:
    """Before and after beside each other; a page that is not there is white."""
    from PIL import Image

    there = [page.squeeze() for page in (*old, *new)]
    height, width = (max(page.shape[k] for page in there) for k in (0, 1))
    sheet = np.full((height, 2 * width + 8), 255, np.uint8)
    for column, pages in ((0, old), (width + 8, new)):
        for page in pages:
            flat = page.squeeze()
            sheet[: flat.shape[0], column : column + flat.shape[1]] = flat
    sheet[:, width : width + 8] = 128
    file.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(sheet).save(file, optimize=True)
