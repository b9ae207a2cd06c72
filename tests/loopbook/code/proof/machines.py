"""The emitted texts at work: C compiled and fed through pipes, JavaScript in V8, Python, Structured Text interpreted.

Every machine takes a chunk of inputs (samples, lanes) and gives what was seen, (samples, 6, lanes): u, I, x, v, e and
the flags as one number. It keeps its state from chunk to chunk.
"""

import shutil
import subprocess
import threading
from pathlib import Path

import numpy as np
from reference_pid import FLAGS
from scenarios import INPUTS
from st_interpreter import Interpreter

from loopbook.code import Block, emit

WIDTHS = {"float": np.float32, "double": np.float64}

HARNESS = """
#include "proof.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int same(const proof_settings *a, const proof_settings *b) {
    const lb_real *p = (const lb_real *)a, *q = (const lb_real *)b;
    int i, equal = 1;
    for (i = 0; i < SETTINGS; ++i) equal = equal && p[i] == q[i];
    return equal;
}

int main(void) {
    proof *loops = (proof *)calloc(LANES, sizeof(proof));
    proof_settings *table = (proof_settings *)malloc(SETS * LANES * sizeof(proof_settings));
    lb_real *in = (lb_real *)malloc(INPUTS * LANES * sizeof(lb_real));
    lb_real *out = (lb_real *)malloc(6 * LANES * sizeof(lb_real));
    char *ready = (char *)calloc(LANES, 1);
    long lane;
    if (fread(table, sizeof(proof_settings), SETS * LANES, stdin) != SETS * LANES) return 2;
    while (fread(in, sizeof(lb_real), INPUTS * LANES, stdin) == INPUTS * LANES) {
        for (lane = 0; lane < LANES; ++lane) {
            proof *c = &loops[lane];
            const lb_real y_sp = in[lane], y = in[LANES + lane], ff = in[2 * LANES + lane];
            const lb_real elapsed = in[3 * LANES + lane], u = in[4 * LANES + lane];
            const proof_settings *s = &table[(long)in[8 * LANES + lane] * LANES + lane];
            if (in[9 * LANES + lane] != 0) { memset(c, 0, sizeof *c); ready[lane] = 0; }
            if (!ready[lane]) ready[lane] = proof_init(c, s);
            else if (!same(&c->s, s)) proof_change(c, s);
            if (!ready[lane]) {
                int i;
                for (i = 0; i < 5; ++i) out[i * LANES + lane] = 0;
                out[5 * LANES + lane] = 64;
                continue;
            }
            if (in[6 * LANES + lane] != 0) proof_reset(c);
            else {
                if (in[7 * LANES + lane] != 0) proof_start(c, y, y_sp, u, ff);
                proof_manual(c, in[5 * LANES + lane] != 0, u);
                proof_cycle(c, elapsed);
                proof_step(c, y_sp, y, ff);
            }
            out[lane] = c->u; out[LANES + lane] = c->I; out[2 * LANES + lane] = c->x;
            out[3 * LANES + lane] = c->v; out[4 * LANES + lane] = c->e;
            out[5 * LANES + lane] = (lb_real)proof_flags(c);
        }
        if (fwrite(out, sizeof(lb_real), 6 * LANES, stdout) != 6 * LANES || fflush(stdout)) return 4;
    }
    return 0;
}
"""


class NoTool(Exception):
    """A compiler or an engine is not on this machine."""


class CannotBuild(Exception):
    """The text is refused by a compiler or a parser."""


def stacked(chunk: dict[str, np.ndarray], number: type) -> np.ndarray:
    """(samples, inputs, lanes) in one type."""
    with np.errstate(over="ignore"):
        return np.stack([chunk[n] for n in INPUTS], axis=1).astype(number)


