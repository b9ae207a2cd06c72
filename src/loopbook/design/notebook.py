"""Where the notebook of the design is: in the project at hand, in the package, or in the sources beside it."""

from pathlib import Path

NAME = Path("own_process") / "design.ipynb"
HERE = Path(__file__).parent


def design_notebook() -> Path:
    """The notebook that ``loopbook design`` runs: the package's own, never that of the folder it is called in.

    An installed package carries it; run from the sources it is the one in ``notebooks/``.
    """
    sources = HERE.parents[2] / "notebooks" / NAME
    found = next((place for place in (HERE / NAME.name, sources) if place.is_file()), None)
    if found is None:
        raise FileNotFoundError(f"the installation lacks {HERE / NAME.name}: install loopbook again")
    return found
