"""All tuning rules by name, in the order in which tables show them.

A rule with formulas is a file in `derivations/tuning` with a function `rules`; one that is computed is a file in this
folder with a function `computed`. Both are found by being there.
"""

import difflib
import pkgutil
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module

from derivations.tuning.takes import Takes
from loopbook.refusal import Refusal
from loopbook.tuning.formulas import published
from loopbook.tuning.rule import TuningRule

FOLDER = "loopbook.tuning"
RANK = {Takes.FREQUENCY_AND_GAIN: 1, Takes.TWO_LAGS: 1, Takes.PULSE: 1, Takes.FREQUENCY: 2, Takes.PROCESS: 3}
"""By what must be known of the process; 0: what one step response tells."""


class UnknownRule(Refusal):
    """No tuning rule has this name; the message has the nearest ones."""


@cache
def rules() -> dict[str, TuningRule]:
    """Every rule by name: by what it must know of the process, then by year.

    >>> list(rules())[:3]
    ['zn-step-p', 'zn-step-pi', 'zn-step-pid']
    """
    found = published()
    for module in sorted(m.name for m in pkgutil.iter_modules(import_module(FOLDER).__path__)):
        computed = getattr(import_module(f"{FOLDER}.{module}"), "computed", None)
        found += computed() if computed else ()
    found.sort(key=lambda rule: (RANK.get(rule.takes, 0), rule.year or 9999))
    return {rule.name: replace(rule, instead=fitting) for rule in found}


def fitting(integrates: bool | None, action: str) -> list[str]:
    """The names of the rules that are meant for such a process.

    >>> fitting(True, "PI")[0]
    'simc-pi-integrating'
    """
    return [rule.name for rule in rules().values() if rule.fits(integrates) and rule.action == action]


class _Rules(Mapping[str, TuningRule]):
    """Every tuning rule by its name, looked up when it is first needed; `lb.tune` takes these names."""

    def __getitem__(self, name: str) -> TuningRule:
        if name not in rules():
            raise UnknownRule(_unknown(name, "", []))
        return rules()[name]

    def __contains__(self, name: object) -> bool:
        return name in rules()

    def __iter__(self) -> Iterator[str]:
        return iter(rules())

    def __len__(self) -> int:
        return len(rules())


RULES = _Rules()
"""Every tuning rule by name; an unknown name raises UnknownRule with the nearest ones."""


def named(name: str, action: str = "") -> list[TuningRule]:
    """The rules meant by a name, a part of one or a title: "simc-pi", "simc", "Ziegler-Nichols ultimate".

    action: "P", "PI", "PID", or "" for any. Variants only where their own name is given. Raises UnknownRule.

    >>> [rule.name for rule in named("ziegler nichols ultimate", "PID")]
    ['zn-ultimate-pid']
    """
    known = rules()
    if name in known and action.upper() in ("", known[name].action):
        return [known[name]]
    wanted = set(_words(name))
    found = [rule for rule in known.values() if wanted <= {*_words(rule.name), *_words(rule.title)}]
    meant = [rule for rule in found if action.upper() in ("", rule.action) and not rule.variant_of]
    if not wanted or not meant:
        raise UnknownRule(_unknown(name, action, found))
    return meant


def _words(text: str) -> list[str]:
    return re.findall(r"[a-z0-9]+", text.lower())


def _unknown(name: str, action: str, found: list[TuningRule]) -> str:
    if found:
        return f"{name!r} has no {action}; it has {', '.join(rule.name for rule in found)}"
    known = {"-".join(_words(key)): rule.name for rule in rules().values() for key in (rule.name, rule.title)}
    families = {rule.name.split("-")[0] for rule in rules().values()}
    asked = "-".join(_words(name))
    near = difflib.get_close_matches(asked, [*known, *families], n=4, cutoff=0.5)
    near = list(dict.fromkeys(known.get(key, key) for key in near))
    hint = f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(rules())}"
    return f"no tuning rule {name!r}; {hint}"
