"""One process at a time writes in a case directory; the lock dies with the process."""

from __future__ import annotations

import errno
import json
import os
import shutil
import socket
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final, TypeAlias

from filelock import FileLock, Timeout

from liggghts_io.case.failure import Failure, failure_of
from liggghts_io.errors import CaseError, DiskFull
from liggghts_io.files import write_text

LOCK: Final = "lock"
HOLDER: Final = "lock.holder"
Tell: TypeAlias = Callable[[str], None]

_PATIENCE_S: Final = 1.0  # before the one who waits says so
_NO_LOCKS: Final = frozenset({errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP})


@contextmanager
def gone_if_full(directory: Path, record: str) -> Iterator[None]:
    """Take a directory away that is new and lacks its record, if the disk is full in the block."""
    new = not directory.exists()
    try:
        yield
    except DiskFull:
        if new and not (directory / record).exists():
            shutil.rmtree(directory, ignore_errors=True)
        raise


@contextmanager
def locked(directory: Path, tell: Tell | None = None) -> Iterator[None]:
    """Hold the lock of a case directory while a ``with`` block lasts.

    Parameters
    ----------
    directory : Path
        Made if missing.
    tell : callable, optional
        Receives one line when the wait for another process gets long.

    Raises
    ------
    CaseError
        If the file system has no locks, or nothing can be written there; `DiskFull` if the disk
        is full, also when that shows inside the block.
    """
    lock = FileLock(directory / LOCK, fallback_to_soft=False)
    try:
        directory.mkdir(parents=True, exist_ok=True)
        _acquire(lock, directory, tell)
        try:
            with suppress(OSError):  # it serves messages only
                write_text(directory / HOLDER, json.dumps(_own_name()) + "\n")
            yield
        finally:
            with suppress(OSError):
                (directory / HOLDER).unlink(missing_ok=True)
            lock.release()
    except OSError as err:
        raise_if_unusable(err, directory)
        raise


def holder(directory: Path) -> str | None:
    """Return who holds the lock of a case directory just now, None where nobody does.

    The answer may be out of date when it arrives; it helps to choose what to do first.
    """
    if not (directory / LOCK).exists():
        return None
    lock = FileLock(directory / LOCK, fallback_to_soft=False)
    try:
        lock.acquire(timeout=0)
    except Timeout:
        return _holder(directory)
    except (OSError, NotImplementedError):
        return None  # whoever runs the case finds out why, and says so
    lock.release()
    return None


def raise_if_unusable(error: OSError, directory: Path) -> None:
    """Raise a `CaseError` that says why a directory cannot be used, if an error is about that.

    A file elsewhere, as a picture of the case, is told by its own name.
    """
    number = error.errno
    directory = _elsewhere(error, directory) or directory
    if failure_of(error) == Failure.DISK and number != errno.EROFS:
        remedy = "raise the limit (ulimit -f)" if number == errno.EFBIG else "free some space"
        msg = f"{directory}: {os.strerror(number or errno.EIO)}; {remedy} and try again"
        raise DiskFull(msg) from error
    if number in _NO_LOCKS:
        msg = f"{directory}: this file system has no file locks; choose a directory on another one"
        raise CaseError(msg) from error
    about_place = (
        FileExistsError, FileNotFoundError, IsADirectoryError, NotADirectoryError, PermissionError,
    )  # fmt: skip
    if isinstance(error, about_place) or number in (errno.ENAMETOOLONG, errno.ELOOP, errno.EROFS):
        text = os.strerror(number or errno.EACCES)
        msg = f"{directory}: cannot be written ({text}); choose another directory"
        raise CaseError(msg) from error


def _elsewhere(error: OSError, directory: Path) -> Path | None:
    """Return the file that an error is about where it lies outside a directory."""
    if not isinstance(error.filename, str):
        return None
    file = Path(error.filename)
    inside = file.absolute().is_relative_to(directory.absolute())
    return None if inside or (not file.is_absolute() and file.parent == Path()) else file


def _acquire(lock: FileLock, directory: Path, tell: Tell | None) -> None:
    try:
        lock.acquire(timeout=_PATIENCE_S)
    except Timeout:
        if tell is not None:
            tell(f"waiting for {_holder(directory)}")
        lock.acquire(timeout=-1)


def _own_name() -> dict[str, str | int]:
    return {
        "host": socket.gethostname(),
        "pid": os.getpid(),
        "since": time.strftime("%H:%M"),
        "command": " ".join(sys.argv),
    }


def _holder(directory: Path) -> str:
    """Return who holds the lock, as far as the file beside it says."""
    try:
        one = json.loads((directory / HOLDER).read_text(encoding="utf-8"))
        who = f"pid {one['pid']} on host {one['host']}, at work here since {one['since']}"
    except (OSError, ValueError, KeyError, TypeError):
        return f"another process, which uses {directory}"
    return f"{who} ({one.get('command', '')})"
