"""The script of the tuner's page: readable modules put together as one classic script.

Each module is one file of `js/`. An import names what it takes, ``import { a, b } from "./file.js";``, an export stands
before a function, class or constant. All modules share one scope, so a name at the top of a module is given once in the
whole script; that, and everything else which would make the bundle differ from the modules, is an error here.
The result is made small by `loopbook.tuner_page.small`.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from posixpath import dirname, normpath
from types import MappingProxyType

from derivations.errors import LoopbookError
from loopbook.tuner_page.small import small

FOLDER = Path(__file__).parent / "js"
IMPORT = re.compile(r'import \{([^}]*)\} from "([^"]+)";\n')
TOP = re.compile(r"^(?:export )?(?:async )?(?:function|class|const|let)\s+(\w+)", re.M)
EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const|let)\b)", re.M)


OWN = frozenset(
    re.findall(
        r"\w+",
        """arriving axes bad_measurement band banding bandSoon before begin beginning blocks boxes branch
        branchEnd buttons cautions chips clearance clipped colour colours constants count crossing crossings
        current curvature curve curveAt dead deadTime deepest defaults delay depth disc distance draw drawn
        drawRecord edges element evaluated extra extremes falls first firstLag firstViolation formKnobs
        formShown frame future gainAtInfinity gainCrossovers gainLow given grab grid holding horizon
        instants integralOfMagnitude inverse kdLimit kept keyRow keyTold kindShown knobs lacks lacksEqual
        lags largest lastFrequency lastStable later limited limited_high limited_low line listeners
        logMagnitude logSlope logX logY magnitude main margins mark modes monotonePhase nodes notes onAxis
        outputs overflow overshoot ownUnits part past phaseAtStart phaseCrossovers pinButton placed plant
        plotCard plots polished possible printing quiet rangeAround rate_limited rate_step readAddress
        reference refresh refusals replay replayed result rows rowsTold rule ruleCard rulesFor scaled scales
        second secondTouch settle settling shortcut show showKnobs showRules shows signals slider stable
        stairs started startPhase survey tails toCoefficients transfer travel typedIn undershoot
        unstableRoots useRule usual valueOf variation view waiting wanted whole worst writeAddress writing
        written xLabels xTicks y_last y_sp_last yTicks""",
    )
)
"""Properties of the page's own objects that get shorter names in the bundle: long ones, and those used often.

None is used of an object of the browser's, nor named in a text.
"""


class BundleError(LoopbookError):
    """The modules do not make one script; the message names the module."""


def read(name: str) -> str:
    """The text of a module, by its path in `js/`."""
    return (FOLDER / name).read_text(encoding="utf-8")


def _imports(name: str, text: str) -> list[tuple[str, list[str]]]:
    """(module, names) of each import."""
    found = []
    for names, place in IMPORT.findall(text):
        target = normpath(f"{dirname(name)}/{place}").lstrip("/")
        found.append((target, [n.strip() for n in names.split(",") if n.strip()]))
    return found


def _in_order(entry: str, more: dict[str, str]) -> dict[str, str]:
    """Every module that an entry reaches, those that are imported first. more: texts of modules that are no files."""
    texts: dict[str, str] = {}
    waiting: list[str] = []

    def visit(name: str) -> None:
        if name in texts:
            return
        if name in waiting:
            raise BundleError(f"{name}: modules import each other in a circle: {' -> '.join([*waiting, name])}")
        text = more.get(name) or read(name)
        waiting.append(name)
        for other, names in _imports(name, text):
            visit(other)
            missing = sorted(set(names) - set(exports(texts[other])))
            if missing:
                raise BundleError(f"{name}: {other} does not export {', '.join(missing)}")
        waiting.remove(name)
        texts[name] = text

    visit(entry)
    return texts


def exports(text: str) -> list[str]:
    """The names that a module exports."""
    return re.findall(r"^export (?:async )?(?:function|class|const|let)\s+(\w+)", text, re.M)


def _plain(name: str, text: str) -> str:
    """A module without imports and exports."""
    body = EXPORT.sub("", IMPORT.sub("", text))
    if re.search(r"^(import|export)\b", body, re.M):
        raise BundleError(f"{name}: an import or export of a form that the bundle does not know")
    if re.search(r"^(const|let)\s*[\[{]", body, re.M):
        raise BundleError(f"{name}: a pattern at the top of a module; give each name a declaration")
    return body


def _bundled(entry: str, more: dict[str, str]) -> tuple[str, list[str]]:
    texts = _in_order(entry, more)
    owner: dict[str, str] = {}
    for name, text in texts.items():
        for top in TOP.findall(text):
            if owner.setdefault(top, name) != name:
                raise BundleError(f"{name}: {top} is a name of {owner[top]} as well; all modules share one scope")
    return "\n".join(_plain(name, text) for name, text in texts.items()), exports(texts[entry])


def bundle(entry: str, more: Mapping[str, str] = MappingProxyType({}), returned: str = "") -> str:
    """One script of an entry module and all that it imports.

    more: texts of generated modules by their path in `js/`. returned: the name of a global that holds what the entry
    exports; "" for none. What others see keeps its names.
    """
    body, names = _bundled(entry, dict(more))
    head, tail = ('"use strict";\n(() => {\n', "\n})();\n")
    if returned:
        head = f'"use strict";\nconst {returned} = (() => {{\n'
        tail = f"\nreturn {{ {', '.join(names)} }};\n}})();\n"
    return head + small(body, frozenset(names), frozenset() if returned else OWN) + tail
