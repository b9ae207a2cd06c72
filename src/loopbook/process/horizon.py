"""How long a response is worth looking at."""

import numpy as np

from loopbook.numerics.characteristic_roots import zeros_in
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial

ON_AXIS = 1e-9
TIME_CONSTANTS, DOUBLINGS, WITHOUT_ANY = 6.0, 6.0, 10.0


def default_horizon(num: ExponentialPolynomial, den: ExponentialPolynomial) -> float:
    """A time [s] in which all that is worth seeing of num/den happens.

    The longest dead time, six time constants of the slowest pole and one of each other; of an unstable one, six time
    constants of its growth; of integrators alone, ten dead times or ten seconds.

    >>> of = ExponentialPolynomial.of
    >>> default_horizon(of([1], 3), of([2, 1]))
    15.0
    """
    zeros = zeros_in(den)[0]
    found = np.repeat(zeros.values, zeros.multiplicity)
    delay = max([*num.delays, *den.delays, 0.0])
    size = float(np.abs(found).max(initial=0.0))
    growing = found.real[found.real > ON_AXIS * size]
    if growing.size:
        return delay + DOUBLINGS / float(growing.max())
    decays = -found.real[found.real < -ON_AXIS * size]
    if not decays.size:
        return WITHOUT_ANY * delay or (DOUBLINGS * 2 * np.pi / size if size else WITHOUT_ANY)
    rest = float((1 / decays).sum()) - 1 / float(decays.min()) if len(den.terms) == 1 else delay
    return delay + TIME_CONSTANTS / float(decays.min()) + rest
