"""Scripts of a page: none but those that an installed package offers, each named by its hash in the page's policy.

A notebook's output carries data under a MIME type. Which script shows it, says a package's entry point::

    [project.entry-points."notebook_reports.scripts"]
    "application/vnd.example.dial+json" = "example.dial:shown"

``shown(data)`` returns (script, markup): the text of the script and what stands in the page before it runs, both the
package's own. The data itself is put beside the markup as text of the type ``application/json``, in an element with the
class ``data``; markup and data are the children of one ``<div class="live" data-mime="...">``. From a notebook comes no
script, ever; and an entry point counts only where its package is installed, not where a folder claims to be one.
"""

import base64
import json
import sysconfig
from collections.abc import Callable, Iterable
from functools import cache
from hashlib import sha256
from importlib.metadata import EntryPoint, distributions
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from notebook_reports.export.errors import CannotShow

GROUP = "notebook_reports.scripts"
Shown = Callable[[Any], tuple[str, str]]


def installed_places() -> list[str]:
    """Where the packages of this interpreter are installed."""
    return list(dict.fromkeys(sysconfig.get_path(name) for name in ("purelib", "platlib")))


@cache
def offered() -> dict[str, EntryPoint]:
    """The entry points by MIME type. Raises CannotShow where two packages offer one for the same."""
    found: dict[str, EntryPoint] = {}
    for distribution in distributions(path=installed_places()):
        for point in distribution.entry_points:
            if point.group != GROUP:
                continue
            if point.name in found and found[point.name].value != point.value:
                both = f"{found[point.name].value} and {point.value}"
                raise CannotShow(f"{point.name}: both {both} offer a script for it; remove one of the packages")
            found[point.name] = point
    return found


def shown(mime: str, data: Any) -> tuple[str, str]:
    """(script, markup) for data under a MIME type that is offered. Raises CannotShow where the package fails."""
    point = offered()[mime]
    try:
        script, markup = point.load()(data)
    except Exception as error:
        raise CannotShow(f"{mime}: {point.value} does not show it ({type(error).__name__}: {error})") from None
    if "</script" in script.lower() or "<!--" in script:
        raise CannotShow(f"{mime}: the script of {point.value} would end before its end; write <\\/script in it")
    return script.replace("\r\n", "\n"), markup  # as a browser reads it, and the hash


def print_of(mimes: Iterable[str]) -> str:
    """The hash of the code that shows these types: of the files of the packages that hold it, none imported."""
    told = []
    for mime in sorted(set(mimes) & set(offered())):
        spec = find_spec(offered()[mime].module)
        files = [Path(spec.origin)] if spec and spec.origin else []
        if spec and (spec.parent or spec.submodule_search_locations):
            files = sorted(p for p in files[0].parent.rglob("*") if p.is_file() and p.suffix != ".pyc")
        told.append([mime, offered()[mime].value, [sha256(p.read_bytes()).hexdigest() for p in files]])
    return sha256(json.dumps(told).encode()).hexdigest()[:16] if told else ""


def as_text(data: Any) -> str:
    """Data as JSON that ends no element of a page."""
    text = json.dumps(data, ensure_ascii=False, sort_keys=True)
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def policy(scripts: Iterable[str] = ()) -> str:
    """A page's Content-Security-Policy: no script but these, by hash; nothing fetched; all that is shown is inside.

    >>> policy()[:38]
    "default-src 'none'; script-src 'none';"
    """
    hashes = [f"'sha256-{base64.b64encode(sha256(s.encode()).digest()).decode()}'" for s in scripts]
    allowed = " ".join(hashes) or "'none'"
    return (
        f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:; "
        "font-src data:; base-uri 'none'; form-action 'none'"
    )
