"""In a real browser: a page runs no script but its own, fetches nothing, and is seen as it was written.

Where there is no Chromium and no playwright the tests say so and are skipped.
"""

import http.server
import shutil
import threading

import pytest

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: make browser")
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
if not CHROMIUM:
    pytest.skip("no chromium on PATH: apt-get install chromium, then make browser", allow_module_level=True)
pytestmark = pytest.mark.xdist_group("browser")

QUIET = ("disable-background-networking", "disable-component-update", "disable-sync", "no-first-run", "disable-quic")
ATTACKS = (
    '<svg xmlns="http://www.w3.org/2000/svg"><p/><![CDATA[><script>document.title="ran"</script>]]></svg>',
    '<svg xmlns="http://www.w3.org/2000/svg" onload="document.title=\'ran\'"><rect width="5" height="5"/></svg>',
    '<img src="x" onerror="document.title=\'ran\'">',
    "<script>document.title='ran'</script>",
    '<style>@import "SERVER/style.css"; body{background:url(SERVER/back.png)}</style><p>words</p>',
    '<div style="background:url(SERVER/div.png)">words</div>',
    '<img src="SERVER/picture.png" alt="x">',
    '<svg xmlns="http://www.w3.org/2000/svg"><rect fill="url(SERVER/fill.svg#p)"/><image href="SERVER/i.png"/></svg>',
    '<iframe src="SERVER/frame.html"></iframe><object data="SERVER/o.svg"></object><embed src="SERVER/e.svg">',
    '<link rel="stylesheet" href="SERVER/l.css"><link rel="prefetch" href="SERVER/p.html">',
    '<meta http-equiv="refresh" content="0;url=SERVER/away.html">',
)


@pytest.fixture(scope="module")
def asked():
    """A server on this machine that notes what it is asked for: the network of the tests."""

    class Noting(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            server.asked.append(self.path)
            self.send_response(404)
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Noting)
    server.asked = []
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    server.address = f"http://127.0.0.1:{server.server_port}"
    yield server
    server.shutdown()


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as started:
        words = [f"--{word}" for word in ("no-sandbox", "disable-gpu", *QUIET)]
        running = started.chromium.launch(executable_path=CHROMIUM, args=words)
        yield running
        running.close()


@pytest.fixture
def opened(browser, tmp_path):
    """A function that opens a page as a file and gives it, with what its console said."""
    context = browser.new_context()

    def show(text: str):
        path = tmp_path / "page.html"
        path.write_text(text, encoding="utf-8")
        page = context.new_page()
        page.said = []
        page.on("console", lambda message: page.said.append(message.text))
        page.goto(path.as_uri(), wait_until="load")
        return page

    yield show
    context.close()


def pages(make, asked):
    """The page of each attack that is not refused, alone in a notebook."""
    from notebook_reports.export.errors import ExportError

    for attack in ATTACKS:
        text = attack.replace("SERVER", asked.address)
        for mime in ("text/html", "image/svg+xml", "text/markdown"):
            try:
                yield make.html(make.notebook("# Untouched", make.code({mime: text})))
            except ExportError:
                continue


def test_nothing_that_an_output_holds_runs_or_is_fetched(make, asked, opened):
    shown = 0
    for page in pages(make, asked):
        assert opened(page).title() == "Untouched"
        shown += 1
    assert shown and asked.asked == []


def test_the_policy_holds_where_a_page_would_not(make, asked, opened):
    """The second wall: attacks put into a finished page do nothing; without the policy they do."""
    page = make.html(make.notebook("# Untouched", "Words."))
    attacks = "".join(a.replace("SERVER", asked.address) for a in ATTACKS[1:8])
    broken = page.replace("</main>", f"{attacks}</main>")
    shown = opened(broken)
    assert shown.title() == "Untouched" and asked.asked == []
    assert sum("Content Security Policy" in text for text in shown.said) >= 5
    head, _, rest = broken.partition('<meta http-equiv="Content-Security-Policy"')
    assert opened(head + rest.partition(">")[2]).title() == "ran" and asked.asked
    asked.asked.clear()


def test_the_script_of_an_installed_package_runs_and_is_the_only_one(make, opened, monkeypatch):
    from notebook_reports.export import scripts

    mime = "application/vnd.example.dial+json"
    script = (
        "const live = document.querySelector('.live');\n"
        "live.dataset.shown = JSON.parse(live.querySelector('.data').textContent).text;"
    )
    monkeypatch.setattr(scripts, "offered", lambda: {mime: None})
    monkeypatch.setattr(scripts, "shown", lambda mime, data: (script, "<b>dial</b>"))
    data = {"text": "</script><script>document.title='ran'</script>"}
    page = make.html(make.notebook("# Untouched", make.code({mime: data, "text/plain": "x"})))
    shown = opened(page.replace("</main>", "<script>document.title = 'ran'</script></main>"))
    assert shown.locator(".live").get_attribute("data-shown") == data["text"]
    assert shown.title() == "Untouched"


def test_a_figure_inside_a_page_is_drawn(make, opened):
    from notebook_reports.display import Figure

    shown = opened(make.html(make.notebook("# T", make.code(Figure(make.svg, "A caption", "Alt")))))
    text = shown.locator("svg text")
    assert text.text_content() == "Drawn words ψ" and text.bounding_box()["width"] > 20
    assert shown.said == []
