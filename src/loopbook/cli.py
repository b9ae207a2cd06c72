"""The `loopbook` command."""

import sys
from pathlib import Path

import click

from notebook_reports.cli import main
from notebook_reports.project.project import Project


@main.command()
@click.argument("data", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="DATA...")
@click.option("-o", "--report", type=click.Path(path_type=Path), metavar="FILE|DIR",
              help="The report (.pdf, .html, .ipynb, .json) or their folder; default: beside the data.")  # fmt: skip
@click.option("--aim", type=click.Choice(["robust", "fast", "no-overshoot", "quiet"]), help="What is recommended.")
@click.option("--time", "time_column", metavar="COLUMN", help="The record's column of the time.")
@click.option("--input", "input_column", metavar="COLUMN", help="The record's column of the input.")
@click.option("--output", "output_column", metavar="COLUMN", help="The record's column of the output.")
@click.option("-p", "--parameter", "parameters", type=(str, str), multiple=True, metavar="NAME VALUE",
              help="Any other parameter of the notebook own_process/design.")  # fmt: skip
@click.option("--format", "formats", default="pdf", show_default=True, help="What to write: pdf,html,ipynb,json.")
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Kernels at a time; default: one per core.")
@click.pass_obj
def design(project: Project, data, report, aim, time_column, input_column, output_column, parameters, formats, jobs):
    """A regulator for your own process, from recorded step tests (CSV) or models (TOML).

    Many records at once: loopbook design *.csv -o reports/. The designs run in parallel; a record that no model can be
    made of does not stop the others, is named at the end, and makes the exit code 1.
    """
    from notebook_reports.build.apply import apply, items

    given = {"aim": aim, "time": time_column, "input": input_column, "output": output_column}
    chosen = [f.strip() for f in formats.split(",") if f.strip()]
    wanted = items(data, report, "design", chosen)
    notebook = project.notebooks_folder / "own_process" / "design.ipynb"
    if not notebook.is_file():
        notebook = Path(__file__).parents[2] / "notebooks" / "own_process" / "design.ipynb"
    named = [(k, v) for k, v in given.items() if v is not None]
    where = ["-o", str(report)] if report else []
    kinds = ["--format", formats] if chosen != ["pdf"] else []
    ready = "loopbook.design.ready:derive"
    sys.exit(
        apply(
            project,
            notebook,
            wanted,
            [*named, *parameters],
            jobs=jobs,
            repeat=["loopbook", "design", *where, *kinds],
            ready=ready,
        ).code
    )


if __name__ == "__main__":
    main()
