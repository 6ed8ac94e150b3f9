"""What became of the runs in a directory, read from the case directories.

An index beside them remembers what was read. It is a cache: an entry counts as long as the result
file of its case has the same inode, size and time of last change (which nobody can set), so that
the directories are always right. It is rebuilt when it is missing, damaged or of another version.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final, NamedTuple, TypeAlias

from liggghts_io.case.directory import OUTPUT, RECORD, RESULT
from liggghts_io.case.lock import HOLDER, LOCK, holder
from liggghts_io.files import read_signed_json, sha256_text, write_text

__all__ = ["INDEX", "Case", "list_cases"]

INDEX: Final = ".status"
DAMAGED, RUNNING, UNFINISHED = "damaged", "running", "unfinished"
_VERSION: Final = "bulkcal status 1"
_Stamp: TypeAlias = tuple[int, int, int]
_SAME: Final = 3  # numbers of a stamp


class Case(NamedTuple):
    """A case directory in a word.

    Attributes
    ----------
    name : str
        Of the directory.
    status : str
        "ok", "failed", "damaged" (its result cannot be read), "running", or "unfinished": begun
        by a process that is gone, or written and never run.
    failure : str
        Class of the failure.
    reason : str
        Why it failed, what is damaged, or who runs it.
    wall_s : float
        Duration of the run [s].
    ended : float
        When the result was written [s since 1970].
    """

    name: str
    status: str
    failure: str = ""
    reason: str = ""
    wall_s: float = 0.0
    ended: float = 0.0


@dataclass
class _Index:
    """Cases by name, each with the stamp of the file that it was read from."""

    entries: dict[str, tuple[_Stamp, Case]]
    changed: bool = False


def list_cases(root: Path) -> list[Case]:
    """Return what became of every case in a directory.

    Parameters
    ----------
    root : Path
        Holds case directories; other directories and files are passed over.
    """
    index = _read_index(root / INDEX)
    cases = [case for name in _directories(root) if (case := _case(root, name, index))]
    gone = index.entries.keys() - {case.name for case in cases}
    for name in gone:
        del index.entries[name]
    if gone or (index.changed and index.entries):  # nothing is left where there are no cases
        _write_index(root / INDEX, index)
    return cases


def _directories(root: Path) -> list[str]:
    with os.scandir(root) as entries:
        return sorted(one.name for one in entries if one.name[0] != "." and one.is_dir())


def _case(root: Path, name: str, index: _Index) -> Case | None:
    """Return what became of a case; None for a directory that holds none."""
    path = f"{root}/{name}"
    # The file that names the holder is there while a lock is held, and after a sudden death.
    if _stamp(f"{path}/{HOLDER}") and (who := holder(root / name)) is not None:
        return Case(name, RUNNING, reason=who)
    stamp = _stamp(f"{path}/{RESULT}")
    if stamp is None:
        begun = any(os.path.lexists(f"{path}/{one}") for one in (RECORD, LOCK, OUTPUT))
        return Case(name, UNFINISHED) if begun else None
    known = index.entries.get(name)
    if known is not None and known[0] == stamp:
        return known[1]
    case = _read(root / name)
    if case.status != DAMAGED:
        index.entries[name] = (stamp, case)
        index.changed = True
    return case


def _stamp(path: str) -> _Stamp | None:
    """Return what changes with every change of a file; None where there is none."""
    try:
        found = os.stat(path)  # noqa: PTH116 - a tenth of the time of Path.stat, 100 000 times
    except OSError:
        return None
    return found.st_ctime_ns, found.st_size, found.st_ino


def _read(directory: Path) -> Case:
    path = directory / RESULT
    try:
        result = read_signed_json(path, "result")
        ended = path.stat().st_mtime
        return Case(
            directory.name, str(result["status"]), str(result["failure"]), str(result["reason"]),
            float(result["wall_s"]), ended,
        )  # fmt: skip
    except (OSError, ValueError, KeyError, TypeError) as err:
        return Case(directory.name, DAMAGED, reason=f"{RESULT}: {err}")


def _read_index(path: Path) -> _Index:
    """Return the stored index, empty where it cannot be used."""
    with suppress(OSError, ValueError, KeyError, TypeError):
        head, _, text = path.read_text(encoding="utf-8").partition("\n")
        if head == f"{_VERSION} {sha256_text(text)}":
            return _Index(dict(_entries(json.loads(text))))
    return _Index({}, changed=True)


def _entries(rows: list[list[object]]) -> Iterator[tuple[str, tuple[_Stamp, Case]]]:
    for row in rows:
        changed, size, inode = row[:_SAME]
        case = Case(*row[_SAME:])  # type: ignore[arg-type]
        yield case.name, ((int(changed), int(size), int(inode)), case)  # type: ignore[call-overload]


def _write_index(path: Path, index: _Index) -> None:
    rows = [[*stamp, *case] for stamp, case in index.entries.values()]
    text = json.dumps(rows, separators=(",", ":"))
    with suppress(OSError):  # the directory may be somebody else's
        write_text(path, f"{_VERSION} {sha256_text(text)}\n{text}")
