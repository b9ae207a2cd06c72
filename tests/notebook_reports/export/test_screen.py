"""The HTML: complete in itself, for light and dark, for readers of every kind."""

import re
from html.parser import HTMLParser

import pytest

from notebook_reports.display import Figure, Table
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
        assert f'<span class="symbol">{symbol}</span>' in page
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