class CMachine:
    """The C source, compiled with these flags, as a process."""

    def __init__(
        self,
        block: Block,
        settings: np.ndarray,
        real: str,
        folder: Path,
        compiler: str,
        *flags: str,
        emulator: tuple[str, ...] = (),
    ):
        for tool in (compiler, *emulator):
            if not shutil.which(tool):
                raise NoTool(tool)
        self.number, self.lanes = WIDTHS[real], settings.shape[2]
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in emit(block.named("proof"), "c", real=real).items():
            (folder / name).write_text(text)
        (folder / "harness.c").write_text(HARNESS)
        sizes = {"LANES": self.lanes, "SETS": settings.shape[0], "SETTINGS": settings.shape[1], "INPUTS": len(INPUTS)}
        standard = ["-xc++"] if "++" in compiler else ["-std=c99"]
        command = [compiler, *standard, *flags, *(f"-D{k}={v}" for k, v in sizes.items())]
        made = subprocess.run(
            [*command, "proof.c", "harness.c", "-o", "run"], cwd=folder, capture_output=True, text=True
        )
        if made.returncode:
            raise CannotBuild(made.stderr)
        self.process = subprocess.Popen([*emulator, folder / "run"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        with np.errstate(over="ignore"):
            table = np.ascontiguousarray(settings.transpose(0, 2, 1)).astype(self.number)
        self.process.stdin.write(table.tobytes())

    def run(self, chunk: dict[str, np.ndarray]) -> np.ndarray:
        values = stacked(chunk, self.number)
        writer = threading.Thread(target=self._feed, args=(values.tobytes(),))  # a pipe is short: both ends at once
        writer.start()
        seen = self.process.stdout.read(6 * self.lanes * len(values) * values.itemsize)
        writer.join()
        return np.frombuffer(seen, self.number).reshape(len(values), 6, self.lanes)

    def _feed(self, data: bytes) -> None:
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def close(self) -> None:
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait(timeout=10)


SCRIPT = """
let loops, table;
const same = (a, b) => Object.keys(a).every((k) => a[k] === b[k]);
function begin(settings) {
    table = settings.map((row) => row.map((s) => Object.fromEntries(s.map(([k, v]) => [k, Number(v)]))));
    loops = table[0].map(() => null);
}
function made(s) {
    try { return proof(s); } catch (error) { if (error instanceof RangeError) return null; throw error; }
}
function run(buffer, samples, lanes) {
    const all = new Float64Array(buffer), out = all.subarray(10 * samples * lanes);
    for (let k = 0; k < samples; ++k) {
        const at = (i, lane) => all[(k * 10 + i) * lanes + lane];
        for (let lane = 0; lane < lanes; ++lane) {
            const s = table[at(8, lane)][lane];
            const y_sp = at(0, lane), y = at(1, lane), ff = at(2, lane), u = at(4, lane);
            if (at(9, lane) !== 0) loops[lane] = null;
            if (loops[lane] === null) loops[lane] = made(s);
            else if (!same(loops[lane].state.s, s)) loops[lane].change(s);
            let seen = [0, 0, 0, 0, 0, 64];
            if (loops[lane] !== null) {
                const c = loops[lane], q = c.state;
                if (at(6, lane) !== 0) c.reset();
                else {
                    if (at(7, lane) !== 0) c.start(y, y_sp, u, ff);
                    c.manual(at(5, lane) !== 0, u);
                    c.cycle(at(3, lane));
                    c.step(y_sp, y, ff);
                }
                let flags = 0;
                FLAGS.forEach((name, i) => { if (q[name]) flags += 2 ** i; });
                seen = [q.u, q.I, q.x, q.v, q.e, flags];
            }
            seen.forEach((value, i) => { out[(k * 6 + i) * lanes + lane] = value; });
        }
    }
}
"""


class ScriptMachine:
    """The classic script in V8."""

    number = np.float64

    def __init__(self, block: Block, settings: np.ndarray):
        try:
            from py_mini_racer import MiniRacer
        except ImportError:
            raise NoTool("mini-racer") from None
        import json

        names = list(block.settings())
        self.lanes, self.engine = settings.shape[2], MiniRacer()
        self.engine.eval(emit(block.named("proof"), "js")["proof.js"])
        self.engine.eval(f"const FLAGS = {list(FLAGS)};" + SCRIPT)
        words = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}

        def named(one: np.ndarray) -> list[list[str]]:
            return [[n, words.get(repr(float(v)), repr(float(v)))] for n, v in zip(names, one, strict=True)]

        rows = [[named(one) for one in part.T] for part in settings]
        self.engine.eval(f"begin({json.dumps(rows)})")

    def run(self, chunk: dict[str, np.ndarray]) -> np.ndarray:
        samples = len(chunk["y"])
        sizes = (10 * samples * self.lanes, 16 * samples * self.lanes)
        memory = np.frombuffer(self.engine.eval(f"var buffer = new ArrayBuffer({8 * sizes[1]}); buffer"), np.float64)
        memory[: sizes[0]] = stacked(chunk, np.float64).ravel()
        self.engine.eval(f"run(buffer, {samples}, {self.lanes})")
        return memory[sizes[0] :].reshape(samples, 6, self.lanes).copy()

    def close(self) -> None:
        self.engine.close()


class PythonMachine:
    """The emitted class, one object a lane, with floats."""

    number = np.float64

    def __init__(self, block: Block, settings: np.ndarray):
        space: dict = {}
        exec(emit(block.named("proof"), "py")["proof.py"], space)
        self.make = space["Proof"]
        self.table = [[tuple(one) for one in part.T.tolist()] for part in settings]
        self.loops = [None] * settings.shape[2]
        self.used = [()] * settings.shape[2]

    def run(self, chunk: dict[str, np.ndarray]) -> np.ndarray:
        lanes = [self._lane(i, [chunk[n][:, i].tolist() for n in INPUTS]) for i in range(len(self.loops))]
        return np.array(lanes, float).transpose(1, 2, 0)

    def _lane(self, lane: int, columns: list[list[float]]) -> list[tuple]:
        c, used, seen = self.loops[lane], self.used[lane], []
        for y_sp, y, ff, elapsed, u, manual, reset, start, index, power in zip(*columns, strict=True):
            s = self.table[int(index)][lane]
            if power:
                c = None
            if c is None:
                c, used = self._made(s), s
            elif s != used and c.change(*s):
                used = s
            if c is None:
                seen.append((0, 0, 0, 0, 0, 64))
                continue
            if reset:
                c.reset()
            else:
                if start:
                    c.start(y, y_sp, u, ff)
                c.manual(manual != 0, u)
                c.cycle(elapsed)
                c.step(y_sp, y, ff)
            flags = c.limited_low + 2 * c.limited_high + 4 * c.rate_limited + 8 * c.bad_measurement
            flags += 16 * c.wrong_cycle + 32 * c.overflow + 64 * c.refused
            seen.append((c.u, c.I, c.x, c.v, c.e, flags))
        self.loops[lane], self.used[lane] = c, used
        return seen

    def _made(self, settings: tuple):
        try:
            return self.make(*settings)
        except ValueError:
            return None

    def close(self) -> None:
        pass


CALLS = {"y_sp": "SET_POINT", "y": "ACTUAL", "ff": "FEEDFORWARD", "elapsed": "ELAPSED", "u_manual": "Y_MANUAL"}
MODES = {"manual": "MANUAL", "reset": "RESET", "start": "START"}
INPUT_NAMES = ("KP", "TN", "TV", "TF", "WEIGHT_P", "WEIGHT_D", "TT", "CYCLE", "Y_MIN", "Y_MAX", "RATE")


class TextMachine:
    """The function block in the interpreter, all lanes at once."""

    def __init__(self, block: Block, settings: np.ndarray, real: str):
        self.number, self.settings = WIDTHS[real], settings
        text = emit(block.named("proof"), "st", real=real)["proof.st"]
        self.block = Interpreter(text, settings.shape[2])
        self.lanes = np.arange(settings.shape[2])

    def run(self, chunk: dict[str, np.ndarray]) -> np.ndarray:
        return np.array([self._sample({n: a[k] for n, a in chunk.items()}) for k in range(len(chunk["y"]))])

    def _sample(self, row: dict[str, np.ndarray]) -> np.ndarray:
        block = self.block
        with np.errstate(all="ignore"):
            block.switch_on(row["power"] != 0)
            chosen = self.settings[row["index"].astype(int), :, self.lanes].T.astype(self.number)
            for name, value in zip(INPUT_NAMES, chosen, strict=True):
                block.put(name, value)
            for name, outside in CALLS.items():
                block.put(outside, row[name].astype(self.number))
            for name, outside in MODES.items():
                block.put(outside, row[name] != 0)
            block.call()
        flags = sum(block.get(f).astype(self.number) * self.number(1 << i) for i, f in enumerate(FLAGS))
        return np.array([*(block.get(n) for n in ("Y", "I", "x", "v", "ERROR")), flags]).astype(self.number)

    def close(self) -> None:
        pass
