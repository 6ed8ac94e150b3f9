"""The ``minidem`` command: takes what ``liggghts`` takes."""

from __future__ import annotations

import argparse
import gc
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from minidem.errors import DemError, InputError, OutputError, RunInterrupted
from minidem.files import writing

if TYPE_CHECKING:
    from minidem.script.paths import CaseFolder

__all__ = ["main"]

TRACEBACK = "minidem-traceback.txt"
"""File in the current directory that tells of a fault of the engine itself."""
REPORT = "minidem-report.txt"
"""File in the current directory that tells what the engine lacks for a script."""
_FINE, _FAULT, _REFUSED, _INTERRUPTED = 0, 1, 2, 130  # exit codes


def _parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(
        prog="minidem",
        description="Run a LIGGGHTS script. Everything it writes lies in the current directory.",
        epilog="Example: minidem -in in.script -var seed 10007. Exit code 0: done; 2: the script, "
        "an option, the simulation, the disk or the memory says no; 130: interrupted; 1: a fault "
        "of minidem.",
    )
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("-in", "-i", dest="script", metavar="SCRIPT", help="script to run")
    what.add_argument(
        "--check", "-check", metavar="SCRIPT",
        help="list all words of a script that minidem lacks, without running it; exit code 2 if "
        "it would be refused",
    )  # fmt: skip
    what.add_argument(
        "--report", "-report", metavar="SCRIPT",
        help=f"write that list to {REPORT}, to send it with an issue",
    )  # fmt: skip
    parser.add_argument(
        "-var", "-v", dest="variables", nargs="+", action="append", default=[],
        metavar=("NAME", "VALUE"), help="set an index-style variable",
    )  # fmt: skip
    parser.add_argument(
        "-folder", "--folder", metavar="DIR",
        help="the current directory or one above it; the script may read and write in it. For "
        "scripts that you trust and that have their meshes beside their own folder",
    )  # fmt: skip
    parser.add_argument("-log", "-l", default="log.liggghts", help="log file, or none")
    parser.add_argument(
        "-echo", "-e", default="log", choices=("none", "screen", "log", "both"),
        help="where to show commands",
    )  # fmt: skip
    parser.add_argument(
        "-threads", "-t", type=_threads, default=1, metavar="N",
        help="threads that share every step, default 1; the same number gives the same result to "
        "the last bit, another one differs by rounding; worth it from some thousand particles on",
    )  # fmt: skip
    parser.add_argument("-screen", "-sc", default="", help="screen output to a file, or none")
    parser.add_argument(
        "-strict", "--strict", action="store_true",
        help="refuse the words that LIGGGHTS 3.8.0 does not have",
    )  # fmt: skip
    return parser


class _Signals:
    """The first Ctrl-C or SIGTERM asks for a stop between two steps; the second stops at once."""

    def __init__(self) -> None:
        self.asked = False
        wanted = (signal.SIGINT, signal.SIGTERM)
        self._before = {number: signal.signal(number, self._receive) for number in wanted}

    def restore(self) -> None:
        """Leave signals to those who handled them before."""
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _receive(self, number: int, frame: object) -> None:
        del number, frame
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True

    def stop(self) -> bool:
        """Return True after a signal."""
        return self.asked


@contextmanager
def _no_garbage() -> Iterator[None]:
    """Load modules without a search for garbage: it takes a seventh of the start and finds none."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def _threads(word: str) -> int:
    """Read the number of threads."""
    from minidem.run.threads import MOST

    if not word.isascii() or not word.isdigit() or not 1 <= int(word[:9]) <= MOST:
        msg = f"expected a whole number from 1 to {MOST}, found '{word[:20]}'"
        raise argparse.ArgumentTypeError(msg)
    return int(word)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a script; return 0, 2 after an error of the user or the simulation, 130 after Ctrl-C.

    A fault of the engine itself gives 1, and a file that tells of it.
    """
    with _no_garbage():
        args = _parser().parse_args(argv)
    signals = _Signals()
    try:
        return _carry_out(args, signals)
    except DemError as err:
        _say(str(err))
        _give_up_screen(err)
        return _REFUSED
    except RunInterrupted as err:
        kept = f"; continue with read_restart {err.restart}" if err.restart else ""
        _say(f"{err}; dumps written so far are complete{kept}")
        return _INTERRUPTED
    except KeyboardInterrupt:
        _say("interrupted at once; the last dump may be incomplete")
        return _INTERRUPTED
    except Exception as fault:
        _say(_report(fault))
        return _FAULT
    finally:
        signals.restore()


def _carry_out(args: argparse.Namespace, signals: _Signals) -> int:
    """Run or check the script that the arguments name; return the exit code."""
    # The engine multiplies no large matrices: threads of NumPy's library would wait for work,
    # and they wait busily.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if args.script is None:
        return _check(args)
    _run(args, signals)
    return _FINE


