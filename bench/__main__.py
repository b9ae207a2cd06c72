"""Run the benches named, or all, and print one table for each; a folder is what the bench before it measures."""

import importlib
import itertools
import os
import platform
import sys
from pathlib import Path

HERE = Path(__file__).parent
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"  # as kernels run; read when NumPy is loaded, which the benches do


def names() -> list[str]:
    return sorted(p.stem.removeprefix("bench_") for p in HERE.glob("bench_*.py"))


def shown(measured: float | str) -> str:
    """Seconds with three digits, in the unit that a person would choose."""
    if isinstance(measured, str):
        return measured
    for scale, unit in ((1, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if measured >= scale:
            return f"{measured / scale:.3g} {unit}"
    return f"{measured / 1e-9:.3g} ns"


def main(chosen: list[str]) -> int:
    folders = {name: folder for name, folder in itertools.pairwise(chosen) if Path(folder).is_dir()}
    chosen = [name for name in chosen if name not in folders.values()]
    unknown = set(chosen) - set(names())
    if unknown:
        print(f"no bench {', '.join(sorted(unknown))}; there are {', '.join(names())}")
        return 2
    print(f"Python {platform.python_version()}, {os.cpu_count()} cores, {platform.machine()}")
    for name in chosen or names():
        module = importlib.import_module(f"bench.bench_{name}")
        print(f"\n{module.__doc__.splitlines()[0]}", flush=True)
        for what, measured, remark in module.rows(*[folders[name]] if name in folders else []):
            print(f"  {what:58} {shown(measured):>10}  {remark}", flush=True)
    return 0


sys.exit(main(sys.argv[1:]))
