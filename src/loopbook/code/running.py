"""An emitted controller that runs in Python: what a device does, sample by sample."""

from collections.abc import Callable
from functools import cache
from typing import Any

from loopbook.code.block import Block
from loopbook.code.languages import python


@cache
def _class(text: str) -> type:
    space: dict[str, Any] = {}
    exec(compile(text, "<an emitted controller>", "exec"), space)
    return next(value for key, value in space.items() if isinstance(value, type))


def controller(block: Block, number: Callable[[Any], Any] = float, **settings: Any) -> Any:
    """A controller with the block's settings, each made with ``number`` (float, Fraction, numpy.float32).

    settings: in place of those of the block, by spoken name. The object has the operations of the program as methods.

    >>> from loopbook.code import pid_block
    >>> loop = controller(pid_block(K=2.0, Ti=10.0, h=0.5))
    >>> loop.start(20.0, 20.0, 35.0, 0.0)
    >>> loop.step(20.0, 20.0, 0.0), loop.step(21.0, 20.0, 0.0)
    (35.0, 37.0)
    """
    plain = Block(block.program, "running", {s.name: 0.0 for s in block.program.settings})
    values = block.settings() | settings
    return _class(python.text(plain))(**{k: number(v) for k, v in values.items()})
