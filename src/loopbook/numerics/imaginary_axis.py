"""A real polynomial on the imaginary axis: its magnitude and the slope of its argument, and how its roots turn it."""

import math

import numpy as np

ON_AXIS = 1e-9


def _product_with_mirror(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Re(p(jw) conj(q(jw))) as a polynomial in x = w^2, descending: the even part of p(s) q(-s) at s^2 = -x."""
    mirrored = np.asarray(q) * (-1.0) ** np.arange(len(q) - 1, -1, -1)
    even = np.convolve(p, mirrored)[::-1][::2][::-1]
    return even * (-1.0) ** np.arange(len(even) - 1, -1, -1)


def magnitude_squared(p: np.ndarray) -> np.ndarray:
    """|p(jw)|^2, a polynomial in w^2."""
    return _product_with_mirror(p, p)


def slope_of_phase(p: np.ndarray) -> np.ndarray:
    """d/dw arg p(jw) times |p(jw)|^2, a polynomial in w^2: Re(p'(jw) conj(p(jw)))."""
    return _product_with_mirror(np.polyder(p), p) if len(p) > 1 else np.zeros(1)


def positive_roots(p: np.ndarray) -> np.ndarray:
    """The w > 0 at which a real polynomial in x = w^2 vanishes, ascending: candidates at double roots included."""
    x = np.roots(p)
    x = x[(x.real > 0) & (abs(x.imag) <= 1e-6 * abs(x))].real
    return np.sort(np.sqrt(x))


def snapped(roots: np.ndarray) -> np.ndarray:
    """Roots within rounding of the imaginary axis are set on it."""
    roots = np.asarray(roots, dtype=complex)
    near = abs(roots.real) <= ON_AXIS * abs(roots)
    return np.where(near, 1j * roots.imag, roots)


def turned_on_axis(imag: float, w: float) -> float:
    return (math.pi / 2 if w >= imag else -math.pi / 2) + (math.copysign(math.pi / 2, imag) if imag else 0.0)


def turned(roots: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The change of arg(s - root), summed over the roots, from s = 0+ to s = jw; roots on the axis count as left."""
    re, im, w = roots.real, roots.imag, np.asarray(w)[..., None]
    # measured from the direction away from the root's side, where arg never jumps
    side = -np.sign(re) * (np.arctan2(w - im, abs(re)) - np.arctan2(-im, abs(re)))
    on_axis = np.where(w >= im, np.pi / 2, -np.pi / 2) + np.sign(im) * np.pi / 2
    return np.where(re == 0, on_axis, side).sum(axis=-1)
