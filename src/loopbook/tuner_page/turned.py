"""`lb.tuner`: a loop whose knobs can be turned, in a notebook, in its report, as a page."""

import tempfile
import webbrowser
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from loopbook.tuner_page.page import page
from loopbook.tuner_page.script import MIME
from loopbook.tuner_page.settings import settings
from loopbook.tuner_page.still import loop_of, regulator_of, still_svg
from loopbook.tuner_page.widget import widget

FIGURE = "application/vnd.loopbook.figure+json"
CAPTION = "The loop as it begins: output and input after a set-point step and a load step, and its Nyquist curve."
HINT = " In the HTML report its knobs can be turned."


@dataclass(frozen=True)
class TurnedLoop:
    """A loop as the page shows it. It displays itself: in a report's HTML the page, on paper and elsewhere the figure.

    data: see `loopbook.tuner_page.settings`. caption: of the figure, inline text of the press.
    """

    data: Mapping[str, Any]
    caption: str = CAPTION + HINT
    alt: str = field(default="Output and input over time, and the Nyquist curve beside the point -1.")

    @property
    def loop(self) -> Any:
        """The loop that the page begins with: a `Loop`, of a pole placement a `SampledLoop`."""
        return loop_of(self.data)

    @property
    def pid(self) -> Any:
        """Its regulator in the standard form."""
        return regulator_of(self.data)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        told = {"caption": self.caption, "alt": self.alt}
        picture = still_svg(self.data)
        return {MIME: dict(self.data), FIGURE: told, "image/svg+xml": picture, "text/plain": f"Figure: {self.caption}"}

    def page(self, title: str = "Turn the knobs") -> str:
        """The page as text, complete in itself."""
        return page(self.data, title, "a loop with exact dead time", still_svg(self.data))

    def save(self, path: str | Path) -> Path:
        """Write the page; returns where."""
        path = Path(path)
        path.write_text(self.page(), encoding="utf-8")
        return path

    def open(self) -> Path:
        """Write the page among the temporary files and open it in the browser."""
        path = self.save(Path(tempfile.mkdtemp(prefix="loopbook")) / "tuner.html")
        webbrowser.open(path.as_uri())
        return path

    def widget(self) -> Any:
        """The same in JupyterLab, its values to be read back: `loopbook.tuner_page.widget`; needs anywidget."""
        return widget(self.data)


def tuner(process: Any, pid: Any = None, *, caption: str = "", alt: str = "", **more: Any) -> TurnedLoop:
    """A loop whose knobs can be turned: one line in a notebook, the page in its HTML, the figure in its PDF.

    process: a `Process` or what has one. pid: a PID form, a `Tuning`, `PidSettings`, a gain; None to have one chosen.
    more: of `loopbook.tuner_page.settings.settings`: limits, h, steps, uncertainty, record, names, poles, name.
    Raises TunerError for what has no knobs.

    >>> from loopbook.process.transfer_function import Process
    >>> turned = tuner(Process.fopdt(2, 10, 3), 0.5)
    >>> turned.data["state"]["T1"], turned.pid.K
    (10.0, 0.5)
    """
    process = getattr(process, "process", process)
    words = {key: value for key, value in (("caption", caption), ("alt", alt)) if value}
    return TurnedLoop(settings(process, pid, **more), **words)
