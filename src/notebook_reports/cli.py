"""The press's command: build, list, check, doctor, verify."""

import sys
from pathlib import Path

import click

from notebook_reports.project.project import EnvironmentProblem, Project, UsageError, find_project, project_at

HELP = {"help_option_names": ["-h", "--help"]}


class Command(click.Group):
    """Turns what a person can mend into one line and an exit code: 2 usage and parameters, 3 environment."""

    def invoke(self, ctx: click.Context):
        try:
            return super().invoke(ctx)
        except UsageError as error:
            click.echo(f"loopbook: {error}", err=True)
            ctx.exit(2)
        except EnvironmentProblem as error:
            click.echo(f"loopbook: {error}", err=True)
            ctx.exit(3)
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            ctx.exit(130)


@click.group(cls=Command, context_settings=HELP)
@click.version_option(package_name="loopbook", prog_name="loopbook")
@click.option("--root", type=click.Path(exists=True, file_okay=False, path_type=Path), help="The project's folder.")
@click.pass_context
def main(ctx: click.Context, root: Path | None) -> None:
    """Run the notebooks, write their reports, keep the ledger of what the documents print.

    Exit codes: 0 all good, 1 a notebook or a check failed, 2 usage or parameters, 3 the environment.
    """
    ctx.obj = project_at(root) if root else find_project()


@main.command()
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.option("-p", "--parameter", "parameters", type=(str, str), multiple=True, metavar="NAME VALUE",
              help="A parameter of the notebook; the report goes to reports/custom or -o DIR.")  # fmt: skip
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Kernels at a time; default: one per core.")
@click.option("--format", "formats", default="pdf,html,ipynb", show_default=True, help="What to write.")
@click.option("--engine", type=click.Choice(["typst", "latex"]), default="typst", show_default=True,
              help="What makes the PDF; latex needs a TeX installation.")  # fmt: skip
@click.option("-o", "--output", type=click.Path(file_okay=False, path_type=Path), metavar="DIR",
              help="Where the reports go; the ledger's files are then left alone.")  # fmt: skip
@click.option("--force", is_flag=True, help="Run everything, whether it changed or not.")
@click.option("--accept", is_flag=True, help="Write the ledger's files though a verdict or a printed digit moved.")
@click.option("--frozen", is_flag=True, help="Fail where the ledger's files would change at all (for CI).")
@click.option("--timeout", type=click.FloatRange(min=1), default=600.0, show_default=True, metavar="S",
              help="Seconds that one cell may take.")  # fmt: skip
@click.option("--watch", is_flag=True, help="Build again whenever a file changes, until Ctrl-C.")
@click.pass_obj
def build(
    project: Project, notebooks, parameters, jobs, formats, engine, output, force, accept, frozen, timeout, watch
):
    """Run notebooks and write their reports, where something they depend on changed.

    NOTEBOOK is double_tank/03_pole_placement, double_tank/03, double_tank or a path; default: all.
    """
    from notebook_reports.build.build import build as run_build
    from notebook_reports.build.job import Wanted

    chosen = tuple(dict.fromkeys(f.strip() for f in formats.split(",") if f.strip()))
    wanted = Wanted(chosen, engine, output.resolve() if output else None, force, timeout)
    options = {"jobs": jobs, "accept": accept, "frozen": frozen}
    if watch:
        from notebook_reports.build.watch import watch as run_watch

        run_watch(project, notebooks, parameters, wanted, options)
        return
    sys.exit(run_build(project, notebooks, parameters, wanted, **options).code)


@main.command("list")
@click.pass_obj
def list_notebooks(project: Project) -> None:
    """The notebooks, their titles and parameters."""
    from notebook_reports.project.parameters import read_parameters
    from notebook_reports.project.source import read_source

    notebooks = project.notebooks()
    width = max(len(n.id) for n in notebooks)
    for notebook in notebooks:
        source = read_source(notebook.path)
        click.echo(f"{notebook.id:{width}}  {source.title}")
        for parameter in read_parameters(source).values():
            unit = f"  # {parameter.comment}" if parameter.comment else ""
            click.echo(f"{'':{width}}    -p {parameter.name} {parameter.default!r}{unit}")


@main.command()
@click.argument("document", required=False, default="")
@click.argument("place", required=False, default="")
@click.option("--format", "form", type=click.Choice(["text", "json", "csv", "md"]), default="text", show_default=True)
@click.pass_obj
def check(project: Project, document: str, place: str, form: str) -> None:
    """The ledger: what holds, and every row that does not.

    DOCUMENT is pid-report, pid-article or double-tank, PLACE as the document names it: "Table 5.2".
    """
    from notebook_reports.ledger import check as ledger

    chosen = ledger.read_ledger(project).of(document, place)
    forms = {"json": ledger.as_json, "csv": ledger.as_csv, "md": ledger.as_markdown}
    click.echo(forms[form](chosen) if form in forms else ledger.as_text(chosen, whole=bool(place)))
    failed = (project.cache / "failures.txt").exists()
    if failed:
        click.echo("\nthe last build failed; `loopbook build` says where", err=True)
    sys.exit(1 if failed or chosen.failing else 0)


@main.command()
@click.pass_obj
def doctor(project: Project) -> None:
    """Is the environment as it should be?"""
    from notebook_reports.build.doctor import examine

    worst = 0
    for verdict, question, found in examine(project):
        click.echo(f"{verdict:5} {question:22} {found}")
        worst = 3 if verdict == "FAIL" else worst
    sys.exit(worst)


@main.command()
@click.argument("notebooks", nargs=-1, metavar="[NOTEBOOK]...")
@click.pass_obj
def verify(project: Project, notebooks: tuple[str, ...]) -> None:
    """Build twice, in two folders, with one kernel and with four, and compare every byte."""
    from notebook_reports.build.verify import verify as run_verify

    sys.exit(run_verify(project, notebooks))


if __name__ == "__main__":
    main()
