"""The core's tests against an installed wheel: python tools/core_tests.py, where wheel, pytest and hypothesis are.

Only what needs neither notebooks nor compilers: the wheel's core promises to run wherever NumPy and SciPy do. The tests
are copied away from the sources, so that the wheel is what they import.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CORE = "controllers experiments loop numerics pole_placement process response tuning"
FOLDERS = ("derivations", *(f"loopbook/{name}" for name in CORE.split()))
NEEDS_MORE = ("control", "notebook_reports", "simple_pid", "documents", "book.toml", "ROOT", "parents[")


def copied(folder: Path) -> list[str]:
    """The test files that need the core alone, copied; their names."""
    found = []
    for name in FOLDERS:
        for file in sorted((ROOT / "tests" / name).rglob("test_*.py")):
            text = file.read_text(encoding="utf-8")
            if any(f"import {w}" in text or f"from {w}" in text or (w in text and not w.isalpha()) for w in NEEDS_MORE):
                continue
            target = (
                folder / f"test_{'_'.join(file.relative_to(ROOT / 'tests').parts)}"
            )  # flat: no folder like a package
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
