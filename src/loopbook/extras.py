"""Packages that only some functions need: imported when they are, or named with the extra that brings them."""

from importlib import import_module
from typing import Any


def needed(package: str, extra: str) -> Any:
    """The package. Raises ModuleNotFoundError that says what to install.

    >>> needed("math", "reports").gcd(4, 6)
    2
    """
    try:
        return import_module(package)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        text = f"this needs the package {package}: pip install 'loopbook[{extra}]'"
        raise ModuleNotFoundError(text, name=package) from None
