"""Every command that a page shows is one: the subcommand is there, and it takes these words."""

import re
import shlex
from pathlib import Path

import click
import pytest

from loopbook.cli import main

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "src/loopbook/course/new_course/README.md"]
PAGES += sorted((ROOT / "docs").rglob("*.md"))
COMMAND = re.compile(
    r"^ {4,}(?:(?:\S*/)?\.venv/bin/)?(loopbook (?!=).*)$|`(?:\.venv/bin/)?(loopbook [a-z][^`]*)`", re.M
)
TARGET = re.compile(r"^ {4,}make ([a-z][a-z-]*)|`make ([a-z][a-z-]*)", re.M)
PLACEHOLDER = re.compile(r"[A-Z]{3,}|…|\.\.\.")


def commands() -> list[tuple[str, str]]:
    """(page, command): lines of their own whole; in a sentence a command may be without its arguments."""
    found = []
    for page in PAGES:
        for match in COMMAND.finditer(page.read_text(encoding="utf-8")):
            found.append((page.relative_to(ROOT).as_posix(), match[1] or f"{match[2]} # named"))
    return found


def refusal(words: list[str]) -> str:
    """Why the command does not take these words; a file that is not there is no reason."""
    command: click.Command = main
    context = click.Context(main, info_name="loopbook")
    while isinstance(command, click.Group):
        while words[:1] == ["--root"]:
            words = words[2:]
        if not words or words[0].startswith("-"):
            return ""
        inner = command.get_command(context, words[0])
        if inner is None:
            return f"no command {words[0]}"
        command, words = inner, words[1:]
    try:
        command.make_context(command.name, list(words), parent=context)
    except click.UsageError as error:
        return "" if re.search("does not exist|is a (directory|file)", error.message) else error.format_message()
    except click.exceptions.Exit:
        return ""
    return ""


@pytest.mark.parametrize(("page", "line"), commands())
def test_a_command_that_a_page_shows_is_taken(page, line):
    words = shlex.split(line, comments=True)[1:]
    if any(PLACEHOLDER.search(word) for word in words):
        words = words[:1]
    found = refusal(words)
    assert not found or (found.startswith("Missing argument") and line.endswith("# named")), line


def test_a_word_too_much_and_an_option_that_is_none_are_found():
    assert "Got unexpected extra argument" in refusal(["doctor", "twice"])
    assert "No such option" in refusal(["list", "--sorted"])
    assert refusal(["nothing"]) == "no command nothing" and refusal(["list", "double_tank"]) == ""
    assert len(commands()) > 60


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_a_target_that_a_page_names_is_in_the_makefile(page):
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M))
    named = {one or other for one, other in TARGET.findall(page.read_text(encoding="utf-8"))}
    assert named <= targets
