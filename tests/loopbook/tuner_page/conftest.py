"""The page's script in V8, without a browser: what the tests of its numbers and texts ask."""

import json
import math

import pytest
from py_mini_racer import MiniRacer

from loopbook.tuner_page.bundle import bundle
from loopbook.tuner_page.script import generated

PATIENCE = 60_000
ANSWER = """
const plain = (x) => (x === Infinity ? "inf" : x === -Infinity ? "-inf" : x);
const usual = (x) => (x === "inf" ? Infinity : x === "-inf" ? -Infinity : x);
const { page } = golden;
const answer = (ask, given) => {
    const values = JSON.parse(given, (_, x) => usual(x));
    return JSON.stringify(ask(...values) ?? null, (_, x) => (ArrayBuffer.isView(x) ? Array.from(x) : plain(x)));
};
"""


@pytest.fixture(scope="session")
def ask():
    """ask(function of JavaScript, *arguments): the value, as plain data; infinity goes both ways."""
    machine = MiniRacer()
    machine.eval(bundle("golden.js", generated(), returned="golden") + ANSWER, timeout=PATIENCE)

    def plain(value):
        if isinstance(value, float) and math.isinf(value):
            return "inf" if value > 0 else "-inf"
        if isinstance(value, dict):
            return {key: plain(x) for key, x in value.items()}
        return [plain(x) for x in value] if isinstance(value, list | tuple) else value

    def back(value):
        if isinstance(value, dict):
            return {key: back(x) for key, x in value.items()}
        if isinstance(value, list):
            return [back(x) for x in value]
        return float(value) if value in ("inf", "-inf") else value

    def asked(function, *given):
        text = json.dumps(json.dumps(plain(list(given))))
        return back(json.loads(machine.eval(f"answer({function}, {text})", timeout=PATIENCE)))

    return asked
