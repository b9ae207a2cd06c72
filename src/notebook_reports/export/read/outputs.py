"""The outputs of a code cell into a report's blocks, the richest form that a page can show first."""

import json
import re
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from notebook_reports.display import EQUATION_MIME, FIGURE_MIME, TABLE_MIME
from notebook_reports.export import scripts
from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Block, Display, FigureBlock, Live, Mend, Verbatim
from notebook_reports.export.read import pictures
from notebook_reports.export.read.html import read_html
from notebook_reports.export.read.inline_text import read_inline
from notebook_reports.export.read.markdown import read_markdown
from notebook_reports.export.read.reading import Reading, flow, with_math
from notebook_reports.export.read.tables import from_data
from notebook_reports.export.read.terminal import settle

MAX_TEXT = 400_000
"""Characters of text output that a report still shows: some 150 pages."""

Bundle = dict[str, Any]


def read_outputs(outputs: Iterable[Any], reading: Reading) -> list[Block]:
    """The blocks of all outputs; what cannot be shown is noted in `reading.problems`."""
    blocks: list[Block] = []
    for output in _merged(outputs):
        blocks.extend(reading.attempt(partial(read_output, output, reading)))
    return blocks


def read_output(output: Any, reading: Reading) -> list[Block]:
    """The blocks of one output. Raises CannotShow where none of its forms can be shown."""
    match output["output_type"]:
        case "stream":
            return _listing(output.get("text", ""), "stderr" if output.get("name") == "stderr" else "output", reading)
        case "error":
            told = f"{output.get('ename', 'Error')}: {output.get('evalue', '')}"
            return _listing("\n".join(output.get("traceback") or [told]), "error", reading)
        case "display_data" | "execute_result" | "update_display_data" | "pyout":
            return _bundle(output.get("data") or {}, output.get("metadata") or {}, reading)
    raise CannotShow(f"an output of the kind {output['output_type']}")


def _merged(outputs: Iterable[Any]) -> list[Any]:
    """Neighbouring pieces of one stream are one."""
    merged: list[Any] = []
    for output in outputs:
        last = merged[-1] if merged else None
        streams = last is not None and output["output_type"] == "stream" == last["output_type"]
        if last and streams and output.get("name") == last.get("name"):
            merged[-1] = {**last, "text": _joined(last.get("text", "")) + _joined(output.get("text", ""))}
        else:
            merged.append(output)
    return merged


