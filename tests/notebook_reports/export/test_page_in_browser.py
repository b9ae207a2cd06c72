"""The page as a reader has it: buttons that copy, contents in view, nothing wider than a phone, paper without bars.

Where there is no Chromium and no playwright the tests say so and are skipped.
"""

import shutil

import pytest

from notebook_reports.display import Table
from notebook_reports.export.around import Around, Door
from notebook_reports.export.exporters.choose import export
from notebook_reports.export.page import LinkedTable, Page, export_page
from notebook_reports.pages.screen import ledger_page

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (locks/browser.txt)")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
if not CHROMIUM:
    pytest.skip("no chromium on PATH", allow_module_level=True)
pytestmark = pytest.mark.xdist_group("browser")

QUIET = ("disable-background-networking", "disable-component-update", "disable-sync", "no-first-run", "disable-quic")
PROSE = "The level of the lower tank follows that of the upper one, later and more slowly. " * 12
WIDE = r"$$a_{1} + a_{2} + a_{3} + a_{4} + a_{5} + a_{6} + a_{7} + a_{8} + a_{9} + b_{1} + b_{2} + b_{3} + b_{4} = 0$$"
AROUND = Around(Door("../index.html", "The book"), Door("a.html", "Before"), Door("c.html", "After"))


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as started:
        words = [f"--{word}" for word in ("no-sandbox", "disable-gpu", *QUIET)]
        running = started.chromium.launch(executable_path=CHROMIUM, args=words)
        yield running
        running.close()


@pytest.fixture
def opened(browser, tmp_path):
    """A function that opens a page of a size, and fails where the page complains."""
    contexts = []

    def show(text, width=1400, height=900):
        path = tmp_path / "page.html"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        contexts.append(browser.new_context(viewport={"width": width, "height": height}))
        page = contexts[-1].new_page()
        page.said = []
        page.on("console", lambda message: page.said.append(message.text))
        page.on("pageerror", lambda error: page.said.append(str(error)))
        page.goto(path.as_uri(), wait_until="load")
        return page

    yield show
    for context in contexts:
        context.close()


@pytest.fixture
def chapter(make):
    table = Table([f"column {n}" for n in range(14)], [["a long cell"] * 14] * 3, "A wide table")
    sections = [f"## Section {n}\n\n{PROSE}\n\n{WIDE}\n\nand ${WIDE.strip('$')}$ in a line" for n in range(12)]
    cells = ["# A chapter", make.code(make.stream("out"), source="a = 1\nb = '<&>'"), make.code(table, source="show()")]
    return export(make.notebook(*cells, *sections), "html", name="a/b", folded=True, around=AROUND)


def test_a_phone_scrolls_formulas_and_tables_and_not_the_page(opened, chapter):
    page = opened(chapter, 375, 800)
    assert page.evaluate("document.documentElement.scrollWidth") == 375
    for what in (".formula .scroll", ".table .scroll", "p .wide"):
        assert page.evaluate(f"(e => e.scrollWidth > e.clientWidth)(document.querySelector('{what}'))"), what
    assert page.said == []


def test_a_table_is_as_wide_as_the_window_allows(opened, chapter):
    narrow, wide = (
        opened(chapter, width).evaluate("document.querySelector('.table .scroll').clientWidth") for width in (800, 1600)
    )
    text = opened(chapter, 1600).evaluate("document.querySelector('main p').clientWidth")
    assert narrow < 800 and wide > text + 300
    assert opened(chapter, 1600).evaluate("document.documentElement.scrollWidth") == 1600


def test_contents_stay_in_view_and_say_where_the_reader_is(opened, chapter):
    page = opened(chapter)
    for section in (3, 9):
        page.evaluate(f"document.getElementById('Section-{section}').scrollIntoView()")
        page.wait_for_selector(f".contents a[aria-current][href='#Section-{section}']")
        box = page.evaluate(
            "(({top, bottom}) => ({top, bottom}))(document.querySelector('.contents').getBoundingClientRect())"
        )
        assert (
            0 <= box["top"] < 100 and page.evaluate("document.querySelector('.bar').getBoundingClientRect().top") == 0
        )
    phone = opened(chapter, 375, 800)
    phone.evaluate("window.scrollTo(0, 9000)")
    assert phone.locator(".bar .to-contents").is_visible() and phone.locator(".bar .home").is_visible()


def test_code_is_copied_as_it_is_and_opened_all_at_once(opened, chapter):
    page = opened(chapter)
    assert not page.locator("pre.input").first.is_visible()
    page.locator("button.unfold").click()
    assert page.locator("pre.input").count() == 2 and all(e.is_visible() for e in page.locator("pre.input").all())
    page.evaluate("navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve(); }")
    page.locator("pre.input").first.hover()
    page.locator("button.copy").first.click()
    assert page.evaluate("window.copied") == "a = 1\nb = '<&>'\n"
    page.wait_for_selector("button.copy:text-is('Copied')")
    page.locator("button.unfold").click()
    assert not page.locator("pre.input").first.is_visible() and page.said == []


def test_paper_has_no_scroll_bars_no_buttons_and_all_code(opened, chapter):
    page = opened(chapter, 800)
    page.emulate_media(media="print")
    assert not page.locator(".bar").is_visible() and not page.locator("button.copy").first.is_visible()
    for what in (".scroll", ".wide"):
        assert page.evaluate(f"getComputedStyle(document.querySelector('{what}')).overflowX") == "visible"
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert page.locator("pre.input").first.is_visible()


@pytest.fixture
def ledger():
    def rows(document):
        heads = ["place", "the document says", "verdict"]
        lines = [
            ["Table 5", "rise time åäö", "holds"],
            ["Table 5", "settling −1", "fails"],
            ["eq. 4.4", "gain", "holds"],
        ]
        return LinkedTable(
            Table(heads, lines, f"{document}: statements", ["left"] * 3, (), ["good", "note", "good"], groups=1)
        )

    content = ["What is wrong.", rows("The tank"), "Words.", rows("The car")]
    return ledger_page([Page("Errata", content[:2]), Page("Others", content[2:])], "The book")


def test_the_ledger_is_filtered_by_words_document_and_verdict(opened, ledger):
    page = opened(ledger)

    def shown(words="", document="", verdict=""):
        page.fill("input[name=words]", words)
        page.select_option("select[name=document]", document)
        page.select_option("select[name=verdict]", verdict)
        page.wait_for_timeout(250)
        return [row.inner_text().split("\t") for row in page.locator("tbody tr").all() if row.is_visible()]

    assert len(shown()) == 6
    assert [row[1] for row in shown("RISE aao")] == ["rise time åäö"] * 2, "without regard to case and accents"
    assert [row[0] for row in shown("table 5 settling -1")] == ["Table 5"] * 2, "a repeated place is found and named"
    assert len(shown(document="The car")) == 3 and not page.locator("#Errata").is_visible()
    assert [row[1] for row in shown(document="The car", verdict="fails")] == ["settling −1"]
    assert page.locator(".tools output").inner_text() == "1 of 6 rows"
    assert shown("nothing of the kind") == [] and page.locator(".tools output").inner_text() == "0 of 6 rows"
    assert len(shown()) == 6 and page.locator("#Errata").is_visible() and page.said == []


def test_a_page_without_tools_has_no_form(opened):
    page = opened(export_page(Page("Words", ["Only words."])))
    assert page.locator("form").count() == 0 and page.said == []
