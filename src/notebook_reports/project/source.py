"""A notebook file as it stands in git: cells, title, sections. Reads the JSON itself, so that looking is cheap."""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

from notebook_reports.project.project import UsageError

INJECTED = "injected-parameters"
DEEPEST = 100


@dataclass(frozen=True)
class SourceCell:
    """One cell. number: its position from 1, as the failure list counts. section: the nearest heading above it."""

    number: int
    id: str
    kind: str
    text: str
    tags: tuple[str, ...]
    section: str

    @property
    def runs(self) -> bool:
        return self.kind == "code" and bool(self.text.strip())


@dataclass(frozen=True)
class Source:
    """A notebook as written."""

    path: Path
    cells: tuple[SourceCell, ...]
    content: dict[str, Any]

    @cached_property
    def title(self) -> str:
        """The first heading of level one, or the file's name."""
        for cell in self.cells:
            if cell.kind == "markdown" and (found := re.search(r"^# +(.+?)\s*#*\s*$", cell.text, re.MULTILINE)):
                return found[1]
        return self.path.stem.replace("_", " ")

    def hash_code(self) -> str:
        """Changes with what runs: the text and the tags of the code cells. Prose does not count."""
        return _sha([[c.text, c.tags] for c in self.cells if c.kind == "code"])

    def hash_all(self) -> str:
        """Changes with anything a reader sees."""
        metadata = [c.get("metadata", {}) for c in self.content["cells"]]
        attachments = [c.get("attachments", {}) for c in self.content["cells"]]
        return _sha([[[c.id, c.kind, c.text] for c in self.cells], metadata, attachments, self.content.get("metadata")])

    def tagged(self, tag: str) -> list[SourceCell]:
        return [c for c in self.cells if tag in c.tags]


def _sha(value: Any) -> str:
    return sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]


def _join(text: Any) -> str:
    return text if isinstance(text, str) else "".join(text)


def read_source(path: Path) -> Source:
    """Read a notebook. Raises UsageError where the file is not a notebook of format 4 or speaks another language."""
    content = _notebook(path)
    kernel = content["metadata"].get("kernelspec")
    told = content["metadata"].get("language_info")
    languages = [d.get(k) for d, k in ((kernel, "language"), (told, "name")) if isinstance(d, dict)]
    language = next((name for name in languages if isinstance(name, str) and name), "python")
    if language.lower() not in ("python", "ipython"):
        raise UsageError(f"{path}: a notebook in {language}; only Python notebooks are run")
    found, section = [], ""
    for number, cell in enumerate(content["cells"], 1):
        text = _join(cell["source"])
        headings = re.findall(r"^#{1,3} +(.+?)\s*#*\s*$", text, re.MULTILINE) if cell["cell_type"] == "markdown" else []
        section = headings[-1] if headings else section
        tags = tuple(cell["metadata"].get("tags", ()))
        found.append(SourceCell(number, cell.get("id", f"cell-{number}"), cell["cell_type"], text, tags, section))
    return Source(path, tuple(found), content)


def _notebook(path: Path) -> dict[str, Any]:
    """The content of a notebook file, of which every part is what it should be. Raises UsageError."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        version = content["nbformat"]
    except RecursionError:
        raise UsageError(f"{path}: nested too deeply for a notebook") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{path}: cannot be read as a notebook ({type(error).__name__}: {error})") from None
    if version != 4:
        raise UsageError(f"{path}: notebook format {version}; open and save it once in JupyterLab to get format 4")
    if _depth(content) > DEEPEST:
        raise UsageError(f"{path}: nested deeper than {DEEPEST} levels, which no notebook is")
    wrong = next(_wrong(content), None)
    if wrong:
        raise UsageError(f"{path}: {wrong}; open and save it once in JupyterLab")
    return content


def _wrong(content: dict[str, Any]) -> Iterator[str]:
    """What of a notebook is not of the kind that it has to be; what is only missing is added."""
    if not isinstance(content.setdefault("metadata", {}), dict):
        yield "`metadata` is no table of names"
    if not isinstance(content.get("cells"), list):
        yield "`cells` is no list"
        return
    for number, cell in enumerate(content["cells"], 1):
        if not isinstance(cell, dict):
            yield f"cell {number} is no cell"
            return
        where = f"cell {number}: "
        if cell.get("cell_type") not in ("code", "markdown", "raw"):
            yield f"{where}`cell_type` is {cell.get('cell_type')!r}"
        if "source" not in cell:
            yield f"{where}`source` is missing"
        yield from _wrong_parts(cell, where)


def _wrong_parts(cell: dict[str, Any], where: str) -> Iterator[str]:
    source = cell.get("source")
    lines = source if isinstance(source, list) else [source]
    if not all(isinstance(line, str) for line in lines):
        yield f"{where}`source` is no text"
    elif not all(_is_unicode(str(line)) for line in lines):
        yield f"{where}`source` holds half a character"
    if not isinstance(cell.setdefault("metadata", {}), dict):
        yield f"{where}`metadata` is no table of names"
    tags = cell["metadata"].get("tags", []) if isinstance(cell["metadata"], dict) else []
    if not isinstance(tags, list) or not all(isinstance(tag, str) for tag in tags):
        yield f"{where}`tags` is no list of words"
    if not isinstance(cell.get("id", ""), str):
        yield f"{where}`id` is no text"
    if not isinstance(cell.get("attachments", {}), dict):
        yield f"{where}`attachments` is no table of names"
    if cell.get("cell_type") == "code":
        cell.setdefault("execution_count", None)
        outputs = cell.setdefault("outputs", [])
        if not isinstance(outputs, list) or not all(isinstance(output, dict) for output in outputs):
            yield f"{where}`outputs` is no list of outputs"


def _is_unicode(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _depth(value: Any) -> int:
    """How many levels plain data has, counted to one more than `DEEPEST`."""
    level, depth = [value], 0
    while level and depth <= DEEPEST:
        depth += 1
        inner = [v.values() if isinstance(v, dict) else v for v in level if isinstance(v, dict | list)]
        level = [v for values in inner for v in values if isinstance(v, dict | list)]
    return depth
