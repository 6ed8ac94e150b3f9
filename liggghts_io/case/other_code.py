"""Results that other code made: they stay where they are, and nobody takes them for today's."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from liggghts_io.case.directory import RECORD, RESULT, code_today, load_record, other_parts, spec_of
from liggghts_io.case.spec import FORMAT, describe
from liggghts_io.errors import CaseError


@dataclass(frozen=True)
class OtherCode:
    """A stored result that today's code does not take for its own.

    Attributes
    ----------
    path : Path
        Case directory.
    parts : tuple of str
        What differs: "engine", "observables", "script", "meshes", "record" for a case directory
        of another form.
    """

    path: Path
    parts: tuple[str, ...]


def other_code(root: Path) -> list[OtherCode]:
    """Return the case directories under `root` with results that other code made.

    Parameters
    ----------
    root : Path
        Directory of a campaign's cases; it may be missing.

    Returns
    -------
    list of OtherCode
        In the order of the names. Damaged directories are not among them.
    """
    found = ((path.parent, _differences(path.parent)) for path in root.glob(f"*/{RESULT}"))
    return [OtherCode(path, parts) for path, parts in sorted(found) if parts]


def _differences(directory: Path) -> tuple[str, ...]:
    """Return what today's code would make otherwise, nothing for a damaged directory."""
    try:
        record = load_record(directory)
    except CaseError:
        return ("record",) if _of_other_form(directory) else ()
    try:
        parts = other_parts(record, code_today(record, directory))
        today = None if parts else describe(spec_of(record, directory))
    except CaseError:  # a value that is refused today
        return ("script",)
    if today is None:
        return parts
    if today.identity == record["case_id"]:
        return ()
    stored = record["inputs"]
    differ = tuple(part for part in ("script", "meshes") if today.inputs[part] != stored[part])
    return differ or ("record",)


def _of_other_form(directory: Path) -> bool:
    try:
        inputs = json.loads((directory / RECORD).read_bytes().decode("utf-8"))["inputs"]
        return bool(inputs.get("format", 1) != FORMAT)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return False
