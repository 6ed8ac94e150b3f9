"""A study of a kept suite comes out again: drawn from the commit of its rules, and run anew."""

from __future__ import annotations

import json
import shutil
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from calibrate.challenge.folders import SEALS, TABLE
from calibrate.challenge.laboratory import study_cases
from calibrate.challenge.rules import load_rules
from calibrate.challenge.truths import draw_truth
from calibrate.questions.core.problem import space_of
from calibrate.questions.core.stored import question
from calibrate.runs.table import read_rows
from calibrate.study.data import load_data
from tests.again import comes_out_again, short
from tests.paths import ROOT

CASES = ROOT / "cases" / "challenge"
KEPT = sorted(path.parent.name for path in CASES.glob(f"*/{TABLE}"))
BLAMELESS = ("nothing", "foreign")
"""Kinds that are drawn from the ranges of the parameters alone, without an emulator."""
MOST_STEPS = 1e8
"""Particle-steps of a run that a test may repeat, about five seconds."""


@pytest.mark.slow
@pytest.mark.parametrize("name", KEPT)
def test_a_random_study_is_drawn_and_runs_as_it_was(name, tmp_path):
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


def _installed() -> bool:
    return shutil.which("liggghts") is not None
