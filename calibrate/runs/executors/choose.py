"""Executors by name."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import partial
from types import MappingProxyType
from typing import Final

from calibrate.errors import CalibrationError
from calibrate.executor_names import DASK, DASK_LOCAL, LOCAL, ExecutorName, check_executor
from calibrate.runs.executors.clusters import connect, job_cluster, local_cluster, need_dask
from calibrate.runs.executors.dask_executor import DaskExecutor, quiet_dask
from calibrate.runs.executors.options import JobOptions, job_options
from calibrate.runs.executors.sized import SizedExecutor
from calibrate.runs.executors.workers import WorkerPool

__all__ = ["checked", "executor_of"]

_NONE: Final[Mapping[str, object]] = MappingProxyType({})


def executor_of(
    text: str, workers: int = 0, options: Mapping[str, object] = _NONE
) -> SizedExecutor:
    """Return the executor of a name; a context manager, whose end ends its workers.

    Processes, clusters and jobs are started with the first run; a scheduler that runs already is
    asked at once for its workers.

    Parameters
    ----------
    text : str
        "local", "dask-local", "dask://HOST:PORT", "slurm", "pbs" or "lsf".
    workers : int
        Runs at once; 0 for one per core, of the cluster where one runs already, and for one job
        where they wait in a queue.
    options : mapping of str to object
        Of a job queue, see `JobOptions`.

    Raises
    ------
    CalibrationError
        For an unknown name or option, missing packages, or a scheduler that does not answer.
    """
    name, asked = checked(text, options)
    here = workers or os.cpu_count() or 1
    if name.kind == LOCAL:
        return WorkerPool(here)
    need_dask(text)
    if name.kind == DASK_LOCAL:
        return DaskExecutor(partial(local_cluster, here), here)
    if name.kind == DASK:
        with quiet_dask():
            connection = connect(name.address, workers)
        return DaskExecutor(lambda: connection, connection.workers)
    at_once = workers or asked.cores
    return DaskExecutor(partial(job_cluster, name.kind, at_once, asked), at_once)


def checked(text: str, options: Mapping[str, object]) -> tuple[ExecutorName, JobOptions]:
    """Read the name of an executor and its options.

    Parameters
    ----------
    text : str
    options : mapping of str to object

    Raises
    ------
    CalibrationError
        For an unknown name or option, and for options that the executor does not have.
    """
    try:
        name = check_executor(text)
    except ValueError as err:
        msg = f"--executor: {err}"
        raise CalibrationError(msg) from err
    asked = job_options(options)
    if options and name.kind in (LOCAL, DASK_LOCAL, DASK):
        msg = (
            f"--executor-option {next(iter(options))}: the executor '{text}' has no options, only "
            "job queues have"
        )
        raise CalibrationError(msg)
    return name, asked
