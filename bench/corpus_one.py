"""Export one notebook in a process of its own, for ``python -m bench corpus``: what became of it, as JSON."""

import json
import logging
import sys
import time
from pathlib import Path

BEGUN = time.perf_counter()


def main(path: Path, form: str) -> dict[str, object]:
    from notebook_reports.run.quick_imports import import_nbformat

    import_nbformat()
    import nbformat

    from notebook_reports.export.errors import ExportError
    from notebook_reports.export.mends import boxed_cells

    logging.disable(logging.WARNING)
    notebook = nbformat.read(path, 4)
    try:
        page, resources = _exporter(form).from_notebook_node(
            notebook, {"metadata": {"name": path.stem, "path": str(path.parent)}}
        )
    except ExportError as error:
        return {"outcome": "refused", "why": str(error)[:300]}
    seconds = time.perf_counter() - BEGUN
    mends = resources["loopbook_mends"]
    told: dict[str, object] = {"seconds": seconds, "mends": [(cell, m.kind, m.remark) for cell, m in mends]}
    boxes = len(boxed_cells(resources["loopbook_report"])) / max(1, len(notebook.cells))
    told["outcome"] = "refused" if boxes > 0.05 else "delivered"
    told["why"] = f"{boxes:.0%} of the cells are boxes" if boxes > 0.05 else ""
    return told | _words(notebook, page, form)


def _exporter(form: str):
    from notebook_reports.export.exporters.html import HtmlExporter
    from notebook_reports.export.exporters.pdf import PdfExporter

    return PdfExporter() if form == "pdf" else HtmlExporter()


def _words(notebook, page, form: str) -> dict[str, object]:
    import re
    from html import unescape

    from tools.pages.notebook_words import compare
    from tools.pages.page_words import in_the_text, outside, text_of

    from notebook_reports.export.read.pdf_text import PdfText

    if form == "html":
        bare = re.sub(r"<style>.*?</style>|<[^>]*>", " ", page, flags=re.DOTALL)
        found, off = compare(notebook, unescape(bare)), []
    else:
        pages = PdfText(page)
        found, off = compare(notebook, text_of(in_the_text(pages))), outside(pages)
    return {"words": found.count, "lost": found.lost[:20], "displaced": len(found.displaced), "outside": len(off)}


if __name__ == "__main__":
    print(json.dumps(main(Path(sys.argv[1]), sys.argv[2])))
