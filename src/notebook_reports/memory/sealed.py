"""Small files of data in the cache, each with the hash of its content: what was changed is not believed.

The seal is against damage and accidents. It is no signature: who may write the project's cache may also write its
notebooks.
"""

import json
from hashlib import sha256
from pathlib import Path
from typing import Any

from notebook_reports.errors import PressError
from notebook_reports.project import atomic

SEAL = "seal"


class Damaged(PressError):
    """A file of the cache is not as it was written."""


def write(path: Path, data: dict[str, Any], of: str = "") -> None:
    """Write data with its seal, in one step. of: what the data is of; another's data is not taken for it."""
    atomic.clear(path)
    atomic.write(path, json.dumps({**data, SEAL: _seal(data, of)}, ensure_ascii=False, indent=1).encode())


def read(path: Path, of: str = "") -> dict[str, Any] | None:
    """The data; None where there is no file. Raises Damaged for anything that was not written here, of the same."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise Damaged(f"cannot be read ({error.strerror or error})") from None
    try:
        data = json.loads(content)
    except (ValueError, RecursionError):
        raise Damaged("is empty" if not content else "is damaged") from None
    if not isinstance(data, dict) or data.pop(SEAL, None) != _seal(data, of):
        raise Damaged("was changed")
    return data


def _seal(data: dict[str, Any], of: str) -> str:
    return sha256(json.dumps([of, data], sort_keys=True).encode()).hexdigest()
