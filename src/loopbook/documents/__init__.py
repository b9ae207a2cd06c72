"""What serves one document only, a folder each, with what it prints as data.

>>> from loopbook.documents import names, printed
>>> names()
['double-tank', 'pid-article', 'pid-report']
>>> printed("double-tank").values["rise-q0.3"].printed
'3.6635'
"""

from loopbook.lazy import attach

TABLE = {name: f"loopbook.documents.open:{name}" for name in ("glossary", "names", "open_document", "printed")}
TABLE["drawing"] = "loopbook.documents.drawings:drawing"
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
