"""How far an approximation is from what it stands for, over the frequency."""

from typing import Any

import numpy as np

from loopbook.process.rows import ProcessError

PER_DECADE = 200
DECADES = 6


class Approximates:
    """What an approximation of a process knows of its error. exact: what it approximates; method: its name.

    A subclass says what its `frequency_response` is and up to which frequency it has a meaning.
    """

    method: str
    exact: Any

    def frequency_response(self, w: Any) -> Any:
        """The value at the frequencies w [rad/s]."""
        raise NotImplementedError

    @property
    def highest_frequency(self) -> float:
        """Beyond it [rad/s] the approximation says nothing: half the sampling frequency, or infinite."""
        return float("inf")

    def error(self, w: Any) -> Any:
        """|approximation/exact - 1| at the frequencies w [rad/s]. Raises ProcessError where nothing is approximated."""
        if self.exact is None:
            raise ProcessError("it approximates nothing: it is what it says")
        w = np.asarray(w, dtype=float)
        return abs(self.frequency_response(w) / self.exact(1j * w) - 1)

    def good_to(self, error: float = 0.05) -> float:
        """The frequency [rad/s] below which `error` is nowhere exceeded; infinite or the highest where it never is.

        Found on a grid of 200 points a decade and refined to rounding.
        """
        from scipy.optimize import brentq

        if not error > 0:
            raise ProcessError(f"error = {error!r}: a positive number is expected")
        top = min(self.highest_frequency, self._pace * 10.0 ** (DECADES / 2))
        w = np.geomspace(top * 10.0**-DECADES, top * (1 - 1e-12), DECADES * PER_DECADE)
        beyond = np.flatnonzero(~(self.error(w) <= error))
        if not beyond.size:
            return self.highest_frequency if top == self.highest_frequency else float("inf")
        first = int(beyond[0])
        if first == 0:
            return 0.0
        gap = lambda x: float(self.error(x)) - error  # noqa: E731
        return float(brentq(gap, w[first - 1], w[first], rtol=1e-12))

    @property
    def _pace(self) -> float:
        exact = self.exact
        rates = [abs(p) for p in exact.poles if p] + ([1 / exact.delay] if exact.delay else [])
        return float(max(rates, default=1.0))

    def said(self) -> str:
        """One sentence on the error, for tables."""
        if self.exact is None:
            return "exact"
        within = self.good_to(0.05)
        where = f"below {within:.4g} rad/s" if np.isfinite(within) else "at every frequency"
        return f"{self.method}: within 5 % of the exact one {where}"
