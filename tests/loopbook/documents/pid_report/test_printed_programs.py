"""The printed programs as controllers: misprints break them, unknown names are refused."""

from fractions import Fraction as F

import pytest

from loopbook.controllers import PidSettings
from loopbook.documents.pid_report.printed_programs import ProgramController, changes_once

S = PidSettings(K=F(2), Ti=F(4), Td=F(1), Tf=F(1), h=F(1), Tt=F(2))


def test_the_printed_p4_leaves_a_derivative_at_rest():
    """K Td h/(Tf+h)*(Tf+h) = K Td h = 2 in place of 1/2: D settles at 3 y and feeds back with the wrong sign."""
    right, wrong = ProgramController("4.13", S), ProgramController("4.13", S, gains={"p_4": F(2)})
    for _ in range(60):
        u_right, u_wrong = right.step(F(5), F(5)), wrong.step(F(5), F(5))
    assert abs(u_right) < F(1, 10**12)
    assert abs(u_wrong - 3 * 5) < F(1, 10**12)


def test_figure_4_7_by_hand():
    """e = 1, then 1/2: P + I + D = 2 + 0 + 2, then 1 + 1/2 - 1."""
    program = ProgramController("4.7", S)
    assert program.step(F(0), F(1)) == 4
    assert program.states == {"e_old": F(1), "I": F(1, 2)}
    assert program.step(F(1, 2), F(1)) == F(1, 2)


def test_names():
    with pytest.raises(ValueError, match=r"figure '4\.8' has no program; one of 4\.7, 4\.9"):
        ProgramController("4.8", S)
    with pytest.raises(ValueError, match=r"figure 4\.9 has no state 'yfold'; it has y_fold, I"):
        ProgramController("4.9", S, yfold=1)


@pytest.mark.parametrize("reads_first", [False, True])
@pytest.mark.parametrize("settles", [False, True])
def test_the_line_for_bumpless_changes_needs_both_mends(reads_first, settles):
    """Without the measurement it does not run at all; with the old settings kept it changes I in every pass."""
    assert changes_once(reads_first, settles) == (reads_first and settles)
