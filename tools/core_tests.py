"""The core's tests against an installed wheel: python tools/core_tests.py, where wheel, pytest and hypothesis are.

Only what needs neither notebooks nor compilers: the wheel's core promises to run wherever NumPy and SciPy do. The tests
are copied away from the sources, so that the wheel is what they import.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CORE = "controllers experiments loop numerics pole_placement process response tuning"
FOLDERS = ("derivations", *(f"loopbook/{name}" for name in CORE.split()))
NEEDS_MORE = re.compile(
    r"notebook_reports|loopbook\.documents|simple_pid|book\.toml|parents\[|^\s*(import|from) control\b", re.M
)
"""What a test names that needs more than the core: other packages, or files beside the tests."""


def copied(folder: Path) -> list[str]:
    """The test files that need the core alone, copied; their names."""
    found = []
    for name in FOLDERS:
        for file in sorted((ROOT / "tests" / name).rglob("test_*.py")):
            if NEEDS_MORE.search(file.read_text(encoding="utf-8")):
                continue
            target = folder / ("test_" + "_".join(file.relative_to(ROOT / "tests").parts))  # no folder like a package
            shutil.copyfile(file, target)
            found.append(target.as_posix())
    return found


def main() -> int:
    """Run them; pytest's exit code, 1 where the sources were imported instead of a wheel."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        files = copied(folder)
        (folder / "pytest.ini").write_text(
            "[pytest]\nmarkers =\n    long: x\n    builds: x\naddopts = --import-mode=importlib\n"
        )
        where = subprocess.run([sys.executable, "-P", "-c", "import loopbook; print(loopbook.__file__)"], cwd=folder,
                               capture_output=True, text=True, check=True).stdout.strip()  # fmt: skip
        if Path(where).is_relative_to(ROOT / "src"):
            print(f"{where}: these are the sources; install a wheel")
            return 1
        print(f"{len(files)} files of tests against {where}")
        return subprocess.run(
            [sys.executable, "-P", "-m", "pytest", "-q", "-m", "not builds and not long", *files], cwd=folder
        ).returncode


if __name__ == "__main__":
    sys.exit(main())
