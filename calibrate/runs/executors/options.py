"""Options of a job queue: what a user may ask of it, and what dask-jobqueue calls that."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from calibrate.errors import CalibrationError, unknown_name

__all__ = ["JobOptions", "job_options"]

_WALLTIME: Final = re.compile(r"\d{1,3}:[0-5]\d:[0-5]\d")
_MEMORY: Final = re.compile(r"\d+(\.\d+)?\s*[KMGT]i?B", re.IGNORECASE)
_WORDS: Final = ("queue", "account", "interface", "local_directory", "log_directory", "python")
_KNOWN: Final = (*_WORDS, "walltime", "memory", "cores", "setup", "directive")

START_S: Final = 600
"""Time that a job's workers have to start [s]: a full machine takes more than Dask's minute to
read the packages, and a job that ends before its workers are there is not submitted again."""


@dataclass(frozen=True)
class JobOptions:
    """What is asked of a job queue.

    Attributes
    ----------
    cores : int
        Cores of a job: it runs as many cases at once.
    memory : str
        Memory of a job, for example "8GB".
    walltime : str
        Longest time of a job, HH:MM:SS; empty for the queue's own.
    queue, account : str
        Queue (or partition), and account or project that pays; empty for the default.
    interface : str
        Network interface by which jobs and this process reach each other, for example "ib0".
    local_directory, log_directory : str
        Scratch space of a worker; where the output of jobs goes.
    python : str
        Interpreter of the workers; empty for this one.
    setup : tuple of str
        Shell lines before the worker starts, such as "module load gcc".
    directive : tuple of str
        More lines for the head of the job script, without "#SBATCH" and the like.
    """

    cores: int = 1
    memory: str = "2GB"
    walltime: str = ""
    queue: str = ""
    account: str = ""
    interface: str = ""
    local_directory: str = ""
    log_directory: str = ""
    python: str = ""
    setup: tuple[str, ...] = ()
    directive: tuple[str, ...] = ()

    def for_dask(self, kind: str) -> dict[str, Any]:
        """Return the options in the words of dask-jobqueue.

        Parameters
        ----------
        kind : str
            "slurm", "pbs" or "lsf".
        """
        words = {
            "queue": self.queue,
            "project" if kind == "lsf" else "account": self.account,
            # LSF knows hours and minutes only.
            "walltime": self.walltime[: -len(":00")] if kind == "lsf" else self.walltime,
            "interface": self.interface,
            "local_directory": self.local_directory,
            "log_directory": self.log_directory,
            "python": self.python,
            "job_script_prologue": list(self.setup),
            "job_extra_directives": list(self.directive),
        }
        given = {name: value for name, value in words.items() if value}
        # One thread per process: an engine has its process for itself.
        return {
            "cores": self.cores, "processes": self.cores, "memory": self.memory,
            "death_timeout": START_S, **given,
        }  # fmt: skip


def job_options(given: Mapping[str, object], place: str = "--executor-option") -> JobOptions:
    """Check options of a job queue.

    Parameters
    ----------
    given : mapping of str to object
        Values as text, numbers, or sequences of text for `setup` and `directive`.
    place : str
        Where they stand, for the messages.

    Raises
    ------
    CalibrationError
        Naming the option, its value and what would be right.
    """
    values: dict[str, Any] = {}
    for name, value in given.items():
        if name not in _KNOWN:
            msg = f"{place} {name}: {unknown_name(name, _KNOWN)}"
            raise CalibrationError(msg)
        values[name] = _checked(f"{place} {name} = {value!r}", name, value)
    return JobOptions(**values)


def _checked(place: str, name: str, value: object) -> object:
    if name in ("setup", "directive"):
        lines = (value,) if isinstance(value, str) else value
        if not isinstance(lines, list | tuple):
            msg = f"{place}: give a line, or a list of lines"
            raise CalibrationError(msg)
        return tuple(_line(place, line) for line in lines)
    text = _line(place, value)
    if name == "cores":
        if not text.isascii() or not text.isdigit() or int(text) < 1:
            msg = f"{place}: give a whole number of cores from 1 on"
            raise CalibrationError(msg)
        return int(text)
    if name == "walltime" and not _WALLTIME.fullmatch(text):
        msg = f"{place}: give hours, minutes and seconds, for example 12:00:00"
        raise CalibrationError(msg)
    if name == "memory" and not _MEMORY.fullmatch(text):
        msg = f"{place}: give a size with its unit, for example 8GB"
        raise CalibrationError(msg)
    return text


def _line(place: str, value: object) -> str:
    """Return a value as one line of text: another one would be a line of the job script."""
    text = str(value).strip()
    if not text or not text.isprintable():
        msg = f"{place}: give one line of text that can be printed"
        raise CalibrationError(msg)
    return text