def _run(args: argparse.Namespace, signals: _Signals) -> None:
    """Run the script that the arguments name."""
    with _no_garbage():
        from minidem.simulate import run_script
    root = _folder(args)
    log = _inside(root, "-log", args.log)
    with ExitStack() as open_files:
        screen: TextIO | None = sys.stdout
        if isinstance(screen, TextIOWrapper):
            screen.reconfigure(errors="backslashreplace")
        if args.screen:
            target = _inside(root, "-screen", args.screen)
            screen = _open_screen(target, open_files) if target is not None else None
        run_script(
            Path(args.script), root=root,
            variables=_variables(args),
            log=None if log is None else args.log,
            echo=args.echo, screen=screen, stop=signals.stop,
            threads=args.threads, strict=args.strict,
        )  # fmt: skip


def _check(args: argparse.Namespace) -> int:
    """List what minidem lacks for a script; return the exit code."""
    with _no_garbage():
        from minidem.checking import check_script, findings_text, is_refused
    name = args.check or args.report
    findings = check_script(
        Path(name), root=_folder(args), variables=_variables(args), strict=args.strict
    )
    text = _printable(findings_text(_text(name), findings))
    if args.report:
        with writing(REPORT):
            Path(REPORT).write_text(f"{_versions()}\n\n{text}", encoding="utf-8")
        text += f"written to {REPORT}; please look through it before you send it\n"
    with writing("screen"):
        sys.stdout.write(_encodable(text, sys.stdout.encoding))
        sys.stdout.flush()
    return _REFUSED if is_refused(findings) else _FINE


def _folder(args: argparse.Namespace) -> CaseFolder:
    """Return where the script may read and write, and where in it it stands."""
    from minidem.script.paths import CaseFolder

    with writing("the current directory"):
        here = Path.cwd().resolve()
    top = (here / (args.folder or ".")).resolve()
    if not here.is_relative_to(top) or not top.is_dir():
        msg = f"-folder: '{_text(args.folder)}' is neither the current directory nor one above it"
        raise InputError(msg)
    return CaseFolder(top, str(here.relative_to(top)))


def _variables(args: argparse.Namespace) -> dict[str, list[str]]:
    """Return the values of ``-var``."""
    return {_text(words[0]): [*map(_text, words[1:])] for words in args.variables}


def _inside(root: CaseFolder, option: str, name: str) -> Path | None:
    """Return the file of an option, None for ``none``."""
    from minidem.script.paths import inside

    if name in ("none", os.devnull):
        return None
    try:
        return inside(root, name)
    except InputError as err:
        msg = f"{option}: {err}"
        raise InputError(msg) from err


def _open_screen(target: Path, open_files: ExitStack) -> TextIO:
    """Open the file that takes the place of the screen, until the script ends."""
    open_files.enter_context(writing(target.name))
    target.parent.mkdir(parents=True, exist_ok=True)
    screen: TextIO = open_files.enter_context(
        target.open("w", buffering=1, encoding="utf-8", errors="surrogateescape")
    )
    return screen


def _text(word: str) -> str:
    """Return a word of the command line without bytes that are no text."""
    return os.fsencode(word).decode("utf-8", errors="replace")


def _printable(text: str) -> str:
    """Return a text with characters that do not print written as numbers."""
    return "".join(c if c.isprintable() or c == "\n" else repr(c)[1:-1] for c in text)


def _encodable(text: str, encoding: str | None) -> str:
    """Return a text with characters that a terminal does not know written as numbers."""
    known = encoding or "ascii"
    return text.encode(known, "backslashreplace").decode(known)


def _say(message: str) -> None:
    """Tell the user."""
    sys.stderr.write(f"minidem: {_encodable(_printable(message), sys.stderr.encoding)}\n")


def _give_up_screen(err: DemError) -> None:
    """Write nothing more to a screen that nobody reads, such as a pipe that was closed."""
    if isinstance(err, OutputError) and isinstance(err.__cause__, BrokenPipeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _versions() -> str:
    """Return what is running."""
    import platform
    from importlib.metadata import version

    system = f"Python {platform.python_version()}, {platform.platform()}"
    return f"minidem {version('bulkcal')}, {system}"


def _report(fault: Exception) -> str:
    """Write down a fault of the engine; return what to tell the user."""
    import traceback

    text = f"{_versions()}\n{' '.join(sys.argv)}\n\n" + "".join(traceback.format_exception(fault))
    short = f"{type(fault).__name__}: {fault}"[:200]
    try:
        Path(TRACEBACK).write_text(text, encoding="utf-8", errors="backslashreplace")
    except OSError:
        where = f"the following text:\n{text}"
    else:
        where = f"the file {TRACEBACK}"
    return f"a fault of minidem, not of your script ({short}); please report it with {where}"
