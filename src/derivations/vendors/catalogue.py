"""Every PID block by name: each file of this folder with a function `blocks` is a vendor."""

import pkgutil
from functools import cache
from importlib import import_module

from derivations.vendors.block import PidBlock

FOLDER = "derivations.vendors"
LEFT_OUT = {
    "ABB Control AC 800M (PidLoop, PidCC) and AC500 temperature control": "no text with the equation was found",
    "Emerson DeltaV": "the equations of Books Online are pictures in the text that was found; its parameters GAIN, "
    "RESET, RATE, FORM and STRUCTURE are those of the fieldbus block, with ALPHA for its 0.1 (0.125 unless changed)",
    "Honeywell Experion (equations A to E)": "of Control Builder Components Theory only the contents were found",
}
"""Controllers that were looked for and have no block, with the reason."""


@cache
def by_name() -> dict[str, PidBlock]:
    """Every block: the forms of textbooks first, then the vendors by the alphabet.

    >>> list(by_name())[:3]
    ['ideal', 'parallel', 'series']
    """
    files = sorted(m.name for m in pkgutil.iter_modules(import_module(FOLDER).__path__))
    files.sort(key=lambda name: name != "textbook")
    found: list[list[PidBlock]] = [getattr(import_module(f"{FOLDER}.{name}"), "blocks", list)() for name in files]
    return {block.name: block for of_file in found for block in of_file}
