"""Who asks: the notebook and its own modules, or a library that is installed."""

import os
import sys
import sysconfig
from types import FrameType

ABOUT_KERNELS = ("IPython", "ipykernel", "jupyter_client", "traitlets", "debugpy", "comm", "tornado", "zmq")


def _installed_places() -> tuple[str, ...]:
    places = {sysconfig.get_path(name) for name in ("purelib", "platlib", "stdlib", "platstdlib")}
    return tuple(os.path.join(p, "") for p in places | {os.path.dirname(os.__file__)} if p)


INSTALLED = _installed_places()


def installed(filename: str) -> bool:
    """Is it a file of the standard library or of an installed package?"""
    return filename.startswith(INSTALLED) or filename.startswith("<frozen")


HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "")


def caller(passed: tuple[str, ...]) -> str:
    """The file of the nearest function that is not of this folder and not in one of the modules passed over."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        name = frame.f_code.co_filename
        between = name.startswith((HERE, "<frozen os", "<frozen posixpath", "<frozen genericpath"))
        between = between or "_collections_abc" in name or "pathlib" in name
        if not between and os.path.basename(name) not in passed:
            return name
        frame = frame.f_back
    return ""


def package(filename: str) -> str:
    """The installed package that a file belongs to."""
    return filename.rpartition("site-packages" + os.sep)[2].split(os.sep)[0]
