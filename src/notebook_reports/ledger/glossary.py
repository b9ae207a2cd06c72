"""The terms of the documents side by side: Swedish, Polish, English, symbol and unit."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from notebook_reports.display import Table
from notebook_reports.project.toml import read_toml, tables


@dataclass(frozen=True)
class Term:
    """One term; tables: the tables of pid-report that define its variable."""

    en: str
    sv: str = ""
    pl: str = ""
    symbol: str = ""
    unit: str = ""
    tables: tuple[str, ...] = ()


@cache
def terms(source: Path) -> tuple[Term, ...]:
    """All terms in the order of the file. Raises ValueError where an English term stands twice or a key is unknown."""
    found = []
    for number, entry in enumerate(tables(read_toml(source), "term", source.name), 1):
        unknown = set(entry) - set(Term.__dataclass_fields__)
        if unknown or not entry.get("en"):
            raise ValueError(f"{source.name}, term {number}: {sorted(unknown) or 'no English term'}")
        found.append(Term(**{**entry, "tables": tuple(entry.get("tables", ()))}))
    names = [term.en for term in found]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise ValueError(f"{source.name}: {', '.join(sorted(twice))} stands twice")
    return tuple(found)


def variables(source: Path, table: str) -> tuple[Term, ...]:
    """The variables of one table, by its number. Raises ValueError for a table that has none."""
    known = terms(source)
    found = tuple(term for term in known if table in term.tables)
    if not found:
        raise ValueError(f"no variables for table {table!r}; tables {sorted({t for x in known for t in x.tables})}")
    return found


def glossary(source: Path, table: str = "") -> Table:
    """The glossary as a table, whole or for the variables of one table of pid-report."""
    chosen = variables(source, table) if table else terms(source)
    rows = [[t.symbol, t.en, t.sv, t.pl, t.unit] for t in chosen]
    caption = f"The variables of Table {table} of pid-report" if table else "Terms of the three documents"
    return Table(["symbol", "English", "Swedish", "Polish", "unit"], rows, caption, ["left"] * 5)
