"""Import nbformat without the seconds that it does not need.

nbformat imports jsonschema, which imports rfc3987_syntax where that is installed (JupyterLab brings it): a parser of
international web addresses, built at import, 1.2 s and more in every process. Notebooks hold none to check, and
jsonschema does without. So for the time of the import the package is said to be absent.
"""

import sys

SLOW = "rfc3987_syntax"


def import_nbformat() -> None:
    """Call it before anything imports nbformat; where it is imported already, nothing happens."""
    if "nbformat" in sys.modules or SLOW in sys.modules:
        return
    sys.modules[SLOW] = None  # type: ignore[assignment]
    try:
        import nbformat  # noqa: F401
    finally:
        del sys.modules[SLOW]
