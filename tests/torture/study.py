"""The command itself under torture: bulkcal calibrate, with surrogates, pictures and a report."""

from __future__ import annotations

import json
import random
import shutil
import signal
import sys
import time
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from calibrate.errors import CalibrationError
from calibrate.report.record_file import read_record
from calibrate.runs.stored import RECORD, REPORT, TABLE
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.resources import bundled_study
from calibrate.study.schema.parameters import Parameter
from calibrate.study.schema.settings import Apparatus
from calibrate.study.write import study_text
from tests.torture.accidents import Accidents
from tests.torture.arena import Arena, Table
from tests.torture.damage import HARMS
from tests.torture.judge import Verdict
from tests.torture.program import PLATE

POINTS, SEEDS = 8, 2
RUNS = POINTS + SEEDS
NUMBERS = ("parameters", "stages", "covariance", "check", "runs", "failed_runs")
"""What of the record does not depend on where and when it was made."""
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)


def small_study(engine: str) -> Study:
    """Return the bundled study with one small stage on the plate."""
    study = load_study(bundled_study())
    names = ["m1_steel", "m2_steel"]
    free = ["e_pp", "e_pw"]
    stage = study.stages[0].model_copy(
        update={"targets": names, "free": free, "points": POINTS, "repeats": 0, "infill": 0}
    )
    fixed = {"mu_pp": 0.5, "mu_roll_pp": 0.2}
    changes: dict[str, Any] = {
        "run": study.run.model_copy(update={"engine": engine}),
        "design": study.design.model_copy(update={"check_seeds": SEEDS}),
        "surfaces": [study.surface_named("steel")],
        "targets": [one for one in study.targets if one.name in names],
        "stages": [stage],
        "parameters": {
            **study.parameters,
            **{name: Parameter(value={"": value}) for name, value in fixed.items()},
        },
        "rigs": [Apparatus(name="plate_impact", apparatus=PLATE)],
    }
    return study.model_copy(update=changes)


@dataclass
class StudyArena(Arena):
    """An arena for `bulkcal calibrate`.

    Attributes
    ----------
    study : Path
    """

    study: Path = Path()

    def words(self) -> list[str]:
        """Return the command."""
        options = ["--out", str(self.out), "--workers", str(self.workers)]
        start = "from calibrate.cli.main import main; main()"
        return [
            sys.executable,
            "-c",
            start,
            "calibrate",
            str(self.study),
            "--mode",
            "staged",
            *options,
        ]

    def table_of(self, shown: str) -> Table:
        """Return the numbers of the record and the table of runs."""
        del shown
        record = json.loads((self.out / RECORD).read_text(encoding="utf-8"))
        runs = pd.read_csv(self.out / TABLE).drop(columns=["wall_s", "path"])
        return [{name: record[name] for name in NUMBERS}, {"runs.csv": runs.to_csv()}]

    def broken(self) -> list[str]:
        """Return what is wrong with the files of the result, whole or not yet there."""
        faults = []
        report = self.out / REPORT
        if report.exists() and not report.read_text(encoding="utf-8").rstrip().endswith("</html>"):
            faults.append("half a report")
        if (self.out / RECORD).exists():
            read_record(self.out / RECORD)
        return faults


def study_arena(side: Path, engine: str) -> StudyArena:
    """Return a new arena with a study beside it."""
    folder = side / f"study_{engine}"
    folder.mkdir(parents=True, exist_ok=True)
    for table in bundled_study().parent.glob("*.csv"):
        shutil.copy(table, folder)
    path = folder / "small.toml"
    path.write_text(study_text(small_study(engine)), encoding="utf-8")
    return StudyArena(side / uuid.uuid4().hex, side, engine, RUNS, study=path)


def study_round(
    arena: StudyArena, reference: Table, wall_s: float, times: int, draw: random.Random
) -> Verdict:
    """Kill or interrupt a calibration at any time of its life, then let it continue.

    Parameters
    ----------
    arena : StudyArena
    reference : list of dict
        What the calibration finds when nobody disturbs it.
    wall_s : float
        How long that takes.
    times : int
    draw : Random
    """
    done = Accidents()
    for _ in range(times):
        running = arena.start()
        time.sleep(draw.uniform(0.0, wall_s))
        done.count += running.send(draw.choice(SIGNALS))
        running.ended()
        done.faults += arena.broken()
        if arena.orphans():
            done.faults.append(f"processes outlived the command: {arena.orphans()}")
    ended = [one.ended() for one in (arena.start(), arena.start())]
    faults = [f"exit {one.code}: {one.said[-500:]}" for one in ended if one.table is None]
    faults += ["another result" for one in ended if one.table not in (None, reference)]
    return Verdict(done.count + 1, faults=[*done.faults, *faults, *arena.broken()])


def record_round(record: Path, draw: random.Random, times: int) -> Verdict:
    """Harm the record of a calibration: a diagnosis starts from it, or refuses it by name."""
    truth, content = read_record(record), record.read_bytes()
    verdict = Verdict(times)
    for _ in range(times):
        how = draw.choice([one for one in HARMS if one != "deleted"])
        HARMS[how](record, draw)
        try:
            if read_record(record) != truth:
                verdict.faults.append(f"{record} {how}: another record")
        except CalibrationError as err:
            verdict.refused += 1
            if record.name not in str(err):
                verdict.faults.append(f"{record} {how}: refused without its name: {err}")
        record.write_bytes(content)
    return verdict
