"""A held signal as it is: constant from one sampling instant to the next."""

from collections.abc import Sequence

import numpy as np


def stairs(t: Sequence[float] | np.ndarray, values: Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corner points of a zero-order hold: value k holds from t[k] until t[k+1]; the last one is a point.

    >>> [row.tolist() for row in stairs([0, 1, 2], [5, 7, 6])]
    [[0, 1, 1, 2, 2], [5, 5, 7, 7, 6]]
    """
    return np.repeat(t, 2)[1:], np.repeat(values, 2)[:-1]
