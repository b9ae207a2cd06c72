"""The map, the ledger to be read and the book: everything listed, every link alive, nothing left half written."""

import io
import json
import re

import pytest
from tools.pages.page_words import in_the_text, text_of

from notebook_reports.export.read.pdf_text import PdfText
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.memory import stamps
from notebook_reports.pages import publish as pages
from notebook_reports.pages.links import dead_links, read_links
from notebook_reports.project.console import Console
from notebook_reports.project.outline import read_outline
from notebook_reports.project.project import Notebook, Project, UsageError, project_at

pytestmark = pytest.mark.builds

OUTLINE = """
title = "Two tanks"
subtitle = "recomputed"
[[part]]
folder = "double_tank"
title = "The double tank"
about = "With $K = 2$."
[[part]]
folder = "own_process"
title = "Your own"
"""
VALUES = """
document = "double-tank"
place = "Table 5"
value = [
  { id = "rise", quantity = "rise time, $t_r$", printed = "3.66", unit = "s" },
  { id = "open", quantity = "open", printed = "1.0" },
]
claim = [{ id = "settles", says = "It settles." }]
"""


def found(id="rise", table="value", verdict="reproduced", cell=2, **fields):
    value = {"quantity": "rise time, $t_r$", "printed": "3.66", "unit": "s", "kind": "computed"}
    value |= {"exact": "3.6634812345678", "from_inputs": "", "reason": ""}
    claim = {"says": "It settles.", "evidence": "within 4 s"}
    misprint = {"kind": "formula", "printed": "h/Ti", "corrected": "K*h/Ti", "misleads": "yes", "note": "K is lost"}
    told = {"value": value, "claim": claim, "misprint": misprint}[table] | fields
    return LedgerRow(
        table, "double-tank", "Table 5", id, verdict, told, "double_tank/01", cell, "c2", "Results of `x`"
    ).data()


