"""Hidden effects in data of the engine: each must be found, with nothing hidden nothing is named.

The studies were made by `python -m tests.calibrate.challenge.make_hidden tests/data/hidden`; the
diagnosis learns from the runs of `cases/challenge/runs`, none of which lies at their parameters.
"""

from __future__ import annotations

import functools
import json

import numpy as np

from calibrate.causes.candidates import Measured
from calibrate.causes.diagnosis import Diagnosis, Options, diagnose
from calibrate.causes.weighing.evidences import Effort
from calibrate.challenge.folders import Suite
from calibrate.challenge.learnt import learnt_of
from calibrate.study.data import load_data
from tests.calibrate.challenge.make_hidden import CASES, RULES, TRUTHS
from tests.paths import ROOT

SUITE = Suite(ROOT / "tests" / "data" / "hidden")
OPTIONS = Options(held_out=False, effort=Effort(100.0, 4))


@functools.cache
def _learnt():
    return learnt_of(RULES, CASES)[1]


@functools.cache
def _found(number: int, *known: tuple[str, Measured]) -> Diagnosis:
    board = _learnt().board(load_data(SUITE.study(number) / "study.toml"))
    board = board.__class__(board.problem, board.candidates, dict(known), board.spreads)
    return diagnose(board, np.random.default_rng(1), options=OPTIONS)


def test_the_truths_are_those_of_the_command():
    kept = SUITE.truths()
    assert [one["kind"] for one in kept.values()] == [kind for kind, _ in TRUTHS]
    hidden = [[h["name"] for h in one["hidden"]] for one in kept.values()]
    assert hidden == [[h.name for h in causes] for _, causes in TRUTHS]
    assert json.dumps(kept)
