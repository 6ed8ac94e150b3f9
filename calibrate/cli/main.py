"""The `bulkcal` command."""

from __future__ import annotations

import errno
import itertools
import os
import re
import sys
from collections.abc import Callable, Sequence
from functools import cache
from typing import Annotated, Any, Final, NoReturn

import typer
from rich.console import Console

from calibrate.cli import apparatus as cli_apparatus
from calibrate.cli import cases as cli_cases
from calibrate.cli import check as cli_check
from calibrate.cli import studies as cli_study
from calibrate.cli.about import versions, write_bug_report
from calibrate.cli.campaigns.keep import runs
from calibrate.cli.campaigns.retry import retry
from calibrate.cli.campaigns.status import status
from calibrate.cli.challenge.command import app as challenge_app
from calibrate.cli.diagnosis.command import diagnose
from calibrate.cli.files import new_study as cli_new
from calibrate.cli.files.export import export
from calibrate.cli.laboratory import measured as cli_measured
from calibrate.cli.laboratory import photo as cli_photo
from calibrate.cli.laboratory.motion import motion
from calibrate.cli.output.post import post
from calibrate.cli.output.render import render
from calibrate.cli.sensitivity.command import sensitivity
from calibrate.cli.show.output import Screen, printable
from calibrate.errors import BugError, CalibrationError, Terminated
from liggghts_io import CaseError
from liggghts_io.errors import told

__all__ = ["app", "main"]

FAULT: Final = 1
USER_MISTAKE: Final = 2
INTERRUPTED: Final = 130
READER_GONE: Final = 141
TERMINATED: Final = 143