class Shelf:
    """A project as a build leaves it, without running anything."""

    def __init__(self, root):
        self.project = project_at(root)
        self.said = ""
        self.write("notebooks/book.toml", OUTLINE)
        self.write("documents/double_tank/printed/table5.toml", VALUES)
        term = '{ en = "gain", sv = "förstärkning", pl = "wzmocnienie", symbol = "$K$", unit = "1" }'
        self.write("documents/glossary.toml", f"term = [{term}]")
        for name in ("ledger.csv", "claims.csv", "misprints.csv"):
            self.write(f"reports/{name}", "document\n")

    def write(self, name, text):
        path = self.project.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def add(self, id, *records, title="A chapter"):
        """A notebook that was built: one of prose, one of code."""
        source = self.write(f"notebooks/{id}.ipynb", "{}")
        output = {"output_type": "display_data", "data": {"text/plain": "shown"}, "metadata": {}}
        cells = [
            {"cell_type": "markdown", "id": "c1", "metadata": {}, "source": f"# {title}\n\n## Results of `x`"},
            {"cell_type": "code", "id": "c2", "metadata": {}, "source": "x", "execution_count": 1, "outputs": [output]},
        ]
        notebook = Notebook(id, source)
        executed = {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
        kept = stamps.keep(self.project, notebook, json.dumps(executed).encode(), list(records))
        stamps.save(self.project, notebook, stamps.Stamp({}, [], kept[0], "", title, 1.0, {}, kept[1], []))
        for format in ("pdf", "ipynb"):
            self.write(f"reports/{id}.{format}", "x" * 2000)
        self.write(f"reports/{id}.html", '<p id="cell-2">shown</p>')

    def publish(self):
        out = io.StringIO()
        failures = pages.publish(self.project, Console(out))
        self.said = out.getvalue()
        return [f.what for f in failures]

    def read(self, name):
        return (self.project.reports / name).read_bytes()

    def there(self):
        return [name for name in pages.NAMES if (self.project.reports / name).exists()]


@pytest.fixture
def shelf(tmp_path):
    shelf = Shelf(tmp_path)
    shelf.add("double_tank/01", found(), found("settles", "claim", "holds"), found("eq-1", "misprint", "proved"))
    shelf.add("own_process/design", title="Design with $K$")
    return shelf


def test_all_three_and_then_nothing_to_do(shelf):
    assert shelf.publish() == []
    assert shelf.there() == ["loopbook.pdf", "ledger.html", "index.html"]
    assert re.match(r"ok +reports/loopbook.pdf, ledger.html, index.html  \d", shelf.said)
    first = {name: shelf.read(name) for name in shelf.there()}
    assert first["loopbook.pdf"].startswith(b"%PDF")
    assert shelf.publish() == [] and shelf.said == ""
    pages.withdraw(shelf.project)
    assert shelf.publish() == [] and {name: shelf.read(name) for name in shelf.there()} == first


def test_every_link_of_the_map_leads_somewhere_and_nothing_is_fetched(shelf):
    shelf.publish()
    text = shelf.read("index.html").decode()
    links, _ = read_links(text)
    wanted = {f"{id}.{f}" for id in ("double_tank/01", "own_process/design") for f in ("pdf", "html", "ipynb")}
    assert wanted | {"loopbook.pdf", "ledger.html", "ledger.csv", "ledger.html#Errata"} <= set(links)
    assert "<script" not in text and "http" not in re.sub(r"http://www.w3.org/\S+|http-equiv", "", text)
    assert "script-src 'none'" in text
    assert "1 reproduced" in text and "1 misprint" in text and "<math" in text and "typst" in text
    assert text.index("The double tank") < text.index("Your own")


def test_a_row_of_the_ledger_leads_to_the_cell_that_shows_it(shelf):
    shelf.publish()
    text = shelf.read("ledger.html").decode()
    row = next(r for r in re.findall(r"<tr>.*?</tr>", text) if "3.66 s" in r)
    assert 'href="double_tank/01.html#cell-2"' in row and "3.663" in row and "reproduced" in row
    assert "Results of <code>x</code>" in row
    assert "förstärkning" in text and "open" in text.partition("No notebook checks")[2][:200]


@pytest.mark.parametrize(
    ("name", "text", "why"),
    [
        ("notebooks/book.toml", OUTLINE + "# changed\n", "notebooks/book.toml"),
        ("documents/double_tank/printed/table5.toml", VALUES + "# changed\n", "double_tank/printed/table5.toml"),
        ("reports/index.html", "mine", "reports/index.html is not as it was written"),
    ],
)
def test_written_again_with_the_reason(shelf, name, text, why):
    shelf.publish()
    shelf.write(name, text)
    assert shelf.publish() == [] and why in shelf.said and "rebuilt: " in shelf.said


def test_an_unlisted_notebook_fails_by_its_name(shelf):
    shelf.publish()
    shelf.add("essays/extra")
    assert shelf.publish() == ["notebooks/essays/extra.ipynb is in no part of notebooks/book.toml"]
    assert shelf.there() == [] and pages.reasons(shelf.project) == ["first build"]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (OUTLINE.replace("own_process", "gone"), "no notebook in notebooks/gone"),
        (OUTLINE + '[[part]]\nfolder = "own_process"\ntitle = "again"\n', "two parts for own_process"),
        ('title = "x"', "notebooks/book.toml: part is missing"),
        ("title =", "notebooks/book.toml: "),
    ],
)
def test_an_outline_that_does_not_fit(shelf, text, told):
    shelf.write("notebooks/book.toml", text)
    [failure] = shelf.publish()
    assert told in failure


def test_a_dead_link_fails_by_its_name(shelf):
    shelf.write("reports/double_tank/01.html", "<p>no anchors</p>")
    assert shelf.publish() == ["reports/ledger.html: a link to #cell-2, which is nowhere in double_tank/01.html"]
    assert shelf.there() == []


