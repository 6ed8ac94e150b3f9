"""Hidden effects in data of the engine: each must be found, with nothing hidden nothing is named.

The studies were made by `python -m tests.calibrate.challenge.make_hidden tests/data/hidden`; the
diagnosis learns from the runs of `cases/challenge/runs`, none of which lies at their parameters.
"""

from __future__ import annotations

import functools
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Measured
from calibrate.causes.diagnosis import Diagnosis, Options, diagnose
from calibrate.causes.studies.from_study import with_effects
from calibrate.causes.sway import sways
from calibrate.causes.weighing.evidences import Effort
from calibrate.challenge.folders import TABLE, Suite
from calibrate.challenge.judges.variants import OURS, VARIANTS
from calibrate.challenge.learnt import SEEDS, Learnt, learn, learnt_of
from calibrate.challenge.making import make_suite
from calibrate.challenge.opening import checked_truths
from calibrate.inference.problem import Known
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.stored import tabled_runs
from calibrate.runs.table import read_rows
from calibrate.study.data import load_data
from tests.again import comes_out_again, short
from tests.calibrate.challenge.make_hidden import CASES, NAMES, NOTE, RULES, TRUTHS, plan
from tests.paths import ROOT

SUITE = Suite(ROOT / "tests" / "data" / "hidden")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
OPTIONS = Options(held_out=False, effort=Effort(100.0, 4))
NOTHING, TILT, COHESION, SIZES, SLOPE, PAIR, BOX, SMALL_TILT = range(1, len(TRUTHS) + 1)
MOST_MEASURED = 3
MOST_STEPS = 6e7
"""Particle-steps of a run that a test may repeat, about three seconds."""
Told = tuple[tuple[str, float, float], ...]
DROPS, SHEAR = ("e_pp", "e_pw"), ("mu_pp", "mu_roll_pp")
ALONE = {"mu_pp": 0.02, "mu_roll_pp": 0.02, "e_pp": 0.03, "e_pw": 0.03}
"""Standard errors of parameters measured alone: by a shear cell, by grains that are dropped."""


@functools.cache
def _learnt():
    return learnt_of(RULES, CASES)


