"""How work on a study ends early: interrupted, terminated, refused by the machine, by a fault."""

from __future__ import annotations

import contextlib
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType

from calibrate.errors import BugError, CalibrationError, Terminated
from calibrate.report.ours import refuse_foreign
from calibrate.runs.failures import refusal, report_bug
from liggghts_io import CaseError

__all__ = ["result_directory", "said_how_to_continue"]


@contextlib.contextmanager
def said_how_to_continue(out: Path, command: str, say: Callable[[str], None]) -> Iterator[None]:
    """Run a ``with`` block of work on a study; when it ends early, say why and what to do.

    Parameters
    ----------
    out : Path
        Directory of the result.
    command : str
        Command that continues the work.
    say : callable
        Receives a line.

    Raises
    ------
    KeyboardInterrupt, Terminated
        Passed on after Ctrl-C, SIGTERM and SIGHUP.
    CalibrationError, liggghts_io.CaseError
        Passed on, or for an error that the machine is to blame for.
    BugError
        For every other error, whose traceback is then in a file in `out`.
    """
    try:
        with _terminable():
            yield
    except (KeyboardInterrupt, Terminated):
        with contextlib.suppress(OSError):  # the terminal may be what has gone
            say(f"\nstopped; finished runs are kept. Continue with: {command}")
        raise
    except (BugError, CalibrationError, CaseError):
        raise
    except Exception as err:
        raise (refusal(err, out) or report_bug(err, out)) from err


def result_directory(out: Path) -> None:
    """Make the directory of a result, and refuse one that cannot be written before any work.

    Raises
    ------
    CalibrationError
        When it is a file, cannot be made or cannot be written, or holds files of a person where
        those of a result belong.
    """
    try:
        if out.exists() and not out.is_dir():
            msg = f"--out {out}: is a file; name a directory"
            raise CalibrationError(msg)
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass  # rights say less than trying does: the file system may be read-only
    except OSError as err:
        msg = f"--out {out}: cannot be written ({err.strerror}); name another directory"
        raise CalibrationError(msg) from err
    refuse_foreign(out)


@contextlib.contextmanager
def _terminable() -> Iterator[None]:
    """Let SIGTERM end the block as Ctrl-C does; only the main thread may ask for that.

    So does SIGHUP, which comes when a terminal or a connection goes away, unless the program was
    started to outlive that (nohup).
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    asked = [signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        asked.append(signal.SIGHUP)
    before = {number: signal.signal(number, _terminate) for number in asked}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _terminate(number: int, _frame: FrameType | None) -> None:
    raise Terminated(number)
