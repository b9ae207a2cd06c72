"""The environment of every kernel: nothing of the user's configuration, nothing that differs between two runs."""

import os
from importlib.util import cache_from_source
from pathlib import Path

from notebook_reports.project.home import home
from notebook_reports.project.project import Project

HERE = Path(__file__).parent
EPOCH = "1577836800"  # 2020-01-01, the date inside every file that needs one

CONFIGURATION = ("PYTHON", "MPL", "JUPYTER", "IPY", "LC_", "LANGUAGE", "XDG_", "FONTCONFIG", "FC_")
ARITHMETIC = ("OMP_", "OPENBLAS", "GOTO_", "MKL_", "BLIS_", "NPY_", "NUMEXPR", "KMP_", "SYMPY_", "SCIPY_", "MPMATH_")
SESSION = (
    "DISPLAY",
    "WAYLAND_",
    "DBUS_",
    "SSH_",
    "WINDOWID",
    "TERM",
    "COLORTERM",
    "NO_COLOR",
    "FORCE_COLOR",
    "CLICOLOR",
)
DROPPED = (*CONFIGURATION, *ARITHMETIC, *SESSION, "LOOPBOOK_ROOT", "LOOPBOOK_CACHE")
SHELL = ("LINES", "PWD", "OLDPWD", "SHLVL", "_", "LS_COLORS", "MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKEOVERRIDES")
"""Variables that no kernel gets, by how their names begin or, of the shell, by name: they would change outputs by the
user, by the machine's arithmetic, or by the window that a build was started in."""
FIXED = {
    "PYTHONHASHSEED": "0",
    "PYTHONNOUSERSITE": "1",
    "PYTHONUTF8": "1",
    "SOURCE_DATE_EPOCH": EPOCH,
    "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    "MATPLOTLIBRC": str(HERE / "matplotlibrc"),
    "MPL_IGNORE_SYSTEM_FONTS": "1",
    "JUPYTER_NO_CONFIG": "1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "LC_ALL": "C.UTF-8",
    "LANG": "C.UTF-8",
    "TZ": "UTC",
    "COLUMNS": "100",
}
"""Variables that every kernel gets alike."""


def drop_stale_bytecode(project: Project) -> None:
    """Remove bytecode older than its source. Python compares whole seconds and the size only: of a number changed in
    the second in which the file was last compiled it would run the old one."""
    for source in project.src.rglob("*.py") if project.src else ():
        compiled = Path(cache_from_source(source))
        try:
            if compiled.stat().st_mtime_ns < source.stat().st_mtime_ns:
                compiled.unlink()
        except OSError:
            continue


def passed_on(name: str) -> bool:
    """Does a kernel see a variable of this name as the user has it?"""
    return not name.startswith(DROPPED) and name not in (*SHELL, *FIXED)


def environment(project: Project) -> dict[str, str]:
    """The variables of a kernel: nothing of the user's configuration, nothing that differs between two runs.

    The project's ``src``, where it has one, comes first on the path, so that a copy of the project runs its own code.
    The libraries of linear algebra get one thread: kernels run beside each other, and sums then do not depend on the
    number of threads. What a notebook reads of the variables that are passed on, its stamp holds, see `kernel_side`.
    """
    kept = {k: v for k, v in os.environ.items() if passed_on(k)}
    path = [str(project.src)] if project.src else []
    path.append(str(HERE.parents[1]))
    own = {
        "HOME": str(home() or project.cache),
        "PYTHONPATH": os.pathsep.join(dict.fromkeys(path)),
        "MPLCONFIGDIR": str(project.cache / "matplotlib"),
        "LOOPBOOK_ROOT": str(project.root),
        "LOOPBOOK_CACHE": str(project.cache),
    }
    return {**kept, **FIXED, **own}


def of_one_kernel(folder: Path) -> dict[str, str]:
    """The variables that name a kernel's private folder: a profile there has no start-up that somebody put in."""
    names = ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR")
    return {name: str(folder / name.split("_")[0].lower()) for name in names}
