"""Reading TOML: whatever is wrong with a file is one line that names the file and the place in it."""

import re
import tomllib
from pathlib import Path
from typing import Any

from notebook_reports.errors import PressError

_LONG_INTEGER = re.compile(r"\d{4301,}")


class TomlError(PressError, ValueError):
    """A TOML file cannot be read, or does not hold what is expected; the message begins with its name."""


def read_toml(path: Path, name: str = "") -> dict[str, Any]:
    """The content of a file. name: what messages call it, default its own name.

    Raises FileNotFoundError where there is none, TomlError for everything else.
    """
    name = name or path.name
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise
    except OSError as error:
        raise TomlError(f"{name}: cannot be read ({error.strerror or error})") from None
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise TomlError(f"{name}, line {line}: not UTF-8 (byte 0x{raw[error.start]:02x}); save it as UTF-8") from None
    try:
        return tomllib.loads(text.replace("\r\n", "\n"))
    except tomllib.TOMLDecodeError as error:
        raise TomlError(f"{name}: {error}") from None
    except (ValueError, RecursionError, OverflowError) as error:
        raise TomlError(f"{name}{_place(text)}: {_reason(error)}") from None


def _reason(error: Exception) -> str:
    return "nested too deeply" if isinstance(error, RecursionError) else "a number too long to be read"


def _place(text: str) -> str:
    """The line, and its key, that is too much: with the longest number, else with the most brackets."""
    lines = text.splitlines()
    long = [i for i, line in enumerate(lines) if _LONG_INTEGER.search(line.replace("_", ""))]
    at = long[0] if long else max(range(len(lines)), key=lambda i: lines[i].count("[") + lines[i].count("{"))
    key = lines[at].partition("=")[0].strip()
    return f", line {at + 1}" + (f", {key}" if "=" in lines[at] and len(key) <= 60 else "")


def table(content: dict[str, Any], key: str, name: str) -> dict[str, Any]:
    """The table under a key, {} where there is none. Raises TomlError where something else stands there."""
    found = content.get(key, {})
    if not isinstance(found, dict):
        raise TomlError(f"{name}: {key} = {_shown(found)}: a table [{key}] is expected")
    return found


def tables(content: dict[str, Any], key: str, name: str) -> list[dict[str, Any]]:
    """The tables under a key, none where there are none. Raises TomlError where something else stands there."""
    found = content.get(key, [])
    if not isinstance(found, list) or not all(isinstance(entry, dict) for entry in found):
        raise TomlError(f"{name}: {key} = {_shown(found)}: tables [[{key}]] are expected")
    return found


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:39] + "…"
