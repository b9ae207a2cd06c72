"""PI for a first-order plant without dead time: Ti = T cancels the pole, the gain sets the closed loop's speed.

Formulas: `derivations.tuning.rules.lambda_rules`, derived in `derivations.loop.first_order_loop`.
"""

from loopbook.tuning.rule import Tuning, compute


def pole_cancelling_pi(k: float, T: float, closed: float) -> Tuning:
    """PI that makes the closed loop exactly 1/(1 + s closed) for the plant k/(1 + s T).

        Ti = T, K = T/(closed k)

    k: gain [y/u]; T: time constant [s]; closed: wanted time constant of the closed loop [s] (the article's alpha); all
    positive. A load at the plant's input is still left with the plant's own mode exp(-t/T): `notes` says so where
    closed < T. Raises RuleDoesNotApply where a number is not positive and finite.

    >>> pole_cancelling_pi(2, 3, 0.3).K
    5.0
    """
    note = f"a load's effect decays with T = {T:g} s although the set-point response has {closed:g} s"
    return compute("first-order-pi", k, T, closed, notes=(note,) if closed < T else ())


def script_pi(k: float, T: float, i: float) -> Tuning:
    """The same with closed = i T, the dimensionless i of the article's script: K = T/(i T k) = 1/(i k).

    k [y/u], T [s], i [1]: positive.

    >>> script_pi(2, 3, 0.1).K
    5.0
    """
    return compute("first-order-pi-script", k, T, i)
