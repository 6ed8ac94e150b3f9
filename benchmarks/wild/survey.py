"""A script through both engines: which runs it, what stops it, whether they agree."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Final, TypeVar

from benchmarks.wild import engines
from benchmarks.wild.engines import Outcome
from benchmarks.wild.lines import comparable, harmless, on_one_process, output_folders, without
from benchmarks.wild.listing import Entry, Result

LIGGGHTS: Final = ("stdbuf", "-oL", "liggghts")
LIGGGHTS_S: Final = 20.0
MINIDEM_S: Final = 100.0
"""Longer, as the first use of a combination of models compiles; it stops at the wanted lines."""
_REFUSALS_S: Final = 1200.0
WANTED: Final = 30
"""Lines of thermo output with motion, after which an engine is stopped."""
COMPARED: Final = 6
"""Lines with motion at which energies are compared; rounding grows afterwards."""
SAME: Final = 1e-5
"""Largest relative difference of energies: lines are 100 steps apart and have eight digits."""
_LARGEST: Final = 1_000_000
_TEXT: Final = frozenset(
    ("", ".in", ".inp", ".input", ".lmp", ".liggghts", ".sim", ".txt", ".lammps")
)
T = TypeVar("T")
Row = tuple[int, int, int, float]
"""Number of the run, step, particles, kinetic energy."""


def survey(entry: Entry, scripts: Path) -> Result:
    """Return what becomes of a script.

    Parameters
    ----------
    entry : Entry
        The script.
    scripts : Path
        Folder with one folder ``owner+name`` per repository.
    """
    first = _in_scratch(entry, scripts, _run_liggghts)
    if first.verdict != "runs":
        return _result(entry, first, Outcome(None, ""), [])
    plain = _in_scratch(entry, scripts, _run_minidem)
    refused, gone = _in_scratch(entry, scripts, _refused)
    if "fails" in (plain.verdict, *(label.split(":")[0] for label, _ in refused)):
        return _result(entry, first, plain, refused)
    again = _in_scratch(entry, scripts, partial(_compare_minidem, gone=gone))
    return _result(entry, first, plain, refused, again)


def _result(
    entry: Entry, first: Outcome, plain: Outcome, refused: list[tuple[str, str]],
    again: Outcome | None = None,
) -> Result:  # fmt: skip
    here, there = rows(first), rows(again) if again else []
    verdict, compared, energy = agreement(here, there) if again else ("", 0, 0.0)
    says, message = plain.verdict if first.verdict == "runs" else "", plain.message
    if refused and says == "runs":
        says, message = "refuses", refused[0][1]
    return Result(
        entry.repository, entry.path, first.verdict, first.message, says, message,
        "; ".join(dict.fromkeys(label for label, _ in refused)), verdict, compared,
        here[-1][2] if here else 0, energy,
    )  # fmt: skip


def rows(outcome: Outcome) -> list[Row]:
    """Return the lines that show motion, in order."""
    return [
        (number, int(line["Step"]), int(line["Atoms"]), line["KinEng"])
        for number, table in enumerate(outcome.tables)
        for line in table
        if line.get("Atoms", 0) > 0 and line.get("KinEng", 0.0) > 0.0
    ]


def agreement(here: list[Row], there: list[Row]) -> tuple[str, int, float]:
    """Return verdict, lines compared and largest relative difference of energies.

    Examples
    --------
    >>> agreement([(0, 100, 8, 2.0)], [(0, 100, 8, 2.0)])
    ('same', 1, 0.0)
    >>> agreement([(0, 100, 8, 2.0)], [(0, 100, 9, 2.0)])
    ('differs', 1, 0.0)
    >>> agreement([(0, 100, 8, 2.0)], [])
    ('nothing to compare', 0, 0.0)
    """
    other = {row[:2]: row for row in there}
    pairs = [(row, other[row[:2]]) for row in here[:COMPARED] if row[:2] in other]
    if not pairs:
        return "nothing to compare", 0, 0.0
    worst = max(abs(a[3] - b[3]) / max(a[3], b[3]) for a, b in pairs)
    same = worst <= SAME and all(a[2] == b[2] for a, b in pairs)
    return "same" if same else "differs", len(pairs), float(f"{worst:.2g}")


def _in_scratch(entry: Entry, scripts: Path, what: Callable[[Path, str], T]) -> T:
    """Do something in a copy of a script's folder, from the top of its repository."""
    with tempfile.TemporaryDirectory(prefix="wild-") as scratch:
        top = Path(scratch) / "repository"
        shutil.copytree(entry.home(scripts), top, ignore=shutil.ignore_patterns(".git"))
        folder = top / entry.folder
        script = os.path.relpath(top / entry.path, folder)
        for wanted in output_folders(_text(folder / script)):
            if ".." not in wanted.parts:
                (folder / wanted).mkdir(parents=True, exist_ok=True)
        return what(folder, script)


def _run_liggghts(folder: Path, script: str) -> Outcome:
    for path in folder.rglob("*"):
        if path.is_file() and path.suffix in _TEXT and path.stat().st_size < _LARGEST:
            text = _text(path)
            if "shell" in text:
                path.write_text(harmless(text), encoding="utf-8")
    path = folder / script
    path.write_text(on_one_process(comparable(harmless(_text(path)))), encoding="utf-8")
    return engines.run(LIGGGHTS, script, folder, LIGGGHTS_S, _enough)


def _run_minidem(folder: Path, script: str) -> Outcome:
    return engines.run(engines.MINIDEM, script, folder, MINIDEM_S, _begun)


def _compare_minidem(folder: Path, script: str, *, gone: Sequence[int]) -> Outcome:
    path = folder / script
    text = _text(path)
    for line in gone:
        text = without(text, line)
    path.write_text(comparable(text), encoding="utf-8")
    return engines.run(engines.MINIDEM, script, folder, MINIDEM_S, _enough)


def _refused(folder: Path, script: str) -> tuple[list[tuple[str, str]], list[int]]:
    """Return what is refused with its message, and the lines to be taken out."""
    command = [sys.executable, "-m", "benchmarks.wild.refusals", script]
    try:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, timeout=_REFUSALS_S, check=False
        )
        text = done.stdout
    except subprocess.TimeoutExpired as err:
        text = err.stdout or b""
    found, gone = [], []
    for line in text.decode("utf-8", "replace").splitlines():
        label, tab, rest = line.partition("\t")
        message, _, number = rest.rpartition("\t")
        if tab and label:
            found.append((label, message))
        if tab and number.isdigit():
            gone.append(int(number))
    return found, gone


def _enough(screen: str) -> bool:
    return len(rows(Outcome(None, "", engines.thermo(screen)))) >= WANTED


def _begun(screen: str) -> bool:
    """Tell whether a run took its first steps."""
    return any(map(len, engines.thermo(screen)))


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")
