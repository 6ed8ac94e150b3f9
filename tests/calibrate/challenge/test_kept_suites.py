"""A study of a kept suite comes out again: drawn from the commit of its rules, and run anew."""

from __future__ import annotations

import json
import shutil
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from calibrate.challenge import writing
from calibrate.challenge.folders import SEALS, TABLE, TRUTHS
from calibrate.challenge.laboratory import Errors, study_cases
from calibrate.challenge.rules import load_rules
from calibrate.challenge.truths import Truth, draw_truth
from calibrate.errors import CalibrationError
from calibrate.questions.core.from_study import form_key, forms_of, levels_of, place_of
from calibrate.questions.core.problem import space_of
from calibrate.questions.core.stored import question, runs_of_rows
from calibrate.runs.table import read_rows
from calibrate.study.data import load_data
from tests.again import comes_out_again, short
from tests.paths import ROOT

CASES = ROOT / "cases" / "challenge"
KEPT = sorted(path.parent.name for path in CASES.glob(f"*/{TABLE}"))
BLAMELESS = ("nothing", "foreign")
"""Kinds that are drawn from the ranges of the parameters alone, without an emulator."""
SIX_DIGITS = 1e-5
"""Relative error of what is written with six."""
MOST_STEPS = 1e8
"""Particle-steps of a run that a test may repeat, about five seconds."""


@pytest.mark.slow
def test_a_random_study_is_drawn_and_runs_as_it_was(tmp_path):
    name = str(np.random.default_rng().choice(KEPT))
    rules = load_rules(CASES / f"{name}.toml")
    seed = json.loads((CASES / name / SEALS).read_text(encoding="utf-8"))["seed"]
    data = load_data(CASES / rules.study)
    rows = {question(row.spec): row for row in read_rows(CASES / name / TABLE)}
    board: Any = SimpleNamespace(problem=SimpleNamespace(space=space_of(data.study)))
    numbers = [k for k, kind in enumerate(rules.kinds(), start=1) if kind in BLAMELESS]
    for number in np.random.default_rng().permutation(numbers):
        truth = draw_truth(rules, rules.kinds()[number - 1], int(number), seed, board)
        specs = [one for of in study_cases(data, truth, rules.repeats).values() for one in of]
        if question(specs[0]) not in rows or (truth.engine == "liggghts" and not _installed()):
            continue  # a suite that is not finished yet
        assert all(question(spec) in rows for spec in specs)
        cheap = [row for row in (rows[question(spec)] for spec in specs) if short(row, MOST_STEPS)]
        if cheap:
            comes_out_again(cheap[0], tmp_path)
            return
    pytest.fail(f"{name}: no study of its table is drawn from {seed}")


@pytest.mark.parametrize("name", KEPT)
def test_a_study_tells_what_the_runs_of_each_place_measured(name, tmp_path, monkeypatch):
    """Every curve is of its own material and wall, whatever file the suite's study names for it."""
    rules = load_rules(CASES / f"{name}.toml")
    seed = json.loads((CASES / name / SEALS).read_text(encoding="utf-8"))["seed"]
    data = load_data(CASES / rules.study)
    board: Any = SimpleNamespace(problem=SimpleNamespace(space=space_of(data.study)))
    number = rules.kinds().index("nothing") + 1
    truth = draw_truth(rules, "nothing", number, seed, board)
    monkeypatch.setattr(writing, "errors_of", _small_errors)
    rows, runs, told = _written(name, truth, tmp_path)

    assert len(told.study.targets) > len(data.study.targets) / 2
    for target in told.study.targets:
        made = [rows[question(spec)] for spec in runs[place_of(target)].specs]
        if not target.is_curve:
            mean = np.mean([row.result.observables[target.observable] for row in made])
            assert target.value == pytest.approx(mean, rel=SIX_DIGITS)
            continue
        curve = told.curves[target.name]
        columns = [f"{target.observable}@{level:g}" for level in curve.levels]
        means = np.mean([[row.curves[column] for column in columns] for row in made], axis=0)
        assert curve.values == pytest.approx(means, rel=SIX_DIGITS)


def test_of_a_curve_that_no_run_ends_the_levels_are_told_that_every_run_reached(
    tmp_path, monkeypatch
):
    """With 0.3 less flow both runs on the flat plate end between 80 and 90 g."""
    monkeypatch.setattr(writing, "errors_of", _small_errors)
    truths = json.loads((CASES / "suite_6" / TRUTHS).read_text(encoding="utf-8"))
    truth = Truth.of_plain(truths["study_0291"])
    rows, runs, told = _written("suite_6", truth, tmp_path)

    target = next(one for one in told.study.targets if one.name == "curve_steel")
    assert levels_of(told, target) == (10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0)
    study = load_data(CASES / "one_material.toml")
    form = forms_of(study)[form_key(study.study, place_of(target))]
    whole = form.output("mass_time", target.model_scale, tuple(np.arange(10.0, 101.0, 10.0)))
    part = form.output("mass_time", target.model_scale, levels_of(told, target))
    assert (part.columns.start, part.columns.stop) == (whole.columns.start, 8)
    last = [rows[question(spec)].curves["mass_time@80"] for spec in runs[place_of(target)].specs]
    assert told.curves["curve_steel"].values[-1] == pytest.approx(np.mean(last), rel=SIX_DIGITS)
    with pytest.raises(CalibrationError, match="nothing was learnt of mass_time at 15, 20"):
        form.output("mass_time", target.model_scale, (15.0, 20.0))


def _written(name, truth, folder):
    """Write a study of a suite from its table of runs; return rows, runs and what can be read."""
    rules = load_rules(CASES / f"{name}.toml")
    data = load_data(CASES / rules.study)
    forms = forms_of(data)
    rows = {question(row.spec): row for row in read_rows(CASES / name / TABLE)}
    runs = {
        place: runs_of_rows([rows[question(spec)] for spec in specs], forms)
        for place, specs in study_cases(data, truth, rules.repeats).items()
    }
    writing.write_study(data, None, rules, forms, runs, folder, "study")
    return rows, runs, load_data(folder / "study.toml")


def _small_errors(_learnt, _study, _target, _rules, runs):
    """Return errors as a laboratory states them, without learning what they are."""
    return Errors(np.full(runs.shape[1], 0.01), np.array([[0.01, 0.0]]))


def _installed() -> bool:
    return shutil.which("liggghts") is not None
