"""The table of differing bits: every emitted language against a reference that was written by hand.

python tests/loopbook/code/proof/prove.py [SAMPLES]
"""

import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from machines import WIDTHS, CMachine, NoTool, PythonMachine, ScriptMachine, TextMachine
from reference_pid import ReferenceMachine
from scenarios import SCENARIOS, Scenario, settings

from loopbook.code import Block, pid_block

BITS = {np.float32: np.uint32, np.float64: np.uint64}


@dataclass
class Row:
    """One language, one precision: differing numbers by scenario."""

    title: str
    against: str
    differing: dict[str, int] = field(default_factory=lambda: dict.fromkeys(SCENARIOS, 0))
    numbers: int = 0
    missing: str = ""

    @property
    def total(self) -> int:
        return sum(self.differing.values())

    def add(self, seen: np.ndarray, wanted: np.ndarray) -> None:
        wrong = differing(seen, wanted)
        for i, name in enumerate(SCENARIOS):
            self.differing[name] += int(wrong[:, :, i :: len(SCENARIOS)].sum())
        self.numbers += seen.size


@dataclass
class Proof:
    """All rows, and how often each branch of the program was taken, in single and in double precision."""

    rows: list[Row]
    branches: dict[str, dict[tuple[int, int], int]]
    samples: int
    seconds: float
    lanes: int

    @property
    def fewest(self) -> int:
        return min(min(counts.values()) for counts in self.branches.values())

    def text(self) -> str:
        """The table as people read it."""
        head = f"{'':34}{'against':16}" + "".join(f"{name.split()[0]:>10}" for name in SCENARIOS) + f"{'numbers':>12}"
        lines = [f"Differing bits: {self.lanes // len(SCENARIOS)} settings, {self.samples} samples each", head]
        for row in self.rows:
            cells = "".join(f"{n:>10}" for n in row.differing.values()) + f"{row.numbers:>12}"
            lines.append(f"{row.title:34}{row.against:16}" + (f"not run: {row.missing}" if row.missing else cells))
        for width, counts in self.branches.items():
            taken = sorted(counts.values())
            lines.append(
                f"branches in {width}: {len(taken)}, taken {taken[0]} to {taken[-1]} times; the ten rarest "
                + " ".join(map(str, taken[:10]))
            )
        return "\n".join([*lines, f"{self.seconds:.1f} s"])


def differing(seen: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Where two arrays differ in any bit; NaN equals NaN."""
    kind = BITS[wanted.dtype.type]
    same = np.ascontiguousarray(seen).view(kind) == np.ascontiguousarray(wanted).view(kind)
    return ~(same | (np.isnan(seen) & np.isnan(wanted)))


Maker = Callable[[Block, np.ndarray, Path], object]


def compiled(real: str, compiler: str, *flags: str, emulator: tuple[str, ...] = ()) -> Maker:
    def make(block: Block, table: np.ndarray, folder: Path) -> CMachine:
        mine = folder / f"{real}{len(list(folder.iterdir()))}"
        return CMachine(block, table, real, mine, compiler, *flags, emulator=emulator)

    return make


def arm(real: str) -> dict[str, Maker]:
    """A 32-bit ARM with its own floating-point unit, emulated."""
    flags = ("-O2", "-ffp-contract=off", "-static")
    return {f"C {real}, ARM -O2": compiled(real, "arm-linux-gnueabihf-gcc", *flags, emulator=("qemu-arm",))}


def makers(real: str) -> dict[str, Maker]:
    """Every language in one precision, by its title."""
    off = "-ffp-contract=off"
    found = {f"C {real}, gcc {level}": compiled(real, "gcc", level, off) for level in ("-O0", "-O2", "-O3")}
    found[f"C {real}, clang -O2"] = compiled(real, "clang", "-O2", off)
    found[f"C++ {real}, g++ -O2"] = compiled(real, "g++", "-O2", off)
    name = {"float": "REAL", "double": "LREAL"}[real]
    found[f"Structured Text, {name}"] = lambda block, table, folder: TextMachine(block, table, real)
    if real == "double":
        found["JavaScript, V8"] = lambda block, table, folder: ScriptMachine(block, table)
        found["Python, emitted"] = lambda block, table, folder: PythonMachine(block, table)
    return found


def prove(
    samples: int = 2000,
    count: int = 50,
    *,
    chosen: Callable[[str], bool] = lambda title: True,
    compensated: bool = False,
    tell: Callable[[str], None] = lambda text: None,
    extra: Mapping[str, Mapping[str, Maker]] | None = None,
    size: int = 2000,
) -> Proof:
    """Run everything that this machine can. chosen: which titles. extra: more makers by precision. size: of a chunk."""
    begun = time.perf_counter()
    block = pid_block(K=2.0, Ti=10.0, h=0.5, compensated=compensated)
    rows: list[Row] = []
    branches: dict[str, dict[tuple[int, int], int]] = {}
    with tempfile.TemporaryDirectory() as temporary:
        for real, number in WIDTHS.items():
            table = settings(number, count)
            against = {"float": "NumPy float32", "double": "NumPy float64"}[real]
            wanted = {t: m for t, m in makers(real).items() if chosen(t)} | dict((extra or {}).get(real, {}))
            machines = {}
            for title, make in wanted.items():
                rows.append(Row(title, against))
                try:
                    machines[title] = make(block, table, Path(temporary))
                except NoTool as missing:
                    rows[-1].missing = f"no {missing} on this machine"
            mine = {row.title: row for row in rows}
            reference = ReferenceMachine(table, number, compensated)
            done = 0
            for chunk in Scenario(table, number).chunks(samples, size):
                expected = reference.run(chunk)
                for title, machine in machines.items():
                    mine[title].add(machine.run(chunk), expected)
                done += len(chunk["y"])
                tell(f"{real}: {done} of {samples} samples")
            for machine in machines.values():
                if isinstance(machine, TextMachine):
                    branches[real] = dict(machine.block.taken)
                machine.close()
    return Proof(rows, branches, samples, time.perf_counter() - begun, table.shape[2])


def main() -> int:
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    extra = {real: arm(real) for real in WIDTHS} if "--arm" in sys.argv else {}
    proof = prove(*numbers[:1] or [100_000], extra=extra, tell=lambda text: print(text, file=sys.stderr, flush=True))
    print(proof.text())
    return int(any(row.total for row in proof.rows) or proof.fewest < 1000)


if __name__ == "__main__":
    sys.exit(main())
