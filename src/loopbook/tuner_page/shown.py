"""The tuner in a report's page: what the press asks an installed package for, and the page that stands alone."""

from collections.abc import Mapping
from typing import Any

from loopbook.process.transfer_function import Process
from loopbook.tuner_page.page import page
from loopbook.tuner_page.script import PLACE, script
from loopbook.tuner_page.settings import settings
from loopbook.tuner_page.still import still_svg

TITLE = "Turn the knobs"
ABOUT = "a PID loop with exact dead time: what its margins and responses do"


def shown(data: Mapping[str, Any]) -> tuple[str, str]:
    """(script, markup) for `notebook_reports.export.scripts`."""
    if not isinstance(data, Mapping) or "state" not in data:
        raise ValueError("the data of a tuner have a state")
    return script(), PLACE


def complete() -> tuple[str, str, str]:
    """(title, what it is, text) of the page of its own, for `notebook_reports.pages`."""
    data = settings(Process.fopdt(2.0, 40.0, 8.0))
    return TITLE, ABOUT, page(data, TITLE, ABOUT, still_svg(data, usual=True))
