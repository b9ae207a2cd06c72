"""``loopbook code``: a regulator's JSON as programs in files."""

from pathlib import Path

import click


@click.command()
@click.argument("regulator", type=click.Path(path_type=Path))
@click.option("--target", "targets", default="c", show_default=True, help="Languages, as in c,st,js,py.")
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE|DIR",
              help="One target: its main file; more: a folder. Default: the folder of the JSON.")  # fmt: skip
@click.option("--float/--double", "single", default=True, help="REAL and float, or LREAL and double.")
@click.option("--name", default="", help="Of the program, as heater_pid; default: from the JSON.")
@click.option("--compensated", is_flag=True, help="The integral keeps what rounding would take from it.")
@click.option("--arduino", is_flag=True, help="With a sketch (target c).")
@click.option("--test-main", is_flag=True, help="With a main that tries it (target c).")
def code(
    regulator: Path,
    targets: str,
    output: Path | None,
    single: bool,
    name: str,
    compensated: bool,
    arduino: bool,
    test_main: bool,
) -> None:
    """A regulator as a program: C99, Structured Text, JavaScript or Python.

    REGULATOR is the JSON of a design (loopbook design record.csv -o regulator.json), or one written by hand. Files that
    are there are written anew. Exit codes: 0 written, 2 the JSON or an option is wrong.
    """
    from loopbook.code import CodeError, regulator_from_json
    from loopbook.code.files import write_controller

    chosen = list(dict.fromkeys(t.strip() for t in targets.split(",") if t.strip()))
    real = "float" if single else "double"
    try:
        block = regulator_from_json(regulator, name=name, compensated=compensated)
        extras = {"arduino": arduino, "test_main": test_main}
        made = write_controller(block, chosen, output or regulator.parent, real=real, named=bool(name), **extras)
    except CodeError as error:
        raise click.UsageError(str(error)) from None
    except OSError as error:
        raise click.UsageError(f"{error.filename}: cannot be written: {error.strerror}") from None
    for path in made:
        click.echo(path)
