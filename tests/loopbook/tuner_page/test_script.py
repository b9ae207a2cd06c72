"""The one script of the page: small, whole, of modules that can be read; and what makes it small changes nothing."""

import json
import re
from pathlib import Path

import pytest

from loopbook.tuner_page import bundle as bundling
from loopbook.tuner_page.bundle import FOLDER, OWN, BundleError, bundle
from loopbook.tuner_page.formulas import rules_words
from loopbook.tuner_page.packed import packed
from loopbook.tuner_page.script import generated, script
from loopbook.tuner_page.small import small
from loopbook.tuner_page.syntax import tokens

MODULES = sorted(FOLDER.rglob("*.js"))
MOST = 120_000  # bytes added to a report


def test_the_script_adds_at_most_120_kilobytes():
    assert len(script().encode()) <= MOST


def test_the_script_is_classic_fetches_nothing_and_evaluates_nothing():
    text = script()
    assert "</script" not in text.lower() and "<!--" not in text
    for word in (
        "import(",
        "import ",
        "export ",
        "fetch(",
        "XMLHttpRequest",
        "WebSocket",
        "eval(",
        "new Function",
        "Worker(",
        "innerHTML",
    ):
        assert word not in text, word


def test_the_script_is_the_same_at_each_run():
    assert bundle("main.js", generated()) == script()


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(FOLDER).as_posix())
def test_a_module_holds_one_idea_and_says_which(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("// ") and lines[0][3:4].isupper()
    assert len(lines) <= 300 or path.name in LONG


LONG = {
    "plots.js": "each plot with its drag",
    "tuner.js": "the page's one object, a method for each thing that it does",
}


def test_the_bundle_refuses_what_it_would_change():
    clash = {"a.js": 'import { x } from "./b.js";\nconst y = x;\n', "b.js": "export const x = 1;\nconst y = 2;\n"}
    with pytest.raises(BundleError, match=r"a\.js: y is a name of b\.js as well"):
        bundle("a.js", clash)
    with pytest.raises(BundleError, match=r"b\.js does not export z"):
        bundle("a.js", {**clash, "a.js": 'import { z } from "./b.js";\n'})
    with pytest.raises(BundleError, match=r"circle: a\.js -> b\.js"):
        bundle(
            "a.js",
            {"a.js": 'import { x } from "./b.js";\n', "b.js": 'import { y } from "./a.js";\nexport const x = 1;\n'},
        )
    with pytest.raises(BundleError, match="a pattern at the top"):
        bundle("a.js", {"a.js": "const { x } = Math;\n"})
    with pytest.raises(BundleError, match="of a form that the bundle does not know"):
        bundle("a.js", {"a.js": "export default 3;\n"})


def test_properties_that_get_shorter_names_are_asked_for_by_no_text():
    """A text that is the name of such a property could be its key; one that is written out as a key is not."""
    texts = [re.sub(r"^import .*$", "", path.read_text(encoding="utf-8"), flags=re.M) for path in MODULES]
    texts += [generated()[name] for name in ("rules/formulas.js", "generated/law.js")]
    names = set()
    for text in texts:
        found = list(tokens(text))
        for i, (kind, token) in enumerate(found):
            key = found[i - 1][1] in ("{", ",") and found[i + 1][1] == ":" if i else False
            if kind == "string" and not key:
                names |= {token.strip("\"'"), *token.strip("\"'").split(",")}
    keys = set(re.findall(r'"(\w+)":', (FOLDER / "ui" / "words.json").read_text(encoding="utf-8")))
    places = set(re.findall(r"\{(\w+)", json.dumps(rules_words())))  # what the words of a rule ask for
    words_of_rules = {key for words in rules_words()["rules"] for key in words}
    assert OWN & (names | keys | places | words_of_rules | DATA) == set()


DATA = {"state", "process", "record", "names", "name", "pins", "formula", "num", "den", *"tuy", "u0", "y0"}
"""Keys of what Python gives to a page; those of its state are names of knobs."""

SAMPLE = """
// a remark
const far = (x) => {
    const half = x / 2, mark = /[/"]x/.test(`a${half > 1 ? "b" : `c${x}`}d`);
    return { half, mark, far: -x };
};
function next({ half, mark = false }, [a, ...rest]) {
    let total = 0;
    for (const one of rest) total += one;
    for (let i = 0; i < 3; i += 1) { const deep = i; total += deep; }
    const choose = half > 1 ? { half } : { half: a };
    label: for (;;) { break label; }
    return mark ? [total - -a, choose.half, Math.max(a, half)] : ["no;}", total, - -half];
}
class Thing {
    constructor(half) { this.half = half; }
    get twice() { return this.half * 2; }
    half2(x) { return x + this.twice; }
}
const made = new Thing(4);
const rows = [next(far(8), [1, 2, 3]).join(), next({ half: 1 }, [2]).join()];
const found = [JSON.stringify(far(3)), ...rows, made.half2(1), made.twice].join("|");
"""


def test_what_is_small_does_the_same():
    from py_mini_racer import MiniRacer

    short = small(SAMPLE.replace("label: ", "").replace("break label", "break"), frozenset({"found"}))
    plain, other = MiniRacer(), MiniRacer()
    plain.eval(SAMPLE, timeout=2000)
    other.eval(short, timeout=2000)
    assert other.eval("found", timeout=2000) == plain.eval("found", timeout=2000)
    assert len(short) < 0.75 * len(SAMPLE)


def test_all_of_the_core_small_and_not_small_gives_the_same_numbers():
    from py_mini_racer import MiniRacer

    question = "JSON.stringify(golden.core.margins(new golden.core.LoopTransfer([7.2, 0.6], [480, 168, 12, 0], 3)))"
    answers = []
    for shorten in (small, lambda text, *_: text):
        original, bundling.small = bundling.small, shorten
        try:
            machine = MiniRacer()
            machine.eval(bundle("core/index.js", returned="golden"), timeout=20_000)
        finally:
            bundling.small = original
        answers.append(machine.eval(question, timeout=5000))
    assert answers[0] == answers[1] and json.loads(answers[0])["Ms"]["value"] > 1


TEXTS = ("", "a", "aaaaaaaaaaaaaaaaaaaa" * 9, 'é–x±\n\t"\\`$' * 7, Path(__file__).read_text(encoding="utf-8"))


@pytest.mark.parametrize("text", TEXTS, ids=range(len(TEXTS)))
def test_a_packed_text_comes_back(ask, text):
    short = packed(text)
    assert ask("(short) => page.unpacked(short)", short) == text
    assert short.isascii() and short.isprintable() and not set(short) & {'"', "\\"}


def test_a_packed_text_is_shorter():
    text = Path(bundling.__file__).read_text(encoding="utf-8") * 2
    assert len(packed(text)) < 0.32 * len(text)
