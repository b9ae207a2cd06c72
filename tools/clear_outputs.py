"""Notebooks as they stand in git: without outputs, counts and what an editor leaves behind.

python tools/clear_outputs.py notebooks            clears them
python tools/clear_outputs.py --check notebooks    names what is to clear and ends with 1
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path

KEPT = {"tags", "jupyter"}  # metadata of a cell that people write


def unclean(content: dict) -> Iterator[str]:
    """What of a notebook does not belong into git."""
    for number, cell in enumerate(content["cells"], 1):
        if cell.get("outputs") or cell.get("execution_count") is not None:
            yield f"cell {number} has outputs or a count: make format clears them"
        if extra := set(cell["metadata"]) - KEPT:
            yield f"cell {number} has the metadata {sorted(extra)}"
    if "version" in content["metadata"].get("language_info", {}):
        yield "language_info names a version of Python"


def clear(content: dict) -> None:
    """Take it out."""
    for cell in content["cells"]:
        cell["metadata"] = {k: v for k, v in cell["metadata"].items() if k in KEPT}
        if cell["cell_type"] == "code":
            cell["outputs"], cell["execution_count"] = [], None
    content["metadata"].get("language_info", {}).pop("version", None)


def main(arguments: list[str]) -> int:
    check = "--check" in arguments
    found = 0
    for folder in (a for a in arguments if a != "--check"):
        for path in sorted(Path(folder).rglob("*.ipynb")):
            if ".ipynb_checkpoints" in path.parts:
                continue
            content = json.loads(path.read_text(encoding="utf-8"))
            problems = list(unclean(content))
            for problem in problems:
                print(f"{path}: {problem}")
            if problems and not check:
                clear(content)
                path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
            found += bool(problems)
    return 1 if check and found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
