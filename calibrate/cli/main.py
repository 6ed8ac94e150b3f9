"""The `bulkcal` command."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import typer
from rich.console import Console

from calibrate.cli import cases as cli_cases
from calibrate.cli import studies as cli_study
from calibrate.cli.retry import retry
from calibrate.errors import BugError, CalibrationError, Terminated
from liggghts_io import CaseError

__all__ = ["app", "main"]

USER_MISTAKE = 2
FAULT = 1
INTERRUPTED, TERMINATED = 130, 143

app = typer.Typer(
    name="bulkcal",
    help="Calibrate contact parameters of a discrete element simulation from bench experiments.\n\n"
    "Start with: bulkcal demo",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command("generate")(cli_cases.generate)
app.command("run")(cli_cases.run)
app.command("post")(cli_cases.post)
app.command("render")(cli_cases.render)
app.command("calibrate")(cli_study.calibrate_command)
app.command("demo")(cli_study.demo)

app.command("diagnose")(cli_study.diagnose)
app.command("retry")(retry)

# Typer brings its own copy of click; the error classes are reached through what it exports.
_UsageError: type[Exception] = typer.BadParameter.__bases__[0]


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and end with an exit code, a line on stderr unless it is 0.

    0: done; 1: a fault of this program; 2: a mistake of the user, or a machine that refuses (a
    full disk, say); 130: Ctrl-C; 143: SIGTERM.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words of the command line, default those of the process.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        code = app(args=words, prog_name="bulkcal", standalone_mode=False)
    except (CalibrationError, CaseError) as err:
        _fail(str(err))
    except _UsageError as err:
        text = getattr(err, "format_message", err.__str__)()
        _fail(f"{' '.join(str(text).split())} (see: bulkcal {_verb(words)}--help)")
    except BugError as err:
        _fail(str(err), FAULT)
    except Terminated:
        raise SystemExit(TERMINATED) from None
    except (KeyboardInterrupt, typer.Abort):
        raise SystemExit(INTERRUPTED) from None
    else:
        raise SystemExit(code if isinstance(code, int) else 0)


def _verb(words: Sequence[str]) -> str:
    known = {command.name for command in app.registered_commands}
    return f"{words[0]} " if words and words[0] in known else ""


def _fail(message: str, code: int = USER_MISTAKE) -> None:
    Console(stderr=True).print(
        f"bulkcal: {message}", style="red", markup=False, highlight=False, soft_wrap=True
    )
    raise SystemExit(code)
