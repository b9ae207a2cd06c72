"""The outputs of a code cell into a report's blocks, the richest form that a page can show first."""

import json
from collections.abc import Callable
from typing import Any

from notebook_reports.display import EQUATION_MIME, FIGURE_MIME, TABLE_MIME
from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Block, Display, Figure, Listing
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


def read_outputs(outputs: list[Any], reading: Reading) -> list[Block]:
    """The blocks of all outputs; what cannot be shown is noted in `reading.problems`."""
    blocks: list[Block] = []
    for output in _merged(outputs):
        with reading.guard():
            blocks.extend(read_output(output, reading))
    return blocks


def read_output(output: Any, reading: Reading) -> list[Block]:
    """The blocks of one output. Raises CannotShow where none of its forms can be shown."""
    match output["output_type"]:
        case "stream":
            return _listing(output["text"], "stderr" if output["name"] == "stderr" else "output")
        case "error":
            text = "\n".join(output.get("traceback") or [f"{output['ename']}: {output['evalue']}"])
            return _listing(text, "error")
        case "display_data" | "execute_result" | "update_display_data":
            return _bundle(output["data"], output.get("metadata") or {}, reading)
    raise CannotShow(f"an output of the kind {output['output_type']}")


def _merged(outputs: list[Any]) -> list[Any]:
    """Neighbouring pieces of one stream are one."""
    merged: list[Any] = []
    for output in outputs:
        last = merged[-1] if merged else None
        same = last and output["output_type"] == "stream" == last["output_type"] and output["name"] == last["name"]
        if same:
            merged[-1] = {**last, "text": _joined(last["text"]) + _joined(output["text"])}
        else:
            merged.append(output)
    return merged


def _bundle(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    for mime, read in _FORMS.items():
        if mime in data:
            return read(data, metadata, reading)
    shown = [mime for mime in data if not mime.startswith("application/vnd.loopbook.")]
    if shown or not data:
        forms = ", ".join(sorted(shown)) or "nothing"
        raise CannotShow(f"an output that exists only as {forms}; display a table, a figure or text instead")
    return []


def _table(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    return [from_data(data[TABLE_MIME])]


def _figure(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    told = data[FIGURE_MIME]
    picture = _first_picture(data, metadata, reading.alt(told.get("alt"), "the figure"))
    if picture is None:
        raise CannotShow("a figure without its drawing; run the cell again")
    return [Figure(picture, read_inline(told["caption"]))]


def _equation(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    told = data[EQUATION_MIME]
    return [Display(told["latex"], told["label"], told["anchor"])]


def _latex(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    text = _joined(data["text/latex"]).strip()
    alone = text.startswith("$") and text.endswith("$") and "$" not in text.strip("$")
    if alone or (text.startswith(r"\begin") and "$" not in text):
        return [reading.display(text.strip("$").strip())]
    return flow(with_math(text, reading))


def _picture(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    told = next((m["alt"] for m in (metadata, *metadata.values()) if isinstance(m, dict) and m.get("alt")), "")
    picture = _first_picture(data, metadata, reading.alt(told, "a picture"))
    return [Figure(picture)]


def _first_picture(data: Bundle, metadata: Bundle, alt: str) -> Any:
    for mime in pictures.KINDS:
        if mime in data:
            own = metadata.get(mime)
            width = own.get("width") if isinstance(own, dict) else None
            return pictures.from_bundle(mime, data[mime], alt, width)
    return None


def _html(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    text = _joined(data["text/html"])
    _refuse_long(text, 20 * MAX_TEXT)
    return read_html(text, reading)


def _script(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    raise CannotShow("an output that is a script, which a page cannot run; display a table, a figure or text instead")


def _markdown(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    return read_markdown(_joined(data["text/markdown"]), reading)


def _plain(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    return _listing(data["text/plain"], "output")


def _json(data: Bundle, metadata: Bundle, reading: Reading) -> list[Block]:
    text = json.dumps(data["application/json"], indent=2, ensure_ascii=False)
    return _listing(text, "output")


def _listing(text: Any, role: str) -> list[Block]:
    text = _joined(text)
    _refuse_long(text, MAX_TEXT)
    text = settle(text).strip("\n")
    return [Listing(text, role)] if text.strip() else []


def _refuse_long(text: str, limit: int) -> None:
    if len(text) > limit:
        size = f"{len(text) / 1e6:.1f} million characters"
        raise CannotShow(f"an output of {size}, more than a report can show ({limit / 1e6:.1f}): show a part of it")


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
