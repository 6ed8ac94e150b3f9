"""Make a suite: draw what is hidden, run the laboratory, write the studies, seal the truths."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from calibrate.challenge.folders import FRESH, REFUSED, SEALS, STUDIES, TABLE, TRUTHS, Suite
from calibrate.challenge.laboratory import bench_of, measured_values, study_cases
from calibrate.challenge.learnt import Learnt
from calibrate.challenge.rules import Rules
from calibrate.challenge.sealing import sealed
from calibrate.challenge.truths import Truth, draw_truth
from calibrate.challenge.writing import write_study
from calibrate.errors import CalibrationError
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import form_key, forms_of, levels_of, place_of
from calibrate.questions.core.runs import Runs, make_runs
from calibrate.questions.core.stored import question, runs_of_rows
from calibrate.runs.runner import Runner
from calibrate.runs.stored import RUNS
from calibrate.runs.table import TableRow, finished_rows, read_rows, write_rows
from calibrate.study.data import StudyData
from calibrate.study.places import Place
from liggghts_io import CaseSpec
from liggghts_io.case.lock import locked
from liggghts_io.files import write_text

__all__ = ["Plan", "make_suite", "plan_of"]

IDENTITY: Final = 64
"""Digits of a case's name."""


@dataclass(frozen=True)
class Plan:
    """What a suite runs.

    Attributes
    ----------
    truths : tuple of Truth
    cases : tuple of dict of Place to list of CaseSpec
        Of each study.
    fresh : tuple of dict of Place to list of CaseSpec
        Of each study, the same once more with other seeds; empty where gains are not checked.
    """

    truths: tuple[Truth, ...]
    cases: tuple[dict[Place, list[CaseSpec]], ...]
    fresh: tuple[dict[Place, list[CaseSpec]], ...]

    @property
    def specs(self) -> list[CaseSpec]:
        """All runs, study by study."""
        every = (*self.cases, *self.fresh)
        return [spec for study in every for specs in study.values() for spec in specs]


def plan_of(
    rules: Rules,
    data: StudyData,
    learnt: Learnt,
    seed: str,
    sealed: Sequence[Mapping[str, Any]] = (),
    tell: Callable[[str], None] | None = None,
) -> Plan:
    """Draw what is hidden in every study.

    Parameters
    ----------
    rules : Rules
    data : StudyData
    learnt : Learnt
    seed : str
        Text from which all draws follow, such as the id of the commit that holds the rules.
    sealed : sequence of mapping
        Truths of a suite that is under way; they stay what they are, whatever would be drawn now.
    tell : callable, optional
        Told which study is drawn: where causes must be unlike anything, one takes seconds.
    """
    truths = [Truth.of_plain(one) for one in sealed]
    if not truths:
        board, kinds = bench_of(learnt, data, rules), rules.kinds()
        for number, kind in enumerate(kinds, start=1):
            if tell:
                tell(f"drawing what is hidden: study {number} of {len(kinds)}")
            truths.append(draw_truth(rules, kind, number, seed, board))
    cases = [study_cases(data, one, rules.repeats) for one in truths]
    fresh = [study_cases(data, one, rules.repeats, 1) if one.fresh else {} for one in truths]
    return Plan(tuple(truths), tuple(cases), tuple(fresh))


def make_suite(
    rules: Rules,
    data: StudyData,
    learnt: Learnt,
    plan: Plan,
    runner: Runner,
    suite: Suite,
    note: Mapping[str, str],
    tell: Callable[[str], None],
) -> None:
    """Run the laboratory, write studies and seals, and the truths apart; goes on where it was.

    Who makes a suite deletes the cases of a study that is written, so that a second one waits.

    Parameters
    ----------
    rules : Rules
    data : StudyData
    learnt : Learnt
    plan : Plan
    runner : Runner
        Runs cases in the suite's folder.
    suite : Suite
        Who forecasts must not see its truths.
    note : mapping
        From what everything was drawn: ``seed``, and ``design``, the digest of the table of runs.
    tell : callable
        Told of studies that could not be made, and of another process that makes the suite.

    Raises
    ------
    CalibrationError
        If the folder holds another suite.
    """
    with locked(suite.path, tell):
        forms = forms_of(data)
        _seal(rules, plan, suite, note)
        done, rows = suite.tried(), _kept(suite, {})
        for truth, cases, fresh in zip(plan.truths, plan.cases, plan.fresh, strict=True):
            name = suite.study(truth.number).name
            if name in done:
                continue
            label = f"{name} of {len(plan.truths)}"
            runs, again = (_runs(one, label, runner, forms, rows) for one in (cases, fresh))
            rows = _kept(suite, rows)
            if again:
                _write_fresh(data, forms, again, suite.path / FRESH / f"{name}.json")
            try:
                write_study(data, learnt, rules, forms, runs, suite.study(truth.number), name)
            except CalibrationError as err:
                tell(f"{err}; it gets no study, and the floor of every score")
                suite.study(truth.number).mkdir(parents=True, exist_ok=True)
                write_text(suite.study(truth.number) / REFUSED, f"{err}\n")
            _forget(suite)


