"""The HTML: complete in itself, for light and dark, for readers of every kind."""

import re
from html.parser import HTMLParser

import pytest

from notebook_reports.display import Figure, Table
from notebook_reports.export.around import Around, Door
from notebook_reports.export.write.inside_page import inside_page

VOID = {"meta", "br", "hr", "img", "input", "link"}


class Balance(HTMLParser):
    """Raises where tags do not nest."""

    def __init__(self):
        super().__init__()
        self.open, self.ids = [], []

    def handle_starttag(self, tag, attrs):
        self.ids += [value for key, value in attrs if key == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        pass

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, (tag, self.getpos())


def test_complete_in_itself_and_well_formed(make):
    drawing = Figure(make.svg, "Caption", "Alt")
    page = make.html(
        make.notebook(
            "# T\n\n## A\n\n### B\n\n## C\n\n$x_1$ and [a](https://example.org)[^1]\n\n[^1]: note",
            make.code(drawing, drawing),
            make.code(Table(["a"], [["x"]], "Caption", notes=["n"])),
        ),
        language="sv",
    )
    assert '<html lang="sv">' in page and "<script" not in page and "<link" not in page
    assert not re.search(r'(src|href)="(?!#|data:|https://example\.org")', page)
    assert "url(http" not in page and "@import" not in page
    checker = Balance()
    checker.feed(page)
    assert checker.open == [] and len(checker.ids) == len(set(checker.ids))


def test_light_and_dark(make):
    page = make.html(make.notebook("text"))
    assert '<meta name="color-scheme" content="light dark">' in page and "prefers-color-scheme: dark" in page


def contrast(one, other):
    def luminance(colour):
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
        r, g, b = (p / 12.92 if p <= 0.03928 else ((p + 0.055) / 1.055) ** 2.4 for p in parts)
        return 0.2126 * r + 0.7152 * g + 0.0722 * b

    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_every_text_colour_can_be_read_on_every_ground():
    from notebook_reports.export.exporters.html import style_sheet

    themes = re.findall(r":root \{(.*?)\}", style_sheet(), re.S)[:2]
    assert len(themes) == 2
    for theme in themes:
        colours = dict(re.findall(r"--([\w-]+): (#\w{6})", theme))
        for ink in ("ink", "quiet", "accent", "green", "amber", "red", "string", "number", "name"):
            for ground in ("paper", "tint"):
                assert contrast(colours[ink], colours[ground]) >= 4.5, (ink, ground)


@pytest.mark.builds
def test_marks_are_not_told_by_colour_alone(make):
    rows = [["a", "reproduced"], ["b", "misprint"], ["c", "unexplained"]]
    nb = make.notebook(make.code(Table(["q", "verdict"], rows, marks=["good", "note", "bad"])))
    page = make.html(nb)
    for symbol in "✓◆✗":
        assert re.search(f'<span class="symbol \\w+">{symbol}</span>', page)
    assert all(f'mark: "{mark}"' in make.typst(nb) for mark in ("good", "note", "bad"))


def test_drawings_keep_their_ids_apart_and_their_styles_to_themselves():
    drawing = (
        '<svg xmlns="u"><defs><style type="text/css">*{stroke-linejoin: round; stroke-linecap: butt}</style>'
        '<clipPath id="p1"><path/></clipPath></defs><g id="axes" clip-path="url(#p1)"><use href="#p1"/></g></svg>'
    )
    shown = inside_page(drawing, "d7", "Alt")
    assert 'id="d7-p1"' in shown and "url(#d7-p1)" in shown and 'href="#d7-p1"' in shown
    assert "<style" not in shown and 'id="axes"' not in shown and 'stroke-linejoin="round"' in shown
    assert inside_page("<svg><style>.a{fill:red}</style></svg>", "d1", "Alt") == ""


def test_links_of_a_drawing_from_elsewhere_do_not_run_scripts(make):
    page = make.html(
        make.notebook(make.code(Figure('<svg xmlns="http://www.w3.org/2000/svg"><style>p{}</style></svg>', "c", "a")))
    )
    assert '<img src="data:image/svg+xml;base64,' in page


AROUND = Around(
    Door("../index.html", "The book of $x$"),
    Door("01_a.html", "Before"),
    Door("03_c.html", "After & beyond"),
    (Door("02_b.pdf", "PDF"), Door("02_b.ipynb", "notebook")),
)


def test_a_way_back_the_neighbours_and_the_other_forms(make):
    page = make.html(make.notebook("# T\n\n## A\n\n## B\n\n## C"), around=AROUND)
    bar = re.search(r'<nav class="bar".*?</nav>', page, re.S)[0]
    assert re.findall(r'href="([^"]+)"', bar) == [
        "../index.html",
        "01_a.html",
        "03_c.html",
        "#contents-title",
        "02_b.pdf",
        "02_b.ipynb",
    ]
    assert "The book of <math" in bar and 'aria-label="the next chapter: After &amp; beyond"' in bar
    onward = re.search(r'<nav class="onward".*?</nav>', page, re.S)[0]
    assert re.findall(r'rel="(\w+)" href="([^"]+)"', onward) == [("prev", "01_a.html"), ("next", "03_c.html")]
    alone = make.html(make.notebook("# T"))
    assert 'class="bar"' not in alone and 'class="onward"' not in alone


def test_headings_lead_to_themselves(make):
    page = make.html(make.notebook("# T\n\n## Two tanks"))
    assert '<a class="anchor" href="#Two-tanks" aria-label="Link to this section"></a></h2>' in page


def test_code_is_folded_where_that_is_asked_for_or_tagged(make):
    plain = make.code(make.stream("out 1"), source="a = 1\nb = 2")
    tagged = make.code(make.stream("out 2"), source="c = 3", tags=["hide-input"])
    away = make.code(make.stream("out 3"), source="d = 4", tags=["remove-input"])
    output = make.code(make.stream("out 4"), source="e = 5", tags=["hide-output"])
    nb = make.notebook("# T", plain, tagged, away, output)
    fold = r'<details class="fold"><summary>(.*?)</summary><pre class="(\w+)">'
    page = make.html(nb)
    assert re.findall(fold, page) == [("Code<small>, 1 line</small>", "input"), ("Output", "output")]
    assert "d = 4" not in re.sub("<[^>]+>", "", page) and "out 3" in page
    folded = re.findall(fold, make.html(nb, folded=True))
    assert [words for words, _ in folded] == [
        "Code<small>, 2 lines</small>",
        "Code<small>, 1 line</small>",
        "Code<small>, 1 line</small>",
        "Output",
    ]


@pytest.mark.builds
def test_on_paper_hidden_code_is_left_out_and_hidden_output_is_there(make):
    tagged = make.code(make.stream("out 2"), source="c = 3", tags=["hide-input"])
    output = make.code(make.stream("out 4"), source="e = 5", tags=["hide-output"])
    source = make.typst(make.notebook("# T", tagged, output))
    assert "c = 3" not in source and all(words in source for words in ("out 2", "e = 5", "out 4"))


@pytest.mark.builds
def test_code_goes_to_the_end_or_away(make):
    shown = make.code(make.stream("shown"), source="b = 2")
    nb = make.notebook("# T\n\n## One", make.code(source="a = 1"), "## Two", shown)
    source = make.typst(nb, code="end")
    order = [source.index(words) for words in ('"shown"', "The code", "1 One", '"a = 1"', "2 Two", '"b = 2"')]
    assert order == sorted(order)
    gone = make.typst(nb, code="none")
    assert "a = 1" not in gone and "The code" not in gone and '"shown"' in gone
    page = make.html(nb, code="end")
    assert page.index("shown") < page.index('id="the-code"') < page.index('<pre class="input">')
