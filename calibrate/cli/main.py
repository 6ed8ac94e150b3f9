"""The `bulkcal` command."""

from __future__ import annotations

import errno
import itertools
import re
import sys
from collections.abc import Callable, Sequence
from functools import cache
from typing import Annotated, Any, Final, NoReturn

import typer

from calibrate.cli.show.output import Screen, printable
from calibrate.cli.show.streams import READER_GONE, Terminal, open_streams, to_nowhere
from calibrate.cli.verbs import VERBS, Verbs, verbs_of
from calibrate.errors import BugError, CalibrationError, Terminated
from liggghts_io.errors import CaseError, told

__all__ = ["app", "main"]

FAULT: Final = 1
USER_MISTAKE: Final = 2
INTERRUPTED: Final = 130

app = typer.Typer(
    name="bulkcal",
    cls=Verbs,
    help="Calibrate contact parameters of a discrete element simulation from bench experiments.\n\n"
    "Start with: bulkcal demo",
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
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
    errno.EFBIG: "raise the limit of the size of files (ulimit -f)",
    errno.EMFILE: "raise the limit of open files (ulimit -n)",
    errno.ENFILE: "end other programs, or raise the limit of open files",
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
        from calibrate.cli.show.about import versions

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
    open_streams()
    words = _verb_first(sys.argv[1:] if arguments is None else arguments)
    try:
        code = _command()(args=words, prog_name="bulkcal", standalone_mode=False)
    except (KeyboardInterrupt, Terminated, typer.Abort) as err:
        code = err.code if isinstance(err, Terminated) else INTERRUPTED
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
    verb = 2 if rest[:1] and rest[0] in VERBS and VERBS[rest[0]].is_group else 1
    return [*rest[:verb], *front, *rest[verb:]]


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
        _fail(f"{plain} (see: {' '.join(filter(None, ('bulkcal', verbs_of(words))))} --help)")
    if isinstance(err, MemoryError):
        _fail("this needs more memory than the machine has; make it smaller (-a, --scale)")
    if isinstance(err, OSError):
        _fail(_words_of(err))
    from calibrate.cli.show.about import write_bug_report

    path = write_bug_report(err, words)
    evidence = f"the file {path}" if path else f"this command: bulkcal {' '.join(words)}"
    _fail(
        f"{type(err).__name__}: {err}. This is a fault of bulkcal, not of your study; finished "
        f"runs are kept. Please report it with {evidence}",
        FAULT,
    )


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
        to_nowhere()
        return True
    return False


def _fail(message: str, code: int = USER_MISTAKE) -> NoReturn:
    Terminal(stderr=True).print(
        f"bulkcal: {printable(message)}",
        style="red", markup=False, highlight=False, soft_wrap=True,
    )  # fmt: skip
    raise SystemExit(code)
