"""Loops in sums, products and loops around them: each stands for what it makes of its reference, `closed()`.

2 * loop    loop - P    loop / P    1 / loop    loop ** 2    loop.feedback(P)
"""

from typing import Any


class LoopAlgebra:
    """For a loop whose ``closed("reference", "y")`` is a transfer function, in s or in z."""

    __array_ufunc__ = None  # a NumPy number on the left leaves the operation to us

    def closed(self, source: str = "reference", output: str = "y") -> Any:
        """The transfer function from an input to a signal."""
        raise NotImplementedError

    def __add__(self, other: Any) -> Any:
        return self.closed() + opened(other)

    def __radd__(self, other: Any) -> Any:
        return other + self.closed()

    def __sub__(self, other: Any) -> Any:
        return self.closed() - opened(other)

    def __rsub__(self, other: Any) -> Any:
        return other - self.closed()

    def __mul__(self, other: Any) -> Any:
        return self.closed() * opened(other)

    def __rmul__(self, other: Any) -> Any:
        return other * self.closed()

    def __truediv__(self, other: Any) -> Any:
        return self.closed() / opened(other)

    def __rtruediv__(self, other: Any) -> Any:
        return other / self.closed()

    def __pow__(self, power: int) -> Any:
        return self.closed() ** power

    def __neg__(self) -> Any:
        return -self.closed()

    def feedback(self, other: Any = 1.0, sign: float = -1.0) -> Any:
        """The loop with `other` around it, from its output back to its reference; sign 1 for positive feedback."""
        return self.closed().feedback(opened(other), sign)


def opened(system: Any) -> Any:
    """What a loop makes of its reference; anything else as it is."""
    return system.closed() if isinstance(system, LoopAlgebra) else system
