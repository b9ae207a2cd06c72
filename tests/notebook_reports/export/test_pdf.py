"""The PDF itself: its standards, its metadata, its bytes, the nbconvert command."""

import json
import os
import re
import subprocess
import sys
import zlib
from time import gmtime

import nbformat
import pytest

from notebook_reports.display import Equation, Figure, Table
from notebook_reports.export.exporters.choose import export
from notebook_reports.run.surroundings import EPOCH

pytestmark = pytest.mark.builds


@pytest.fixture
def sample(make):
    return make.notebook(
        "# A title with åäö and $x$\n\n## One\n\n$a^2$\n\n## Two\n\n## Three",
        make.code(Figure(make.svg, "A caption.", "Words for the eye")),
        make.code(Table(["a", "b"], [["x", 1.5]], "Some numbers", marks=["good"])),
        make.code(Equation("x = 1", "4.9", "doc")),
        make.code(make.stream("hello"), source="print('hello')"),
    )


def inflated(pdf):
    """The PDF with its compressed streams opened."""
    opened = [pdf]
    for found in re.finditer(rb"stream\r?\n", pdf):
        try:
            opened.append(zlib.decompressobj().decompress(pdf[found.end() :]))
        except zlib.error:
            continue
    return b"\n".join(opened)


def test_accessible_and_archivable(sample):
    text = inflated(export(sample, "pdf", name="a/b", language="sv")).replace(b" ", b"")
    for piece in (b"<pdfuaid:part>1</pdfuaid:part>", b"<pdfaid:part>2</pdfaid:part>", b"<pdfaid:conformance>A"):
        assert piece in text
    for piece in (b"/StructTreeRoot", b"/Lang(sv", b"/Alt(Wordsfortheeye", b"/Outlines", b"/FontFile"):
        assert piece in text, piece
    for kind in (b"/S/H1", b"/S/Figure", b"/S/Formula", b"/S/Table", b"/S/TH", b"/S/Caption", b"/S/Link"):
        assert kind in text, kind
    assert b"/DisplayDocTitletrue" in text


def test_a_figure_without_alternative_text_is_refused_when_asked(make):
    from notebook_reports.export.exporters.choose import ExportError

    nb = make.notebook(make.code({"image/svg+xml": make.svg}))
    with pytest.raises(ExportError, match=r"cell 1: a picture has no alternative text"):
        export(nb, "pdf", name="a/b")
    assert export(nb, "pdf", name="a/b", strict_alt=False).startswith(b"%PDF")


def together(commands, **options):
    """The standard output of processes that run beside each other."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    started = [subprocess.Popen(command, **pipes, **options, **own) for command, own in commands]
    said = [process.communicate() for process in started]
    assert [process.returncode for process in started] == [0] * len(started), said
    return [out for out, _ in said]


def test_same_bytes_in_another_folder_and_process(sample, tmp_path):
    program = (
        "import hashlib, nbformat; from notebook_reports.export.exporters.choose import export;"
        "nb = nbformat.read('nb.ipynb', 4);"
        "print([hashlib.sha256(export(nb, form, name='a/b')).hexdigest() for form in ('pdf', 'html')])"
    )
    commands = []
    for folder in ("one", "another folder"):
        (tmp_path / folder).mkdir()
        nbformat.write(sample, tmp_path / folder / "nb.ipynb")
        environment = {**os.environ, "TMPDIR": str(tmp_path / folder), "PYTHONHASHSEED": str(len(folder))}
        commands.append(([sys.executable, "-c", program], {"cwd": tmp_path / folder, "env": environment}))
    one, another = together(commands)
    assert one == another and one.count(",") == 1


def test_same_bytes_twice_in_one_process(sample):
    assert export(sample, "pdf", name="a/b") == export(sample, "pdf", name="a/b")


def test_no_date_and_no_folder_in_the_file(sample, tmp_path):
    text = inflated(export(sample, "pdf", name="a/b"))
    assert b"/tmp" not in text and set(re.findall(rb"D:(\d{4})", text)) == {str(gmtime(int(EPOCH)).tm_year).encode()}


def test_the_nbconvert_commands(make, tmp_path):
    nbformat.write(make.notebook("# Any notebook\n\n$x$", make.code(make.stream("hello"))), tmp_path / "any.ipynb")
    nbconvert = [sys.executable, "-m", "nbconvert", "any.ipynb", "--to"]
    together([([*nbconvert, f"loopbook_{form}"], {}) for form in ("pdf", "html")], cwd=tmp_path)
    assert (tmp_path / "any.pdf").read_bytes().startswith(b"%PDF")
    assert "<h1 " in (tmp_path / "any.html").read_text(encoding="utf-8")


def test_unknown_format(make):
    with pytest.raises(ValueError, match="is one of"):
        export(make.notebook("x"), "docx", name="a")


def test_importing_the_package_is_light():
    heavy = "print([m for m in ('nbconvert', 'typst', 'bs4') if m in sys.modules])"
    program = f"import sys, notebook_reports.export.exporters.choose; {heavy}"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert json.loads(run.stdout.replace("'", '"')) == []