def _bundle(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    """The first form that a page can show. An output without data is nothing."""
    for mime in data:
        if mime not in _FORMS and mime in scripts.offered():
            rest = {other: content for other, content in data.items() if other != mime}
            if not rest:
                raise CannotShow(f"an output that exists only as {mime}; give it a form for paper too")
            return [Live(mime, data[mime], *scripts.shown(mime, data[mime]), _bundle(rest, metadata, reading))]
    data = {mime: content for mime, content in data.items() if content not in ("", [], None)}
    refused: list[CannotShow] = []
    for mime, read in _FORMS.items():
        if mime not in data or (mime == "text/plain" and _more_than_text(data)):
            continue
        try:
            lost = [error for error in refused if error.kind != "table"]
            return [*(Mend(e.kind, e.reason, e.text, e.address) for e in lost[:1]), *read(data, metadata, reading)]
        except CannotShow as error:
            if not reading.mending and not (error.kind == "table" and "text/html" in data):
                raise
            refused.append(error)
    shown = [mime for mime in data if not mime.startswith("application/vnd.loopbook.")]
    if not shown:
        return []
    return _mended(data, shown, refused, reading)


def _mended(data: Bundle, shown: list[str], refused: list[CannotShow], reading: Reading) -> list[Block]:
    """A box for an output that no page can show, its text form beside it."""
    words = _listing(data["text/plain"], "output", reading) if "text/plain" in data else []
    other = next((mime for mime in shown if mime.startswith("text/") and mime not in _FORMS), "")
    words = words or (_listing(data[other], "output", reading) if other else [])
    if not refused:
        forms = ", ".join(sorted(mime for mime in shown if mime != "text/plain"))
        if not words and not reading.mending:
            raise CannotShow(f"an output that exists only as {forms}; display a table, a figure or text instead")
        kind = "widget" if "widget" in forms else "output"
        reason = "a page is not interactive" if kind == "widget" else f"a page cannot show {forms}"
        refused = [CannotShow(f"an output that a page can show only as text, not as {forms}", kind, reason)]
    if not reading.mending:
        raise refused[0]
    first = refused[0]
    told = f"{first.reason}; its text form follows" if words else first.reason
    return [Mend(first.kind, told, "" if words else first.text, first.address), *words]


def _more_than_text(data: Bundle) -> bool:
    """Is there something beside the text that a browser would show instead, such as a widget or a chart?"""
    return any(_INTERACTIVE.search(mime) for mime in data)


_INTERACTIVE = re.compile(
    r"^application/(vnd\.(jupyter\.widget|plotly|vega|bokeh|holoviews)|javascript|geo|pdf)|^(video|audio|model)/"
)


def _table(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    return [from_data(data[TABLE_MIME])]


def _figure(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    told = data[FIGURE_MIME]
    picture = _first_picture(data, metadata, reading.alt(told.get("alt"), "the figure"))
    if picture is None:
        raise CannotShow("a figure without its drawing; run the cell again")
    return [FigureBlock(picture, read_inline(told["caption"]))]


def _equation(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    told = data[EQUATION_MIME]
    return [Display(told["latex"], told["label"], told["anchor"])]


def _latex(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    text = _joined(data["text/latex"]).strip()
    if re.search(r"\\begin\{(tabular|longtable|table|figure|center|tikzpicture)", text):
        raise CannotShow("LaTeX that is no formula; give the output an HTML form", "table", "it is LaTeX for a printer")
    alone = text.startswith("$") and text.endswith("$") and "$" not in text.strip("$")
    if alone or (text.startswith(r"\begin") and "$" not in text):
        return [*reading.display(text.strip("$").strip())]
    if reading.mending and "$" not in text and re.match(r"\\[a-zA-Z(\[]", text) and "\\(" not in text:
        return [*reading.display(text.removeprefix(r"\[").removesuffix(r"\]"))]
    return flow(with_math(text, reading))


def _picture(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    told = next((m["alt"] for m in (metadata, *metadata.values()) if isinstance(m, dict) and m.get("alt")), "")
    picture = _first_picture(data, metadata, reading.alt(told, "a picture"))
    return [FigureBlock(picture)] if picture else []


def _first_picture(data: Bundle, metadata: Bundle, alt: str) -> Any:
    for mime in pictures.KINDS:
        if mime in data:
            own = metadata.get(mime)
            asked = own if isinstance(own, dict) else metadata
            sizes = (_pixels(asked.get(key)) for key in ("width", "height"))
            return pictures.from_bundle(mime, data[mime], alt, *sizes)
    return None


def _pixels(told: Any) -> float | None:
    return float(told) if isinstance(told, int | float) and told > 0 else None


def _html(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    text = _joined(data["text/html"])
    _refuse_long(text, 20 * MAX_TEXT)
    if re.search(r"text-repr-fallback", text) and "text/plain" in data:
        return _plain(data, metadata, reading)  # xarray, scikit-learn: the same in text, made for pages without styles
    blocks = read_html(text, reading, anchors=not reading.mending)
    if "text/plain" in data and not any(not isinstance(block, Mend) for block in blocks):
        blocks += _plain(data, metadata, reading)
    return blocks


def _script(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    raise CannotShow(
        "an output that is a script, which a page cannot run; display a table, a figure or text instead",
        "script",
        "a page runs no scripts",
    )


def _markdown(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    return read_markdown(_joined(data["text/markdown"]), reading)


def _plain(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    return _listing(data["text/plain"], "output", reading)


def _json(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    text = json.dumps(data["application/json"], indent=2, ensure_ascii=False)
    return _listing(text, "output", reading)


def _listing(text: Any, role: str, reading: Reading) -> list[Block]:
    """Printed text; a text over the limit is an error or, mended, cut in its middle with a count."""
    text = settle(_joined(text)).strip("\n")
    if not reading.mending:
        _refuse_long(text, MAX_TEXT)
    if len(text) <= MAX_TEXT:
        return [Verbatim(text, role)] if text.strip() else []
    head = text[: MAX_TEXT * 3 // 4].rpartition("\n")[0] or text[: MAX_TEXT * 3 // 4]
    tail = text[-MAX_TEXT // 4 :].partition("\n")[2] or text[-MAX_TEXT // 4 :]
    left = text[len(head) : len(text) - len(tail)]
    size = f"{len(left.split()):,} words in {left.count(chr(10)):,} lines"
    told = f"{size} are left out here, of an output of {len(text):,} characters"
    return [Verbatim(head, role), Mend("text", told), Verbatim(tail.strip("\n"), role)]


def _refuse_long(text: str, limit: int) -> None:
    if len(text) > limit:
        size = f"{len(text) / 1e6:.1f} million characters"
        raise CannotShow(
            f"an output of {size}, more than a report can show ({limit / 1e6:.1f}): show a part of it",
            reason=f"it has {size}, more than a page can show",
        )


def _joined(text: Any) -> str:
    return "".join(text) if isinstance(text, list) else str(text)


_FORMS: dict[str, Callable[[Bundle, Bundle, Reading], list[Block]]] = {
    TABLE_MIME: _table,
    FIGURE_MIME: _figure,
    EQUATION_MIME: _equation,
    "text/latex": _latex,
    **dict.fromkeys(pictures.KINDS, _picture),
    "application/javascript": _script,
    "text/html": _html,
    "text/markdown": _markdown,
    "application/json": _json,
    "text/plain": _plain,
}
