"""Each text is what its language's own tools accept, and uses nothing but + - * / and comparisons."""

import re
import shutil
import subprocess

import pytest
from st_interpreter import Interpreter

from derivations.programs import frozen
from derivations.programs.form import Assign, Do, Fill, If, walk
from loopbook.code import emit, pid_block
from loopbook.code.languages import languages

pytestmark = pytest.mark.builds

WARNINGS = ["-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Wdouble-promotion", "-Wshadow", "-Werror"]
NAME = "heater_pid"
CODESYS = [
    "ACTUAL",
    "SET_POINT",
    "KP",
    "TN",
    "TV",
    "Y_MANUAL",
    "Y_OFFSET",
    "Y_MIN",
    "Y_MAX",
    "MANUAL",
    "RESET",
    "CYCLE",
]


@pytest.fixture(scope="module", params=[False, True], ids=["plain sum", "compensated sum"])
def block(request):
    numbers = {"K": 2.35, "Ti": 11.7, "Td": 2.9, "Tf": 0.29, "h": 0.1, "u_low": -10.0, "u_high": 100.0}
    return pid_block(name=NAME, rest=(35.0, 20.0), compensated=request.param, **numbers)


@pytest.fixture
def written(block, tmp_path):
    """All C files of both extras."""

    def write(real: str):
        for name, text in emit(block, "c", real=real, arduino=True, test_main=True).items():
            (tmp_path / name).write_text(text)
        return tmp_path

    return write


def tool(name: str) -> str:
    if not shutil.which(name):
        pytest.skip(f"no {name} on this machine: what it would say of the C is not tested")
    return name


