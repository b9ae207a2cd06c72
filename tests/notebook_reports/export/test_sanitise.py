"""What comes from an output is data: a drawing that would run, fetch or break out is refused or loses that part."""

import json
import random
import re
import sys

import nh3
import pytest

from notebook_reports.export import scripts
from notebook_reports.export.errors import CannotShow, ExportError
from notebook_reports.export.exporters.html import page_script
from notebook_reports.export.read import sanitise
from notebook_reports.export.read.sanitise import LOOKS, drawing
from notebook_reports.export.write.inside_page import inside_page

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="9" height="9">'
REFUSED = {
    "markup hidden in CDATA": "<p/><![CDATA[><script>alert(1)</script>]]>",
    "a script": "<script>alert(1)</script>",
    "a script with another prefix": '<x:script xmlns:x="http://www.w3.org/2000/svg">alert(1)</x:script>',
    "a script in capitals": "<SCRIPT>alert(1)</SCRIPT>",
    "an event": '<rect onclick="alert(1)"/>',
    "an event in capitals": '<rect ONLOAD="alert(1)"/>',
    "HTML inside": "<foreignObject><b>x</b></foreignObject>",
    "HTML of its own namespace": '<img xmlns="http://www.w3.org/1999/xhtml" src="x" onerror="alert(1)"/>',
    "a frame": "<iframe/>",
    "a link that is a script": '<a href="javascript:alert(1)"><text>x</text></a>',
    "a link that is a script, by XLink": '<a xlink:href="javascript:alert(1)"><text>x</text></a>',
    "a link that is a script, broken up": '<a xlink:href=" java&#10;script:alert(1)"><text>x</text></a>',
    "a link that is data": '<a href="data:text/html,x"><text>x</text></a>',
    "an attribute set to a script": '<a><set attributeName="href" to="javascript:alert(1)"/><text>x</text></a>',
    "an attribute animated": '<a><animate attributeName="href" values="javascript:alert(1)"/><text>x</text></a>',
    "an image of the network": '<image href="https://example.org/a.png"/>',
    "an image of this machine": '<image xlink:href="file:///etc/passwd"/>',
    "an image that is a drawing": '<image href="data:image/svg+xml;base64,PHN2Zy8+"/>',
    "a part of another file": '<use href="other.svg#x"/>',
    "a fill from the network": '<rect fill="url(https://example.org/a.svg#p)"/>',
    "a fill from the network, in a style": "<rect style=\"fill: url( '//example.org/a#p' )\"/>",
    "a mask from the network": '<rect mask="url(//example.org/a#m)"/>',
    "a filter from the network": '<rect filter="URL(https://example.org/a#f)"/>',
    "an address in escapes": '<rect style="fill: u\\72l(https://example.org/a#p)"/>',
    "an image set": "<rect style=\"mask: image-set('https://example.org/a' 1x)\"/>",
    "a style that imports": "<style>@import 'https://example.org/a.css'; rect{fill:red}</style>",
    "a style with a font of the network": "<style>@font-face{font-family:x;src:url(https://example.org/f)}</style>",
    "a style with an address": "<style>rect{fill:url(https://example.org/a#p)}</style>",
    "a style with markup": "<style>rect{fill:red}&lt;/style>&lt;script>alert(1)&lt;/script></style>",
    "a picture of a filter": '<filter id="f"><feImage href="https://example.org/a.png"/></filter>',
    "elements without end": "<g>" * 300 + "</g>" * 300,
}
LEFT_OUT = {
    "an editor's notes": '<i:view xmlns:i="http://www.inkscape.org" i:x="1"><i:grid/></i:view><rect width="1"/>',
    "metadata": "<metadata><script>alert(1)</script></metadata>",
    "a comment": "<!-- <script>alert(1)</script> -->",
    "an instruction": "<?xml-stylesheet href='https://example.org/a.css'?>",
    "a title that is markup": "<title>&lt;script>alert(1)&lt;/script></title>",
    "text that is markup": "<text>&lt;script>alert(1)&lt;/script></text>",
    "another base": '<g xml:base="https://example.org/"><use href="#a"/></g>',
    "an unknown property": '<rect style="behavior: x; fill: red; background: red"/>',
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_drawing_that_would_run_or_fetch_is_refused(what):
    with pytest.raises(CannotShow, match="an SVG image"):
        drawing(f"{HEAD}{REFUSED[what]}</svg>".encode())


@pytest.mark.parametrize("what", LEFT_OUT)
def test_what_nobody_sees_is_left_out(what):
    text = drawing(f"{HEAD}{LEFT_OUT[what]}</svg>".encode()).decode()
    assert_static(text)
    assert "alert(1)" not in re.sub(r"&lt;script&gt;alert\(1\)", "", text)


def test_entities_are_not_expanded():
    bomb = '<!DOCTYPE svg [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>' + HEAD + "<text>&b;</text></svg>"
    with pytest.raises(CannotShow, match="entities"):
        drawing(bomb.encode())
    outside = '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]>' + HEAD + "<text>&a;</text></svg>"
    with pytest.raises(CannotShow, match=r"entities|cannot be read"):
        drawing(outside.encode())


def test_an_attribute_of_the_document_type_counts():
    typed = '<!DOCTYPE svg [<!ATTLIST rect onclick CDATA "alert(1)">]>' + HEAD + "<rect/></svg>"
    with pytest.raises(CannotShow, match="onclick"):
        drawing(typed.encode())


def test_a_drawing_keeps_what_is_seen():
    figure = (
        '<?xml version="1.0"?>\n<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/svg11.dtd">\n'
        + HEAD
        + '<defs><style type="text/css">*{stroke-linejoin: round; stroke-linecap: butt}</style>'
        '<clipPath id="p"><rect x="1"/></clipPath></defs>'
        '<g id="axes" clip-path="url(#p)"><use xlink:href="#p" style="fill: #ff0000; stroke: none"/>'
        '<a xlink:href="https://example.org/?a=1&amp;b=2"><text xml:space="preserve">a &lt; b &amp; c</text></a>'
        '<image xlink:href="data:image/png;base64,iVBORw0K"/></g></svg>'
    )
    text = drawing(figure.encode()).decode()
    for kept in (
        ">*{stroke-linejoin: round; stroke-linecap: butt}</style>",
        'clip-path="url(#p)"',
        'style="fill: #ff0000; stroke: none"',
        'xlink:href="https://example.org/?a=1&amp;b=2"',
        "a &lt; b &amp; c",
        "base64,iVBORw0K",
    ):
        assert kept in text
    assert drawing(text.encode()).decode() == text
    assert inside_page(text, "d1", "Alt").startswith("<svg role=")


RUNS = {"script", "iframe", "object", "embed", "foreignobject", "set", "animate", "base", "form", "meta"}


def assert_static(page: str) -> None:
    """No element that runs, no event, no address that runs or fetches, as the parser of a browser meets them."""
    body = page.partition("</head>")[2] or page
    left = nh3.clean(body, tags=RUNS, clean_content_tags=set(), attributes={}, link_rel=None)
    assert not re.search(r"<\w", left), left
    seen: list[tuple[str, str]] = []

    def note(element: str, name: str, value: str) -> None:
        seen.append((name, value.strip().lower()))

    nh3.clean(
        body,
        tags=set(re.findall(r"<([A-Za-z][\w-]*)", body)),
        clean_content_tags=set(),
        attributes={"*": {"href", "xlink:href", "src", "style", *LOOKS.split()}},
        generic_attribute_prefixes={"on"},
        attribute_filter=note,
        link_rel=None,
        url_schemes={"http", "https", "mailto", "data", "javascript", "vbscript", "file"},
    )
    for name, value in seen:
        assert not name.startswith("on"), name
        if name.endswith("href") or name == "src":
            assert value.startswith(("#", "https:", "http:", "mailto:", "data:image/")) or ":" not in value, value
        assert "url(" not in value or "url(#" in value, value


def test_the_independent_parser_of_these_tests_does_see_what_runs():
    for text in ("<script>1</script>", "<p onclick=x>", "<a href=javascript:x>", "<b style='mask:url(http://x)'>"):
        with pytest.raises(AssertionError):
            assert_static(text)


def test_a_seeded_fuzz_of_drawings_gives_static_ones_or_none():
    chance = random.Random(5)
    pieces = [*REFUSED.values(), *LEFT_OUT.values(), "<g>", "</g>", "]]>", "<![CDATA[", "&#x3c;", '"', "'", "<", ">"]
    kept = 0
    for _ in range(3000):
        inside = "".join(chance.sample(pieces, chance.randint(1, 4)))
        if chance.random() < 0.5:
            at = chance.randrange(len(inside))
            inside = inside[:at] + chance.choice(["/", " ", "\x0b", ">", "-", "x:", "\\"]) + inside[at + 1 :]
        try:
            text = drawing(f"{HEAD}{inside}</svg>".encode()).decode()
        except CannotShow:
            continue
        kept += 1
        assert_static(text)
        assert drawing(text.encode()).decode() == text
    assert kept > 50


HTML = [
    "<img src=x onerror=alert(1)>",
    "<script>alert(1)</script>",
    '<a href="javascript:alert(1)">x</a>',
    '<a href="JaVaScRiPt&colon;alert(1)">x</a>',
    '<a href="vbscript:x">x</a>',
    '<a href="data:text/html,<script>alert(1)</script>">x</a>',
    '<div onclick="alert(1)" style="background:url(https://example.org)">words</div>',
    "<style>@import 'https://example.org'</style><p>words</p>",
    "<table><tr><td onmouseover=alert(1)>1</td></tr></table>",
    "<svg><script>alert(1)</script></svg>",
    "<math><mtext></form><form><mglyph><style></math><img src onerror=alert(1)>",
    '<form action="https://example.org"><input autofocus onfocus=alert(1)></form>',
    "<base href='https://example.org'><p>words</p>",
    "<meta http-equiv=refresh content='0;url=https://example.org'><p>words</p>",
    "<p title='\"><script>alert(1)</script>'>words</p>",
    '<p id="&quot;><script>alert(1)</script>">words</p>',
    "<a name='\"><script>'>x</a>",
    "<ol start='1\"><script>'><li>x</li></ol>",
    "<td colspan='2\"><script>'>x</td>",
]


@pytest.mark.parametrize("text", HTML)
@pytest.mark.parametrize("mime", ["text/html", "text/markdown"])
def test_html_of_outputs_is_written_anew_or_refused(make, text, mime):
    try:
        page = make.html(make.notebook("# T", make.code({mime: text})))
    except ExportError:
        return
    assert_static(page)


def test_a_formula_and_a_caption_carry_no_markup(make):
    from notebook_reports.display import Figure, Table

    attack = "</span><script>alert(1)</script>"
    node = make.notebook(
        "# T",
        make.code(Figure(make.svg, attack, attack), Table([attack], [[attack]], attack, notes=[attack])),
        make.code(make.stream(attack), make.error(attack), source=attack),
    )
    page = make.html(node, document=attack, chapter=attack)
    assert_static(page)


DIAL = "application/vnd.example.dial+json"


@pytest.fixture
def dial(tmp_path, monkeypatch):
    """A package, installed, that offers a script for a MIME type."""
    code = (
        "def shown(data):\n"
        '    return (\'document.querySelector(".live").dataset.ran = "yes";\', \'<b class="dial">dial</b>\')\n'
        "def breaks(data):\n    raise ValueError('no such dial')\n"
        "def ends(data):\n    return ('</script><script>alert(1)', '')\n"
    )
    (tmp_path / "a_dial.py").write_text(code)
    about = tmp_path / "a_dial-1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: a-dial\nVersion: 1\n")

    def offer(function="shown"):
        (about / "entry_points.txt").write_text(f"[{scripts.GROUP}]\n{DIAL} = a_dial:{function}\n")
        scripts.offered.cache_clear()

    monkeypatch.setattr(scripts, "installed_places", lambda: [str(tmp_path)])
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "a_dial", raising=False)
    offer()
    yield offer
    scripts.offered.cache_clear()


