"""Many synthetic records in one run on a cluster, a worker killed again and again; the bad ones must stand first.

    python tests/loopbook/design/acceptance/prove_plant.py 2000 [workers]

Ten records are made bad on purpose, the others so that there is nothing to object to. A share of the files is compared
with what processes here write.
"""

import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")
sys.path.insert(0, str(Path(__file__).parent))

import numpy as np  # noqa: E402
from processes import True_, recorded  # noqa: E402
from synthetic import make  # noqa: E402

KILL_EVERY = 200
COMPARED = 10
SHAPES = ("step", "up and down", "stairs")


def sound(number: int, folder: Path) -> list[Path]:
    """So many records of steps on a linear process, long enough and hardly noisy, by the seeds that give them."""
    found: list[Path] = []
    seed = 0
    with tempfile.TemporaryDirectory() as aside:
        while len(found) < number:
            made = make(seed, Path(aside))
            usual = made.fault == "none" and made.shape in SHAPES and not made.told
            if usual and not made.process.integrating and made.signal > 30 * made.noise and made.length >= 5:
                found.append(Path(shutil.copy(made.file, folder)))
            seed += 1
    return found


def spoiled(folder: Path) -> dict[str, Path]:
    """Ten records that are of no use, each in a way of its own, by that way."""
    random = np.random.default_rng(1)
    time_ = np.arange(400) * 0.5
    u = np.where(time_ > 20, 60.0, 40.0)
    y = 20 + recorded(True_(0.5, (8.0,), 2.0), u, np.zeros(400), 0.5, 0.0) + 0.05 * random.standard_normal(400)
    swing = 20 + 4 * np.sin(time_ * 0.7) + 0.05 * random.standard_normal(400)

    def text(*columns: np.ndarray) -> str:
        return "\n".join(["time [s],u,y", *(",".join(f"{v:.6g}" for v in row) for row in zip(*columns, strict=True))])

    whole = text(time_, u, y)
    contents = {
        "no step": text(time_, np.full(400, 40.0), y),
        "only noise": text(time_, u, 20 + random.standard_normal(400)),
        "empty": "",
        "words": "this is the diary of a plant\nand no record at all\n",
        "one line": "\n".join(whole.splitlines()[:2]),
        "no answer": text(time_, u, np.full(400, 20.0)),
        "time goes back": text(time_[::-1], u, y),
        "oscillates by itself": text(time_, u, swing),
        "one column": "\n".join(["y", *(f"{v:.6g}" for v in y)]),
        "bytes": "\x00\x01\x02" * 300,
    }
    paths = {}
    for place, (way, content) in enumerate(contents.items()):
        paths[way] = folder / f"m{place}.csv"
        paths[way].write_text(content + "\n", encoding="utf-8")
    return paths


def killing(address: str, every: int) -> tuple[Callable[..., None], list[int]]:
    """What is told of each design; it kills a worker's process after so many. The pids that it killed."""
    from distributed import Client

    killed: list[int] = []
    count = [0]

    def tell(*_: object) -> None:
        count[0] += 1
        if count[0] % every == 0:
            with Client(address, set_as_default=False) as client:
                pids = client.run(os.getpid)
            pid = next(iter(pids.values()))
            os.kill(pid, signal.SIGKILL)
            killed.append(pid)

    return tell, killed


def prove(number: int, folder: Path, workers: int = 2, every: int = KILL_EVERY, compared: int = COMPARED) -> list[str]:
    """What does not hold, a sentence each."""
    from distributed import LocalCluster

    from loopbook.design.plant.run import design_plant
    from loopbook.jobs import NUMBERS, PACKAGES
    from notebook_reports.build.apply import items
    from notebook_reports.executors.cluster import Cluster
    from notebook_reports.executors.executor import surroundings
    from notebook_reports.executors.processes import Processes

    records = folder / "records"
    records.mkdir()
    bad = spoiled(records)
    files = sorted([*sound(number - len(bad), records), *bad.values()])
    wanted = items(files, folder / "out", "design", ["json"])
    modules = (*NUMBERS, "loopbook.design.plant.warm")
    with surroundings():
        local = LocalCluster(n_workers=workers, threads_per_worker=1, host="127.0.0.1", memory_limit=0,
                             dashboard_address="127.0.0.1:0")  # fmt: skip
    began = time.monotonic()
    with local:
        tell, killed = killing(local.scheduler_address, every)
        done = design_plant(wanted, folder / "out", [], Cluster(local.scheduler_address, PACKAGES, modules), tell=tell)
    took = time.monotonic() - began
    print(f"{len(done.rows)} records in {took:.0f} s, {took / number:.2f} s each on {workers} workers, "
          f"{len(killed)} of them killed", flush=True)  # fmt: skip
    wrong = []
    if len(done.rows) != number or done.fresh != number:
        wrong.append(f"{len(done.rows)} of {number} came to an end")
    if len(killed) != number // every:
        wrong.append(f"{len(killed)} workers were killed instead of {number // every}")
    first = {row.name for row in done.rows[: len(bad)]}
    stems = {path.stem: way for way, path in bad.items()}
    wrong += [f"{stems[name]!r} is not among the first {len(bad)}" for name in sorted(stems.keys() - first)]
    wrong += [f"{row.name} is among the first: {row.state}, {row.why}" for row in done.rows[: len(bad)]
              if row.name not in stems]  # fmt: skip
    share = [*files[: compared // 2], *files[-(compared - compared // 2) :]]
    here = items(share, folder / "here", "design", ["json"])
    design_plant(here, folder / "here", [], Processes(1, modules))
    for one in here:
        made, there = (place / one.outputs["json"].name for place in (folder / "here", folder / "out"))
        if made.is_file() != there.is_file() or (made.is_file() and made.read_bytes() != there.read_bytes()):
            wrong.append(f"{made.name} is another here than on the cluster")
    return wrong


if __name__ == "__main__":
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    with tempfile.TemporaryDirectory() as temporary:
        found = prove(number, Path(temporary), int(sys.argv[2]) if len(sys.argv) > 2 else 2)
    print("\n".join(found) or "the ten that were made bad stand first, and the bytes are those of a run here")
    sys.exit(1 if found else 0)
