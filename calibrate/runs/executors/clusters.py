"""Dask clusters: one of this machine, one that runs already, one of jobs in a queue."""

from __future__ import annotations

import logging
import multiprocessing
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from importlib.util import find_spec
from multiprocessing import resource_tracker
from typing import TYPE_CHECKING, Any, Final

from calibrate.errors import CalibrationError
from calibrate.runs.executors.dask_executor import RECONNECT_S, Connection
from calibrate.runs.executors.options import JobOptions
from calibrate.runs.executors.workers import interrupts_later

if TYPE_CHECKING:
    from distributed import Client, LocalCluster
    from distributed.deploy.spec import SpecCluster

__all__ = ["connect", "job_cluster", "job_script", "local_cluster"]

_INSTALL: Final = "python -m pip install 'bulkcal[cluster]'"
_END_S: Final = 10.0
_JOB_NAME: Final = "bulkcal"
_CLASSES: Final = {"slurm": "SLURMCluster", "pbs": "PBSCluster", "lsf": "LSFCluster"}
# A run whose worker died is tried again by the campaign, which says so; Dask would do it thrice
# without a word.
_CONFIG: Final = {"distributed.scheduler.allowed-failures": 0}


def local_cluster(workers: int) -> Connection:
    """Start a scheduler and worker processes on this machine.

    Parameters
    ----------
    workers : int
        Processes, of one thread each.

    Raises
    ------
    CalibrationError
        If Dask is not installed.
    """
    need_dask("dask-local")
    import dask
    from distributed import LocalCluster

    # Silent also while it is closed, after the option below has been taken back.
    logging.getLogger("distributed.batched").setLevel(logging.CRITICAL)
    others = set(multiprocessing.active_children())
    # Its start lets signals through again, and so comes before they are held back.
    resource_tracker.ensure_running()
    with interrupts_later(), dask.config.set(_CONFIG):
        cluster = LocalCluster(
            n_workers=workers, threads_per_worker=1, memory_limit=0,
            # A free port: another cluster on this machine has the usual one.
            dashboard_address="127.0.0.1:0", scheduler_kwargs={"dashboard": False},
            host="127.0.0.1", silence_logs=logging.CRITICAL,
        )  # fmt: skip
        client = _client(cluster)
    return Connection(client, workers, "dask-local", partial(_end_local, cluster, others))


def connect(address: str, workers: int = 0) -> Connection:
    """Connect to a scheduler that runs already.

    Parameters
    ----------
    address : str
        HOST:PORT.
    workers : int
        Runs at once, 0 for as many as the cluster has threads.

    Raises
    ------
    CalibrationError
        If Dask is not installed, no scheduler answers, or it has no workers.
    """
    name = f"dask://{address}"
    need_dask(name)
    with interrupts_later():
        try:
            client = _client(f"tcp://{address}")
        except OSError as err:
            msg = (
                f"--executor {name}: no Dask scheduler answers within {RECONNECT_S:g} s ({err}); "
                "start one there with 'dask scheduler', or mend the address"
            )
            raise CalibrationError(msg) from err
    threads = sum(client.nthreads().values())
    if not threads:
        client.close()
        msg = (
            f"--executor {name}: the scheduler has no workers; start some with "
            f"'dask worker {address} --nthreads 1'"
        )
        raise CalibrationError(msg)
    return Connection(client, workers or threads, name, lambda _at_once: None)


def job_cluster(kind: str, workers: int, options: JobOptions) -> Connection:
    """Start a scheduler here whose workers are jobs in a queue.

    Jobs that end, at their walltime for example, are submitted again as long as the campaign
    lasts.

    Parameters
    ----------
    kind : str
        "slurm", "pbs" or "lsf".
    workers : int
        Runs at once.
    options : JobOptions

    Raises
    ------
    CalibrationError
        If Dask is not installed.
    """
    import dask

    with interrupts_later(), dask.config.set(_CONFIG):
        cluster = _cluster_class(kind)(
            **options.for_dask(kind), job_name=_JOB_NAME,
            # Any free port: another campaign on this machine may have Dask's usual one.
            scheduler_options={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
            silence_logs=logging.CRITICAL,
        )  # fmt: skip
        jobs = -(-workers // options.cores)
        cluster.adapt(minimum_jobs=jobs, maximum_jobs=jobs)
        client = _client(cluster)
    return Connection(client, workers, kind, lambda _at_once: _close(cluster))


def job_script(kind: str, options: JobOptions) -> str:
    """Return the script of a job, for a scheduler whose address is not known yet.

    Parameters
    ----------
    kind : str
        "slurm", "pbs" or "lsf".
    options : JobOptions

    Raises
    ------
    CalibrationError
        If Dask is not installed.
    """
    job = _cluster_class(kind).job_cls(
        scheduler="tcp://SCHEDULER:PORT", name=_JOB_NAME, job_name=_JOB_NAME,
        **options.for_dask(kind),
    )  # fmt: skip
    return str(job.job_script())


def need_dask(name: str) -> None:
    """Refuse an executor whose packages are missing.

    Raises
    ------
    CalibrationError
        With the command that installs them.
    """
    if not all(find_spec(package) for package in ("distributed", "dask_jobqueue")):
        msg = f"--executor {name}: needs the extra packages for clusters; run: {_INSTALL}"
        raise CalibrationError(msg)


def _cluster_class(kind: str) -> Any:
    need_dask(kind)
    with _same_answer_to_ctrl_c():
        import dask_jobqueue

    return getattr(dask_jobqueue, _CLASSES[kind])


@contextmanager
def _same_answer_to_ctrl_c() -> Iterator[None]:
    """Restore what Ctrl-C does: importing dask-jobqueue 0.9 makes it end a program as if well."""
    before = signal.getsignal(signal.SIGINT)
    try:
        yield
    finally:
        if signal.getsignal(signal.SIGINT) is not before:
            signal.signal(signal.SIGINT, before)


def _client(where: str | SpecCluster) -> Client:
    from distributed import Client

    return Client(where, timeout=RECONNECT_S, set_as_default=False)


def _end_local(
    cluster: LocalCluster, others: set[multiprocessing.process.BaseProcess], at_once: bool
) -> None:
    """Stop the worker processes; at once, they are killed with the runs that they are at."""
    if at_once:
        for nanny in cluster.workers.values():
            nanny.auto_restart = False
        for child in set(multiprocessing.active_children()) - others:
            child.kill()
    _close(cluster)


def _close(cluster: SpecCluster) -> None:
    with suppress(OSError, TimeoutError):
        cluster.close(timeout=_END_S)
