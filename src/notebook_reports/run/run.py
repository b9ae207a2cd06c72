"""Run one notebook with papermill, and say truly what happened.

papermill's own record is not believed: it calls a notebook completed whose kernel died or ran out of time. Here a run
is good when every cell that runs was run and answered, and none raised but those that say they do.
"""

import copy
import logging
import re
import subprocess
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import nbformat
from nbclient.exceptions import CellTimeoutError, DeadKernelError
from papermill.engines import Engine, papermill_engines
from papermill.iorw import load_notebook_node
from papermill.parameterize import parameterize_notebook
from papermill.translators import PythonTranslator, papermill_translators

from notebook_reports.project.failures import Failure
from notebook_reports.project.project import Project
from notebook_reports.project.source import INJECTED, Source
from notebook_reports.run import kernels
from notebook_reports.run.canonical import canonical
from notebook_reports.run.filled import filled
from notebook_reports.run.surroundings import environment

_ANSI = re.compile(r"\x1b\[[0-9;]*m")
_WARNING = re.compile(r"(?:^|[\s:])(\w*Warning): (.*)")
_QUIET = logging.getLogger("loopbook.kernels")
_QUIET.addHandler(logging.NullHandler())
_QUIET.propagate = False
_QUIET.setLevel(logging.CRITICAL)
logging.getLogger("asyncio").setLevel(logging.CRITICAL)  # it tells of tasks that wait for a kernel that died


@dataclass(frozen=True)
class Run:
    """One run. content: the canonical executed notebook, up to the failure where there was one. depends: what the
    kernel imported and read, see `watching.report`. warnings: (cell, text) for all that went to stderr."""

    content: dict[str, Any]
    seconds: float
    failure: Failure | None = None
    warnings: list[tuple[int, str]] = field(default_factory=list)
    depends: dict[str, Any] = field(default_factory=dict)

    def cell_of(self, count: int) -> int:
        """The position, from 1, of one of the cells that ran; 0 where there is none. count: from 1, in order."""
        number = ran = 0
        for cell in self.content["cells"]:
            number += INJECTED not in cell["metadata"].get("tags", ())
            ran += cell.get("execution_count") is not None
            if ran == count and count:
                return number
        return 0


class _Translator(PythonTranslator):
    """papermill's injected cell, with each value as its exact Python literal and no formatter that may be absent."""

    @classmethod
    def translate(cls, val: Any) -> str:
        return repr(val)

    @classmethod
    def codify(cls, parameters: Mapping[str, Any], comment: str = "Parameters") -> str:
        return "\n".join([f"# {comment}", *(f"{name} = {cls.translate(v)}" for name, v in parameters.items())])


class _Engine(Engine):
    """papermill's engine on private kernels; the client is left where `run` can ask it what happened."""

    @classmethod
    def execute_managed_notebook(cls, nb_man: Any, kernel_name: str, **kwargs: Any) -> None:
        client = kernels.Client(
            nb_man,
            beside=kwargs["beside"],
            kernel_name=kernel_name,
            timeout=kwargs["timeout"],
            startup_timeout=60,
            log=_QUIET,
        )
        kwargs["clients"].append(client)
        with tempfile.TemporaryFile() as said:
            try:
                client.execute(env=kwargs["env"], cwd=kwargs["folder"], stdout=subprocess.DEVNULL, stderr=said)
            finally:
                said.seek(0)
                client.last_words = said.read()[-4000:].decode(errors="replace").strip()


papermill_engines.register("loopbook", _Engine)
papermill_translators.register("loopbook", _Translator)


def run_notebook(
    source: Source, name: str, project: Project, parameters: Mapping[str, Any] | None = None, timeout: float = 600
) -> Run:
    """Run a notebook from the first cell to the last or to the first that fails.

    name: what failures call the notebook. parameters: checked values by name, see `parameters.assign`. timeout: s for
    one cell. Raises `kernels.Stopped` where the build was interrupted.
    """
    started = time.monotonic()
    notebook = loaded(source, parameters)
    error, client = _execute(notebook, source.path.parent, project, timeout)
    if isinstance(error, DeadKernelError) and kernels.lost_its_parent() and not kernels.stopping():
        notebook = loaded(source, parameters)
        error, client = _execute(notebook, source.path.parent, project, timeout)
    if kernels.stopping():
        raise kernels.Stopped
    executed = canonical(notebook, project.root, [c.id for c in source.cells], _elsewhere(source, project))
    content = filled(executed, source, parameters)
    failure = _failure(content, name, error, client, timeout)
    depends = client.depends if client else {}
    warnings = _warnings(content) + [
        (0, f"left running, and ended: {command}") for command in (client.left if client else ())
    ]
    return Run(content, time.monotonic() - started, failure, warnings, depends)


