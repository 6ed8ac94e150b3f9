"""A script through both engines: which runs it, what stops it, whether they agree."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
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
"""Longer, as the first use of a combination of models compiles; it stops after those compared."""
_BEFORE_S: Final = 60.0
"""For each script that has to be run before, to its end."""
_REFUSALS_S: Final = 1200.0
WANTED: Final = 12
"""Lines of thermo output with motion, after which LIGGGHTS is stopped."""
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
    first = liggghts(entry, scripts)
    if first.verdict != "runs":
        return _result(entry, first, Outcome(None, ""), [])
    plain = _in_scratch(entry, scripts, _run_minidem)
    refused, gone = _in_scratch(entry, scripts, _refused)
    if any(label.startswith("thermo") for label, _ in refused):
        # the script that is compared has other thermo output, which hides what LIGGGHTS refuses
        asked = _in_scratch(entry, scripts, partial(_run_liggghts, alike=False))
        if asked.verdict != "runs":
            return _result(entry, asked, Outcome(None, ""), [])
    if "fails" in (plain.verdict, *(label.split(":")[0] for label, _ in refused)):
        return _result(entry, first, plain, refused)
    here = rows(first)
    if not here:
        return _result(entry, first, plain, refused, Outcome(None, ""))
    again = _in_scratch(entry, scripts, partial(_compare_minidem, gone=gone, here=here))
    return _result(entry, first, plain, refused, again)


def liggghts(entry: Entry, scripts: Path) -> Outcome:
    """Return how LIGGGHTS ends a script; the folder is that of `survey`."""
    return _in_scratch(entry, scripts, _run_liggghts)


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
    """Return the lines that show motion, in order; where nothing moves those with particles."""
    found = [
        (number, int(line["Step"]), int(line["Atoms"]), line.get("KinEng", 0.0))
        for number, table in enumerate(outcome.tables)
        for line in table
        if line.get("Atoms", 0) > 0
    ]
    return [row for row in found if row[3] > 0.0] or found


def agreement(here: list[Row], there: list[Row]) -> tuple[str, int, float]:
    """Return verdict, lines compared and largest relative difference of energies.

    Examples
    --------
    >>> agreement([(0, 100, 8, 2.0)], [(0, 100, 8, 2.0)])
    ('same', 1, 0.0)
    >>> agreement([(0, 100, 8, 2.0)], [(0, 100, 9, 2.0)])
    ('differs', 1, 0.0)
    >>> agreement([(0, 100, 8, 0.0)], [(0, 100, 8, 0.0)])
    ('same', 1, 0.0)
    >>> agreement([(0, 100, 8, 2.0)], [])
    ('nothing to compare', 0, 0.0)
    """
    other = {row[:2]: row for row in there}
    pairs = [(row, other[row[:2]]) for row in here[:COMPARED] if row[:2] in other]
    if not pairs:
        return "nothing to compare", 0, 0.0
    worst = max(abs(a[3] - b[3]) / (max(a[3], b[3]) or 1.0) for a, b in pairs)
    same = worst <= SAME and all(a[2] == b[2] for a, b in pairs)
    return "same" if same else "differs", len(pairs), float(f"{worst:.2g}")


@dataclass(frozen=True)
class _Case:
    """A script in a copy of its repository, with those that are run before it."""

    top: Path
    folder: Path
    chain: tuple[str, ...]
    variables: Mapping[str, Sequence[str]]

    @property
    def script(self) -> Path:
        return self.folder / self.chain[-1]

    @property
    def up(self) -> str:
        """The folder above the repository, seen from the folder."""
        return os.path.relpath(self.top.parent, self.folder)

    @property
    def minidem(self) -> tuple[str, ...]:
        """The command; meshes may lie anywhere in the repository, output beside it."""
        return (*engines.MINIDEM, "-folder", self.up)

    def run(
        self, engine: Sequence[str], seconds: float, enough: Callable[[str], bool] | None = None
    ) -> Outcome:
        """Run all scripts, those before the last one to their ends."""
        options = [w for name, values in self.variables.items() for w in ("-var", name, *values)]
        for script in self.chain[:-1]:
            before = self._run((*engine, *options), script, _BEFORE_S)
            if before.code != 0 or before.message:
                before.message = f"{script}: {before.message or 'does not end'}"
                before.tables.clear()
                return before
        return self._run((*engine, *options), self.chain[-1], seconds, enough)

    def _run(
        self, command: Sequence[str], script: str, seconds: float,
        enough: Callable[[str], bool] | None = None,
    ) -> Outcome:  # fmt: skip
        return engines.run(command, script, self.folder, seconds, enough)


def _in_scratch(entry: Entry, scripts: Path, what: Callable[[_Case], T]) -> T:
    """Do something in a copy of a script's folder, from the top of its repository."""
    with tempfile.TemporaryDirectory(prefix="wild-") as scratch:
        top = Path(scratch).resolve() / "repository"
        shutil.copytree(
            entry.home(scripts), top, ignore=shutil.ignore_patterns(".git"),
            ignore_dangling_symlinks=True,
        )  # fmt: skip
        folder = top / entry.folder
        chain = tuple(os.path.relpath(top / path, folder) for path in entry.chain)
        for script in chain:
            for wanted in output_folders(_text(folder / script)):
                made = (folder / wanted).resolve()
                if made.is_relative_to(top):
                    made.mkdir(parents=True, exist_ok=True)
        return what(_Case(top, folder, chain, entry.variables))


