"""Why the header asks for -ffp-contract=off and against -ffast-math: with them the bits are others. And one ARM."""

from pathlib import Path

import pytest
from prove import arm, compiled, prove

pytestmark = pytest.mark.builds


def differing(title: str, real: str, maker) -> int:
    (row,) = prove(300, 20, chosen=lambda t: False, extra={real: {title: maker}}).rows
    if row.missing:
        pytest.skip(row.missing)
    return row.total


@pytest.mark.parametrize("real", ["float", "double"])
def test_fast_math_gives_other_bits(real):
    """The header refuses the flag; here its test is taken away."""
    maker = compiled(real, "gcc", "-O3", "-ffast-math", "-U__FAST_MATH__")
    assert differing("fast math", real, maker) > 1000


@pytest.mark.parametrize("real", ["float", "double"])
def test_fused_operations_give_other_bits(real):
    if " fma " not in Path("/proc/cpuinfo").read_text():
        pytest.skip("this processor has no fused multiply-add")
    assert differing("fused", real, compiled(real, "gcc", "-O2", "-mfma", "-ffp-contract=fast")) > 1000
    assert differing("not fused", real, compiled(real, "gcc", "-O2", "-mfma", "-ffp-contract=off")) == 0


@pytest.mark.parametrize("real", ["float", "double"])
def test_an_arm_gives_the_same_bits(real):
    (maker,) = arm(real).values()
    assert differing("ARM", real, maker) == 0
