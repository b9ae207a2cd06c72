"""A drawing of a document, from its data to the page: the figure with its caption and its description."""

from loopbook.plots import block_diagram, circuit
from notebook_reports.display import Figure, figure


def drawing(data: block_diagram.Diagram | circuit.Circuit) -> Figure:
    """The figure of a block diagram or a circuit; its caption and the words for those who do not see it are the data's.

    >>> from loopbook.documents.pid_report.diagrams import CRUISE_CONTROL
    >>> drawing(CRUISE_CONTROL).alt.partition(";")[0]
    'Block diagram: comparison takes set point and minus car'
    """
    fig = circuit.drawn(data) if isinstance(data, circuit.Circuit) else block_diagram.drawn(data)
    return figure(fig, data.caption, data.told())
