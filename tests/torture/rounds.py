"""Rounds of incidents, each followed by a campaign that nobody disturbs."""

from __future__ import annotations

import random
import shutil
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from liggghts_io import CaseResult, load_result
from tests.torture.accidents import ACCIDENTS, Accidents
from tests.torture.arena import Arena, Table
from tests.torture.damage import HARMS, RESULT, STORED, Harm, harm, litter
from tests.torture.disk import fill_and_free, small_disk
from tests.torture.judge import Verdict, consult, judge

DOUBLE = 0.5
"""Part of the harmed cases that lose their result as well, so that they have to look further."""


@dataclass(frozen=True)
class Torture:
    """Campaigns of one engine and what they should say.

    Attributes
    ----------
    side : Path
        Where to work.
    engine : str
    finished : Path
        Directory of a campaign that nobody disturbed.
    reference : list of dict
        Its table.
    """

    side: Path
    engine: str
    finished: Path
    reference: Table

    def arena(self, out: Path | None = None) -> Arena:
        """Return a new arena, with an empty directory where none is given."""
        out = out or self.side / uuid.uuid4().hex
        return Arena(out, self.side, self.engine, len(self.reference))

    def truth(self, case: str) -> CaseResult:
        """Return the result of a case that nobody disturbed."""
        return load_result(self.finished / "runs" / case)


def undisturbed(side: Path, engine: str, cases: int) -> Torture:
    """Run the campaign that all others are compared with."""
    side.mkdir(parents=True, exist_ok=True)
    arena = Arena(side / f"undisturbed_{engine}", side, engine, cases)
    ended = arena.finish()
    if ended.table is None or any(row["status"] != "ok" for row in ended.table):
        msg = f"the undisturbed campaign failed: {ended}"
        raise RuntimeError(msg)
    return Torture(side, engine, arena.out, ended.table)


def accident_round(
    torture: Torture, names: Sequence[str], times: int, draw: random.Random
) -> Verdict:
    """Disturb a running campaign in ways of `ACCIDENTS`, then let it continue.

    Parameters
    ----------
    torture : Torture
    names : sequence of str
        Keys of `ACCIDENTS`, one after the other in the same directory.
    times : int
        Incidents of each.
    draw : Random
    """
    arena = torture.arena()
    done = Accidents()
    for name in names:
        done += ACCIDENTS[name](arena, draw, times)
    verdict = judge(arena, done, torture.reference, set())
    shutil.rmtree(arena.out)
    return verdict


def disk_round(torture: Torture, times: int, draw: random.Random) -> Verdict:
    """Fill the disk of a campaign and free it again."""
    with small_disk(torture.side / uuid.uuid4().hex) as disk:
        arena = torture.arena(disk / "out")
        return judge(arena, fill_and_free(arena, draw, times), torture.reference, set())


def damage_round(torture: Torture, hows: Sequence[str], draw: random.Random) -> Verdict:
    """Harm one file or two of every case of a finished campaign, then let it continue.

    Parameters
    ----------
    torture : Torture
    hows : sequence of str
        Keys of `HARMS` to draw from, or "littered".
    draw : Random
    """
    arena = torture.arena(torture.side / uuid.uuid4().hex)
    shutil.copytree(torture.finished, arena.out)
    done, verdict = Accidents(lost=-arena.cases), Verdict()
    for case in sorted(arena.runs.iterdir()):
        harms = _harms(case, hows, draw)
        done.count += len(harms)
        if len(harms) > 1:
            done.lost += 1
        refused, faults = consult(case, harms, torture.truth(case.name), torture.side)
        verdict.refused += refused
        verdict.faults += faults
    verdict += judge(arena, done, torture.reference, set(arena.runs.iterdir()))
    verdict.starts += arena.cases  # the copied campaign had them behind it
    shutil.rmtree(arena.out)
    return verdict


def _harms(case: Path, hows: Sequence[str], draw: random.Random) -> list[Harm]:
    """Harm a random file of a case, and often its result too."""
    how = draw.choice(list(hows))
    if how not in HARMS:
        return [litter(case, draw)]
    found = None
    while found is None:
        kind = draw.choice([one for one in STORED if one != "lock" or how != "edited"])
        found = harm(case, kind, how, draw)
    harms = [found]
    if found.path.name != RESULT and draw.random() < DOUBLE:
        second = harm(case, RESULT, draw.choice(["cut", "emptied", "bit flipped", "deleted"]), draw)
        harms += [second] if second else []
    return harms