@functools.cache
def _half(second: bool) -> Learnt:
    """Return what one half of the design teaches; it fills the ranges as the other does."""
    data = load_data(CASES / RULES.study)
    runs = tabled_runs(data, forms_of(with_effects(data)), *(CASES / one for one in RULES.tables))
    seeds: dict[int, set[int]] = {}
    for spec in runs.specs:  # twins have the seed of their run
        seeds.setdefault(spec.seed // SEEDS, set()).add(spec.seed)
    middle = {block: np.median(sorted(own)) for block, own in seeds.items()}
    here = [(spec.seed > middle[spec.seed // SEEDS]) == second for spec in runs.specs]
    return learn(data, runs.where(here))


@functools.cache
def _found(
    number: int, variant: str = OURS, known: Told = (), friction: tuple[str, ...] = ()
) -> Diagnosis:
    """Diagnose a study; causes and parameters that were measured alone are told their truth."""
    data = load_data(SUITE.study(number) / "study.toml")
    board = VARIANTS[variant].change(_learnt()[1].board(data), data.study)
    measured = {name: (Measured(value, se),) for name, value, se in known}
    names, truth = board.problem.space.names, dict(zip(NAMES, TRUTHS[number - 1][1], strict=True))
    alone = tuple(Known(names.index(name), truth[name], ALONE[name]) for name in friction)
    problem = replace(board.problem, known=alone)
    told = replace(board, known=measured, problem=problem)
    return diagnose(told, np.random.default_rng(1), options=OPTIONS)


def test_the_truths_are_those_of_the_command():
    for kept, (kind, _, hidden) in zip(checked_truths(SUITE).values(), TRUTHS, strict=True):
        assert kept["kind"] == kind
        assert [(h["name"], h["strength"]) for h in kept["hidden"]] == [
            (h.name, h.strength) for h in hidden
        ]


def test_its_table_of_runs_makes_the_same_studies_without_a_run(tmp_path):
    data, learnt = _learnt()
    again = Suite(tmp_path)
    shutil.copy(SUITE.path / TABLE, again.path / TABLE)

    def run(specs, label):
        raise AssertionError(label)

    make_suite(RULES, data, learnt, plan(data), run, again, NOTE, print)
    for kept, made in zip(SUITE.studies(), again.studies(), strict=True):
        for path in kept.iterdir():
            # Another processor rounds otherwise, and the fit behind an error ends elsewhere.
            words, numbers = _parted(path)
            other_words, other_numbers = _parted(made / path.name)
            assert words == other_words, path
            assert numbers == pytest.approx(other_numbers, rel=1e-6), path


def _parted(path):
    """Return the text of a file without its numbers, and these."""
    text = path.read_text(encoding="utf-8")
    return NUMBER.split(text), [float(one) for one in NUMBER.findall(text)]


def test_nothing_hidden_names_nothing():
    verdict = _found(NOTHING).verdict
    assert verdict.kind == "none"
    assert not verdict.names


@pytest.mark.parametrize("number", [COHESION, TILT])
def test_a_hidden_cause_is_named_and_sized(number):
    found = _found(number)
    (hidden,) = TRUTHS[number - 1][2]
    assert found.verdict.kind == "named"
    assert found.verdict.names == (hidden.name,)
    span = found.interval(hidden.name, 0.99)
    assert span.low < hidden.strength < span.high


@pytest.mark.parametrize(("number", "friction"), [(SIZES, SHEAR + DROPS), (SLOPE, DROPS)])
def test_what_parameters_imitate_is_named_once_these_are_measured_alone(number, friction):
    # Free parameters take over what these causes do (docs/challenge.md).
    found = _found(number, friction=friction)
    (hidden,) = TRUTHS[number - 1][2]
    assert (found.verdict.kind, found.verdict.names) == ("named", (hidden.name,))
    span = found.interval(hidden.name, 0.99)
    assert span.low <= hidden.strength <= span.high


def test_a_pair_is_named_as_two():
    verdict = _found(PAIR, friction=DROPS).verdict
    assert verdict.kind == "named"
    assert set(verdict.names) == {one.name for one in TRUTHS[PAIR - 1][2]}


@pytest.mark.long
def test_another_design_names_no_other_cause():
    # Of two halves of the runs either is another design: less sure, and never of another cause.
    (hidden,) = TRUTHS[COHESION - 1][2]
    names, ratios, sway = (hidden.name,), [], []
    for second in (False, True):
        board = _half(second).board(load_data(SUITE.study(COHESION) / "study.toml"))
        found = diagnose(board, np.random.default_rng(1), options=OPTIONS)
        assert next(iter(found.verdict.answers.inclusion)) == hidden.name
        if found.verdict.kind == "named":
            assert found.verdict.names == names
        ratios.append(found.log_ratio(hidden.name))
        sway.append(sways(found.found, [names], found.seed)[names])
    # They differ by no more than each says that other runs would change.
    assert abs(ratios[0] - ratios[1]) < 3.0 * np.hypot(*sway)


@pytest.mark.slow
def test_a_random_few_of_its_runs_come_out_again(tmp_path):
    rows = [row for row in read_rows(SUITE.path / TABLE) if short(row, MOST_STEPS)]
    for k in np.random.default_rng().choice(len(rows), 2, replace=False):
        comes_out_again(rows[k], tmp_path)


def test_look_alikes_are_a_set_until_what_was_proposed_is_measured():
    # Without the curves of the conveyor, a tilt looks like its period, amplitude and pour.
    (hidden,) = TRUTHS[SMALL_TILT - 1][2]
    found, known = _found(SMALL_TILT, "no_curves"), ()
    assert found.verdict.kind == "set"
    assert hidden.name in found.verdict.names
    while found.verdict.kind == "set" and len(known) < MOST_MEASURED:
        best = found.prospect.offers[0].measurement
        truth = hidden.strength if best.effect == hidden.name else 0.0
        known = (*known, (best.effect, truth, best.se))
        found = _found(SMALL_TILT, "no_curves", known)
    assert found.verdict.kind == "named"
    assert found.verdict.names == (hidden.name,)


def test_what_no_candidate_describes_is_unknown_in_the_right_experiment():
    verdict = _found(BOX).verdict
    assert verdict.kind == "unknown"
    assert next(iter(verdict.answers.where)).startswith("unknown in plate_impact")
