"""Names that are imported when they are first asked for (PEP 562): a package's face decides them in one table."""

import difflib
from collections.abc import Callable, Mapping
from importlib import import_module
from types import ModuleType
from typing import Any


def attach(package: str, table: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """``__getattr__``, ``__dir__`` and ``__all__`` of a package.

    table: name -> "module:attribute", or "module" for a module itself. An unknown name raises AttributeError with the
    nearest ones.

    >>> ask, _, names = attach("example", {"gcd": "math:gcd"})
    >>> ask("gcd")(12, 18), names
    (6, ['gcd'])
    """

    def ask(name: str) -> Any:
        if name not in table:
            near = difflib.get_close_matches(name, table, n=3)
            hint = f"; did you mean {' or '.join(near)}?" if near and not name.startswith("_") else ""
            raise AttributeError(f"module {package!r} has no attribute {name!r}{hint}", name=name, obj=None)
        module, _, attribute = table[name].partition(":")
        found = import_module(module)
        return getattr(found, attribute) if attribute else found

    return ask, lambda: sorted(table), sorted(table)


class _Late(ModuleType):
    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(import_module(self.__name__), name)


def late(module: str) -> Any:
    """A module that is imported when something of it is first asked for, such as one that loads SymPy.

    >>> late("math").gcd(12, 18)
    6
    """
    return _Late(module)
