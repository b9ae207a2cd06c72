"""pid-report: Realisering och inställning av PID-regulatorer, J. Wahlfrid, 2007.

>>> from loopbook.documents import pid_report
>>> pid_report.aliasing.alias(9.0, 0.1)
1.0
"""

from loopbook.lazy import attach

MODULES = (
    "aliasing", "batch", "cruise_control", "diagrams", "equations", "experiment_figures", "filter_forms",
    "filter_price",
    "looking_ahead", "perfect_alpha", "printed_programs", "program_listing", "saturated_sine", "waiting", "windup",
)  # fmt: skip
TABLE = {name: f"loopbook.documents.pid_report.{name}" for name in MODULES}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
