"""Hashes of files, folders and plain data: what is remembered is compared by them, before it is used."""

import json
import os
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any


def of_bytes(content: bytes) -> str:
    """The hash by which everything here is compared: the first 64 bits of SHA-256, in hexadecimal."""
    return sha256(content).hexdigest()[:16]


def digest(value: Any) -> str:
    """The hash of plain data."""
    return of_bytes(json.dumps(value, sort_keys=True).encode())


@cache
def _hash_file(path: str, *_changed: int) -> str:
    return of_bytes(Path(path).read_bytes())


def hash_file(path: Path) -> str:
    """The hash of a file's content, "" where there is none. Within a process a file whose times did not change is
    read once: for what notebooks depend on. What was built is read again each time, see `hash_now`."""
    try:
        found = path.stat()
        return _hash_file(str(path), found.st_mtime_ns, found.st_ctime_ns, found.st_size)
    except (OSError, ValueError):
        return ""


def hash_now(path: Path) -> str:
    """The hash of what the file holds at this moment, "" where there is none."""
    try:
        return of_bytes(path.read_bytes())
    except OSError:
        return ""


def hash_folder(path: Path) -> str:
    """The hash of the names in a folder, "" where there is none."""
    try:
        names = sorted(n for n in os.listdir(path) if not n.startswith((".", "__pycache__")))
    except OSError:
        return ""
    return of_bytes("\n".join(names).encode("utf-8", "surrogateescape"))
