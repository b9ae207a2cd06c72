"""The Typst compiler as a judge of what the converter writes.

It refuses or accepts, it measures, and its HTML export says in MathML how it understood a formula: a second reading
of the same formula, made by other people's code, that the converter's own MathML has to agree with.
"""

import json
import re
import runpy
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
import typst

HERE = Path(__file__).parent


def _document(codes: list[str]) -> bytes:
    """Every formula once as a block and, every other one, once inline."""
    lines = [f"{i}. $ {code} $\n" + (f"\n{i}. ${code}$\n" if i % 2 else "") for i, code in enumerate(codes)]
    return ("#set page(width: auto, height: auto)\n" + "\n".join(lines)).encode()


def _complaint(codes: list[str], glyphs: bool) -> str | None:
    try:
        _, warnings = typst.compile_with_warnings(
            _document(codes), format="pdf", ignore_system_fonts=True, pdf_standards=["a-2b"] if glyphs else []
        )
    except typst.TypstError as error:
        return str(error)
    return "; ".join(str(warning.message) for warning in warnings) or None


def _refused(pairs: list[tuple[str, str]], glyphs: bool = True) -> str | None:
    """Found by halving: the first pair of LaTeX and Typst code that does not compile or compiles with a warning.

    glyphs: PDF/A refuses a glyph that no font of the wheel has.
    """
    complaint = _complaint([code for _, code in pairs], glyphs)
    if complaint is None:
        return None
    if len(pairs) == 1:
        return f"{complaint}\n  LaTeX: {pairs[0][0]}\n  Typst: {pairs[0][1]}"
    half = len(pairs) // 2
    return _refused(pairs[:half], glyphs) or _refused(pairs[half:], glyphs) or complaint


@pytest.fixture(scope="session")
def refused() -> Callable[..., str | None]:
    """A function from pairs (LaTeX, Typst) to the compiler's complaint about the first bad one, or None."""
    return _refused


@cache
def _size(code: str) -> tuple[float, float]:
    source = f"#context [#metadata(((m) => (m.width.pt(), m.height.pt()))(measure($ {code} $))) <size>]"
    width, height = json.loads(typst.query(source.encode(), "<size>", ignore_system_fonts=True))[0]["value"]
    return width / 11, height / 11


@pytest.fixture(scope="session")
def size() -> Callable[[str], tuple[float, float]]:
    """A function from Typst code to the width and height, in em, of the formula as a block."""
    return _size


@pytest.fixture(scope="session")
def understood() -> Callable[[list[str]], list[str]]:
    """A function from Typst codes to the MathML in which Typst's HTML export says how it understood each."""

    def read(codes: list[str]) -> list[str]:
        source = "\n".join(f"{i}. $ {code} $\n" for i, code in enumerate(codes))
        html, _ = typst.compile_with_warnings(source.encode(), format="html")
        found = re.findall(r"<math.*?</math>", html.decode(), re.DOTALL)
        assert len(found) == len(codes)
        return found

    return read


@pytest.fixture(scope="session")
def sympy_formulas() -> list[str]:
    """The corpus of `corpus`."""
    return runpy.run_path(str(HERE / "corpus.py"))["formulas"]()


@pytest.fixture(scope="session")
def report_formulas() -> list[str]:
    """The hand-written formulas of report_formulas.txt."""
    blocks = (HERE / "report_formulas.txt").read_text(encoding="utf-8").split("\n\n")
    lines = ("\n".join(line for line in block.splitlines() if not line.startswith("%%")) for block in blocks)
    return [block.strip() for block in lines if block.strip()]
