"""Notebooks built in code, and what to ask of their reports."""

import base64
import struct
import zlib
from types import SimpleNamespace

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from notebook_reports.export.exporters.choose import export


def bundle(data, **metadata):
    """An execute_result: of a displayable object, or of a MIME bundle."""
    data = data._repr_mimebundle_() if hasattr(data, "_repr_mimebundle_") else data
    return new_output("execute_result", data=data, metadata=metadata, execution_count=1)


def code(*outputs, source="show()", tags=()):
    """A code cell that shows outputs."""
    return new_code_cell(
        source,
        outputs=[bundle(o) if "output_type" not in o else o for o in map(_dict, outputs)],
        metadata={"tags": list(tags)} if tags else {},
    )


def _dict(output):
    return output._repr_mimebundle_() if hasattr(output, "_repr_mimebundle_") else output


def markdown(text, **attachments):
    """A Markdown cell."""
    cell = new_markdown_cell(text)
    if attachments:
        cell["attachments"] = attachments["attachments"]
    return cell


def notebook(*cells):
    """A notebook of cells; a string is a Markdown cell."""
    built = [markdown(cell) if isinstance(cell, str) else cell for cell in cells]
    for i, cell in enumerate(built):
        cell["id"] = f"cell-{i}"
    return new_notebook(cells=built, metadata={"language_info": {"name": "python"}})


def png(width=2, height=2):
    """The bytes of a grey picture."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + b"\x80" * width for _ in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


SVG = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="120" height="40">'
    '<text x="5" y="20" style="font: 10px \'DejaVu Sans\', sans-serif">Drawn words ψ</text></svg>'
)


def typst(nb, **particulars):
    """The Typst source of a notebook, compiled on the way, so that what a test reads is known to be a PDF."""
    from notebook_reports.export.exporters.pdf import PdfExporter
    from notebook_reports.export.write.typst_engine import compile_settled

    told = {"name": "folder/sample", "mode": "strict", **particulars}
    exporter = PdfExporter()
    report = exporter.report(nb, {"metadata": {}, "loopbook": told})
    sources = []

    def write(layout):
        sources.append(exporter.source(report, layout))
        return sources[-1]

    assert compile_settled(write).startswith(b"%PDF-1.7")
    return sources[-1][0]


def html(nb, **particulars):
    """The HTML of a notebook without the script that every page has, known to be there once and as it should be."""
    from notebook_reports.export.exporters.html import page_script

    page = export(nb, "html", **{"name": "folder/sample", **particulars}).decode()
    own = f"<script>{page_script()}</script>\n"
    assert page.count(own) == 1
    return page.replace(own, "")


@pytest.fixture
def make():
    """The builders, for tests that import nothing of each other."""
    picture = base64.b64encode(png()).decode()
    return SimpleNamespace(
        bundle=bundle,
        code=code,
        markdown=markdown,
        notebook=notebook,
        stream=lambda text, name="stdout": new_output("stream", name=name, text=text),
        error=lambda *lines: new_output("error", ename="E", evalue="v", traceback=list(lines)),
        png=png,
        picture=picture,
        svg=SVG,
        typst=typst,
        html=html,
    )
