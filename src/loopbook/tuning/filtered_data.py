"""Process data adjusted for the derivative filter, before an AMIGO rule is asked (pid-report, section 5.3.2)."""

from dataclasses import replace
from typing import Any

from loopbook.experiments.data import StepData, TwoLagData
from loopbook.lazy import late
from loopbook.tuning.result import RuleDoesNotApply

amigo = late("derivations.tuning.amigo")


def with_filter(data: Any, Tf: float) -> Any:
    """Process data adjusted for the derivative filter's time constant Tf [s] (section 5.3.2): tune with the result.

        T + Tf/2 and L + Tf/2 for step data,   T2 + Tf/2 and L1 + Tf/2 for combined data;   gains stay

    Raises RuleDoesNotApply for frequency data, for which no adjustment is given, and for a negative Tf.

    >>> with_filter(StepData(Kp=1, T=1, L=0.5), Tf=0.2)
    StepData(Kp=1, T=1.1, L=0.6)
    """
    import sympy

    if not Tf >= 0:
        raise RuleDoesNotApply(f"Tf = {Tf!r} s: a filter's time constant is zero or positive")
    symbols = {
        StepData: {"T": amigo.T, "L": amigo.L},
        TwoLagData: {"T1": amigo.T_1, "T2": amigo.T_2, "L1": amigo.L_1},
    }.get(type(data))
    if symbols is None:
        raise RuleDoesNotApply(
            f"{type(data).__name__}: section 5.3.2 adjusts StepData and TwoLagData only; "
            "make the experiment with the filter in the loop instead"
        )
    adjusted = amigo.with_filter({s: sympy.Float(getattr(data, n)) for n, s in symbols.items()})
    return replace(data, **{n: float(adjusted[s].subs(amigo.T_f, Tf)) for n, s in symbols.items()})