def test_links_are_looked_up_among_the_files_and_among_the_pages_not_written_yet(tmp_path):
    (tmp_path / "b.html").write_text('<p id="there">')
    page = b'<h1 id="top"><a href="#top"><a href="b.html#there"><a href="c.html#new"><a href="https://example.org">'
    page += b'<a href="gone.pdf"><a href="#nowhere"><a href="b.html#away"><img src="p.png">'
    assert dead_links("a.html", tmp_path, {"a.html": page, "c.html": b'<p id="new">'}) == [
        "a link to gone.pdf, which is not there",
        "a link to #nowhere, which is nowhere in a.html",
        "a link to #away, which is nowhere in b.html",
        "a link to p.png, which is not there",
    ]


def test_a_record_that_the_book_cannot_show_fails_by_its_name(shelf):
    shelf.add("double_tank/01", found(cell=9))
    [failure] = shelf.publish()
    assert "a link to no place #cell-9 in double_tank/01 of this book" in failure


def test_without_every_report_there_are_no_pages(shelf):
    shelf.publish()
    (shelf.project.reports / "own_process/design.pdf").unlink()
    shelf.add("double_tank/02")
    (shelf.project.reports / "double_tank/02.html").unlink()
    assert shelf.publish() == [] and shelf.there() == []
    assert "not built double_tank/02, own_process/design" in shelf.said


def test_a_build_of_all_in_all_formats_publishes(shelf):
    formats = ("pdf", "html", "ipynb")
    assert pages.publishes(shelf.project, True, formats)
    assert not pages.publishes(shelf.project, False, formats)
    assert not pages.publishes(shelf.project, True, ("html",))
    (shelf.project.notebooks_folder / "book.toml").unlink()
    assert not pages.publishes(shelf.project, True, formats)


def test_build_writes_them_and_names_what_is_unlisted(bench):
    def export(content, format, notebook, title):
        return "".join(f'<p id="cell-{n}"></p>' for n, _ in enumerate(content["cells"], 1)).encode()

    outline = OUTLINE.partition('[[part]]\nfolder = "own')[0]
    bench.write("double_tank/01", "# Title\n\n## Results", bench.record("rise", printed="3.66", exact="3.6634"))
    (bench.root / "notebooks" / "book.toml").write_text(outline, encoding="utf-8")
    formats = ("pdf", "html", "ipynb")
    assert bench.build(exporter=export, formats=formats).code == 0
    # only the tables that hold a row are written, and the map links what is there
    assert {"index.html", "ledger.html", "loopbook.pdf"} <= set(bench.reports())
    assert bench.build(exporter=export, formats=formats).code == 0 and "reports/" not in bench.said
    bench.write("essays/02", "# Other", "1")
    outcome = bench.build(exporter=export, formats=formats)
    assert outcome.code == 1
    assert "notebooks/essays/02.ipynb is in no part of notebooks/book.toml" in bench.said
    assert not {"index.html", "ledger.html", "loopbook.pdf"} & set(bench.reports())


@pytest.mark.parametrize(
    ("order", "ids"),
    [
        ([], ["a/one", "a/two", "a/zero"]),
        (["zero"], ["a/zero", "a/one", "a/two"]),
        (["two", "zero", "one"], ["a/two", "a/zero", "a/one"]),
    ],
)
def test_a_part_has_the_order_that_it_names(tmp_path, order, ids):
    def outlined(names):
        text = f'title = "T"\n[[part]]\nfolder = "a"\ntitle = "A"\norder = {names!r}\n'
        (tmp_path / "notebooks").mkdir(exist_ok=True)
        (tmp_path / "notebooks" / "book.toml").write_text(text)
        entries = [{"id": f"a/{name}", "folder": "a"} for name in ("one", "two", "zero")]
        return [e["id"] for e in read_outline(Project(tmp_path, tmp_path / "c"), entries).entries]

    assert outlined(order) == ids
    with pytest.raises(UsageError, match="order names three; there are one, two, zero"):
        outlined([*order, "three"])


FIND = """
[[part.find]]
says = "It is *$K$* that is lost."
misprint = "eq-1"
verdict = "proved"
"""


