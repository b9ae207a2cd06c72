"""The `loopbook` command."""

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from loopbook.code.cli import code as code_command
from loopbook.course.cli import course as course_command
from loopbook.design.notebook import design_notebook
from loopbook.tuner_page.cli import tune_page
from notebook_reports.cli import main, say
from notebook_reports.project.project import Project, UsageError

MOST_NAMED = 10  # records without a regulator that are named in the terminal
FILES = """\b
Records: CSV, .xlsx or Parquet, one sample a line, with a time, an input and an output, in any order and language:
  time [s], valve [%], temperature [°C]
Models: TOML, times in seconds (loopbook design --template writes one):
  [process]
  gain = 2.0                    output per input; integrating: per input and second
  time_constants = [10.0, 4.0]  a single number will do
  delay = 3.0                   dead time, 0 for none
  integrating = false
\b
Further parameters (-p NAME VALUE): h (sampling interval, s), K180 and T180 (of a relay test), reference and load (the
steps of the final simulation).
"""


@main.command(epilog=FILES)
@click.argument("data", nargs=-1, type=click.Path(path_type=Path), metavar="[DATA...]")
@click.option("-o", "--report", type=click.Path(path_type=Path), metavar="FILE|DIR",
              help="The report (.pdf, .html, .ipynb, .json) or their folder; default: beside the data.")  # fmt: skip
@click.option("--aim", type=click.Choice(["robust", "fast", "no-overshoot", "quiet"]), help="What is recommended.")
@click.option("--speed", type=float, metavar="0..1", help="How fast, from 0 (slow) to 1 (fast).")
@click.option("--closed-loop", metavar="TIME", help="The closed loop's time constant: 20s, 1.5min, 300ms.")
@click.option("--model", metavar="TEXT", help="Parameters of the model that you know: 'K=2, T=30, L=5', any of them.")
@click.option("--limits", nargs=2, type=float, metavar="LOW HIGH",
              help="The actuator's limits, in the input's unit; default: from the record. -inf inf: none.")  # fmt: skip
@click.option("--time", "time_column", metavar="COLUMN", help="The record's column of the time.")
@click.option("--interval", metavar="TIME", help="Between the samples of a record without a time column: 0.1, 100ms.")
@click.option("--input", "input_column", metavar="COLUMN", help="The record's column of the input.")
@click.option("--output", "output_column", metavar="COLUMN", help="The record's column of the output.")
@click.option("-p", "--parameter", "parameters", type=(str, str), multiple=True, metavar="NAME VALUE",
              help="Any other parameter of the notebook own_process/design.")  # fmt: skip
@click.option(
    "--format", "formats", default="", help="What to write: pdf,html,ipynb,json; programs: c,st,js,py; default: pdf."
)
@click.option("--page", is_flag=True, help="The first page only.")
@click.option("--code", is_flag=True, help="Show the code, the program's listing and the data as well.")
@click.option("--template", is_flag=True, help="Write an annotated model file, to standard output or to -o, and stop.")
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Designs at a time; default: one per core.")
@click.option("--cluster", metavar="N|tcp://HOST:PORT",
              help="Many records on Dask's workers: N started here, or a scheduler's, tcp:// or tls://.")  # fmt: skip
@click.pass_obj
def design(
    project: Project,
    data: tuple[Path, ...],
    report: Path | None,
    model: str | None,
    formats: str,
    page: bool,
    code: bool,
    template: bool,
    jobs: int | None,
    cluster: str | None,
    parameters: tuple[tuple[str, str], ...],
    **options: Any,
) -> None:
    """A regulator for your own process, from recorded step tests or models.

    Many records at once: loopbook design records/*.csv -o out/. The designs run in parallel, on other machines with
    --cluster; out/summary.html and .csv name first what needs attention. A record that no model can be made of does not
    stop the others, is named, and makes the exit code 1. The same command goes on where it was broken off.
    """
    from loopbook.design.model_file import TEMPLATE, as_toml, read_fixed

    if template:
        _template(TEMPLATE, report)
        return
    named = _named(options) + ([("known", model)] if model else [])
    if not data and not model:
        raise UsageError("name a record or a model: loopbook design record.csv (loopbook design --help says more)")
    if cluster is not None and (len(data) < 2 or report is None):
        raise UsageError("--cluster is for many records: loopbook design records/*.csv -o out/ --cluster 4")
    if len(data) > 1 and report is not None:
        sys.exit(_plant(data, report, formats, named + list(parameters), page, code, jobs, cluster))
    if data:
        sys.exit(_apply(project, data, report, formats, named + list(parameters), page, code, jobs))
    import tempfile

    with tempfile.TemporaryDirectory(prefix="loopbook") as folder:
        file = Path(folder) / "model.toml"
        file.write_text(_usable(as_toml, _usable(read_fixed, model)), encoding="utf-8")
        rest = [pair for pair in named if pair[0] != "known"] + list(parameters)
        sys.exit(_apply(project, (file,), report or Path.cwd(), formats, rest, page, code, jobs))


def _usable(read: Callable[..., Any], *args: Any) -> Any:
    """The result of a reading, its error as one of usage."""
    from loopbook.design.model import ModelError

    try:
        return read(*args)
    except ModelError as error:
        raise UsageError(str(error)) from None


