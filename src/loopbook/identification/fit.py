"""A fitted model: its parameters with their intervals, and what is said of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from loopbook.identification.models import Structure
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.process.transfer_function import Process


@dataclass(frozen=True)
class Parameter:
    """An estimate with its half-width of the 95 % interval, in the parameter's unit."""

    name: str
    value: float
    half_width: float

    @property
    def interval(self) -> tuple[float, float]:
        return self.value - self.half_width, self.value + self.half_width


@dataclass(frozen=True)
class Fit(ShownAsTable):
    """One fitted model.

    parameters: gain first (Kp or Kv), then time constants, then dead time L. nuisance: what was fitted beside the
    model, of `least_squares.NUISANCES`. residuals: shape (n,), zero at samples that were left out. fit: percentage
    100 (1 - |residual| / |y - mean|). rmse: root mean square residual. correlation: of neighbouring residuals.
    settled: how many time constants were recorded after the last step (infinite for integrating models).
    covariance: of (gain, lags, L). effects: of further inputs, their gains by name. answer: peak to peak of the part of
    the output that the input made.
    """

    structure: Structure
    parameters: tuple[Parameter, ...]
    rest: float
    drift: float
    residuals: np.ndarray
    fit: float
    rmse: float
    correlation: float
    settled: float
    covariance: np.ndarray
    nuisance: str = "rest"
    effects: Mapping[str, float] = field(default_factory=dict)
    answer: float = np.nan

    @property
    def gain(self) -> float:
        return self.parameters[0].value

    @property
    def lags(self) -> tuple[float, ...]:
        return tuple(p.value for p in self.parameters[1:-1])

    @property
    def delay(self) -> float:
        return self.parameters[-1].value

    @property
    def process(self) -> Process:
        """The model as a Process."""
        return self.structure.process(self.gain, self.lags, self.delay)

    @property
    def noise(self) -> float:
        """Standard deviation of the measurement's sample-to-sample noise, quantisation included."""
        kept = self.residuals[self.residuals != 0]
        return float(np.std(np.diff(kept)) / np.sqrt(2)) if len(kept) > 2 else 0.0

    def table(self) -> PlainTable:
        """The parameters with the half-widths of their 95 % intervals."""
        rows = [[p.name, p.value, p.half_width] for p in self.parameters]
        return PlainTable(["parameter", "value", "+- (95 %)"], rows)

    def __str__(self) -> str:
        said = f"explains {self.fit:.1f} % of the response (rms residual {self.rmse:.3g})"
        return f"{self.structure.name}, {said}\n{self.table()}"

    def parameter(self, name: str) -> Parameter:
        return next(p for p in self.parameters if p.name == name)
