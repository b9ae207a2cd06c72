"""The tuner as a widget of JupyterLab: the same script, its state shared with Python."""

from collections.abc import Mapping
from typing import Any

from loopbook.controllers.pid_forms import PidStandard
from loopbook.extras import needed
from loopbook.tuner_page.bundle import bundle
from loopbook.tuner_page.script import generated
from loopbook.tuner_page.still import loop_of, regulator_of


def module() -> str:
    """The ES module that anywidget loads."""
    return bundle("widget.js", generated(), returned="loopbookTuner") + "export default loopbookTuner.widget;\n"


def widget(data: Mapping[str, Any]) -> Any:
    """A widget that begins with `data`. Its `state` follows the knobs; `pid` and `loop` are made of it.

    Raises an error that says what to install where anywidget is not there.
    """
    anywidget = needed("anywidget", "widget")
    import traitlets

    class TunerWidget(anywidget.AnyWidget):  # type: ignore[misc, name-defined]
        _esm = module()
        data = traitlets.Dict().tag(sync=True)
        state = traitlets.Dict().tag(sync=True)

        @property
        def pid(self) -> PidStandard:
            """The regulator as the knobs stand, in the standard form."""
            return regulator_of({**self.data, "state": self.state})

        @property
        def loop(self) -> Any:
            """The loop as the knobs stand."""
            return loop_of({**self.data, "state": self.state})

    return TunerWidget(data=dict(data), state=dict(data["state"]))
