"""One derivation, four languages: a controller as C, Structured Text, JavaScript and Python.

>>> from loopbook.code import emit, pid_block
>>> block = pid_block(K=2.0, Ti=10.0, h=0.5, name="heater_pid")
>>> sorted(emit(block, "c"))
['heater_pid.c', 'heater_pid.h']
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from loopbook.code.block import Block, BlockSignal, CodeError
    from loopbook.code.emission import emit, how_to_call, statements
    from loopbook.code.from_json import regulator_from_json
    from loopbook.code.laws import on_off_block, rst_block, scheduled_block, smith_block
    from loopbook.code.pid import pid_block, states_at_rest
    from loopbook.code.running import controller

_PLACES = {
    "block": ("Block", "CodeError", "BlockSignal"),
    "running": ("controller",),
    "emission": ("emit", "how_to_call", "statements"),
    "from_json": ("regulator_from_json",),
    "laws": ("on_off_block", "rst_block", "scheduled_block", "smith_block"),
    "pid": ("pid_block", "states_at_rest"),
}
_MODULE_OF = {name: module for module, names in _PLACES.items() for name in names}

__all__ = [
    "Block",
    "BlockSignal",
    "CodeError",
    "controller",
    "emit",
    "how_to_call",
    "on_off_block",
    "pid_block",
    "regulator_from_json",
    "rst_block",
    "scheduled_block",
    "smith_block",
    "statements",
    "states_at_rest",
]


def __getattr__(name: str) -> Any:
    """SymPy takes its time: a command that emits nothing does not wait for it."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
