"""Spreadsheets (.xlsx) and Parquet files as the cells of a table, through pandas' readers."""

from datetime import date, datetime, time
from pathlib import Path
from typing import Any, Literal

from loopbook.records.cells import Cells, table
from loopbook.records.record import RecordError
from loopbook.records.units import TIME_UNITS

SPREADSHEETS = {".xlsx", ".xlsm", ".xls", ".ods"}
ENGINES: tuple[Literal["calamine", "openpyxl"], ...] = ("calamine", "openpyxl")
PARQUET = {".parquet", ".pq"}


def is_sheet(path: Path) -> bool:
    """Is the file one that pandas has to read? By its ending, or by its first bytes where the ending is another."""
    if path.suffix.lower() in SPREADSHEETS | PARQUET:
        return True
    try:
        with path.open("rb") as file:
            return file.read(4) in (b"PK\x03\x04", b"PAR1")
    except OSError:
        return False


def sheet_cells(path: Path) -> Cells:
    """The table of the file: of a spreadsheet the sheet with the most rows. Raises RecordError with what is missing."""
    if not path.is_file():
        raise RecordError(f"there is no file {path}")
    frames = _parquet(path) if _is_parquet(path) else _spreadsheet(path)
    name, rows = max(frames.items(), key=lambda pair: len(pair[1]))
    rows = [row for row in rows if any(row)]
    if len(rows) < 2:
        raise RecordError(f"{path.name} holds no table")
    cells = table(rows, "cells", set(TIME_UNITS))
    if len(frames) > 1:
        cells.notes.append(f"The sheet '{name}' was read, of {len(frames)} the one with the most rows.")
    return Cells(cells.heads, cells.rows, cells.delimiter, ".", cells.notes)


def _is_parquet(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(4) == b"PAR1"


def _spreadsheet(path: Path) -> dict[str, list[list[str]]]:
    import pandas as pd

    for engine in ENGINES:
        try:
            frames = pd.read_excel(path, sheet_name=None, header=None, dtype=object, engine=engine)
            break
        except ImportError:
            continue
        except Exception as error:
            raise RecordError(f"{path.name} cannot be read as a spreadsheet: {error}") from None
    else:
        raise RecordError(
            f"{path.name}: reading spreadsheets needs a reader (pip install python-calamine, or loopbook[records]); "
            "or save the sheet as CSV"
        )
    return {name: [[_text(v) for v in row] for row in f.to_numpy(object)] for name, f in frames.items()}


def _parquet(path: Path) -> dict[str, list[list[str]]]:
    import pandas as pd

    try:
        frame = pd.read_parquet(path)
    except ImportError:
        raise RecordError(
            f"{path.name}: reading Parquet needs pyarrow (pip install pyarrow, or loopbook[records]); "
            "or save the record as CSV"
        ) from None
    except Exception as error:
        raise RecordError(f"{path.name} cannot be read as Parquet: {error}") from None
    if frame.index.name or not isinstance(frame.index, pd.RangeIndex):
        frame = frame.reset_index()
    body = [[_text(v) for v in row] for row in frame.astype(object).to_numpy(object)]
    return {path.stem: [[str(c) for c in frame.columns], *body]}


def _text(value: Any) -> str:
    """A cell as a CSV file would have it; numbers keep all their digits."""
    if value is None or value != value:
        return ""
    if isinstance(value, datetime | date):
        return value.isoformat(sep=" ") if isinstance(value, datetime) else value.isoformat()
    if isinstance(value, time):
        return value.isoformat()
    if isinstance(value, bool):
        return "on" if value else "off"
    return repr(float(value)) if isinstance(value, float) else str(value)
