"""Emitted texts in files: all of them, or none."""

import os
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from loopbook.code.block import Block, CodeError, identifier
from loopbook.code.emission import emit
from loopbook.code.from_json import regulator_from_json
from loopbook.code.languages import languages


def write_controller(
    block: Block, targets: Sequence[str], output: Path, *, named: bool = False, **options: Any
) -> list[Path]:
    """Write a controller in these languages.

    output: a folder, or for one target the main file, whose stem then names the rest and, unless it is ``named``
    already, the program. options: of `emit`. Returns the paths. Raises CodeError for a target or an ending that does
    not fit; nothing is written then.
    """
    if not targets:
        raise CodeError(f"no target: one or more of {', '.join(languages())} are expected")
    folder, stem = output, ""
    if output.suffix and not output.is_dir():
        folder, stem = output.parent, output.stem
        if len(targets) > 1:
            raise CodeError(f"{output} is one file, {len(targets)} languages are to be written: give a folder")
        language = languages().get(targets[0])
        if language and output.suffix not in language.suffixes:
            raise CodeError(f"{output}: {language.title} ends in {' or '.join(language.suffixes)}")
        block = block if named else block.named(identifier(stem))
    texts: dict[str, str] = {}
    for target in targets:
        texts |= emit(block, target, stem=stem, **options)
    folder.mkdir(parents=True, exist_ok=True)
    return _all(folder, texts)


def _all(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write aside first, then put everything in its place."""
    aside = {folder / name: folder / f".{name}.{os.getpid()}" for name in texts}
    try:
        for path, temporary in aside.items():
            temporary.write_text(texts[path.name], encoding="utf-8", newline="\n")
        for path, temporary in aside.items():
            temporary.replace(path)
    finally:
        for temporary in aside.values():
            temporary.unlink(missing_ok=True)
    return list(aside)


def _of_design(suffix: str, data: Mapping[str, Any], stem: str) -> bytes:
    """One file of a design: data is its JSON, stem the name of its files."""
    language = next(one for one in languages().values() if f".{suffix}" in one.suffixes)
    block = regulator_from_json(data, name=identifier(data.get("name") or Path(data.get("data", stem)).stem))
    return emit(block, language.name, stem=stem)[f"{stem}.{suffix}"].encode()


def with_all_files(formats: Sequence[str]) -> list[str]:
    """Formats of a report, with the endings of all the files that a language needs.

    >>> with_all_files(["pdf", "c", "st"])
    ['pdf', 'c', 'h', 'st']
    """
    known = {name: [s.lstrip(".") for s in language.suffixes] for name, language in languages().items()}
    return [ending for one in formats for ending in known.get(one, [one])]


PROGRAMS: Mapping[str, Callable[[dict, str], bytes]] = MappingProxyType(
    {s.lstrip("."): partial(_of_design, s.lstrip(".")) for one in languages().values() for s in one.suffixes}
)
"""Files of a design by their ending: (the design's JSON, stem) -> bytes. All that a press has to know of programs."""
