"""Run a script with the bundled engine or with LIGGGHTS, in the folder where it lies."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

from liggghts_io.case.failure import (
    EngineStopped,
    Failure,
    failure_of,
    out_of_time,
    said_plainly,
)
from liggghts_io.case.liggghts import LIGGGHTS, run_liggghts
from liggghts_io.measure.schedule import read_schedule

MINIDEM: Final = "minidem"
ENGINES: Final = (MINIDEM, LIGGGHTS)
LOG: Final = "log.liggghts"
Progress: TypeAlias = Callable[[int, int], None]


def run_engine(
    folder: Path,
    script: str,
    engine: str,
    progress: Progress | None = None,
    limit_s: float | None = None,
) -> None:
    """Run a script in its folder.

    Parameters
    ----------
    folder : Path
    script : str
        File name in the folder.
    engine : str
    progress : callable, optional
        Called with the steps done and the steps in all.
    limit_s : float, optional
        Wall-clock time after which the engine is stopped [s].

    Raises
    ------
    EngineStopped
        If the engine stopped with an error or was out of time; the message is the reason.
    CaseError
        If the engine is not there.
    """
    if engine == LIGGGHTS:
        run_liggghts(folder, script, read_schedule(folder / script).most, progress, limit_s)
    else:
        _run_minidem(folder, script, progress, limit_s)


def _run_minidem(
    folder: Path, script: str, progress: Progress | None, limit_s: float | None
) -> None:
    from minidem import DemError, RunInterrupted, run_script

    deadline = time.monotonic() + (limit_s or 0.0)
    stop = None if limit_s is None else (lambda: time.monotonic() > deadline)
    try:
        run_script(folder / script, root=folder, log=LOG, progress=progress, stop=stop)
    except RunInterrupted as err:  # only the deadline asks for it
        raise out_of_time(MINIDEM, limit_s) from err
    except (DemError, OSError, MemoryError) as err:
        failure = failure_of(err)
        if failure is None and not isinstance(err, DemError):
            raise
        raise EngineStopped(failure or Failure.PHYSICS, said_plainly(err)) from err
