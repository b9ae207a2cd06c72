"""An invented class: who they are, and what each of them hands in, from solutions by hand and released notebooks alone.

Nothing of `loopbook` is imported here: a student has the notebook and a head.
"""

import csv
import importlib.util
import json
import random
import re
from functools import cache
from pathlib import Path

HAND = Path(__file__).parents[1] / "by_hand"
FIRST = ("Åsa", "Bo", "Chidi", "Dana", "Emre", "Fang", "Greta", "Hugo", "Inés", "João", "Kaja", "Liv", "Mats", "Nour")
LAST = ("Öst", "Nordin", "Okafor", "Şahin", "Ek", "Żak", "Ito", "Lund", "García", "O'Neil", "van Dijk", "Åberg")
GARBAGE = (
    "1,23",
    float("nan"),
    "abc",
    [1, 2, 3, 4, 5, 6, 7],
    {"a": 1},
    True,
    "1.5 s",
    [[[]]],
    "K*(",
    10**30,
    "__import__('os')",
)


def roster(number: int, path: Path) -> list[str]:
    """Write a roster of so many invented students; their ids."""
    dice = random.Random(number)
    ids = [f"c{dice.randrange(10**6):06}-{i:03}" for i in range(number)]
    with path.open("w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, delimiter=";")
        out.writerow(["Student_ID", "First name", "Last name"])
        out.writerows([id, dice.choice(FIRST), dice.choice(LAST)] for id in ids)
    return ids


@cache
def by_hand(sheet: str):
    """The function `solve` of a sheet's file."""
    spec = importlib.util.spec_from_file_location(f"by_hand_{sheet}", HAND / f"{sheet}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.solve


def wrong_methods(sheet: str, numbers: dict) -> list[tuple[str, str]]:
    """(answer, method) of each wrong method that was worked out by hand."""
    return [(name, method) for name, (_, wrong) in by_hand(sheet)(numbers, {}).items() for method in wrong]


def own_value(value):
    """A value in the form in which a solution by hand goes on with it."""
    return value[0] if isinstance(value, tuple) else value


def answers(sheet: str, numbers: dict, how: str, which: int = 0) -> dict:
    """What a student finds: "right", "rounded", "method" (the wrong method number `which`, and what follows from it),
    or "garbage"."""
    solve = by_hand(sheet)
    if how == "garbage":
        return {name: GARBAGE[(which + i) % len(GARBAGE)] for i, name in enumerate(solve(numbers, {}))}
    if how == "method":
        name, method = wrong_methods(sheet, numbers)[which]
        wrong = solve(numbers, {})[name][1][method]
        found = solve(numbers, {name: wrong})
        return {key: wrong if key == name else value for key, (value, _) in found.items()}
    found = {name: value for name, (value, _) in solve(numbers, {}).items()}
    return found if how == "right" else {name: _two_digits(value) for name, value in found.items()}


def _two_digits(value):
    return float(f"{value:.2g}") if isinstance(value, float) else value


def hand_in(notebook: dict, found: dict) -> dict:
    """The released notebook with the answers in its last cell, as a student writes them."""
    text = "\n".join("".join(cell["source"]) for cell in notebook["cells"])
    letters = {reason: letter for letter, reason in re.findall(r"^(\w)\) (.*)$", text, re.MULTILINE)}
    before, lines = [], []
    for name, value in found.items():
        if isinstance(value, str) and value.startswith("def "):
            before.append(value)
            lines.append(f"    {name!r}: {name},")
        else:
            lines.append(f"    {name!r}: {_written(value, letters)},")
    cells = [dict(cell) for cell in notebook["cells"]]
    cells[-1]["source"] = "\n".join([*before, "nan = float('nan')", "answers = {", *lines, "}"])
    return {**notebook, "cells": cells}


def _written(value, letters: dict[str, str]) -> str:
    if isinstance(value, tuple):
        return repr([value[0], letters[value[1]]])
    if isinstance(value, list | dict | str | bool):
        return repr([float(v) if hasattr(v, "item") else v for v in value] if isinstance(value, list) else value)
    return repr(value.item() if hasattr(value, "item") else value)


def scenario(place: int) -> tuple[str, int]:
    """What the student at a place of the roster does: (how, which)."""
    kinds = ("right", "method", "rounded", "method", "method", "garbage")
    return kinds[place % len(kinds)], place // len(kinds) * 3 + {1: 0, 3: 1, 4: 2}.get(place % len(kinds), 0)


def write_submissions(
    released: Path, sheet: str, ids: list[str], numbers: dict, folder: Path
) -> dict[str, tuple[str, int]]:
    """Everybody hands in; who did what."""
    done = {}
    for place, id in enumerate(ids):
        how, which = scenario(place)
        which = which % len(wrong_methods(sheet, numbers[id])) if how == "method" else which
        notebook = json.loads((released / "students" / id / f"{sheet}.ipynb").read_text(encoding="utf-8"))
        path = folder / id / f"{sheet}.ipynb"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(hand_in(notebook, answers(sheet, numbers[id], how, which))), encoding="utf-8")
        done[id] = (how, which)
    return done