app = typer.Typer(
    name="bulkcal",
    help="Calibrate contact parameters of a discrete element simulation from bench experiments.\n\n"
    "Start with: bulkcal demo",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app.command("generate", short_help="Write a case directory.")(cli_cases.generate)
app.command("run", short_help="Run a case and show its observables.")(cli_cases.run)
app.command("post", short_help="Measure a case, or any LIGGGHTS output.")(post)
app.command("render", short_help="Draw a case, or any LIGGGHTS output.")(render)
app.command("apparatus", short_help="Show what can be changed.")(cli_apparatus.apparatus)
app.command("check", short_help="Check a study, and say what it costs.")(cli_check.check)
app.command("export", short_help="Write the values for LIGGGHTS or others.")(export)
app.command("init", short_help="Write a study to be filled in.")(cli_new.init)
app.command("migrate", short_help="Write an old study file anew.")(cli_new.migrate)
app.command("calibrate", short_help="Calibrate a study.")(cli_study.calibrate_command)
app.command("demo", short_help="Calibrate the bundled study.")(cli_study.demo)
app.command("diagnose", short_help="Say what is still wrong.")(diagnose)
app.add_typer(challenge_app, short_help="Hide causes and see whether they are found.")
app.command("motion", short_help="Fit cosines to a plate's motion.")(motion)
app.add_typer(cli_measured.app, short_help="Turn logs and numbers into targets.")
app.command("sensitivity", short_help="Say what moves what.")(sensitivity)
app.add_typer(cli_photo.app, short_help="Measure grains and heaps on photographs.")
app.command("status", short_help="Say how far the runs are.")(status)
app.command("runs", short_help="Keep runs as a table.")(runs)
app.command("retry", short_help="Let failed runs run again.")(retry)

# Typer brings its own copy of click; the error classes are reached through what it exports.
_UsageError: type[Exception] = typer.BadParameter.__bases__[0]

_LOUDNESS: Final = ("-q", "-v")

_NEGATIVE: Final = re.compile(r"No such option: -[.,]?\d.*")

_REMEDIES: Final = {
    errno.ENOSPC: "free some space and start again; finished runs are kept",
    errno.EDQUOT: "free some space and start again; finished runs are kept",
    errno.EACCES: "ask for the permission, or work in a directory of your own",
    errno.EPERM: "ask for the permission, or work in a directory of your own",
    errno.EROFS: "work in a directory that can be written",
    errno.ENAMETOOLONG: "use a shorter name",
}


@app.callback(invoke_without_command=True)
def start(
    ctx: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", help="Show the versions of bulkcal and its engines.")
    ] = False,
) -> None:
    """Show versions, or help where no command is given."""
    if version:
        Screen().result("\n".join(versions()))
    elif ctx.invoked_subcommand is None:
        Screen().result(ctx.get_help())


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command; mistakes of the user end with one message on stderr and exit code 2.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words of the command line, default those of the process.
    """
    words = _verb_first(sys.argv[1:] if arguments is None else arguments)
    try:
        code = _command()(args=words, prog_name="bulkcal", standalone_mode=False)
    except (KeyboardInterrupt, Terminated, typer.Abort) as err:
        code = TERMINATED if isinstance(err, Terminated) else INTERRUPTED
        raise SystemExit(code) from None
    except Exception as err:
        _end(err, words)
    else:
        raise SystemExit(code if isinstance(code, int) else 0)


@cache
def _command() -> Callable[..., Any]:
    """Return the command; made once, as reading the verbs takes longer than many a verb."""
    return typer.main.get_command(app)


def _verb_first(words: Sequence[str]) -> list[str]:
    """Return the words with ``-q`` and ``-v`` behind the verb, where people do not always put them.

    Examples
    --------
    >>> _verb_first(["-q", "run", "heap"]), _verb_first(["-q", "measured", "scale", "log"])
    (['run', '-q', 'heap'], ['measured', 'scale', '-q', 'log'])
    """
    front = list(itertools.takewhile(_LOUDNESS.__contains__, words))
    rest = list(words[len(front) :])
    verb = 2 if rest[:1] and rest[0] in _groups() else 1
    return [*rest[:verb], *front, *rest[verb:]]


def _groups() -> set[str | None]:
    """Return the verbs that have verbs of their own."""
    return {
        str(group.typer_instance.info.name)
        for group in app.registered_groups
        if group.typer_instance
    }


def _end(err: Exception, words: Sequence[str]) -> NoReturn:
    """Say what went wrong, in one message, and end with the exit code that fits."""
    if isinstance(err, BrokenPipeError) and _reader_is_gone():
        raise SystemExit(READER_GONE) from None
    if isinstance(err, BugError):
        _fail(str(err), FAULT)
    if isinstance(err, CalibrationError | CaseError):
        _fail(str(err))
    if isinstance(err, _UsageError):
        text = str(getattr(err, "format_message", err.__str__)())
        plain = told({"msg": " ".join(text.split())})
        if _NEGATIVE.fullmatch(plain):
            plain = f"{plain}; write -- before numbers that begin with a minus sign"
        _fail(f"{plain} (see: bulkcal {_verb(words)}--help)")
    if isinstance(err, MemoryError):
        _fail("this needs more memory than the machine has; make it smaller (-a, --scale)")
    if isinstance(err, OSError):
        _fail(_words_of(err))
    path = write_bug_report(err, words)
    evidence = f"the file {path}" if path else f"this command: bulkcal {' '.join(words)}"
    _fail(
        f"{type(err).__name__}: {err}. This is a fault of bulkcal, not of your study; finished "
        f"runs are kept. Please report it with {evidence}",
        FAULT,
    )


def _verb(words: Sequence[str]) -> str:
    """Return the verb of a command line as far as it is known, with a space behind."""
    known = {str(command.name) for command in app.registered_commands} | {
        f"{group.typer_instance.info.name} {command.name}"
        for group in app.registered_groups
        if group.typer_instance
        for command in group.typer_instance.registered_commands
    }
    found = next((" ".join(words[:n]) for n in (2, 1) if " ".join(words[:n]) in known), "")
    if not found and words and words[0] in _groups():
        found = words[0]
    return f"{found} " if found else ""


def _words_of(err: OSError) -> str:
    """Return place, reason and remedy of what the operating system refused."""
    place = f"{err.filename}: " if err.filename is not None else ""
    remedy = _REMEDIES.get(err.errno or 0, "")
    return f"{place}{err.strerror or err}{f'; {remedy}' if remedy else ''}"


def _reader_is_gone() -> bool:
    """Whether nobody reads our output any more, as after ``bulkcal ... | head``."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        # What Python still wants to write when it ends must go somewhere.
        with open(os.devnull, "w", encoding="utf-8") as nowhere:  # noqa: PTH123 - not a file
            os.dup2(nowhere.fileno(), sys.stdout.fileno())
        return True
    return False


def _fail(message: str, code: int = USER_MISTAKE) -> NoReturn:
    Console(stderr=True).print(
        f"bulkcal: {printable(message)}",
        style="red", markup=False, highlight=False, soft_wrap=True,
    )  # fmt: skip
    raise SystemExit(code)
