"""The alpha of section 5.2.7: found where the process is two lags and a dead time, refused where nothing fits."""

import numpy as np
import pytest

from loopbook.documents.pid_report.perfect_alpha import perfect_alpha
from loopbook.process.transfer_function import Process


@pytest.mark.parametrize("ratio", [0.2, 0.5, 0.9])
def test_two_lags_and_a_dead_time_give_their_own_ratio_back(ratio):
    process = Process((1.0,), tuple(np.polymul([1.0, 1.0], [ratio, 1.0])), delay=0.3)
    assert perfect_alpha(process) == (pytest.approx(ratio, rel=1e-6), "")


def test_six_equal_lags_have_none_and_the_text_says_why():
    alpha, why = perfect_alpha(Process((1.0,), tuple(np.poly([-1.0] * 6))))
    assert alpha is None and why