def with_find(find=FIND):
    return OUTLINE.replace('about = "With $K = 2$."\n', f'about = "With $K = 2$."\n{find}')


def test_what_was_found_is_said_in_words_and_leads_to_its_proof(shelf):
    shelf.write("notebooks/book.toml", with_find())
    assert shelf.publish() == []
    text = shelf.read("index.html").decode()
    item = re.search(r'<ul class="finds">(.*?)</ul>', text, re.S)[1]
    assert 'href="double_tank/01.html#cell-2">proved</a>' in item and "<math" in item and "that is lost" in item
    assert "<b>1</b> error found in the documents" in text and "<b>1</b> statement put to the test" in text


@pytest.mark.parametrize(
    ("find", "told"),
    [
        (FIND.replace("eq-1", "eq-9"), "double-tank has no misprint 'eq-9' in the ledger"),
        (FIND.replace("proved", "noted"), "is 'proved' in the ledger and 'noted' here; does the sentence still hold?"),
        (FIND.replace('misprint = "eq-1"', ""), "a find has says, verdict and one of value, claim, misprint"),
        (FIND.replace('"eq-1"', "1"), "each a text"),
    ],
)
def test_a_find_that_the_ledger_does_not_bear_out_fails(shelf, find, told):
    shelf.write("notebooks/book.toml", with_find(find))
    [failure] = shelf.publish()
    assert told in failure and shelf.there() == []


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ('picture = { notebook = "double_tank/01", figure = 1 }', "figure 1 of double_tank/01, which has 0"),
        ('picture = { notebook = "double_tank/07", figure = 1 }', "the picture is of notebooks/double_tank/07.ipynb"),
        ("picture = 1", "picture is { notebook"),
        ('code = "behind"', "code is one of inline, end, none, got 'behind'"),
    ],
)
def test_a_front_page_that_cannot_be_made_fails(shelf, line, told):
    shelf.write("notebooks/book.toml", line + OUTLINE)
    [failure] = shelf.publish()
    assert told in failure


def test_a_card_begins_as_the_chapter_does():
    from notebook_reports.pages.front import opening

    def cells(text):
        return {"cells": [{"cell_type": "markdown", "source": text}]}

    assert opening(cells("# T\n\nTwo tanks, $K = 2$.\n\nMore.")).startswith('Two tanks, <span class="together"><math')
    long = "A sentence of some length about tanks. " * 20
    assert opening(cells(f"# T\n\n{long}")) == ("A sentence of some length about tanks. " * 8).strip()
    assert opening(cells("# T")) == "" and opening(cells("# T\n\n- a list")) == ""


def pdf_words(pdf):
    return text_of(in_the_text(PdfText(pdf)))


def test_the_book_explains_the_verdicts_first_and_its_ledger_begins_with_the_errata(shelf):
    shelf.publish()
    words = pdf_words(shelf.read("loopbook.pdf"))
    order = ["How to read this book", "derived here, and the exact number", "Part I", "Errata", "Coverage", "Index of"]
    after = words.index("the exact number")
    assert [words.rindex(w) if w in order[3:] else words.index(w) for w in order] == sorted(
        words.rindex(w) if w in order[3:] else words.index(w) for w in order
    )
    assert words.index("Results of", after) > after and "1  A chapter" in words, "the index names chapters"
    html = shelf.read("ledger.html").decode()
    assert html.index('id="Errata"') < html.index('id="Coverage"')
    assert '<form class="tools" role="search" hidden>' in html and 'href="index.html"' in html


def test_the_book_has_its_code_where_it_is_asked_for(shelf):
    out = io.StringIO()
    made = {}
    for code in ("", "end", "none"):
        assert pages.publish(shelf.project, Console(out), code) == []
        made[code] = pdf_words(shelf.read("loopbook.pdf"))
        assert pages.reasons(shelf.project, code) == []
    assert pages.reasons(shelf.project) == ["--code"]
    assert "The code" not in made[""] and made["end"].count("The code") == 2 + 2 and "The code" not in made["none"]
    assert re.search(r"shown\s+The code", made["end"])
