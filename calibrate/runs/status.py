"""How far the runs in a directory are: done, failed and why, under way, still to come."""

from __future__ import annotations

import re
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from calibrate.runs.listing import DAMAGED, RUNNING, UNFINISHED, Case, list_cases
from calibrate.runs.presence import Plan, campaigns_in

__all__ = ["Group", "Status", "status_of"]

_NUMBER: Final = re.compile(r"[-+]?\d[\d.]*(?:[eE][-+]?\d+)?")
_WINDOW_S: Final = 3600.0
"""The rate is that of the last hour, or since the campaigns began where that is less [s]."""
_LEAST: Final = 2  # runs that a rate needs


@dataclass(frozen=True)
class Group:
    """Runs that failed for the same reason, numbers in its words apart.

    Attributes
    ----------
    failure : str
        Class.
    reason : str
        That of the first one.
    runs : int
    first : str
        Name of its case directory.
    """

    failure: str
    reason: str
    runs: int
    first: str


@dataclass(frozen=True)
class Status:
    """How far the runs in a directory are.

    Attributes
    ----------
    root : Path
    done : int
        Runs with numbers.
    failed : tuple of Group
        The largest first.
    damaged : tuple of Case
        Results that cannot be read; a campaign runs these cases again.
    running : tuple of Case
        Their `reason` says who runs them.
    unfinished : int
        Cases begun by a process that is gone, or written and never run.
    campaigns : tuple of Plan
        Campaigns under way.
    waiting : int
        Runs that these still have to start.
    per_hour : float or None
        Runs that ended in an hour; None where no campaign is under way or too few have ended.
    left_s : float or None
        Time until the runs known of have ended, at this rate [s].
    """

    root: Path
    done: int
    failed: tuple[Group, ...]
    damaged: tuple[Case, ...]
    running: tuple[Case, ...]
    unfinished: int
    campaigns: tuple[Plan, ...]
    waiting: int
    per_hour: float | None
    left_s: float | None

    @property
    def failures(self) -> int:
        """Failed runs."""
        return sum(group.runs for group in self.failed)


def status_of(root: Path) -> Status:
    """Read how far the runs in a directory are, also while they go on.

    Scripts, meshes and tables of finished cases are not checked, as a campaign does before it
    takes a result.

    Parameters
    ----------
    root : Path
        Holds one directory per case.
    """
    campaigns = campaigns_in(root)
    cases = list_cases(root)
    by = {name: [one for one in cases if one.status == name] for name in (DAMAGED, RUNNING)}
    waiting = max(0, _still_to_come(campaigns) - len(by[RUNNING]))
    rate = _rate([case.ended for case in cases if case.ended], campaigns, time.time())
    left = None if rate is None else (waiting + len(by[RUNNING])) / rate
    return Status(
        root=root,
        done=sum(case.status == "ok" for case in cases),
        failed=tuple(_groups([case for case in cases if case.status == "failed"])),
        damaged=tuple(by[DAMAGED]),
        running=tuple(by[RUNNING]),
        unfinished=sum(case.status == UNFINISHED for case in cases),
        campaigns=tuple(campaigns),
        waiting=waiting,
        per_hour=None if rate is None else 3600.0 * rate,
        left_s=left,
    )


def _still_to_come(campaigns: Sequence[Plan]) -> int:
    """Return how many runs campaigns wait for; those at the same part of a study share them."""
    parts: dict[tuple[str, int], int] = {}
    for plan in campaigns:
        part = plan.label, plan.total
        parts[part] = min(plan.total - plan.done, parts.get(part, plan.total))
    return sum(parts.values())


def _rate(ended: Sequence[float], campaigns: Sequence[Plan], now: float) -> float | None:
    """Return runs per second, of the campaigns under way; None when it cannot be told."""
    if not campaigns:
        return None
    since = max(min(plan.started for plan in campaigns), now - _WINDOW_S)
    fresh = sum(since <= one <= now for one in ended)
    return fresh / (now - since) if fresh >= _LEAST else None


def _groups(failed: Sequence[Case]) -> list[Group]:
    keys = [(case.failure, _NUMBER.sub("#", case.reason)) for case in failed]
    first: dict[tuple[str, str], Case] = {}
    for key, case in zip(keys, failed, strict=True):
        first.setdefault(key, case)
    return [
        Group(first[key].failure, first[key].reason, runs, first[key].name)
        for key, runs in Counter(keys).most_common()
    ]
