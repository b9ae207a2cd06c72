"""How empty the pages of the reports are: of those that are neither a title nor the last of a report."""

from pathlib import Path

from tools.pages.page_fill import fills

Row = tuple[str, float | str, str]
REPORTS = Path(__file__).parents[1] / "reports"
QUARTER, MOST = 0.25, 0.40


def rows(folder: str = "") -> list[Row]:
    root = Path(folder) if folder else REPORTS
    paths = sorted(root.glob("*/*.pdf"))
    if not paths:
        return [("no reports", "-", f"none in the folders of {root}; `make` writes them")]
    read = [(path, fill) for path in paths for fill in fills(path.read_bytes())]
    inside = [(path, fill) for path, fill in read if fill.inside]
    poor = sorted((row for row in inside if row[1].empty > QUARTER), key=lambda row: -row[1].empty)
    worst = max((fill.empty for _, fill in inside), default=0.0)
    found: list[Row] = [
        ("pages", str(len(read)), f"{len(inside)} neither title nor last, of {len(paths)} reports"),
        (f"of these, more than {QUARTER:.0%} empty", str(len(poor)), ""),
        (f"of these, more than {MOST:.0%} empty", str(sum(fill.empty > MOST for _, fill in poor)), ""),
        ("the emptiest", f"{worst:.0%}", ""),
        (
            "all together",
            f"{sum(f.empty for _, f in inside) / max(1, len(inside)):.1%}",
            "of the paper",
        ),
    ]
    names = [(f"  {path.relative_to(root).with_suffix('')}, page {fill.page}", fill) for path, fill in poor]
    return found + [(name, f"{fill.empty:.0%}", "") for name, fill in names]
