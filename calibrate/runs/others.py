"""What else is in a directory of runs: cases that others are at, results of other code."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from liggghts_io import CaseSpec, case_id, other_code
from liggghts_io.case.lock import holder

__all__ = ["held_case", "older_runs"]


def held_case(spec: CaseSpec, root: Path) -> str | None:
    """Return who runs a case just now, or None."""
    return holder(root / case_id(spec))


def older_runs(root: Path) -> str:
    """Return a line about stored runs of other code; empty when there are none.

    Parameters
    ----------
    root : Path
        Holds one directory per case.
    """
    older = other_code(root)
    if not older:
        return ""
    parts = Counter(part for one in older for part in one.parts)
    what = ", ".join(f"{name}: {count}" for name, count in parts.most_common())
    runs = "1 stored run was" if len(older) == 1 else f"{len(older)} stored runs were"
    kept = "it is" if len(older) == 1 else "they are"
    return f"{runs} made by other code ({what}); {kept} kept in {root} and not used"
