"""What pyproject.toml cannot say: the wheel carries the notebook of the design, which is run where it stands."""

from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

CARRIED = {"notebooks/own_process/design.ipynb": "loopbook/design/design.ipynb"}


class BuildWithNotebook(build_py):
    """Copies it beside the module that looks for it; an editable installation finds the original."""

    def run(self) -> None:
        super().run()
        if not self.editable_mode:
            for source, target in CARRIED.items():
                place = Path(self.build_lib) / target
                place.parent.mkdir(parents=True, exist_ok=True)
                self.copy_file(source, str(place))


setup(cmdclass={"build_py": BuildWithNotebook})
