"""Real scripts through both engines: python -m benchmarks.wild FOLDER.

FOLDER holds the repositories of ``scripts.csv``, each at its commit as ``FOLDER/owner+name``; of
each only the script, what it reads and its folder are needed. Scripts that have a result already
are left out, so that it can be stopped and continued; ``--again TEXT`` takes those whose
repository, path or results contain a text anew. Without FOLDER only the page is written.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import astuple
from pathlib import Path

from benchmarks.wild import page
from benchmarks.wild.listing import PLAIN, RESULTS, Entry, Result, entries, results, store
from benchmarks.wild.survey import survey

_NICE = 15


def _wanted(known: dict[tuple[str, str], Result], again: str | None) -> list[Entry]:
    found = []
    for entry in entries():
        old = known.get((entry.repository, entry.path))
        seen = f"{entry.repository}/{entry.path} {' '.join(map(str, astuple(old)))}" if old else ""
        if entry.what == PLAIN and (old is None or (again is not None and again in seen)):
            found.append(entry)
    return found


def _ordered(known: dict[tuple[str, str], Result]) -> list[Result]:
    keys = [(entry.repository, entry.path) for entry in entries()]
    return [known[key] for key in keys if key in known]


def main(argv: Sequence[str] | None = None) -> None:
    """Run what has no result yet, then write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", help="where the repositories are")
    parser.add_argument("--again", metavar="TEXT", help="scripts to be run once more")
    parser.add_argument("--workers", type=int, default=1, choices=(1, 2))
    chosen = parser.parse_args(argv)
    if chosen.folder:
        os.setpriority(os.PRIO_PROCESS, 0, max(_NICE, os.getpriority(os.PRIO_PROCESS, 0)))
        scripts = chosen.folder.resolve()
        known = {(row.repository, row.path): row for row in results()}
        wanted = _wanted(known, chosen.again)
        with ThreadPoolExecutor(chosen.workers) as pool:
            tasks = [
                pool.submit(survey, entry, scripts)
                for entry in wanted
                if (entry.home(scripts) / entry.path).is_file()
            ]
            for task in as_completed(tasks):
                row = task.result()
                known[row.repository, row.path] = row
                store(_ordered(known), RESULTS)
                print(
                    row.repository, row.path, row.liggghts, row.minidem or "-",
                    row.verdict or row.refused, sep=" | ", flush=True,
                )  # fmt: skip
    page.write()


if __name__ == "__main__":
    main()
