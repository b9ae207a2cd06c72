"""The summary of a plant: a table to be sorted and filtered that needs nothing, and the same as CSV."""

import base64
import csv
import html
import io
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from hashlib import sha256
from pathlib import Path
from urllib.parse import quote

from loopbook.design.plant.attention import FINE, ORDER, LoopRow
from notebook_reports.display import number
from notebook_reports.project.printable import printable

HERE = Path(__file__).parent
NUMBERS: tuple[tuple[str, str, Callable[[LoopRow], float | None]], ...] = (
    ("fit", "%", lambda r: r.fit),
    ("Ms", "", lambda r: r.Ms),
    ("overshoot", "%", lambda r: r.overshoot),
    ("settling", "s", lambda r: r.settling),
    ("at limit", "%", lambda r: None if r.at_limit is None else 100 * r.at_limit),
    ("gain", "", lambda r: r.gain),
    ("lags", "s", lambda r: r.time_constant),
    ("delay", "s", lambda r: r.delay),
    ("K", "", lambda r: r.K),
    ("Ti", "s", lambda r: r.Ti),
    ("Td", "s", lambda r: r.Td),
)
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What a spreadsheet takes for a formula at the start of a cell."""


def summary_csv(rows: Sequence[LoopRow]) -> bytes:
    """One line for each loop, ranked; numbers whole, with a point. Text that a spreadsheet would run begins with '."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    heads = [f"{name} [{unit}]" if unit else name for name, unit, _ in NUMBERS]
    writer.writerow(["rank", "loop", "state", *heads, "rule", "what to look at"])
    for rank, row in enumerate(rows, 1):
        values = ["" if (v := of(row)) is None else repr(float(v)) for _, _, of in NUMBERS]
        writer.writerow([rank, _text(row.name), row.state, *values, _text(row.rule), _text(row.why)])
    return out.getvalue().encode()


def _text(text: str) -> str:
    plain = " ".join(printable(text).split())
    return f"'{plain}" if plain.startswith(FORMULA) else plain


def summary_page(rows: Sequence[LoopRow], links: Mapping[str, Mapping[str, str]]) -> bytes:
    """The page. links: the files of each loop by format, beside the page."""
    style, script = ((HERE / name).read_text(encoding="utf-8") for name in ("summary.css", "summary.js"))
    counts = Counter(row.state for row in rows)
    options = "".join(f'<option value="{s}">{s} ({counts[s]})</option>' for s in ORDER if counts[s])
    heads = "".join(
        f'<th scope="col"{" class=number" if numeric else ""}><button type="button">{html.escape(head)}</button></th>'
        for head, numeric in _heads()
    )
    body = "\n".join(_row(rank, row, links.get(row.name, {})) for rank, row in enumerate(rows, 1))
    good = counts[FINE]
    told = f"{len(rows)} loops, {good} with nothing to look at. What needs attention most stands first."
    policy = f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'"
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>All loops</title>
<style>{style}</style>
</head>
<body>
<h1>All loops</h1>
<p>{told}</p>
<form class="tools">
<label>Words <input type="search" name="words" autocomplete="off"></label>
<label>State <select name="state"><option value="">all</option>{options}</select></label>
<output aria-live="polite"></output>
</form>
<div class="frame">
<table>
<thead><tr>{heads}</tr></thead>
<tbody>
{body}
</tbody>
</table>
</div>
<script>{script}</script>
</body>
</html>
""".encode()


def _heads() -> list[tuple[str, bool]]:
    numbers = [(f"{name} [{unit}]" if unit else name, True) for name, unit, _ in NUMBERS]
    return [("rank", True), ("loop", False), ("state", False), *numbers, ("rule", False), ("what to look at", False)]


def _row(rank: int, row: LoopRow, links: Mapping[str, str]) -> str:
    there = "" if row.failed or row.refused else " ".join(
        f'<a href="{html.escape(quote(file))}">{html.escape(format)}</a>' for format, file in links.items()
    )  # fmt: skip
    cells = [
        f'<td class="number">{rank}</td>',
        f'<th scope="row">{html.escape(printable(row.name))} <small>{there}</small></th>',
        f'<td class="state {row.state.replace(" ", "-")}">{row.state}</td>',
        *(_number(of(row)) for _, _, of in NUMBERS),
        f"<td>{html.escape(printable(row.rule))}</td>",
        f'<td class="why">{html.escape(printable(row.why))}</td>',
    ]
    return f'<tr data-state="{row.state}">{"".join(cells)}</tr>'


def _number(value: float | None) -> str:
    if value is None:
        return '<td class="number">–</td>'
    return f'<td class="number" data-value="{float(value)!r}">{html.escape(number(value, 3))}</td>'


def _hash(text: str) -> str:
    return f"sha256-{base64.b64encode(sha256(text.encode()).digest()).decode()}"