def _template(text: str, target: Path | None) -> None:
    if target is None:
        click.echo(text, nl=False)
        return
    file = target / "process.toml" if target.is_dir() else target
    if file.exists():
        raise UsageError(f"{file} is there already: name another file, or remove it")
    file.write_text(text, encoding="utf-8")
    click.echo(f"{file}: fill it in, then run: loopbook design {file}")


def _named(options: dict[str, Any]) -> list[tuple[str, str]]:
    """The options that are parameters of the notebook, by the notebook's names."""
    from loopbook.design.model_file import seconds

    names = {"time": "time_column", "input": "input_column", "output": "output_column", "aim": "aim", "speed": "speed"}
    found = [(name, str(options[o])) for name, o in names.items() if options[o] is not None]
    for name in ("interval", "closed_loop"):
        if options[name] is not None:
            found.append((name, repr(_usable(seconds, options[name]))))
    if options["limits"]:
        given = [(n, v) for n, v in zip(("u_low", "u_high"), options["limits"], strict=True) if math.isfinite(v)]
        found += [(name, repr(v)) for name, v in given] + [("unlimited", "True")] * (len(given) < 2)
    return found


def _apply(
    project: Project,
    data: Sequence[Path],
    report: Path | None,
    formats: str,
    parameters: list[tuple[str, str]],
    page: bool,
    code: bool,
    jobs: int | None,
) -> int:
    from notebook_reports.build.apply import FORMATS, apply, items

    chosen = [f.strip() for f in formats.split(",") if f.strip()]
    programs: Mapping[str, Callable[[dict, str], bytes]] = {}
    if {*chosen, report.suffix.lstrip(".") if report else ""} - {"", *FORMATS}:
        from loopbook.code import files  # with the languages comes SymPy

        chosen, programs = files.with_all_files(chosen), files.PROGRAMS
    wanted = items(data, report, "design", chosen, more=tuple(programs))
    _say(wanted, dict(parameters))
    repeat = [
        "loopbook",
        "design",
        *(["-o", str(report)] if report else []),
        *(["--format", formats] if formats else []),
    ]
    repeat += ["--page"] * page + ["--code"] * code
    ready = "loopbook.design.ready:derive"
    for_programs = all({*item.outputs} <= {"json", *programs} for item in wanted)
    leave_out = frozenset({"detail"} if page or for_programs else ())
    return apply(
        project,
        design_notebook(),
        wanted,
        parameters,
        jobs=jobs,
        repeat=repeat,
        ready=ready,
        programs=programs,
        code=code,
        leave_out=leave_out,
    ).code


def _plant(
    data: Sequence[Path],
    out: Path,
    formats: str,
    parameters: list[tuple[str, str]],
    page: bool,
    code: bool,
    jobs: int | None,
    cluster: str | None,
) -> int:
    from loopbook.code.files import PROGRAMS, with_all_files
    from loopbook.design.plant.attention import FAILED, REFUSED
    from loopbook.design.plant.run import CSV, HTML, Progress, design_plant
    from loopbook.jobs import NUMBERS, PACKAGES, PRINTING
    from notebook_reports.build.apply import items
    from notebook_reports.executors.asked import executor_for
    from notebook_reports.executors.executor import interruptible
    from notebook_reports.project.parameters import assign
    from notebook_reports.project.source import read_source

    chosen = [f.strip() for f in formats.split(",") if f.strip()]
    wanted = items(data, out, "design", with_all_files(chosen), more=tuple(PROGRAMS))
    given = assign(read_source(design_notebook()), parameters)
    values = [(name, value) for name, value in given.items() if name != "data"]
    modules = (*NUMBERS, "loopbook.design.plant.warm", *PRINTING)
    executor = executor_for(jobs, cluster, PACKAGES, modules)
    progress = Progress(lambda text: click.echo(text, nl=False, err=True), sys.stderr.isatty())
    try:
        with interruptible():
            done = design_plant(wanted, out, values, executor, page, code, progress)
    except KeyboardInterrupt:
        click.echo(f"\nbroken off; what is done is kept in {out}, and the same command goes on", err=True)
        return 130
    bad = done.of(FAILED, REFUSED)
    for row in bad[:MOST_NAMED]:
        say(f"{row.name}: {row.why}", err=True)
    if len(bad) > MOST_NAMED:
        say(f"and {len(bad) - MOST_NAMED} more without a regulator: see the summary", err=True)
    kept = len(done.rows) - done.fresh
    say(f"{len(done.rows)} records, {len(bad)} without a regulator" + (f", {kept} from before" if kept else ""))
    say(f"{out / HTML}\n{out / CSV}")
    return done.code


def _say(wanted: Sequence[Any], given: dict[str, str]) -> None:
    """One line for each record: what was taken for what."""
    from loopbook.records.summary import describe

    for item in wanted:
        if item.data.suffix.lower() == ".toml":
            continue
        name = f"{item.data.name}: " if len(wanted) > 1 else ""
        time, input, output = (given.get(key, "") for key in ("time", "input", "output"))
        try:
            interval = float(given.get("interval", 0))
        except ValueError:
            interval = 0.0
        click.echo(name + describe(item.data, time, input, output, interval))


for command in (design, code_command, course_command, tune_page):
    setattr(command, "needs_project", False)  # noqa: B010 (it runs in whatever folder the data is; nothing there is run)
main.add_command(code_command)
main.add_command(course_command)
main.add_command(tune_page)


if __name__ == "__main__":
    main()
