"""A printer that is wrong in one place is found out: by a compiler, by a parser or by a differing bit."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from machines import CannotBuild
from prove import prove
from st_interpreter import TextError

from derivations.programs import frozen
from derivations.programs.form import Assign, If
from loopbook.code.languages import c, javascript, python, structured_text

pytestmark = pytest.mark.builds

C, ST, JS, PY = "C double, gcc -O0", "Structured Text, REAL", "JavaScript, V8", "Python, emitted"
CLASSES = {
    C: (c.CArithmetic, c.CWriter),
    ST: (structured_text.TextArithmetic, structured_text.TextWriter),
    JS: (javascript.ScriptArithmetic, javascript.ScriptWriter),
    PY: (python.PythonArithmetic, python.PythonWriter),
}


@dataclass(frozen=True)
class Mutation:
    """language: whose printer. place: 0 the arithmetic, 1 the statements. method is replaced by mutate(old method)."""

    name: str
    language: str
    place: int
    method: str
    mutate: Callable


def printed_as(sign: str) -> Callable:
    return lambda old: lambda self, node: self._sum(node, sign) if sign in "+-" else self._product(node, sign)


def bare(old: Callable) -> Callable:
    return lambda self, node, *kinds: self._print(node)


def to_the_right(old: Callable) -> Callable:
    def sum_(self, node, sign):
        left, right = node.operands
        if sign == "+" and isinstance(left, frozen.Plus):
            return old(self, frozen.Plus(left.operands[0], frozen.Plus(left.operands[1], right)), sign)
        return old(self, node, sign)

    return sum_


def factors_to_the_right(old: Callable) -> Callable:
    def product(self, node, sign):
        left, right = node.operands
        if sign == "*" and isinstance(left, frozen.Times):
            return old(self, frozen.Times(left.operands[0], frozen.Times(left.operands[1], right)), sign)
        return old(self, node, sign)

    return product


def without(target: str, nothing: str) -> Callable:
    """No assignment from a local to this state."""

    def mutate(old: Callable) -> Callable:
        def statement(self, one, depth, own):
            lost = isinstance(one, Assign) and str(one.target) == target and str(one.value).endswith("_next")
            return [self.tab * depth + nothing] if lost else old(self, one, depth, own)

        return statement

    return mutate


def neighbours_swapped(old: Callable) -> Callable:
    """The first statement of a body that reads what the one before it sets comes before that one."""

    def lines(self, body, depth=0, own=()):
        body = list(body)
        for i in range(len(body) - 1):
            if all(isinstance(s, Assign) for s in body[i : i + 2]) and body[i + 1].value.has(body[i].target):
                body[i], body[i + 1] = body[i + 1], body[i]
                break
        return old(self, body, depth, own)

    return lines


def else_lost(old: Callable) -> Callable:
    return lambda self, one, depth, own: old(self, If(one.test, one.then), depth, own)


def attribute(value: object) -> Callable:
    return lambda old: value


def signs(**changed: str) -> Callable:
    names = {"more": ">", "equal": "=="}
    return lambda old: {**old, **{names[key]: value for key, value in changed.items()}}


MUTATIONS = [
    Mutation("minus is plus", C, 0, "_print_Minus", printed_as("+")),
    Mutation("division is multiplication", C, 0, "_print_Over", printed_as("*")),
    Mutation("no parentheses", C, 0, "_within", bare),
    Mutation("sums from the right", C, 0, "_sum", to_the_right),
    Mutation("products from the right", C, 0, "_product", factors_to_the_right),
    Mutation("x is not updated", C, 1, "_statement", without("x", ";")),
    Mutation("two statements change places", JS, 1, "lines", neighbours_swapped),
    Mutation("and is or", C, 0, "both", attribute(" || ")),
    Mutation("more is at least", C, 0, "signs", signs(more=">=")),
    Mutation("untyped literals", ST, 0, "_print_Integer", lambda old: lambda self, node: f"{int(node)}.0"),
    Mutation("whole literals", ST, 0, "_print_Integer", lambda old: lambda self, node: f"{int(node)}"),
    Mutation("sums from the right", ST, 0, "_sum", to_the_right),
    Mutation("I is not updated", ST, 1, "_statement", without("I", "")),
    Mutation("no else", ST, 1, "_branches", else_lost),
    Mutation("not is lost", ST, 0, "unless", attribute("")),
    Mutation("or is and", ST, 0, "either", attribute(" AND ")),
    Mutation("else if is if", ST, 1, "chained", attribute("IF {} THEN")),
    Mutation("minus is plus", JS, 0, "_print_Minus", printed_as("+")),
    Mutation("equal is unequal", JS, 0, "signs", signs(equal="!==")),
    Mutation("products from the right", JS, 0, "_product", factors_to_the_right),
    Mutation("v is not updated", JS, 1, "_statement", without("v", ";")),
    Mutation("else if is if", PY, 1, "chained", attribute("if {}:")),
    Mutation("true is false", PY, 0, "true", attribute("False")),
    Mutation("no parentheses", PY, 0, "_within", bare),
]


def found_out(language: str) -> str:
    """How the wrong printer shows; empty where it does not."""
    try:
        with np.errstate(all="ignore"):
            proof = prove(200, 20, chosen=lambda title: title == language)
    except (CannotBuild, TextError, SyntaxError, ArithmeticError) as error:
        return f"refused: {type(error).__name__}"
    (row,) = proof.rows
    if row.missing:
        pytest.skip(row.missing)
    return f"{row.total} differing" if row.total else ""


def tried() -> list:
    """The first mutation of each name, which `make test` tries too, and the others, for `make test WHOLE=1`."""
    met: set[str] = set()
    found = []
    for mutation in MUTATIONS:
        marks = [pytest.mark.whole] * (mutation.name in met)
        met.add(mutation.name)
        found.append(pytest.param(mutation, marks=marks, id=f"{mutation.language.split(',')[0]}: {mutation.name}"))
    return found


@pytest.mark.parametrize("mutation", tried())
def test_a_wrong_printer_is_found_out(mutation, monkeypatch):
    owner = CLASSES[mutation.language][mutation.place]
    monkeypatch.setattr(owner, mutation.method, mutation.mutate(getattr(owner, mutation.method)))
    assert found_out(mutation.language)


@pytest.mark.parametrize("language", CLASSES)
def test_the_printers_as_they_are_pass_the_same_test(language):
    assert not found_out(language)


def test_a_negative_literal_inside_its_type_is_found_out(monkeypatch):
    whole = structured_text.literal
    wrong = lambda value, real="REAL": whole(value, real).replace(f"-{real}#", f"{real}#-")  # noqa: E731
    monkeypatch.setattr(structured_text, "literal", wrong)
    assert found_out(ST).startswith("refused")


def test_a_state_of_another_width_is_found_out(monkeypatch):
    whole = structured_text.function_block
    narrow = lambda block, options: whole(block, options).replace("    I : LREAL;", "    I : REAL;")  # noqa: E731
    monkeypatch.setattr(structured_text, "function_block", narrow)
    assert found_out("Structured Text, LREAL")
