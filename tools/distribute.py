"""What a release carries: wheel, source distribution, reports as a zip file. python tools/distribute.py FOLDER"""

import shutil
import sys
import zipfile
from pathlib import Path

from setuptools import build_meta

ROOT = Path(__file__).resolve().parents[1]
WHEN = (1980, 1, 1, 0, 0, 0)


def zipped(folder: Path, target: Path) -> None:
    """The files of a folder, sorted, without times: the same reports give the same file."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(p for p in folder.rglob("*") if p.is_file()):
            entry = zipfile.ZipInfo(file.relative_to(folder.parent).as_posix(), WHEN)
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)


def main(target: Path) -> int:
    """Write the three files."""
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    shutil.rmtree(ROOT / "build" / "lib", ignore_errors=True)  # an older build's modules must not get in
    for build in (build_meta.build_wheel, build_meta.build_sdist):
        build(str(target))
    zipped(ROOT / "reports", target / "reports.zip")
    for file in sorted(target.iterdir()):
        print(f"{file.stat().st_size:>12,} {file}")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