def dials(make, **forms):
    data = {"angle": "</script><script>alert(1)</script>", "n": 1}
    return make.notebook("# T", make.code({DIAL: data, "text/plain": "a dial at 1"}), "Words.")


@pytest.mark.builds
def test_a_script_comes_from_an_installed_package_and_its_hash_is_in_the_policy(make, dial):
    page = make.html(dials(make))
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', page)[1]
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    assert "dataset.ran" in script and "alert" not in script
    assert scripts.policy([page_script(), script]) == policy
    assert "sha256-" in policy and "'none'; script-src 'sha256" in policy
    (data,) = re.findall(r'<script type="application/json" class="data">(.*?)</script>', page, re.DOTALL)
    assert json.loads(data) == {"angle": "</script><script>alert(1)</script>", "n": 1}
    assert page.index('<b class="dial">') < page.index("<noscript>") < page.index("a dial at 1")
    assert "a dial at 1" in make.typst(dials(make))


def test_one_script_for_two_outputs_stands_once(make, dial):
    two = make.notebook("# T", *[make.code({DIAL: {"n": n}, "text/plain": "x"}) for n in (1, 2)])
    page = make.html(two)
    assert page.count("<script>") == 1 and page.count('class="live"') == 2


def test_a_package_that_fails_is_named(make, dial):
    dial("breaks")
    with pytest.raises(ExportError, match=r"a_dial:breaks does not show it \(ValueError: no such dial"):
        make.html(dials(make))
    dial("ends")
    with pytest.raises(ExportError, match="would end before its end"):
        make.html(dials(make))


