"""The environment of every kernel: nothing of the user's configuration, nothing that differs between two runs."""

import os
from importlib.util import cache_from_source
from pathlib import Path

HERE = Path(__file__).parent
EPOCH = "1577836800"  # 2020-01-01, the date inside every file that needs one


def drop_stale_bytecode(root: Path) -> None:
    """Remove bytecode older than its source. Python compares whole seconds and the size only: of a number changed in
    the second in which the file was last compiled it would run the old one."""
    for source in (root / "src").rglob("*.py"):
        compiled = Path(cache_from_source(source))
        try:
            if compiled.stat().st_mtime_ns < source.stat().st_mtime_ns:
                compiled.unlink()
        except OSError:
            continue


def environment(root: Path, cache: Path) -> dict[str, str]:
    """The variables of a kernel: nothing of the user's configuration, nothing that differs between two runs.

    root: the project's folder; its ``src`` comes first on the path, so that a copy of the project runs its own code.
    cache: the folder for what libraries keep between runs. The libraries of linear algebra get one thread: kernels run
    beside each other, and sums then do not depend on the number of threads.
    """
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "MPL", "JUPYTER", "IPYTHON", "LC_"))}
    for name in ("matplotlib", "ipython", "jupyter"):
        (cache / name).mkdir(parents=True, exist_ok=True)
    source = [str(root / "src")] if (root / "src").is_dir() else []
    source.append(str(HERE.parents[1]))
    fixed = {
        "PYTHONHASHSEED": "0",
        "PYTHONNOUSERSITE": "1",
        "PYTHONUTF8": "1",
        "PYTHONPATH": os.pathsep.join(dict.fromkeys(source)),
        "SOURCE_DATE_EPOCH": EPOCH,
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
        "MATPLOTLIBRC": str(HERE / "matplotlibrc"),
        "MPLCONFIGDIR": str(cache / "matplotlib"),
        "IPYTHONDIR": str(cache / "ipython"),
        "JUPYTER_CONFIG_DIR": str(cache / "jupyter"),
        "JUPYTER_NO_CONFIG": "1",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
        "LC_ALL": "C.UTF-8",
        "LANG": "C.UTF-8",
        "TZ": "UTC",
        "COLUMNS": "100",
        "LOOPBOOK_ROOT": str(root),
    }
    kept.pop("DISPLAY", None)
    return {**kept, **fixed}
