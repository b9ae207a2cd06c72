"""Any emitted controller in any language, fed with the arguments of its own operations, at its own settings."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
from machines import WIDTHS, NoTool
from st_interpreter import Interpreter

from loopbook.code import Block, controller, emit

SEEN = ("y_sp", "y", "feedforward", "schedule", "elapsed", "u_wanted", "on", "reset", "begin")
OUTSIDE = {"y_sp": "SET_POINT", "y": "ACTUAL", "feedforward": "FEEDFORWARD", "schedule": "SCHEDULE"}
OUTSIDE |= {"elapsed": "ELAPSED", "u_wanted": "Y_MANUAL", "on": "MANUAL", "reset": "RESET", "begin": "START"}


def arguments(block: Block, operation: str) -> list[str]:
    names = [a.name for a in block.program.operation(operation).arguments]
    return ["u_wanted" if n == "u_0" else n for n in names]


def samples(count: int, seed: int) -> dict[str, np.ndarray]:
    """Signals that wander, with starts, resets, manual, and bad measurements; exact in single precision."""
    draw = np.random.default_rng(seed)
    steps = {n: np.repeat(draw.normal(0, 10, count // 20 + 1), 20)[:count] for n in ("y_sp", "feedforward", "u_wanted")}
    steps["y"] = np.cumsum(draw.normal(0, 1, count))
    steps["schedule"] = np.cumsum(draw.normal(0, 3, count))
    steps["elapsed"] = draw.choice([0.0, 0.3, 1.0, 5.0], count)
    found = {n: a.astype(np.float32).astype(float) for n, a in steps.items()}
    found["on"] = np.repeat(draw.random(count // 15 + 1) < 0.3, 15)[:count].astype(float)
    found["reset"] = (draw.random(count) < 0.01).astype(float)
    found["begin"] = (draw.random(count) < 0.02).astype(float)
    found["y"][draw.random(count) < 0.02] = np.nan
    return found


def rows(chunk: dict[str, np.ndarray]):
    return (dict(zip(chunk, values, strict=True)) for values in zip(*(a.tolist() for a in chunk.values()), strict=True))


def in_python(block: Block, chunk: dict[str, np.ndarray], number: type) -> np.ndarray:
    """(samples, 2): u and the flags as a number, from the emitted class."""
    loop, seen = controller(block, number), []
    flags = [f.name for f in block.program.flags]
    for row in rows(chunk):
        given = {n: v != 0 if n in ("on", "reset", "begin") else number(v) for n, v in row.items()}
        if given["reset"]:
            loop.reset()
        else:
            if given["begin"]:
                loop.start(*(given[n] for n in arguments(block, "start")))
            loop.manual(given["on"], given["u_wanted"])
            if block.program.has("cycle"):
                loop.cycle(given["elapsed"])
            loop.step(*(given[n] for n in arguments(block, "step")))
        seen.append((loop.u, sum(1 << i for i, f in enumerate(flags) if getattr(loop, f))))
    return np.array(seen, number)


def in_c(block: Block, chunk: dict[str, np.ndarray], real: str, folder: Path, *flags: str) -> np.ndarray:
    if not shutil.which("gcc"):
        raise NoTool("gcc")
    number, name = WIDTHS[real], block.name

    def call(operation: str) -> str:
        words = [f"in[{SEEN.index(n)}]" + (" != 0" if n == "on" else "") for n in arguments(block, operation)]
        return f"{name}_{operation}(&loop, {', '.join(words)});"

    cycle = call("cycle") if block.program.has("cycle") else ""
    text = f"""#include "{name}.h"
#include <stdio.h>
int main(void) {{
    static {name} loop;
    {name}_settings s = {name}_designed();
    lb_real in[{len(SEEN)}], out[2];
    if (!{name}_init(&loop, &s)) return 3;
    while (fread(in, sizeof in, 1, stdin) == 1) {{
        if (in[7] != 0) {name}_reset(&loop);
        else {{
            if (in[8] != 0) {call("start")}
            {call("manual")}
            {cycle}
            {call("step")}
        }}
        out[0] = loop.u;
        out[1] = (lb_real){name}_flags(&loop);
        fwrite(out, sizeof out, 1, stdout);
    }}
    return 0;
}}
"""
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in {**emit(block, "c", real=real), "run.c": text}.items():
        (folder / file).write_text(content)
    strict = "-std=c99 -ffp-contract=off -Wall -Wextra -pedantic -Wconversion -Wdouble-promotion -Wshadow -Werror"
    command = ["gcc", *strict.split(" "), *flags, f"{name}.c", "run.c", "-o", "run"]
    subprocess.run(command, cwd=folder, check=True)
    data = np.stack([chunk[n] for n in SEEN], axis=1).astype(number).tobytes()
    out = subprocess.run([folder / "run"], input=data, stdout=subprocess.PIPE, check=True).stdout
    return np.frombuffer(out, number).reshape(-1, 2)


def in_script(block: Block, chunk: dict[str, np.ndarray]) -> np.ndarray:
    try:
        from py_mini_racer import MiniRacer
    except ImportError:
        raise NoTool("mini-racer") from None
    engine = MiniRacer()
    engine.eval(emit(block, "js")[f"{block.name}.js"])

    def call(operation: str) -> str:
        words = [f"r[{SEEN.index(n)}]" + (" !== 0" if n == "on" else "") for n in arguments(block, operation)]
        return f"loop.{operation}({', '.join(words)});"

    name = block.title[:1].lower() + block.title[1:]
    flags = json.dumps([f.name for f in block.program.flags])
    cycle = call("cycle") if block.program.has("cycle") else ""
    engine.eval(f"""
        const loop = {name}(), names = {flags};
        function run(rows) {{
            return rows.map((texts) => {{
                const r = texts.map(Number);
                if (r[7] !== 0) loop.reset();
                else {{ if (r[8] !== 0) {{ {call("start")} }} {call("manual")} {cycle} {call("step")} }}
                let raised = 0;
                names.forEach((n, i) => {{ if (loop.state[n]) raised += 2 ** i; }});
                return [loop.state.u, raised];
            }});
        }}""")
    words = {"nan": "NaN"}
    texts = [[words.get(repr(v), repr(v)) for v in row] for row in np.stack([chunk[n] for n in SEEN], axis=1).tolist()]
    seen = json.loads(engine.eval(f"JSON.stringify(run({json.dumps(texts)}))"))
    engine.close()
    return np.array(seen, float)


def in_text(block: Block, chunk: dict[str, np.ndarray], real: str) -> np.ndarray:
    loop, seen = Interpreter(emit(block, "st", real=real)[f"{block.name}.st"], 1), []
    flags = [f.name.upper() for f in block.program.flags]
    with np.errstate(all="ignore"):
        for row in rows(chunk):
            for n, v in row.items():
                if OUTSIDE[n] in loop.inputs:
                    loop.put(OUTSIDE[n], v)
            loop.call()
            seen.append((loop.get("Y")[0], sum(1 << i for i, f in enumerate(flags) if loop.get(f)[0])))
    return np.array(seen, WIDTHS[real])
