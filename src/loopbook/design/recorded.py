"""A study's record with its models, together with further records of the same process where there are some."""

from pathlib import Path
from typing import Any

from loopbook.design.model_file import read_fixed
from loopbook.identification.choice import Identified, identify
from loopbook.identification.pooled import identify_together
from loopbook.records.reading import read_record
from loopbook.records.record import Record


def identified(study: Any) -> Identified | None:
    """None where a model was given."""
    if study.record is None:
        return None
    fixed = read_fixed(study.known)
    return identify_together([study.record, *further(study)], fixed) if study.more else identify(study.record, fixed)


def further(study: Any) -> list[Record]:
    """The further records, beside the first."""
    paths = [Path(study.data).parent / name.strip() for name in study.more.split(";") if name.strip()]
    return [read_record(path, study.time, study.input, study.output, study.interval) for path in paths]
