"""Names of what runs cases: worker processes here, a Dask cluster, or a job queue."""

from __future__ import annotations

import re
from typing import Final, NamedTuple

from calibrate.errors import suggest

__all__ = ["DASK", "DASK_LOCAL", "JOB_QUEUES", "LOCAL", "ExecutorName", "check_executor"]

LOCAL: Final = "local"
DASK_LOCAL: Final = "dask-local"
JOB_QUEUES: Final = ("slurm", "pbs", "lsf")
DASK: Final = "dask"
_SCHEDULER: Final = "dask://HOST:PORT"
_ADDRESS: Final = re.compile(r"dask://([A-Za-z0-9._-]+|\[[0-9A-Fa-f:]+\]):([0-9]{1,5})")
_LAST_PORT: Final = 65535


class ExecutorName(NamedTuple):
    """What runs cases, read from its name.

    Attributes
    ----------
    kind : str
        "local", "dask-local", "dask", "slurm", "pbs" or "lsf".
    address : str
        HOST:PORT of the scheduler of a Dask cluster, else empty.
    """

    kind: str
    address: str = ""


def check_executor(text: str) -> ExecutorName:
    """Read the name of an executor.

    Parameters
    ----------
    text : str
        "local", "dask-local", "dask://HOST:PORT", "slurm", "pbs" or "lsf".

    Raises
    ------
    ValueError
        With the nearest known name; the place is the caller's to add.

    Examples
    --------
    >>> check_executor("dask://login1:8786").address
    'login1:8786'
    """
    plain = (LOCAL, DASK_LOCAL, *JOB_QUEUES)
    if text in plain:
        return ExecutorName(text)
    found = _ADDRESS.fullmatch(text)
    if found and 0 < int(found[2]) <= _LAST_PORT:
        return ExecutorName(DASK, f"{found[1]}:{int(found[2])}")
    known = f"known: {', '.join((*plain, _SCHEDULER))}"
    if text.startswith("dask:"):
        msg = f"'{text}': write the scheduler of a Dask cluster as {_SCHEDULER} ({known})"
    else:
        msg = f"unknown executor '{text}'{suggest(text, plain)} ({known})"
    raise ValueError(msg)
