"""The tuner as a page of its own: one file that opens from a disk and needs nothing."""

import base64
import json
from collections.abc import Mapping
from hashlib import sha256
from html import escape
from typing import Any

from loopbook.tuner_page.script import MIME, PLACE, script

POLICY = (
    "default-src 'none'; script-src 'sha256-{}'; style-src 'unsafe-inline'; img-src data: blob:; "
    "base-uri 'none'; form-action 'none'"
)
PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
body {{ margin: 0; padding: 10px 14px; background: #eaeef2; color: #16202b;
  font: 15px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }}
h1 {{ font-size: 17px; margin: 2px 2px 8px; display: flex; gap: 12px; align-items: baseline; flex-wrap: wrap; }}
h1 small {{ font-size: 13px; font-weight: 400; color: #5a6673; }}
main > .live .lbt {{ width: 100%; margin: 0; }}
main > .live .lbt-grid {{ min-height: 0; }}
noscript svg, noscript img {{ max-width: 100%; height: auto; background: #fff; }}
@media (prefers-color-scheme: dark) {{ body {{ background: #0b0f14; color: #e4e9ef; }} h1 small {{ color: #9aa8b6; }} }}
@media (max-width: 640px) {{ body {{ padding: 6px; }} }}
</style>
</head>
<body>
<main>
<h1>{title} <small>{about}</small></h1>
<div class="live" data-mime="{mime}">{place}<script type="application/json" class="data">{data}</script></div>
<noscript>
<p>The page is interactive with JavaScript; without it, this is the loop as it begins.</p>
{still}
</noscript>
</main>
<script>{script}</script>
</body>
</html>
"""


def page(data: Mapping[str, Any], title: str, about: str = "", still: str = "") -> str:
    """A complete page. data: see `loopbook.tuner_page.settings`. still: markup of its figure, an SVG."""
    text = script()
    digest = base64.b64encode(sha256(text.encode()).digest()).decode()
    return PAGE.format(
        policy=POLICY.format(digest),
        title=escape(title),
        about=escape(about),
        mime=MIME,
        place=PLACE,
        data=as_text(data),
        still=still,
        script=text,
    )


def as_text(data: Mapping[str, Any]) -> str:
    """Data as JSON that ends no element of a page."""
    text = json.dumps(data, ensure_ascii=False, sort_keys=True)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
