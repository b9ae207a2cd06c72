"""A kernel per notebook: on sockets of its own, in an environment that gives the same bytes on every run.

Parallel kernels on TCP race for ports, and share one default path on IPC; here each has a private folder for its
sockets. Where IPC does not exist (Windows) TCP is used, and a start that fails for its port is tried again.
"""

import ast
import asyncio
import json
import math
import os
import shutil
import signal
import sys
import threading
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Empty
from typing import Any

from jupyter_client.asynchronous import AsyncKernelClient
from jupyter_client.kernelspec import KernelSpec
from jupyter_client.manager import AsyncKernelManager
from jupyter_client.provisioning.local_provisioner import LocalProvisioner
from nbclient.exceptions import DeadKernelError
from papermill.clientwrap import PapermillNotebookClient
from traitlets import Type

from notebook_reports.errors import PressError
from notebook_reports.project import runtime
from notebook_reports.run import leftovers
from notebook_reports.run.surroundings import of_one_kernel
from notebook_reports.run.warm import Warm

TRANSPORT = "tcp" if sys.platform == "win32" else "ipc"
STARTS = 3 if TRANSPORT == "tcp" else 1

_alive: set["PrivateKernelManager"] = set()
_warm: Warm | None = None
_lock = threading.Lock()
_stopping = threading.Event()


class Stopped(PressError):
    """The build was interrupted; no kernel is started any more."""


class NoAccount(PressError):
    """A kernel ran to its end and cannot say what it read: its report could not be known to be up to date."""


class WarmProvisioner(LocalProvisioner):
    """jupyter_client's way to start a kernel, by a fork where that works."""

    warm: Warm | None = None
    process: Any  # a Popen, or a `Forked` that does what is asked of one

    async def launch_kernel(self, cmd: list[str], **kwargs: Any) -> Any:
        kernel = None
        if self.warm is not None:
            arguments = cmd[cmd.index("ipykernel_launcher") :]
            order = (arguments, kwargs["env"], str(kwargs["cwd"]), kwargs["stderr"].fileno())
            kernel = await asyncio.to_thread(self.warm.fork, *order)
        if kernel is None:
            return await super().launch_kernel(cmd, **kwargs)
        self.process = kernel
        self.pid = self.pgid = kernel.pid
        self.cwd = kwargs["cwd"]
        return self.connection_info


class ReadyClient(AsyncKernelClient):
    """jupyter_client's client, that knows a kernel to be ready by what it says, not by silence after it."""

    async def _async_wait_for_ready(self, timeout: float | None = None) -> None:
        ends = time.monotonic() + (timeout or math.inf)
        while True:
            asked = self.kernel_info()
            try:
                reply = await self.shell_channel.get_msg(timeout=1)
                while reply["parent_header"].get("msg_id") != asked:
                    reply = await self.shell_channel.get_msg(timeout=1)
                while True:  # what comes before belongs to no cell; without a last word the channel was not open yet
                    said = await self.iopub_channel.get_msg(timeout=0.1)
                    last = said["msg_type"] == "status" and said["content"]["execution_state"] == "idle"
                    if last and said["parent_header"].get("msg_id") == asked:
                        self._handle_kernel_info_reply(reply)
                        return
            except Empty:
                pass
            if not await self._async_is_alive():
                raise DeadKernelError("the kernel died before it was ready")
            if time.monotonic() > ends:
                raise RuntimeError(f"the kernel was not ready after {timeout:g} s")

    wait_for_ready = _async_wait_for_ready


