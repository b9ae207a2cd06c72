"""Imported by a process that will make many designs: what all of them derive alike is derived here, once."""

from loopbook.design.plant import one
from loopbook.design.ready import derive

__all__ = ["one"]

derive()
