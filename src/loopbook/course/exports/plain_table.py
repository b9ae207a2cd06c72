"""A table of all variants: one line for each answer, with its key, its tolerance and what wrong methods give."""

from loopbook.course.exports.variants import Variant
from loopbook.course.grade.grading import as_csv
from loopbook.course.grade.verdicts import shown_raw
from loopbook.course.notebooks import source_of

HEAD = [
    "sheet",
    "variant",
    "question",
    "answer",
    "wants",
    "unit",
    "key",
    "tolerance",
    "points",
    "wrong methods",
    "text",
]


def plain_table(sheet: str, variants: list[Variant]) -> bytes:
    """The CSV, for whatever has no format of its own."""
    rows = [HEAD]
    for variant in variants:
        for place, cell, asked in variant.questions():
            for one in asked:
                tolerance = getattr(one.kind, "tolerance", None)
                wrong = "; ".join(f"{m}: {shown_raw(one.kind.plain(v))}" for m, v in one.wrong.items())
                rows.append(
                    [
                        sheet,
                        str(variant.number),
                        str(place),
                        one.name,
                        one.kind.wants(),
                        one.kind.unit,
                        str(one.kind.plain(one.key)),
                        "conditions" if one.holds else str(tolerance or "exact"),
                        f"{one.points:g}",
                        wrong,
                        source_of(cell),
                    ]
                )
    return as_csv(rows)