def _seal(rules: Rules, plan: Plan, suite: Suite, note: Mapping[str, str]) -> None:
    """Write digests of all truths, and the truths, if they are not there."""
    asked = {"rules": rules.model_dump(), **note}
    if (suite.path / SEALS).exists():
        known = suite.seals()
        # A key that is newer than a suite has its default there.
        usual = {key: one.default for key, one in Rules.model_fields.items()}
        if isinstance(known.get("rules"), dict):
            known["rules"] = usual | known["rules"]
        if {key: known.get(key) for key in asked} != json.loads(json.dumps(asked)):
            msg = f"{suite.path / SEALS}: of other rules, runs or seed; give another --out"
            raise CalibrationError(msg)
        return
    pairs = {suite.study(one.number).name: sealed(one.plain()) for one in plan.truths}
    truths = {name: kept for name, (kept, _) in pairs.items()}
    digests = {name: digest for name, (_, digest) in pairs.items()}
    (suite.path / STUDIES).mkdir(parents=True, exist_ok=True)
    write_text(suite.path / TRUTHS, json.dumps(truths, indent=1) + "\n")
    write_text(suite.path / SEALS, json.dumps({**asked, "digests": digests}, indent=1) + "\n")


def _write_fresh(
    data: StudyData, forms: dict[FormKey, Form], runs: dict[Place, Runs], path: Path
) -> None:
    """Write what the same experiments gave with other seeds, by target, in its unit."""
    found: dict[str, Any] = {}
    for target in data.study.targets:
        place = place_of(target)
        form = forms[form_key(data.study, place)]
        output = form.output(target.observable, target.model_scale, levels_of(data, target))
        values = measured_values(runs[place], output.table_columns)
        mean = np.full(len(output.table_columns), np.nan)
        if len(values):
            mean[: values.shape[1]] = values.mean(axis=0)
        found[target.name] = mean.tolist()
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(found) + "\n")


def _runs(
    cases: Mapping[Place, Sequence[CaseSpec]],
    label: str,
    runner: Runner,
    forms: Mapping[FormKey, Form],
    rows: Mapping[str, TableRow],
) -> dict[Place, Runs]:
    """Return the runs of a study by place; those that the suite's table has are not made again."""
    found = {}
    for place, specs in cases.items():
        known = [rows[asked] for spec in specs if (asked := question(spec)) in rows]
        every = len(known) == len(specs)
        found[place] = (
            runs_of_rows(known, forms) if every else make_runs(specs, label, runner, forms)
        )
    return found


def _kept(suite: Suite, rows: Mapping[str, TableRow]) -> dict[str, TableRow]:
    """Add finished runs to the table of the suite and return its rows, by what they asked."""
    path, runs = suite.path / TABLE, suite.path / RUNS
    known = dict(rows)
    if not known and path.exists():
        known = {question(row.spec): row for row in read_rows(path)}
    made = finished_rows(runs) if runs.is_dir() else []
    if made:
        known |= {question(row.spec): row for row in made}
        write_rows(path, known.values(), "bulkcal challenge make")
    return known


def _forget(suite: Suite) -> None:
    """Delete the case directories of this suite whose numbers are in its table."""
    for path in (suite.path / RUNS).glob("*/"):
        if len(path.name) == IDENTITY:
            shutil.rmtree(path, ignore_errors=True)


def seconds_of(
    specs: Sequence[CaseSpec], rows: Sequence[CaseSpec], seconds: Sequence[float]
) -> float:
    """Return how long runs take one after the other, as runs of their kind took [s]."""
    known: dict[tuple[str, str], list[float]] = {}
    for spec, one in zip(rows, seconds, strict=True):
        known.setdefault((spec.experiment, spec.surface), []).append(one)
    means = {key: sum(all_) / len(all_) for key, all_ in known.items()}
    return sum(means.get((spec.experiment, spec.surface), 0.0) for spec in specs)
