"""Many seeded loops, each also in another unit of time and in other units of y and u: the same answers.

    python tests/loopbook/scaling/prove_scaling.py 2000 [first seed] [workers]

Prints what differs, and how many loops, answers and refusals were compared. Loops so near a border of stability that
rounding decides are left out and counted. Exit code 1 where anything differs.
"""

import os
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")
sys.path.insert(0, str(Path(__file__).parent))

from answers import compare  # noqa: E402


def main(count: int, first: int = 0, workers: int = 2) -> int:
    total: Counter[str] = Counter()
    with ProcessPoolExecutor(workers) as pool:
        for found in pool.map(compare, range(first, first + count), chunksize=20):
            total.update(
                {
                    "loops": not found.border,
                    "of them stable": found.stable,
                    "left out, on a border": found.border,
                    "answers": found.answers,
                    "of them refusals": found.refusals,
                    "different": len(found.differences),
                }
            )
            for line in found.differences:
                print(line[:400], flush=True)
    print(", ".join(f"{number} {name}" for name, number in total.items()))
    return int(total["different"] > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
