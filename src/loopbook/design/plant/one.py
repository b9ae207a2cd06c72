"""One record of many: its design as plain data and as files, or why there is none."""

import json
import tempfile
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.code.files import PROGRAMS
from loopbook.design.notebook import design_notebook
from loopbook.design.plant.attention import LoopRow, row_of
from loopbook.design.plant.printing import report_files
from loopbook.design.study import Study

DETAIL = "detail"


@dataclass(frozen=True)
class DesignJob:
    """file: its name; content: its bytes. label: what reports call it. stems: of the files, by format. values: the
    notebook's parameters, typed, in order. page: the first page only. code: show code."""

    label: str
    file: str
    content: bytes
    stems: tuple[tuple[str, str], ...]
    values: tuple[tuple[str, Any], ...] = ()
    page: bool = False
    code: bool = False


@dataclass(frozen=True)
class Designed:
    """What came of it. files: contents by format, none where the record is refused."""

    row: LoopRow
    files: dict[str, bytes] = field(default_factory=dict)


def design_one(job: DesignJob) -> Designed:
    """Design for one record. A record that no regulator can be made of is a result; what else goes wrong is raised."""
    with tempfile.TemporaryDirectory(prefix="loopbook-") as name:
        folder = Path(name)
        data = folder / job.file
        data.write_bytes(job.content)
        values = dict(job.values)
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore", category=RuntimeWarning):
                study = Study(data, **values)
                found = study.results()
        except LoopbookError as error:
            return Designed(LoopRow(job.label, refused=_without(folder, str(error))))
        files = _files(job, folder, json.loads(json.dumps(found, sort_keys=True)))
        return Designed(row_of(job.label, found, study.recommendation.compromise, study.cautions), files)


def _without(folder: Path, text: str) -> str:
    """A sentence without the folder that only this run has."""
    return text.replace(f"{folder}/", "").replace(str(folder), "")


def _files(job: DesignJob, folder: Path, found: dict[str, Any]) -> dict[str, bytes]:
    files, pages = {}, []
    for format, stem in job.stems:
        if format == "json":
            files[format] = (json.dumps(found, indent=2, ensure_ascii=False) + "\n").encode()
        elif format in PROGRAMS:
            files[format] = PROGRAMS[format](found, stem)
        else:
            pages.append(format)
    if pages:
        left_out = frozenset({DETAIL} if job.page else ())
        given = {**dict(job.values), "data": job.file}
        files |= report_files(design_notebook(), folder, job.label, given, pages, left_out, job.code)
    return files
