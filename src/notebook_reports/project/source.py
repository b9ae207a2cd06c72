"""A notebook file as it stands in git: cells, title, sections. Reads the JSON itself, so that looking is cheap."""

import json
import re
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Any

from notebook_reports.project.project import UsageError

INJECTED = "injected-parameters"


@dataclass(frozen=True)
class Cell:
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
    cells: tuple[Cell, ...]
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

    def tagged(self, tag: str) -> list[Cell]:
        return [c for c in self.cells if tag in c.tags]


def _sha(value: Any) -> str:
    return sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]


def _join(text: Any) -> str:
    return text if isinstance(text, str) else "".join(text)


def read_source(path: Path) -> Source:
    """Read a notebook. Raises UsageError where the file is not a notebook of format 4 or speaks another language."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        version, cells = content["nbformat"], content["cells"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{path}: cannot be read as a notebook ({type(error).__name__}: {error})") from None
    if version != 4:
        raise UsageError(f"{path}: notebook format {version}; open and save it once in JupyterLab to get format 4")
    kernel = content.get("metadata", {}).get("kernelspec", {})
    language = kernel.get("language") or content.get("metadata", {}).get("language_info", {}).get("name") or "python"
    if language.lower() not in ("python", "ipython"):
        raise UsageError(f"{path}: a notebook in {language}; only Python notebooks are run")
    found, section = [], ""
    for number, cell in enumerate(cells, 1):
        text = _join(cell["source"])
        headings = re.findall(r"^#{1,3} +(.+?)\s*#*\s*$", text, re.MULTILINE) if cell["cell_type"] == "markdown" else []
        section = headings[-1] if headings else section
        tags = tuple(cell.get("metadata", {}).get("tags", ()))
        found.append(Cell(number, cell.get("id", f"cell-{number}"), cell["cell_type"], text, tags, section))
    return Source(path, tuple(found), content)
