"""Every published rule by its name: a module of this folder that has a function `rules` adds its own."""

import difflib
import pkgutil
from functools import cache
from importlib import import_module

from derivations.tuning.rule import Rule

FOLDER = "derivations.tuning"


@cache
def catalogue() -> dict[str, Rule]:
    """All rules by name, module by module. Raises ValueError where two have one name."""
    found: dict[str, Rule] = {}
    for module in sorted(m.name for m in pkgutil.iter_modules(import_module(FOLDER).__path__)):
        published = getattr(import_module(f"{FOLDER}.{module}"), "rules", None)
        for rule in published() if published else ():
            if rule.name in found:
                raise ValueError(f"two rules of the name {rule.name!r}; the second is in {module}.py")
            found[rule.name] = rule
    return found


def rule(name: str) -> Rule:
    """A rule by its name. Raises KeyError with the nearest names.

    >>> rule("zn-step-pid").K
    6*T/(5*T_0*k)
    """
    known = catalogue()
    if name not in known:
        near = difflib.get_close_matches(name, known, n=4, cutoff=0.3)
        raise KeyError(f"no tuning rule {name!r}; did you mean {', '.join(near or sorted(known))}?")
    return known[name]
