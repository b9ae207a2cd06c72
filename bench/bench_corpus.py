"""Notebooks of other people through both exporters: ``python -m bench corpus DIR``, each in a process of its own.

Delivered: a page came, at most 5 % of the cells are nothing but boxes, and no word is lost. A cell is a box if
something in it is not shown and nothing else of it is, its code apart.
"""

import json
import statistics
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

FORMS = ("pdf", "html")
SECONDS = 120
Row = tuple[str, float | str, str]


def rows(folder: str = "") -> list[Row]:
    if not folder:
        return [("no notebooks", "-", "name their folder: python -m bench corpus DIR")]
    paths = sorted(p for p in Path(folder).rglob("*.ipynb") if ".ipynb_checkpoints" not in p.parts)
    if not paths:
        return [("no notebooks", "-", f"none below {folder}")]
    found: list[Row] = []
    for form in FORMS:
        with ThreadPoolExecutor(2) as pool:
            told = list(pool.map(lambda path, form=form: _one(path, form), paths))
        found += _rows(form, Path(folder), paths, told)
    return found


def _one(path: Path, form: str) -> dict:
    command = [sys.executable, "-m", "bench.corpus_one", str(path), form]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, cwd=Path(__file__).parents[1])
    except subprocess.TimeoutExpired:
        return {"outcome": "crashed", "why": f"not ready after {SECONDS} s"}
    if run.returncode:
        return {"outcome": "crashed", "why": (run.stderr.strip().splitlines() or ["?"])[-1][:200]}
    return json.loads(run.stdout.splitlines()[-1])


def _rows(form: str, folder: Path, paths: list[Path], told: list[dict]) -> list[Row]:
    outcomes = Counter(t["outcome"] for t in told)
    whole = sum(t["outcome"] == "delivered" and not t["lost"] and not t["outside"] for t in told)
    times = [t["seconds"] for t in told if "seconds" in t]
    kinds = Counter(f"{kind}{' (remark)' if remark else ''}" for t in told for _, kind, remark in t.get("mends", ()))
    name = form.upper()
    found: list[Row] = [
        (f"{name}: notebooks", str(len(told)), ""),
        (f"{name}: delivered, no word lost", f"{whole / len(told):.1%}", f"{whole} notebooks"),
        (f"{name}: refused", str(outcomes["refused"]), "more than 5 % of the cells are boxes"),
        (f"{name}: crashed", str(outcomes["crashed"]), ""),
        (f"{name}: words", f"{sum(t.get('words', 0) for t in told):,}", ""),
        (f"{name}: words lost", str(sum(len(t.get("lost", ())) for t in told)), "on no page"),
        (f"{name}: words displaced", str(sum(t.get("displaced", 0) for t in told)), "not where their cell goes on"),
        (f"{name}: words outside the text block", str(sum(t.get("outside", 0) for t in told)), ""),
        (f"{name}: time of one, imports included (median)", statistics.median(times) if times else "-", ""),
    ]
    found += [(f"  mends: {kind}", str(count), "") for kind, count in kinds.most_common()]
    for path, t in zip(paths, told, strict=True):
        lost = ", ".join(f"{word} (cell {cell})" for cell, word in t.get("lost", ())[:5])
        why = t.get("why") or (f"lost: {lost}" if lost else "")
        if why:
            found.append((f"  {path.relative_to(folder)}"[-58:], t["outcome"], why))
    return found