def loaded(source: Source, parameters: Mapping[str, Any] | None) -> nbformat.NotebookNode:
    """The notebook for papermill, as it was read, whatever the file says now, with its parameters."""
    notebook = load_notebook_node(nbformat.from_dict(copy.deepcopy(source.content)))
    if not parameters:
        return notebook
    notebook.metadata.kernelspec = {"name": "loopbook", "language": "python", "display_name": "loopbook"}
    return parameterize_notebook(notebook, dict(parameters), kernel_name="loopbook", language="python")


def _elsewhere(source: Source, project: Project) -> Path | None:
    folder = source.path.parent
    return None if folder.is_relative_to(project.root) else folder


def _execute(
    notebook: nbformat.NotebookNode, folder: Path, project: Project, timeout: float
) -> tuple[Exception | None, kernels.Client | None]:
    """(the exception that ended the run or None, the client or None where there was no kernel)."""
    for attempt in range(1, kernels.STARTS + 1):
        clients: list[kernels.Client] = []
        options = {
            "clients": clients,
            "timeout": int(timeout),
            "folder": str(folder),
            "env": environment(project),
            "beside": project.beside,
        }
        try:
            papermill_engines.execute_notebook_with_engine(
                "loopbook", notebook, "python3", progress_bar=False, **options
            )
        except kernels.Stopped:
            raise
        except Exception as error:
            started = bool(clients and clients[0].code_cells_executed)
            if started or attempt == kernels.STARTS:
                return error, clients[0] if clients else None
        else:
            return None, clients[0]
    raise AssertionError("unreachable")


def _failure(content: dict, name: str, error: Exception | None, client: Any, timeout: float) -> Failure | None:
    number = 0
    for index, cell in enumerate(content["cells"]):
        tags = cell["metadata"].get("tags", ())
        number += INJECTED not in tags
        if cell["cell_type"] != "code" or not cell["source"].strip() or "skip-execution" in tags:
            continue
        raised = [o for o in cell["outputs"] if o["output_type"] == "error"]
        expected = "raises-exception" in tags
        if raised and not expected:
            return _raised(raised[0], cell, name, number)
        if error is not None and client is not None and client.running == index:
            words = tuple(client.last_words.splitlines()[-2:]) if isinstance(error, DeadKernelError) else ()
            return Failure(name, _ended(error, timeout), cell=number, more=words)
        if cell["execution_count"] is None:
            why = _ended(error, timeout) if error else "not run"
            return Failure(name, why, cell=number)
        if expected and not raised:
            return Failure(name, "is tagged `raises-exception` and raised nothing", cell=number)
    return Failure(name, _ended(error, timeout)) if error else None


def _raised(output: dict, cell: dict, name: str, number: int) -> Failure:
    trace = _ANSI.sub("", "\n".join(output["traceback"]))
    said = [line for line in output["evalue"].strip().splitlines() if line.strip()]
    more = [line.strip()[:200] for line in said[1:4]]
    if found := re.search(r"Cell In\[\d+\], line (\d+)", trace):
        line = int(found[1])
        lines = cell["source"].splitlines()
        if 0 < line <= len(lines):
            more.insert(0, f"line {line}: {lines[line - 1].strip()[:160]}")
    what = f"{output['ename']}: {said[0][:300]}" if said else output["ename"]
    return Failure(name, what, number, tuple(more))


def _ended(error: Exception, timeout: float) -> str:
    if isinstance(error, CellTimeoutError):
        return f"not finished after {timeout:g} s (--timeout sets the limit)"
    if isinstance(error, DeadKernelError):
        early = str(error).startswith("the kernel died")
        return str(error) if early else "the kernel died (killed, out of memory, or ended by the cell)"
    return f"{type(error).__name__}: {str(error).strip() or 'no message'}".splitlines()[0]


def _warnings(content: dict) -> list[tuple[int, str]]:
    found = []
    number = 0
    for cell in content["cells"]:
        number += INJECTED not in cell["metadata"].get("tags", ())
        for output in cell.get("outputs", ()):
            if output["output_type"] == "stream" and output["name"] == "stderr":
                named = [f"{kind}: {text}" for kind, text in _WARNING.findall(output["text"])]
                text = output["text"].strip()
                found += [(number, w) for w in named or [text.splitlines()[0]] if text]
    return found
