"""What results depend on beside their job: the sources that make them, Python, the packages."""

import hashlib
import importlib.metadata
import platform
from collections.abc import Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path

VERSIONS = ("numpy", "scipy", "sympy", "matplotlib", "nbformat", "nbconvert", "typst", "fonttools")


@cache
def fingerprint(packages: Sequence[str]) -> dict[str, str]:
    """packages: a tuple of those whose sources count, as they are imported. Raises ModuleNotFoundError."""
    digest = hashlib.sha256()
    for package in packages:
        found = find_spec(package)
        if found is None or not found.submodule_search_locations:
            raise ModuleNotFoundError(f"there is no package {package}", name=package)
        source = Path(found.submodule_search_locations[0])
        for path in sorted(p for p in source.rglob("*") if p.is_file() and p.suffix != ".pyc"):
            name = f"{package}/{path.relative_to(source).as_posix()}"
            digest.update(name.encode() + b"\0" + path.read_bytes())
    versions = {name: importlib.metadata.version(name) for name in VERSIONS}
    return {f"sources of {packages[-1]}": digest.hexdigest()[:12], "Python": platform.python_version(), **versions}
