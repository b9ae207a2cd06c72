"""The press's command: build, list, check, new, doctor, verify."""

import math
import sys
import warnings
from pathlib import Path
from typing import Any

import click

from notebook_reports.project.outline import CODE
from notebook_reports.project.printable import printable, take_any_text
from notebook_reports.project.project import (
    EnvironmentProblem,
    Project,
    UsageError,
    find_project,
    no_project,
    project_at,
)

HELP = {"help_option_names": ["-h", "--help"]}


def say(text: str, err: bool = False) -> None:
    """Print a line; what came from data is text in it."""
    click.echo(printable(text), err=err)


class Seconds(click.FloatRange):
    """A time: a finite number, at least `min`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        found = super().convert(value, param, ctx)
        if not math.isfinite(found):
            self.fail(f"{value!r} is no number of seconds", param, ctx)
        return found


class Command(click.Group):
    """Turns what a person can mend into one line and an exit code: 2 usage and parameters, 3 environment."""

    def invoke(self, ctx: click.Context) -> Any:
        take_any_text()
        if not sys.warnoptions:
            warnings.simplefilter("ignore")  # of the libraries of this process; what notebooks warn of is reported
        try:
            return super().invoke(ctx)
        except UsageError as error:
            say(f"loopbook: {error}", err=True)
            ctx.exit(2)
        except EnvironmentProblem as error:
            say(f"loopbook: {error}", err=True)
            ctx.exit(3)
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            ctx.exit(130)


@click.group(cls=Command, context_settings=HELP)
@click.version_option(package_name="loopbook", prog_name="loopbook")
@click.option(
    "--root",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="The project's folder; one that is named may be another user's.",
)
@click.pass_context
def main(ctx: click.Context, root: Path | None) -> None:
    """Run the notebooks, write their reports, keep the ledger of what the documents print.

    Exit codes: 0 all good, 1 a notebook or a check failed, 2 usage or parameters, 3 the environment.
    """
    command = main.get_command(ctx, ctx.invoked_subcommand or "")
    if getattr(command, "needs_project", True):
        ctx.obj = project_at(root) if root else find_project()
    else:
        ctx.obj = no_project(Path.cwd(), beside=False)


@main.command()
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.option("-p", "--parameter", "parameters", type=(str, str), multiple=True, metavar="NAME VALUE",
              help="A parameter of the notebook; the report goes to reports/custom or -o DIR.")  # fmt: skip
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Kernels at a time; default: one per core.")
@click.option("--format", "formats", default="pdf,html,ipynb", show_default=True, help="What to write.")
@click.option("-o", "--output", type=click.Path(file_okay=False, path_type=Path), metavar="DIR",
              help="Where the reports go; the ledger's files are then left alone.")  # fmt: skip
@click.option("--force", is_flag=True, help="Run everything, whether it changed or not.")
@click.option("--accept", is_flag=True, help="Write the ledger's files though a verdict or a printed digit moved.")
@click.option("--frozen", is_flag=True, help="Fail where the ledger's files would change at all (for CI).")
@click.option("--code", type=click.Choice(CODE), help="Where the book has its code: in place, at the end of each "
              "chapter, or nowhere; default: what notebooks/book.toml says.")  # fmt: skip
@click.option("--timeout", type=Seconds(min=1), default=600.0, show_default=True, metavar="S",
              help="Seconds that one cell may take.")  # fmt: skip
@click.option("--watch", is_flag=True, help="Build again whenever a file changes, until Ctrl-C.")
@click.pass_obj
def build(
    project: Project,
    notebooks: tuple[str, ...],
    parameters: tuple[tuple[str, str], ...],
    jobs: int | None,
    formats: str,
    output: Path | None,
    force: bool,
    accept: bool,
    frozen: bool,
    code: str | None,
    timeout: float,
    watch: bool,
) -> None:
    """Run notebooks and write their reports, where something they depend on changed.

    NOTEBOOK is double_tank/03_pole_placement, double_tank/03, double_tank or a path; default: all.
    """
    from notebook_reports.build.build import build as run_build
    from notebook_reports.build.job import Wanted

    chosen = tuple(dict.fromkeys(f.strip() for f in formats.split(",") if f.strip()))
    wanted = Wanted(chosen, output=output.resolve() if output else None, force=force, timeout=timeout, code=code or "")
    if watch:
        from notebook_reports.build.watch import watch as run_watch

        run_watch(project, notebooks, parameters, wanted, {"jobs": jobs, "accept": accept, "frozen": frozen})
        return
    sys.exit(run_build(project, notebooks, parameters, wanted, jobs, accept, frozen).code)


@main.command("list")
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.pass_obj
def list_notebooks(project: Project, notebooks: tuple[str, ...]) -> None:
    """The notebooks, their titles and parameters.

    NOTEBOOK is double_tank/03_pole_placement, double_tank/03, double_tank or a path; default: all.
    """
    from notebook_reports.project.parameters import read_parameters
    from notebook_reports.project.source import read_source

    chosen = project.select(notebooks)
    width = max(len(n.id) for n in chosen)
    broken = 0
    for notebook in chosen:
        try:
            source = read_source(notebook.path)
            parameters = read_parameters(source).values()
        except UsageError as error:
            say(f"{notebook.id:{width}}  {error}")
            broken += 1
            continue
        say(f"{notebook.id:{width}}  {source.title}")
        for parameter in parameters:
            unit = f"  # {parameter.comment}" if parameter.comment else ""
            say(f"{'':{width}}    -p {parameter.name} {parameter.default!r}{unit}")
    sys.exit(1 if broken else 0)


@main.command()
@click.argument("document", required=False, default="")
@click.argument("place", required=False, default="")
@click.option("--format", "form", type=click.Choice(["text", "json", "csv", "md"]), default="text", show_default=True)
@click.pass_obj
def check(project: Project, document: str, place: str, form: str) -> None:
    """The ledger: what holds, and every row that does not.

    DOCUMENT is as the ledger names it, PLACE as the document names it: "Table 5.2".
    """
    from notebook_reports.ledger import check as ledger

    chosen = ledger.read_ledger(project).of(document, place)
    forms = {"json": ledger.as_json, "csv": ledger.as_csv, "md": ledger.as_markdown}
    say(forms[form](chosen) if form in forms else ledger.as_text(chosen, whole=bool(place)))
    failed = (project.cache / "failures.txt").exists()
    if failed:
        click.echo("\nthe last build failed; `loopbook build` says where", err=True)
    sys.exit(1 if failed or chosen.failing else 0)


@main.command()
@click.argument("ref", default="HEAD")
@click.option("--format", "form", type=click.Choice(["text", "md"]), default="text", show_default=True)
@click.option("--reports", type=click.Path(path_type=Path, exists=True, file_okay=False), metavar="FOLDER",
              help="Reports built from REF: the changed pages are named too.")  # fmt: skip
@click.option("--pictures", type=click.Path(path_type=Path, file_okay=False), metavar="FOLDER",
              help="Write small pictures of the changed pages, before and after.")  # fmt: skip
@click.pass_obj
def diff(project: Project, ref: str, form: str, reports: Path | None, pictures: Path | None) -> None:
    """What changed in the ledger since the commit REF: rows that are new, gone, or have another verdict.

    The exit code is 1 where a verdict or a printed digit moved.
    """
    from notebook_reports.ledger import difference

    if pictures is not None and reports is None:
        raise UsageError("--pictures needs --reports FOLDER, the reports as they were")
    changes = difference.difference(project, ref)
    say(difference.as_markdown(changes, ref) if form == "md" else difference.as_text(changes, ref))
    if reports is not None:
        from notebook_reports.pages.changed_pages import changed, changes_told

        say(changes_told(changed(reports, project.reports, pictures), form))
    sys.exit(1 if any(change.moved for change in changes) else 0)


@main.command()
@click.argument("folder", type=click.Path(path_type=Path))
def new(folder: Path) -> None:
    """A project of your own in a new FOLDER: a printed table, a notebook, the order of a book."""
    from notebook_reports.project.new import new_project

    for name in new_project(folder):
        click.echo(f"{folder / name}")
    click.echo(f"\ncd {folder} && loopbook build")


@main.command()
@click.pass_obj
def doctor(project: Project) -> None:
    """Is the environment as it should be?"""
    from notebook_reports.build.doctor import examine

    worst = 0
    for verdict, question, found in examine(project):
        say(f"{verdict:5} {question:22} {found}")
        worst = 3 if verdict == "FAIL" else worst
    sys.exit(worst)


@main.command()
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.option("--against", type=click.Path(path_type=Path), metavar="FILE",
              help="Build nothing; compare the reports here with the statement of another build.")  # fmt: skip
@click.pass_obj
def verify(project: Project, notebooks: tuple[str, ...], against: Path | None) -> None:
    """Build twice, under other folders, homes, users, languages, and compare every byte.

    With --against FILE: are the reports here those of which reports/provenance.json of somebody's build speaks?
    """
    if against is not None:
        from notebook_reports.build.provenance import against as compare

        sys.exit(compare(project, against))
    from notebook_reports.build.verify import verify as run_verify

    sys.exit(run_verify(project, notebooks))


if __name__ == "__main__":
    main()