@pytest.mark.parametrize("real", ["float", "double"])
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("level", ["-O0", "-O2"])
def test_a_c_compiler_has_nothing_to_say(written, compiler, real, level):
    folder = written(real)
    command = [tool(compiler), "-std=c99", level, "-ffp-contract=off", *WARNINGS]
    done = subprocess.run(
        [*command, f"{NAME}.c", f"{NAME}_test.c", "-o", "try"], cwd=folder, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    tried = subprocess.run(["./try"], cwd=folder, capture_output=True, text=True)
    assert tried.returncode == 0, tried.stderr
    assert tried.stdout.count("\n") == 21


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
def test_a_cpp_compiler_has_nothing_to_say(written, compiler):
    folder = written("float")
    command = [tool(compiler), "-x", "c++", *WARNINGS, "-c", f"{NAME}.c", "-o", "object"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_cppcheck_has_nothing_to_say(written):
    folder = written("float")
    command = [tool("cppcheck"), "-q", "--std=c99", "--enable=warning,style,performance,portability"]
    command += ["--suppress=unusedStructMember", "--error-exitcode=1", f"{NAME}.c", f"{NAME}_test.c"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_fast_math_is_refused(written):
    folder = written("float")
    command = [tool("gcc"), "-std=c99", "-ffast-math", "-c", f"{NAME}.c", "-o", "object"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode
    assert "-ffast-math" in done.stderr


ARDUINO = """
#include <stdint.h>
const int A0 = 14;
static int analogRead(int pin) { return pin * 0 + 512; }
static void analogWrite(int pin, int value) { (void)pin; (void)value; }
static unsigned long micros(void) { static unsigned long now; return now += 50000; }
"""


def test_the_sketch_compiles_and_runs_against_a_stand_in_of_the_board(written):
    folder = written("float")
    (folder / "board.cpp").write_text(
        f'{ARDUINO}#include "{NAME}.ino"\nint main(void) {{ setup(); for (int i = 0; i < 9; ++i) loop(); return 0; }}'
    )
    tool("g++")
    for source in (["-x", "c++", f"{NAME}.c", "-c", "-o", "a.o"], ["board.cpp", "-c", "-o", "b.o"], ["a.o", "b.o"]):
        done = subprocess.run(
            ["g++", "-Wall", "-Wextra", "-Werror", *source], cwd=folder, capture_output=True, text=True
        )
        assert (done.returncode, done.stderr) == (0, "")
    assert subprocess.run(["./a.out"], cwd=folder).returncode == 0


@pytest.mark.parametrize("real", [pytest.param("float", marks=pytest.mark.whole), "double"])
def test_blark_parses_the_function_block(block, real):
    blark = pytest.importorskip("blark", reason="blark is not installed: Structured Text is parsed by one parser less")
    parsed = blark.parse_source_code(emit(block, "st", real=real)[f"{NAME}.st"])
    (item,) = parsed.transform().items
    assert str(item.name) == "FB_HeaterPid"
    assert len(item.declarations) == 3


@pytest.mark.parametrize("real", ["float", "double"])
def test_tree_sitter_parses_the_function_block(block, real):
    tree_sitter = pytest.importorskip("tree_sitter")
    grammar = pytest.importorskip("tree_sitter_iec61131_3_st")
    parser = tree_sitter.Parser(tree_sitter.Language(grammar.language()))
    text = emit(block, "st", real=real)[f"{NAME}.st"]
    tree = parser.parse(text.encode())
    assert not tree.root_node.has_error
    broken = parser.parse(text.replace("END_IF;", "", 1).encode())
    assert broken.root_node.has_error


def test_the_function_block_has_the_names_of_pid_fixcycle(block):
    text = emit(block, "st")[f"{NAME}.st"]
    inputs = text[text.index("VAR_INPUT") : text.index("END_VAR", text.index("VAR_INPUT"))]
    for name in [
        "ACTUAL",
        "SET_POINT",
        "KP",
        "TN",
        "TV",
        "Y_MANUAL",
        "Y_OFFSET",
        "Y_MIN",
        "Y_MAX",
        "MANUAL",
        "RESET",
        "CYCLE",
    ]:
        assert re.search(rf"^    {name} : ", inputs, re.MULTILINE), name
    for name in ["TF", "WEIGHT_P", "WEIGHT_D", "TT", "FEEDFORWARD"]:
        assert re.search(rf"^    {name} : REAL", inputs, re.MULTILINE), name
    outputs = text[text.index("VAR_OUTPUT") :]
    for name in ["Y", "LIMITS_ACTIVE", "OVERFLOW", "BAD_MEASUREMENT", "WRONG_CYCLE", "ERROR"]:
        assert re.search(rf"^    {name} : ", outputs, re.MULTILINE), name
    assert "-REAL#10.0" in text
    assert not re.search(r"(?<![#\w.])\d+\.\d", re.sub(r"\(\*.*?\*\)", "", text, flags=re.DOTALL)), "a bare literal"


def test_y_offset_and_reset_are_codesys(block):
    loop = Interpreter(emit(block, "st")[f"{NAME}.st"], 1)
    for name, value in {"ACTUAL": 20, "SET_POINT": 20, "Y_MANUAL": 35, "START": True}.items():
        loop.put(name, value)
    loop.call()
    assert loop.get("Y")[0] == 35
    loop.put("START", False)
    loop.call()
    assert loop.get("Y")[0] == pytest.approx(35)
    loop.put("RESET", True)
    loop.put("Y_OFFSET", 12)
    loop.call()
    assert loop.get("Y")[0] == 12
    loop.put("RESET", False)
    loop.call()
    assert loop.get("Y")[0] == pytest.approx(12), "no error, no integral: the offset"


def test_only_four_operations_and_comparisons(block):
    allowed = {"Plus", "Minus", "Times", "Over", "Negative"}
    for operation in block.program.operations:
        for statement in walk(operation.body):
            assert isinstance(statement, Assign | If | Do | Fill)
            if isinstance(statement, Assign):
                assert frozen.operations(statement.value) <= allowed
    for name, text in emit(block, "c").items():
        code = re.sub(r"/\*.*?\*/|#.*", "", text, flags=re.DOTALL if name.endswith(".c") else 0)
        assert not re.search(r"\b(malloc|free|pow|sqrt|fma|fabs|fmin|fmax|static \w+ \w+;)\b", code)


def test_equation_numbers_and_names_of_the_report_are_in_every_text(block):
    for target in languages():
        text = "".join(emit(block, target).values())
        for number in ("4.3", "4.4", "4.5", "4.10", "4.11", "4.12", "4.16", "4.17", "4.18", "4.19", "4.20"):
            assert f"eq. {number}" in text, (target, number)
        for name in ("p1", "p2", "p3", "p4", "p5", "p6"):
            assert re.search(rf"\b{name}\b", text)


def test_texts_are_the_same_every_time(block):
    for target in languages():
        assert emit(block, target) == emit(block, target)


def test_no_line_is_long(block):
    for target in languages():
        for name, text in emit(block, target, arduino=True, test_main=True).items():
            assert [line for line in text.splitlines() if len(line) > 120] == [], name
