"""What a process derives before its first design: afterwards the caches of the functions hold it."""

import subprocess
import sys

import pytest

pytestmark = [pytest.mark.builds, pytest.mark.long]


def test_importing_it_derives_and_says_nothing():
    program = (
        "import loopbook.design.ready as r; r.derive = lambda: print('derived'); import loopbook.design.plant.warm"
    )
    done = subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "derived\n", "")
