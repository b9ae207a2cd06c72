"""The `loopbook` command, and one line that says what to install where its packages are not."""

import sys

OWN = ("loopbook", "notebook_reports", "derivations")


def main() -> None:
    """Run the command; exit code 3 where the packages of the reports are not installed."""
    try:
        from loopbook.cli import main as command
    except ModuleNotFoundError as error:
        if error.name is None or error.name.split(".")[0] in OWN:
            raise
        print(f"loopbook: the command needs {error.name}: pip install 'loopbook[reports]'", file=sys.stderr)
        sys.exit(3)
    command()


if __name__ == "__main__":
    main()
