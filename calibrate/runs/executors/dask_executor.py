"""A Dask cluster behind the interface of the standard library, its ends in plain words."""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Future
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from calibrate.errors import CalibrationError
from calibrate.runs.executors.remote import expected_case, run_there
from calibrate.runs.executors.sized import SizedExecutor

if TYPE_CHECKING:
    from distributed import Client
    from distributed import Future as DaskFuture

__all__ = ["RECONNECT_S", "Connection", "DaskExecutor", "quiet_dask"]

RECONNECT_S: Final = 10.0
"""So long a scheduler may be away before it counts as gone [s]."""
_LOOK_S: Final = 0.1
_CLOSE_S: Final = 5.0
_RUNNING: Final = "running"


@dataclass(frozen=True)
class Connection:
    """A client of a scheduler, and what ends the cluster behind it.

    Attributes
    ----------
    client : distributed.Client
    workers : int
        Runs that the cluster takes at once.
    name : str
        Of the cluster, for messages.
    end : callable
        Called with True when runs under way are to be stopped, where they are ours to stop.
    """

    client: Client
    workers: int
    name: str
    end: Callable[[bool], None]


class DaskExecutor(SizedExecutor):
    """Runs calls on a Dask cluster.

    Parameters
    ----------
    open_ : callable
        Connects, and starts the cluster if it is ours; called with the first run.
    workers : int
        Runs at once.
    """

    def __init__(self, open_: Callable[[], Connection], workers: int) -> None:
        self._open = open_
        self._workers = workers
        self._connection: Connection | None = None
        self._quiet = contextlib.ExitStack()

    @property
    def workers(self) -> int:
        """How many runs it takes at once."""
        return self._workers

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Hand a call to the scheduler.

        Parameters
        ----------
        fn : callable
            Importable by the workers.
        *args, **kwargs : Any
            Where the first is a `CaseSpec`, the worker checks that it is the same case there.

        Returns
        -------
        Future
            Raises `BrokenExecutor` when the worker dies in this call or the scheduler goes away.

        Raises
        ------
        BrokenExecutor
            If the scheduler is gone.
        """
        connection = self._connected()
        outer: Future[Any] = Future()
        inner = connection.client.submit(
            run_there, expected_case(args), fn, *args, **kwargs, pure=False
        )
        outer.add_done_callback(lambda done: inner.cancel() if done.cancelled() else None)
        inner.add_done_callback(lambda done: _pass_on(done, outer, connection.name))
        return outer

    def close(self, *, at_once: bool) -> None:
        """Leave the cluster, and end it if it is ours; `at_once` stops its runs under way."""
        connection, self._connection = self._connection, None
        if connection is None:
            return
        with self._quiet:
            if at_once:
                connection.end(True)
            with suppress(OSError, TimeoutError):  # the scheduler may be gone
                connection.client.close(timeout=_CLOSE_S)
            if not at_once:
                connection.end(False)

    def _connected(self) -> Connection:
        """Return the connection, once the scheduler is there."""
        if self._connection is None:
            self._quiet.enter_context(quiet_dask())
            self._connection = self._open()
        deadline = time.monotonic() + RECONNECT_S + 1.0  # the client gives up a little before
        while self._connection.client.status != _RUNNING:
            if self._connection.client.status == "closed" or time.monotonic() > deadline:
                msg = f"{self._connection.name}: its scheduler is gone"
                raise BrokenExecutor(msg)
            time.sleep(_LOOK_S)
        return self._connection


def _pass_on(inner: DaskFuture[Any], outer: Future[Any], name: str) -> None:
    """Give the outcome of Dask's future to that of the standard library."""
    if not outer.set_running_or_notify_cancel():
        return
    if inner.status == "finished":
        try:
            outer.set_result(inner.result(timeout=RECONNECT_S))
        except Exception as err:
            outer.set_exception(_plain(err, name))
    elif inner.status == "error":
        outer.set_exception(_plain(inner.exception(timeout=RECONNECT_S), name))
    else:
        outer.set_exception(BrokenExecutor(f"{name} lost this run"))


def _plain(error: BaseException, name: str) -> BaseException:
    """Return an error of the cluster as one that a campaign knows; others as they are."""
    from distributed.client import FutureCancelledError
    from distributed.comm.core import CommClosedError
    from distributed.scheduler import KilledWorker

    if isinstance(error, KilledWorker):
        where = str(getattr(error.last_worker, "address", error.last_worker))
        return BrokenExecutor(f"the worker {where} of this run was killed, or ran out of memory")
    if isinstance(error, CommClosedError | FutureCancelledError | TimeoutError):
        return BrokenExecutor(f"{name} lost this run ({type(error).__name__})")
    if isinstance(error, ImportError):
        return CalibrationError(
            f"{name}: a worker cannot load what it should run ({error}); install the same version "
            "of bulkcal there"
        )
    return error


@contextlib.contextmanager
def quiet_dask() -> Iterator[None]:
    """Keep what Dask logs off the screen in a ``with`` block: we say it in our words."""
    logger = logging.getLogger("distributed")
    before = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(before)
