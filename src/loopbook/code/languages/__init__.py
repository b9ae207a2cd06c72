"""The languages that a program is printed in: one module each, found by being here."""

from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from loopbook.code.language import Language


@cache
def languages() -> dict[str, Language]:
    """Every language by its short name, in alphabetical order of the modules.

    >>> list(languages())
    ['c', 'js', 'py', 'st']
    """
    modules = (import_module(f"{__name__}.{m.name}") for m in iter_modules(__path__))
    return {module.LANGUAGE.name: module.LANGUAGE for module in modules}
