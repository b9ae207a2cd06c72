"""Resolve the locks anew for CPython 3.11 to 3.13: `make lock` [ONLY="environment cluster"] [UPGRADE=1].

environment.txt holds what `make` and `make test` need, locks/*.txt what single targets need beside it, at the versions
that environment.txt has; tools/uv.txt the installer. What is locked stays at its version until UPGRADE=1: a new
dependency moves nothing else.
"""

import argparse
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = "environment.txt"
WANTED = {
    ENVIRONMENT: ("pyproject.toml", "--extra", "reports", "--extra", "control", "--extra", "dev"),
    "tools/uv.txt": ("--group", "installer"),
    "locks/browser.txt": ("pyproject.toml", "--extra", "widget", "--group", "browser"),
    "locks/cjk.txt": ("pyproject.toml", "--extra", "cjk"),
    "locks/cluster.txt": ("pyproject.toml", "--extra", "cluster"),
    "locks/docs.txt": ("pyproject.toml", "--extra", "docs"),
    "locks/interop.txt": ("--group", "interop"),
    "locks/prove.txt": ("--group", "prove"),
    "locks/records.txt": ("pyproject.toml", "--extra", "records"),
}


def entries(path: Path) -> list[str]:
    """The packages of a lock, each with its hashes."""
    return re.findall(r"^\S.*(?:\n .*)*", path.read_text(encoding="utf-8"), re.M)


def resolve(uv: str, lock: str, upgrade: bool) -> None:
    path = ROOT / lock
    path.parent.mkdir(exist_ok=True)
    command = [uv, "pip", "compile", *WANTED[lock], "--output-file", lock, "--universal", "--python-version", "3.11"]
    command += ["--fork-strategy", "fewest", "--generate-hashes", "--no-annotate", "--no-header", "--quiet"]
    if lock.startswith("locks/"):
        command += ["--constraint", ENVIRONMENT]
    subprocess.run([*command, *["--upgrade"] * upgrade], cwd=ROOT, check=True)
    if lock.startswith("locks/"):
        there = set(entries(ROOT / ENVIRONMENT))
        path.write_text("".join(f"{e}\n" for e in entries(path) if e not in there), encoding="utf-8")
    print(f"{lock}: {len(entries(path))} packages")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--uv", required=True)
    parser.add_argument("--upgrade", action="store_true")
    parser.add_argument("only", nargs="*", help="names of locks without folder and .txt; none: all")
    wish = parser.parse_args()
    if unknown := set(wish.only) - {Path(lock).stem for lock in WANTED}:
        parser.error(f"no lock named {', '.join(sorted(unknown))}; there are {', '.join(Path(n).stem for n in WANTED)}")
    for name in WANTED:
        if not wish.only or Path(name).stem in wish.only:
            resolve(wish.uv, name, wish.upgrade)
