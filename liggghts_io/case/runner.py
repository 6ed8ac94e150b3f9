"""Run a script with the bundled engine or with LIGGGHTS, in the folder where it lies."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

from liggghts_io.case.failure import EngineStopped, Failure, failure_of, said_plainly
from liggghts_io.case.liggghts import run_liggghts
from liggghts_io.measure.schedule import read_schedule

ENGINES: Final = ("minidem", "liggghts")
LOG: Final = "log.liggghts"
Progress: TypeAlias = Callable[[int, int], None]


def run_engine(folder: Path, script: str, engine: str, progress: Progress | None = None) -> None:
    """Run a script in its folder.

    Raises
    ------
    EngineStopped
        If the engine stopped with an error; the message is the reason.
    CaseError
        If the engine is not there.
    """
    if engine == "liggghts":
        run_liggghts(folder, script, read_schedule(folder / script).steps, progress)
    else:
        _run_minidem(folder, script, progress)


def _run_minidem(folder: Path, script: str, progress: Progress | None) -> None:
    from minidem import DemError, run_script

    try:
        run_script(folder / script, root=folder, log=LOG, progress=progress)
    except (DemError, OSError, MemoryError) as err:
        failure = failure_of(err)
        if failure is None and not isinstance(err, DemError):
            raise
        raise EngineStopped(failure or Failure.PHYSICS, said_plainly(err)) from err
