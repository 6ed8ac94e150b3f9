"""Whether a campaign came through: equal to the last bit, or refused by name."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field
from pathlib import Path

from liggghts_io import CaseError, CaseResult, post_case, run_case, stored_result
from tests.torture.accidents import Accidents
from tests.torture.arena import Arena, Table
from tests.torture.damage import Harm


@dataclass
class Verdict:
    """What came of the incidents of one kind.

    Attributes
    ----------
    incidents, refused, starts : int
        Incidents; refusals by name among what followed; engine starts beyond one per case.
    faults : list of str
        Everything that should not be.
    """

    incidents: int = 0
    refused: int = 0
    starts: int = 0
    faults: list[str] = field(default_factory=list)

    def __iadd__(self, other: Verdict) -> Verdict:
        """Add another verdict to this one."""
        self.incidents += other.incidents
        self.refused += other.refused
        self.starts += other.starts
        self.faults += other.faults
        return self


def judge(arena: Arena, done: Accidents, reference: Table, harmed: set[Path]) -> Verdict:
    """Let an undisturbed campaign continue and compare it with one that never was disturbed.

    Parameters
    ----------
    arena : Arena
    done : Accidents
        What was done to it.
    reference : list of dict
        Table of a campaign that nobody disturbed.
    harmed : set of Path
        Case directories with harmed files.
    """
    before = arena.finished()
    last = arena.finish()
    verdict = Verdict(done.count, faults=list(done.faults))
    for one in (*done.ended, last):
        if one.table is None:
            verdict.faults.append(f"a campaign did not end well: {one.code} {one.said[-500:]}")
        elif one.table != reference:
            verdict.faults.append(f"another result: {_difference(one.table, reference)}")
    verdict.starts = arena.starts() - arena.cases
    if verdict.starts > done.lost:
        verdict.faults.append(f"{verdict.starts} runs too many, {done.lost} were lost")
    for path, stored in before.items():
        final = b'"failure": ""' in stored[0] or b'"failure": "physics"' in stored[0]
        if final and path.parent not in harmed and arena.finished().get(path) != stored:
            verdict.faults.append(f"{path}: a stored result was written anew")
    if arena.orphans():
        verdict.faults.append(f"processes are left: {arena.orphans()}")
    return verdict


def _difference(table: Table, reference: Table) -> str:
    pairs = zip(table, reference, strict=False)
    return "; ".join(f"{one} instead of {other}" for one, other in pairs if one != other)


def consult(case: Path, harms: list[Harm], truth: CaseResult, side: Path) -> tuple[int, list[str]]:
    """Ask a copy of a harmed case for its numbers in every way there is.

    Parameters
    ----------
    case : Path
        Case directory.
    harms : list of Harm
        What was done to it.
    truth : CaseResult
        What it said before.
    side : Path
        Where to put the copy.

    Returns
    -------
    refused : int
        How many ways were refused by name.
    faults : list of str
        Other numbers, refusals that name nothing.
    """
    refused, faults = 0, []
    ways = {
        "stored": lambda copy: stored_result(copy.parent, copy.name),
        "post": post_case,
        "run": run_case,
    }
    for name, way in ways.items():
        copy = side / "copy" / case.name
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(case, copy)
        try:
            result = way(copy)
        except CaseError as err:
            refused += 1
            if not any(harm.path.name in str(err) for harm in harms):
                faults.append(f"{name} of {_words(harms)}: refused without its name: {err}")
            continue
        if result is not None and result.observables != truth.observables:
            faults.append(f"{name} of {_words(harms)}: {result} instead of {truth}")
    return refused, faults


def _words(harms: list[Harm]) -> str:
    return ", ".join(f"{one.path} {one.how}" for one in harms)
