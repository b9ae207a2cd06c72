"""The slowest cells and imports of the notebooks: `make profile`. CPU seconds, a process for each notebook."""

import json
import os
import re
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MOST = 20


def cells(notebook: Path) -> list[tuple[float, str]]:
    """Run a notebook here: (CPU seconds, first line) of each cell. Raises RuntimeError for a cell that fails."""
    from IPython.core.interactiveshell import InteractiveShell

    os.chdir(notebook.parent)
    shell = InteractiveShell.instance()
    found = []
    for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] != "code" or not source.strip():
            continue
        begun = time.process_time()
        outcome = shell.run_cell(source, silent=True)
        if not outcome.success:
            raise RuntimeError(f"{notebook}: {outcome.error_in_exec or outcome.error_before_exec}")
        found.append((time.process_time() - begun, source.strip().splitlines()[0]))
    return found


def imports(notebook: Path) -> Counter[str]:
    """Seconds that each imported module took itself, in a process that runs the notebook's import lines."""
    lines = [
        line
        for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]
        if cell["cell_type"] == "code"
        for line in re.findall(r"^(?:import|from) .*?(?:\([^)]*\)|$)", "".join(cell["source"]), re.M | re.S)
    ]
    done = subprocess.run([sys.executable, "-X", "importtime", "-c", "\n".join(lines)], capture_output=True, text=True)
    found: Counter[str] = Counter()
    for own, name in re.findall(r"import time:\s+(\d+) \|\s+\d+ \|\s+(\S+)", done.stderr):
        found[name.split(".")[0]] += int(own) / 1e6
    return found


def main() -> int:
    """Print both lists for all notebooks, or those named."""
    names = sys.argv[1:]
    notebooks = [
        n for n in sorted((ROOT / "notebooks").rglob("*.ipynb")) if not names or any(w in n.as_posix() for w in names)
    ]
    rows, modules, totals = [], Counter[str](), []
    for notebook in notebooks:
        name = notebook.relative_to(ROOT / "notebooks").with_suffix("").as_posix()
        done = subprocess.run([sys.executable, __file__, "--one", notebook], capture_output=True, text=True)
        if done.returncode:
            print(done.stderr.strip().splitlines()[-1], file=sys.stderr)
            return 1
        mine = json.loads(done.stdout.splitlines()[-1])
        rows += [(seconds, name, line) for seconds, line in mine]
        totals.append((sum(seconds for seconds, _ in mine), name))
        modules += imports(notebook)
    whole = sum(seconds for seconds, _ in totals)
    print(f"{whole:.1f} s of CPU in {len(rows)} cells of {len(notebooks)} notebooks, imports included\n")
    print("the slowest notebooks")
    for seconds, name in sorted(totals, reverse=True)[:5]:
        print(f"  {seconds:7.2f} s  {name}")
    print("the slowest cells")
    for seconds, name, line in sorted(rows, reverse=True)[:MOST]:
        print(f"  {seconds:7.2f} s  {name:38} {line[:70]}")
    print("the slowest imports, of all notebooks together, by package")
    for name, seconds in modules.most_common(MOST):
        print(f"  {seconds:7.2f} s  {name}")
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        found = cells(Path(sys.argv[2]))
        print("\n" + json.dumps(found))
    else:
        sys.exit(main())