def test_no_script_comes_from_a_folder_that_is_not_installed(make, dial, monkeypatch, tmp_path_factory):
    monkeypatch.setattr(scripts, "installed_places", lambda: [str(tmp_path_factory.mktemp("empty"))])
    scripts.offered.cache_clear()
    page = make.html(dials(make))
    assert "<script" not in page and "a dial at 1" in page and scripts.policy([page_script()]) in page


def test_a_changed_script_is_a_reason_to_export_again(dial, tmp_path):
    before = scripts.print_of([DIAL])
    (tmp_path / "a_dial.py").write_text("def shown(data): return '', ''")
    sys.modules.pop("a_dial", None)
    assert before and scripts.print_of([DIAL]) != before and scripts.print_of(["application/x"]) == ""


def test_the_list_of_what_may_be_holds_nothing_that_runs():
    assert not sanitise.ELEMENTS & {
        "script",
        "set",
        "animate",
        "animateTransform",
        "foreignObject",
        "handler",
        "feImage",
    }
    assert not any(a.lower().startswith("on") or "href" in a for a in sanitise.ATTRIBUTES)


@pytest.fixture
def shelf(tmp_path, make):
    """A project with an image in it, one outside, and a link from inside to outside."""
    notebooks = tmp_path / "project" / "notebooks" / "a"
    notebooks.mkdir(parents=True)
    (tmp_path / "project" / "figures").mkdir()
    for place in ("secret.png", "project/figures/inside.png", "project/notebooks/a/near.png"):
        (tmp_path / place).write_bytes(make.png())
    (notebooks / "link.png").symlink_to(tmp_path / "secret.png")
    return notebooks


@pytest.mark.parametrize(
    "name",
    ["../../../secret.png", "{outside}/secret.png", "link.png", "%2e%2e/../../secret.png", "../a/../../../secret.png"],
)
@pytest.mark.parametrize("form", ["![x]({})", '<img alt="x" src="{}">'])
def test_an_image_outside_the_project_is_refused(make, shelf, name, form):
    text = form.format(name.format(outside=shelf.parents[2]))
    for root in (None, shelf.parents[1]):
        with pytest.raises(ExportError, match=r"lies outside of|no image"):
            make.html(make.notebook("# T", text), assets=shelf, root=root)


def test_an_image_of_the_project_is_shown(make, shelf):
    node = make.notebook("# T", "![x](near.png) and ![x](../../figures/inside.png)")
    assert make.html(node, assets=shelf, root=shelf.parents[1]).count("data:image/png") == 2
    with pytest.raises(ExportError, match="lies outside of a/"):
        make.html(node, assets=shelf)


def test_a_device_is_no_image(make, shelf):
    import os

    os.mkfifo(shelf / "pipe.png")
    with pytest.raises(ExportError, match=r"no image pipe\.png"):
        make.html(make.notebook("# T", "![x](pipe.png)"), assets=shelf)