class PrivateKernelManager(AsyncKernelManager):
    """Starts this Python's kernel, whatever name the notebook gives it, on sockets in a folder of its own."""

    client_factory = Type(ReadyClient)

    def __init__(self, **kwargs: Any):
        self.private = runtime.make()
        self.kernel: int | None = None
        self.left: list[str] = []
        kwargs.update(transport=TRANSPORT, connection_file=str(self.private / "c.json"))
        if TRANSPORT == "ipc":
            kwargs["ip"] = str(self.private / "k")
        super().__init__(**kwargs)

    @property
    def kernel_spec(self) -> KernelSpec:
        command = [sys.executable, "-P", "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        return KernelSpec(argv=command, display_name="Python 3", language="python", name="python3")

    async def _async_pre_start_kernel(self, **kwargs: Any) -> Any:
        if self.provisioner is None:
            self.kernel_id = kwargs.pop("kernel_id", None) or self.kernel_id or str(uuid.uuid4())
            self.provisioner = WarmProvisioner(kernel_id=self.kernel_id, kernel_spec=self.kernel_spec, parent=self)
            self.provisioner.warm = _warm
        return await super()._async_pre_start_kernel(**kwargs)

    pre_start_kernel = _async_pre_start_kernel

    async def _async_start_kernel(self, **kwargs: Any) -> None:
        with _lock:
            if _stopping.is_set():
                raise Stopped
            _alive.add(self)
        kwargs["env"] = {**(kwargs.get("env") or os.environ), **of_one_kernel(self.private)}
        await super()._async_start_kernel(**kwargs)
        self.kernel = getattr(self.provisioner, "pid", None)

    start_kernel = _async_start_kernel

    async def _async_wait(self, pollinterval: float = 0.1) -> None:
        await super()._async_wait(pollinterval=min(pollinterval, 0.01))

    async def _async_cleanup_resources(self, restart: bool = False) -> None:
        await super()._async_cleanup_resources(restart=restart)
        with _lock:
            _alive.discard(self)
        self.left += await asyncio.to_thread(leftovers.end, self.private, self.kernel)
        shutil.rmtree(self.private, ignore_errors=True)

    cleanup_resources = _async_cleanup_resources


class Client(PapermillNotebookClient):
    """papermill's client on a private kernel that is not waited for at the end. beside: may the notebook import what
    lies in its folder?"""

    def __init__(self, nb_man: Any, beside: bool = True, **kwargs: Any):
        kwargs.update(
            kernel_manager_class=PrivateKernelManager,
            shutdown_kernel="immediate",
            extra_arguments=[
                "--ext=notebook_reports.run.kernel_side",
                "--HistoryManager.enabled=False",
                "--InlineBackend.figure_formats=svg",
                f"--InteractiveShellApp.ignore_cwd={not beside}",
            ],
            on_cell_start=self._start,
        )
        self.running = 0
        self.depends: dict[str, Any] = {}
        self.last_words = ""
        self.manager: PrivateKernelManager | None = None
        super().__init__(nb_man, **kwargs)

    def create_kernel_manager(self) -> Any:
        self.manager = super().create_kernel_manager()
        return self.manager

    @property
    def left(self) -> list[str]:
        """The processes that the notebook left running; they were ended."""
        return self.manager.left if self.manager else []

    def _start(self, cell: Any, cell_index: int) -> None:
        self.running = cell_index

    def papermill_execute_cells(self) -> None:
        """Run the cells, then ask the kernel what it read; see `watching.report`."""
        try:
            super().papermill_execute_cells()
        finally:
            if self.manager is not None:  # before the kernel ends, and with it some of them unnamed
                self.manager.left += leftovers.end(self.manager.private, self.manager.kernel)
        ask = "__import__('json').dumps(__import__('sys').modules['notebook_reports.run.watching'].report())"
        message = self.kc.execute("", silent=True, store_history=False, user_expressions={"report": ask})
        answer = self.wait_for_reply(message)["content"].get("user_expressions", {}).get("report", {})
        if answer.get("status") != "ok":
            raise NoAccount(f"the kernel does not say what it read: {answer.get('evalue', 'no answer')}")
        self.depends = json.loads(ast.literal_eval(answer["data"]["text/plain"]))


@contextmanager
def forked_from(warm: Warm | None) -> Iterator[None]:
    """Kernels of this block are forked from the warm process, where there is one. None is left at the end."""
    global _warm
    _stopping.clear()
    _warm = warm
    try:
        yield
    finally:
        _warm = None
        if warm is not None:
            warm.close()


def lost_its_parent() -> bool:
    """Did the process that kernels are forked from end by itself? Its kernels end with it, through no fault of a
    notebook; from now on none is forked."""
    return _warm is not None and not _warm.alive()


def stopping() -> bool:
    """Was the build interrupted?"""
    return _stopping.is_set()


def kill_all() -> None:
    """End every kernel now and start no other: for Ctrl-C. The threads that wait for them see a dead kernel."""
    with _lock:
        _stopping.set()
        managers = list(_alive)
    if _warm is not None:
        _warm.kill()
    for manager in managers:
        process = getattr(manager.provisioner, "process", None)
        if process is None or process.poll() is not None:
            continue
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except (AttributeError, OSError):
            process.kill()
        leftovers.end(manager.private, process.pid)
