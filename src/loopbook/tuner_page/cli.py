"""``loopbook tune``: a page on which the knobs of a loop are turned, from a record, a model, a regulator or nothing."""

import webbrowser
from pathlib import Path

import click

from derivations.errors import LoopbookError
from notebook_reports.project import atomic


@click.command("tune")
@click.argument("data", required=False, type=click.Path(path_type=Path), metavar="[RECORD|MODEL|REGULATOR]")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="PAGE.HTML",
              help="Where the page goes; default: beside the data, or tuner.html here.")  # fmt: skip
@click.option("--open", "opened", is_flag=True, help="Open it in the browser.")
def tune_page(data: Path | None, output: Path | None, opened: bool) -> None:
    """A page on which the knobs of a loop are turned: one file that needs nothing, with exact dead time.

    From a record (CSV, spreadsheet, Parquet): the identified model with the recommended regulator, the record behind
    it. From a model (TOML) or a regulator (JSON of loopbook design or of the page): these. Without: a first example.
    Exit codes: 0 written, 2 the data or an option is wrong.
    """
    from loopbook.tuner_page.files import of_file
    from loopbook.tuner_page.shown import complete

    if data is not None and not data.is_file():
        raise click.UsageError(f"there is no file {data}")
    try:
        text = of_file(data).page(f"{data.stem}: turn the knobs") if data else complete()[2]
    except LoopbookError as error:
        told = str(error)
        raise click.UsageError(told if data is None or data.name in told else f"{data.name}: {told}") from None
    target = output or (data.with_name(f"{data.stem}-tuner.html") if data else Path("tuner.html"))
    atomic.write(target, text.encode())
    click.echo(target)
    if opened:
        webbrowser.open(target.resolve().as_uri())
