"""Let stored failures run again without losing what is known of them."""

from __future__ import annotations

import itertools
from contextlib import suppress
from pathlib import Path

from liggghts_io import CaseError, CaseResult, load_result
from liggghts_io.case.directory import OUTPUT, RESULT
from liggghts_io.case.lock import holder, locked

__all__ = ["set_aside"]

_ASIDE = "failed-{}"


def set_aside(root: Path, failure: str = "") -> list[Path]:
    """Move result and output of failed cases into a folder of their own beside them.

    Parameters
    ----------
    root : Path
        A case directory, or one that holds case directories; a case that somebody runs just now
        is left alone.
    failure : str
        Class of the failures, empty for all.

    Returns
    -------
    list of Path
        Case directories that count as not run from now on.
    """
    moved = []
    for directory in (root, *sorted(path.parent for path in root.glob(f"*/{RESULT}"))):
        if _failed(directory, failure) is None or holder(directory) is not None:
            continue
        with locked(directory):
            if _failed(directory, failure) is not None:
                _move(directory)
                moved.append(directory)
    return moved


def _failed(directory: Path, failure: str) -> CaseResult | None:
    """Return the stored failure of a class; None where there is none or the case is damaged."""
    with suppress(CaseError):
        result = load_result(directory)
        if result.status != "ok" and failure in ("", result.failure):
            return result
    return None


def _move(directory: Path) -> None:
    names = (directory / _ASIDE.format(number) for number in itertools.count(1))
    aside = next(path for path in names if not path.exists())
    aside.mkdir()
    for name in (OUTPUT, RESULT):  # the result last: without it the case counts as not run
        if (directory / name).exists():
            (directory / name).rename(aside / name)
