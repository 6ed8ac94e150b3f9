"""What LIGGGHTS 3.8.0 makes of the cases of this folder.

After a change of a case ``python -m tests.minidem.motion.stored [LIST ...]`` runs LIGGGHTS again
and writes ``tests/data/minidem/motion/LIST.json``.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

from tests.minidem.engine.cases import Case, store
from tests.paths import DATA

LISTS = ("region", "force", "carried", "command", "sieve", "dumped")
"""Lists of cases, each in its module ``LIST_cases``."""
FOLDER = DATA / "minidem" / "motion"


def cases(name: str) -> dict[str, Case]:
    """Return the cases of a list by name."""
    found: dict[str, Case] = importlib.import_module(f"tests.minidem.motion.{name}_cases").CASES
    return found


def stored(name: str) -> Path:
    """Return the file of a list."""
    return FOLDER / f"{name}.json"


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for one in sys.argv[1:] or LISTS:
        store(cases(one), stored(one))
