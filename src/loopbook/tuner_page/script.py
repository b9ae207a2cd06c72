"""The script of the page: the modules of `js/`, with what is printed from the derivations, as one text."""

import json
import re
from functools import cache

from loopbook.tuner_page.bundle import FOLDER, bundle
from loopbook.tuner_page.emitted import law_script, programs
from loopbook.tuner_page.formulas import rules_script, rules_words
from loopbook.tuner_page.packed import packed

MIME = "application/vnd.loopbook.tuner+json"
PLACE = '<div class="lbt-place"></div>'
"""What the script fills; the press puts it and the data side by side."""


def _style() -> str:
    """The style sheet in one line."""
    sheet = (FOLDER / "ui" / "style.css").read_text(encoding="utf-8")
    return re.sub(r"\s*([{};:,])\s+|\s+", lambda match: match[1] or " ", sheet)


@cache
def generated() -> dict[str, str]:
    """The modules that are no files, by their path."""
    words = json.loads((FOLDER / "ui" / "words.json").read_text(encoding="utf-8"))
    texts = {"programs": programs(), "style": _style(), **rules_words(), **words}
    short = packed(json.dumps(texts, ensure_ascii=False))
    return {
        "rules/formulas.js": rules_script(),
        "generated/law.js": law_script(),
        "generated/texts.js": f'export const packedTexts = "{short}";\n',
    }


@cache
def script() -> str:
    """One classic script: no module, nothing fetched, nothing evaluated."""
    return bundle("main.js", generated())
