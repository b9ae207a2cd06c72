"""What a language must say of itself."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from loopbook.code.block import Block


@dataclass(frozen=True)
class Options:
    """How a program is printed.

    real: "float" (24 bits, REAL) or "double" (53 bits, LREAL); JavaScript and Python have double alone. arduino,
    test_main: C only, a sketch and a main that tries the controller.
    """

    real: str = "float"
    arduino: bool = False
    test_main: bool = False

    def __post_init__(self) -> None:
        if self.real not in ("float", "double"):
            raise ValueError(f"real = {self.real!r}: float or double is expected")


@dataclass(frozen=True)
class Language:
    """name: as the command takes it. suffixes: endings of its files, the main one first. files: name -> text."""

    name: str
    title: str
    suffixes: tuple[str, ...]
    files: Callable[["Block", Options, str], dict[str, str]]
    """(block, options, stem of the file names) -> texts by file name."""