def _run_liggghts(case: _Case, *, alike: bool = True) -> Outcome:
    """Run LIGGGHTS, with the thermo output that is compared or with that of the script."""
    for path in case.folder.rglob("*"):
        if path.is_file() and path.suffix in _TEXT and path.stat().st_size < _LARGEST:
            text = _text(path)
            if "shell" in text:
                path.write_text(harmless(text), encoding="utf-8")
    for script in case.chain:
        path = case.folder / script
        path.write_text(on_one_process(harmless(_text(path))), encoding="utf-8")
    if alike:
        case.script.write_text(comparable(_text(case.script)), encoding="utf-8")
    return case.run(LIGGGHTS, LIGGGHTS_S, _enough if alike else None)


def _run_minidem(case: _Case) -> Outcome:
    return case.run(case.minidem, MINIDEM_S, _begun)


def _compare_minidem(
    case: _Case, *, gone: Mapping[str, Sequence[int]], here: Sequence[Row]
) -> Outcome:
    last = here[:COMPARED][-1][:2]

    def enough(screen: str) -> bool:
        there = rows(Outcome(None, "", engines.thermo(screen)))
        return bool(there) and there[-1][:2] > last

    for script, lines in gone.items():
        _take_out(case.folder / script, lines)
    case.script.write_text(comparable(_text(case.script)), encoding="utf-8")
    return case.run(case.minidem, MINIDEM_S, enough)


def _refused(case: _Case) -> tuple[list[tuple[str, str]], dict[str, list[int]]]:
    """Return what is refused with its message, and for each script the lines to be taken out.

    A script that is run before the last one is run without them, as it writes what is read next.
    """
    found: list[tuple[str, str]] = []
    gone: dict[str, list[int]] = {}
    for script in case.chain:
        path = case.folder / script
        text = _text(path)
        more, gone[script] = _refused_in(case, script)
        found += more
        path.write_text(text, encoding="utf-8")
        _take_out(path, gone[script])
        if script != case.chain[-1]:
            replace(case, chain=(script,)).run(case.minidem, _BEFORE_S)
    return found, gone


def _refused_in(case: _Case, script: str) -> tuple[list[tuple[str, str]], list[int]]:
    pairs = [f"{name}={','.join(values)}" for name, values in case.variables.items()]
    command = [sys.executable, "-m", "benchmarks.wild.refusals", script, case.up, *pairs]
    try:
        done = subprocess.run(
            command, cwd=case.folder, capture_output=True, timeout=_REFUSALS_S, check=False
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


def _take_out(path: Path, lines: Sequence[int]) -> None:
    text = _text(path)
    for line in lines:
        text = without(text, line)
    path.write_text(text, encoding="utf-8")


def _enough(screen: str) -> bool:
    return len(rows(Outcome(None, "", engines.thermo(screen)))) >= WANTED


def _begun(screen: str) -> bool:
    """Tell whether a run took its first steps."""
    return any(map(len, engines.thermo(screen)))


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")
