"""A sensitivity study: which cases it runs, and what follows from their results."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from calibrate.errors import CalibrationError
from calibrate.questions.core.design import first_cases, joint_rng, refuse_few_points
from calibrate.questions.core.emulate import Emulators, emulators_of
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, Runs, read_stored_curve, with_curves
from calibrate.questions.sensitivity.baseline import baseline_of
from calibrate.questions.sensitivity.responses import Bases, responses_of
from calibrate.questions.sensitivity.result import SensitivityResult, sentences_of
from calibrate.questions.sensitivity.shares import Explained, Share, shares_of
from calibrate.questions.sensitivity.steps import (
    LEVELS,
    SEEDS,
    Series,
    distinct_places,
    series_of,
    specs_of,
)
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["Asked", "Plan", "plan_of", "result_of"]


@dataclass(frozen=True)
class Asked:
    """What is asked of a sensitivity study.

    Attributes
    ----------
    levels : int
        Values over each range, one parameter at a time; 0 for none of that.
    seeds : int
        Runs of each.
    points : int, optional
        Points of the design behind the Sobol indices, in each experiment and for each material; 0
        for no indices, None for the first design of a joint calibration.
    baseline : Path, optional
        Table of values.
    """

    levels: int = LEVELS
    seeds: int = SEEDS
    points: int | None = None
    baseline: Path | None = None

    @property
    def words(self) -> str:
        """Options of the command line that say the same, each after a space."""
        plain = Asked()
        found = [f"--levels {self.levels}"] if self.levels != plain.levels else []
        found += [f"--seeds {self.seeds}"] if self.seeds != plain.seeds else []
        found += [] if self.points is None else [f"--points {self.points}"]
        found += [] if self.baseline is None else [f"--baseline {shlex.quote(str(self.baseline))}"]
        return "".join(f" {one}" for one in found)


@dataclass(frozen=True)
class Plan:
    """What is run.

    Attributes
    ----------
    data : StudyData
    asked : Asked
    baseline : mapping
        By name and instance.
    series : tuple of Series
    singles, design : tuple of CaseSpec
        Cases of one parameter at a time, and of the design; each once.
    """

    data: StudyData
    asked: Asked
    baseline: Mapping[tuple[str, str], float]
    series: tuple[Series, ...]
    singles: tuple[CaseSpec, ...]
    design: tuple[CaseSpec, ...]

    @property
    def specs(self) -> list[CaseSpec]:
        """All cases, each once."""
        return list({repr(spec): spec for spec in (*self.singles, *self.design)}.values())


def plan_of(data: StudyData, asked: Asked, *, alone: bool = True) -> Plan:
    """Return what a sensitivity study runs.

    Parameters
    ----------
    data : StudyData
    asked : Asked
    alone : bool
        Whether there are no other runs from which emulators learn as well.

    Raises
    ------
    CalibrationError
        For a baseline that cannot be read, a parameter without a value, a design too small for
        Sobol indices, or nothing to do.
    """
    study = data.study
    baseline = baseline_of(data, asked.baseline)
    series = series_of(study, baseline, asked.levels, asked.seeds)
    design: list[CaseSpec] = []
    if study.free and asked.points != 0:
        if asked.points is not None:
            wanted = study.design.model_copy(update={"start": asked.points})
            study = study.model_copy(update={"design": wanted})
        forms = forms_of(data)
        design = first_cases(study, forms, joint_rng(study))
        if alone:
            place = "[design] start" if asked.points is None else f"--points {asked.points}"
            refuse_few_points(forms, design, place)
    if not (series or design):
        msg = "nothing to do: --levels 0 and no design; leave one of --levels and --points out"
        raise CalibrationError(msg)
    once = {repr(spec): spec for spec in design}
    return Plan(data, asked, baseline, tuple(series), tuple(specs_of(series)), tuple(once.values()))


def result_of(
    plan: Plan,
    table: pd.DataFrame,
    stored: Runs | None = None,
    read: CurveReader = read_stored_curve,
) -> SensitivityResult:
    """Return what follows from the runs of a plan.

    Parameters
    ----------
    plan : Plan
    table : DataFrame
        A row for each of its `specs`, as a campaign gives it.
    stored : Runs, optional
        Other finished runs of the study; emulators learn from them as well.
    read : callable
        Reads a curve of a run.
    """
    data, study = plan.data, plan.data.study
    forms = forms_of(data)
    runs = with_curves(plan.specs, table, forms, read)
    shares: list[Share] = []
    explained: list[Explained] = []
    said: list[str] = []
    bases: Bases = {}
    if plan.design:
        try:
            emulators = emulators_of(forms, _learnt(plan, runs, stored))
            places = distinct_places(study, plan.series)
            shares, explained = shares_of(data, emulators, places)
            bases = _bases(forms, emulators)
        except CalibrationError as err:
            said = [f"no Sobol indices: {err}"]
    responses = responses_of(data, plan.series, runs, forms, bases)
    every = runs if stored is None else runs.joined(stored)
    return SensitivityResult(
        data=data,
        baseline={study.label(*key): value for key, value in plan.baseline.items()},
        levels=plan.asked.levels,
        seeds=plan.asked.seeds,
        responses=tuple(responses),
        shares=tuple(shares),
        explained=tuple(explained),
        runs=len(every),
        failed=int((every.table["status"] != "ok").sum()),
        sentences=(*said, *sentences_of(responses, shares, explained)),
    )


def _learnt(plan: Plan, runs: Runs, stored: Runs | None) -> Runs:
    """Return the runs that emulators learn from: the design, and what else the study could ask."""
    wanted = {repr(spec) for spec in plan.design}
    rows = [k for k, spec in enumerate(runs.specs) if repr(spec) in wanted]
    found = Runs(tuple(runs.specs[k] for k in rows), runs.table.iloc[rows].reset_index(drop=True))
    return found if stored is None else found.joined(stored)


def _bases(forms: Mapping[FormKey, Form], emulators: Emulators) -> Bases:
    """Return the components of all curves."""
    return {
        (key, output.name): part.components
        for key, form in forms.items()
        for output, part in zip(form.outputs, emulators.trained[key].emulator.parts, strict=True)
        if output.levels
    }
