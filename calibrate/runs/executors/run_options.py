"""How the runs of a study are made: by what, how many at once, for how long."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

from calibrate.executor_names import JOB_QUEUES, LOCAL
from calibrate.runs.executors.choose import checked, executor_of
from calibrate.runs.executors.clusters import job_script
from calibrate.runs.executors.sized import SizedExecutor

__all__ = ["RunOptions"]

Function = TypeVar("Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class RunOptions:
    """How the runs of a study are made; wrong ones are refused when it is made.

    Attributes
    ----------
    workers : int
        Runs at once; 0 for one per core, see `executor_of`.
    executor : str
        "local", "dask-local", "dask://HOST:PORT", "slurm", "pbs" or "lsf".
    options : mapping of str to object
        Of a job queue.
    limit_s : float, optional
        Wall-clock limit of a run [s].
    """

    workers: int = 0
    executor: str = LOCAL
    options: Mapping[str, object] = field(default_factory=dict)
    limit_s: float | None = None

    def __post_init__(self) -> None:
        """Refuse an unknown executor or option."""
        checked(self.executor, self.options)

    def filled(self, other: RunOptions) -> RunOptions:
        """Return these options, with those of another where these have their defaults."""
        return RunOptions(
            workers=self.workers or other.workers,
            executor=other.executor if self.executor == LOCAL else self.executor,
            options=self.options or other.options,
            limit_s=other.limit_s if self.limit_s is None else self.limit_s,
        )

    def open(self) -> SizedExecutor:
        """Return the executor, a context manager."""
        return executor_of(self.executor, self.workers, self.options)

    def limited(self, function: Function) -> Function | partial[Any]:
        """Return a function that runs or looks up a case, with the limit if there is one."""
        return function if self.limit_s is None else partial(function, limit_s=self.limit_s)

    @property
    def place(self) -> str:
        """Where the runs are made, in words."""
        if self.executor == LOCAL:
            return f"{self.workers or os.cpu_count() or 1} processes"
        return self.executor

    @property
    def words(self) -> str:
        """The options of the command line that say the same, each after a space."""
        found = ["--workers", str(self.workers)] if self.workers else []
        if self.executor != LOCAL:
            found += ["--executor", self.executor]
        for name, value in self.options.items():
            for one in value if isinstance(value, list | tuple) else [value]:
                found += ["--executor-option", f"{name}={one}"]
        if self.limit_s is not None:
            found += ["--time-limit", f"{self.limit_s:g}"]
        return "".join(f" {shlex.quote(word)}" for word in found)

    def facts(self) -> dict[str, Any]:
        """Return what a dry run says about it."""
        found: dict[str, Any] = {}
        if self.executor == LOCAL:
            found["processes"] = self.workers or os.cpu_count() or 1
        else:
            found["executor"] = self.executor
        if self.limit_s is not None:
            found["time limit of a run"] = f"{self.limit_s:g} s"
        name, asked = checked(self.executor, self.options)
        if name.kind in JOB_QUEUES:
            found["job script"] = job_script(name.kind, asked).splitlines()
        return found
