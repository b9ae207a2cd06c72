"""Put beside an unpacked wheel as `sitecustomize`: every Python that finds it there refuses what is not declared."""

import json
import sys
from pathlib import Path

REFUSED = frozenset(json.loads(Path(__file__).with_name("refused.json").read_text(encoding="utf-8")))


class Refuse:
    """A finder that is asked first and finds nothing: a package counts as not installed."""

    @staticmethod
    def find_spec(name, path=None, target=None):
        if name.split(".")[0] in REFUSED:
            raise ModuleNotFoundError(f"{name} is not declared by the extra in use", name=name)
        return None


sys.meta_path.insert(0, Refuse)
