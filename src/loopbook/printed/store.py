"""Results of derivations as plain data, kept beside the code: read where the sources are unchanged, else derived.

A function decorated with `kept_for` returns plain data (texts, numbers, lists, tables) that follow from the derivations
and its arguments alone. Asked with arguments that are kept, it answers from ``forms.json``; with others, or where one
byte of the derivations or of a decorated module has changed, it derives. So a kept text is never trusted to be current.
"""

import json
import math
import re
from collections.abc import Callable, Iterable
from functools import cache, reduce, wraps
from hashlib import sha256
from importlib import import_module
from inspect import getsource
from pathlib import Path
from typing import Any

import numpy as np

import derivations

FILE = Path(__file__).with_name("forms.json")
DERIVATIONS = Path(derivations.__file__).parent
USERS = (
    "loopbook.controllers.generated",
    "loopbook.design.start_state",
    "loopbook.experiments.combination",
    "loopbook.identification.models",
    "loopbook.loop.joint_robustness",
    "loopbook.tuning.by_damping",
    "loopbook.tuning.by_margin",
    "loopbook.tuning.formulas",
    "loopbook.tuning.migo_branch",
    "loopbook.vendors.blocks",
)
"""The modules with printed functions."""

_printed: dict[str, tuple[Callable[..., Any], tuple[tuple[Any, ...], ...]]] = {}


def kept_for(*each: tuple[Any, ...]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Keep what the decorated function gives for each of these tuples of arguments; () alone where it takes none."""

    def decorate(make: Callable[..., Any]) -> Callable[..., Any]:
        name = f"{make.__module__}:{make.__qualname__}"
        _printed[name] = (make, each or ((),))

        @cache
        @wraps(make)
        def asked(*args: Any) -> Any:
            found = kept().get(_key(name, args))
            return make(*args) if found is None else found

        return asked

    return decorate


def _key(name: str, args: Iterable[Any]) -> str:
    return name + json.dumps(list(args))


@cache
def kept() -> dict[str, Any]:
    """The kept forms by name and arguments; none where they are older than their sources."""
    try:
        found = json.loads(FILE.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found["forms"] if found.get("sources") == sources() else {}


def sources() -> str:
    """One hash of everything that the forms follow from: the derivations and the modules that print them."""
    files = sorted(DERIVATIONS.rglob("*.py"))
    files += [FILE.parents[2].joinpath(*name.split(".")).with_suffix(".py") for name in USERS]
    total = sha256()
    for file in files:
        total.update(file.name.encode() + b"\0" + file.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return total.hexdigest()[:32]


def derived() -> dict[str, Any]:
    """Every form, derived now."""
    for name in USERS:
        import_module(name)
    return {
        _key(name, args): json.loads(json.dumps(make(*args)))
        for name, (make, each) in sorted(_printed.items())
        for args in each
    }


def forms_text() -> str:
    """The file that holds them."""
    return json.dumps({"sources": sources(), "forms": derived()}, indent=1, ensure_ascii=False) + "\n"


def lambda_text(letters: Iterable[Any], expression: Any, backend: str, **options: Any) -> str:
    """The text of the function that SymPy's lambdify makes of an expression. backend: "math" or "numpy"."""
    import sympy

    text = getsource(sympy.lambdify(list(letters), expression, backend, **options))
    dummies = dict.fromkeys(re.findall(r"\b_?Dummy_\d+\b", text))  # SymPy counts them over the whole process
    for number, dummy in enumerate(dummies):
        text = re.sub(rf"\b{dummy}\b", f"dummy_{number}", text)
    return text


def run_text(text: str, backend: str) -> Callable[..., Any]:
    """The function of `lambda_text`."""

    space: dict[str, Any] = dict(vars(math if backend == "math" else np))
    if backend == "numpy":
        space |= {"numpy": np, "reduce": reduce}
    name = text.split("(", 1)[0].removeprefix("def ").strip()
    exec(compile(text, "<printed>", "exec"), space)
    return space[name]
