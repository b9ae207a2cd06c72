"""Where there are no private sockets kernels run over TCP, and their start, nothing else, is tried again.

The tests keep the private sockets: TCP itself loses a kernel now and then on a busy machine, which is why.
"""

import pytest

from notebook_reports.run import kernels

pytestmark = pytest.mark.builds


@pytest.fixture(autouse=True)
def three_starts(monkeypatch):
    monkeypatch.setattr(kernels, "STARTS", 3)


def failing(monkeypatch, times):
    """Let the first starts fail as they do when a port is taken."""
    begin = kernels.PrivateKernelManager._async_start_kernel
    tried = []

    async def start(self, **kwargs):
        tried.append(self)
        if len(tried) <= times:
            raise RuntimeError("Kernel died before replying to kernel_info")
        await begin(self, **kwargs)

    monkeypatch.setattr(kernels.PrivateKernelManager, "_async_start_kernel", start)
    monkeypatch.setattr(kernels.PrivateKernelManager, "start_kernel", start)
    return tried


def test_a_start_is_tried_three_times(bench, monkeypatch):
    bench.write("a/b", "# A", "1 + 1")
    tried = failing(monkeypatch, 2)
    assert bench.build().code == 0, bench.said
    assert len(tried) == 3


def test_and_then_it_is_a_failure(bench, monkeypatch):
    bench.write("a/b", "# A", "1 + 1")
    tried = failing(monkeypatch, 3)
    assert bench.build().code == 1 and len(tried) == 3
    assert "Kernel died before replying to kernel_info" in bench.said


def test_a_notebook_that_began_is_not_run_again(bench):
    bench.write("a/b", "# A", "open('count', 'a').write('x'); import os; os._exit(1)")
    assert bench.build().code == 1
    assert (bench.root / "notebooks/a/count").read_text() == "x"


def test_the_connection_is_as_the_system_allows(monkeypatch):
    for transport in ("ipc", "tcp"):
        monkeypatch.setattr(kernels, "TRANSPORT", transport)
        manager = kernels.PrivateKernelManager()
        assert manager.transport == transport
        assert manager.ip.startswith(str(manager.private)) == (transport == "ipc")
        manager.private.rmdir()
