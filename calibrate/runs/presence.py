"""What campaigns say of themselves in the directory that they work in, for `bulkcal status`.

Nobody relies on it: cases know each other by their locks, results by their files.
"""

from __future__ import annotations

import json
import shutil
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Final

from liggghts_io.case.lock import holder, locked
from liggghts_io.files import write_text

__all__ = ["CAMPAIGNS", "Plan", "Presence", "campaigns_in", "present"]

CAMPAIGNS: Final = ".campaigns"
_PLAN: Final = "plan.json"
_OFTEN_S: Final = 1.0  # at most so often is it written


@dataclass(frozen=True)
class Plan:
    """What a campaign is at.

    Attributes
    ----------
    label : str
        Part of the work.
    total, done, failed : int
        Runs of this part; `done` counts those that were stored already.
    reused : int
        Runs that were stored already when it began.
    workers : int
        Runs at once.
    started : float
        When this part began [s since 1970].
    who : str
        Process, host and command; empty in the file.
    """

    label: str
    total: int
    done: int
    failed: int
    reused: int
    workers: int
    started: float
    who: str = ""


class Presence:
    """A campaign's own entry.

    Parameters
    ----------
    directory : Path
    plan : Plan
    """

    def __init__(self, directory: Path, plan: Plan) -> None:
        self._directory = directory
        self._plan = plan
        self._written = -_OFTEN_S
        self.update(plan.done, plan.failed)

    def update(self, done: int, failed: int) -> None:
        """Say how far it is; a disk that takes nothing is for the runs to tell."""
        now = time.monotonic()
        if now - self._written < _OFTEN_S:
            return
        self._written = now
        plan = replace(self._plan, done=done, failed=failed)
        with suppress(OSError):
            write_text(self._directory / _PLAN, json.dumps(asdict(plan)) + "\n")


@contextmanager
def present(root: Path, plan: Plan) -> Iterator[Presence]:
    """Have an entry while a ``with`` block lasts; those of dead campaigns are removed.

    Parameters
    ----------
    root : Path
        Directory of the cases.
    plan : Plan
    """
    place = root / CAMPAIGNS
    for old in _entries(place):
        if holder(old) is None:
            shutil.rmtree(old, ignore_errors=True)
    own = place / uuid.uuid4().hex[:12]
    try:
        with locked(own):
            yield Presence(own, plan)
    finally:
        shutil.rmtree(own, ignore_errors=True)
        with suppress(OSError):  # others are there
            place.rmdir()


def campaigns_in(root: Path) -> list[Plan]:
    """Return what the campaigns under way in a directory say.

    Parameters
    ----------
    root : Path
        Directory of the cases.
    """
    found = []
    for entry in _entries(root / CAMPAIGNS):
        who = holder(entry)
        if who is None:
            continue
        with suppress(OSError, ValueError, TypeError):  # half-written, or of another version
            plan = Plan(**json.loads((entry / _PLAN).read_text(encoding="utf-8")))
            found.append(replace(plan, who=who))
    return sorted(found, key=lambda plan: plan.started)


def _entries(place: Path) -> list[Path]:
    try:
        return sorted(path for path in place.iterdir() if path.is_dir())
    except OSError:
        return []
