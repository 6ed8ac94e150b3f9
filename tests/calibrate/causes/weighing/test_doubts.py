"""What is uncertain of an answer explains data that are off, and is no evidence of the cause."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibrate.causes.candidates import Board, Candidate, board_of_problem, doubt_about
from calibrate.causes.judging.probabilities import answers_of
from calibrate.causes.weighing.by_modes import ByModes
from calibrate.causes.weighing.evidences import Effort, Evidences
from calibrate.causes.weighing.on_cloud import OnCloud
from calibrate.emulator.emulator import train_emulator
from calibrate.emulator.signature import Twins
from calibrate.emulator.types import Inputs, Output
from calibrate.emulator.with_effects import WithEffects, learn_change
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.space import Space, Unknown

NOISE = 0.05
SE = 0.05
ANSWER = np.array([0.5, -0.4, 0.3])
"""Of the cause that is known, per ordinary strength."""
VAGUE = 0.4
"""How much each of four twins of the other one differs, the same to both sides of no strength."""
POWER = {"known": 0.9, "vague": 0.9}


def _expected(u):
    return np.column_stack([2.0 + u[:, 0], 1.0 + 0.5 * u[:, 0], 3.0 - 0.7 * u[:, 0]])


@pytest.fixture(scope="module")
def emulator() -> WithEffects:
    rng = np.random.default_rng(1)
    u = rng.random((40, 1))
    outputs = [Output(f"y{k}", slice(k, k + 1)) for k in range(3)]
    y = _expected(u) + NOISE * rng.standard_normal((40, 3))
    base = train_emulator(Inputs.at(u), outputs, y)
    x = np.resize([5.0, -5.0, 2.5, -2.5], 24)
    sure = x[:, None] * ANSWER + NOISE * rng.standard_normal((24, 3))
    few = VAGUE * np.array(
        [[1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, 1.0]]
    )
    at, both = rng.random((24, 1)), np.array([10.0, -10.0, 10.0, -10.0])
    changes = {
        0: learn_change(base, Twins(at, x, sure, np.zeros((24, 3)))),
        1: learn_change(base, Twins(at[:4], both, few, np.zeros((4, 3)))),
    }
    return WithEffects(base, changes, 2)


def _board(emulator: WithEffects, y) -> Board:
    readings = tuple(
        Reading(f"y{k}", slice(k, k + 1), np.array([one]), np.array([SE]))
        for k, one in enumerate(y)
    )
    place = Place("rig", emulator, (Source(0),), (Source(), Source()), readings)
    problem = Problem(Space((Unknown("p", "", Prior.uniform(0.0, 1.0)),)), (place,))
    candidates = [Candidate(name, name, 1.0, -6.0, 6.0, ((0, k),)) for k, name in enumerate(POWER)]
    return board_of_problem(problem, candidates, {}, np.random.default_rng(2))


def _found(board: Board, kind: type[OnCloud] = OnCloud) -> Evidences:
    work = kind(board, np.random.default_rng(3), Effort(200.0, 3))
    work.find_base()
    work.refine()
    work.find_pairs()
    work.settle()
    return work.finished()


def test_a_doubt_widens_and_moves_nothing(emulator):
    u, x = np.linspace(0.1, 0.9, 5)[:, None], np.full(5, 3.0)
    scores = emulator.scores(Inputs.at(u, np.zeros((5, 2))))
    off = emulator.base.assembled(scores)
    on, doubt = (emulator.switched(scores, u, [(k, x)]) for k in (1, 3))
    assert np.array_equal(doubt.mean, off.mean)
    assert doubt.total == pytest.approx(on.total)
    slope, bend, wide = emulator.parts(3, u)
    assert not slope.any()
    assert not bend.any()
    assert np.array_equal(wide, emulator.parts(1, u)[2])


def test_every_candidate_has_a_doubt_about_it(emulator):
    board = _board(emulator, _expected(np.array([[0.5]]))[0])
    wide = board.with_doubts()
    assert [one.name for one in wide.candidates] == [
        *POWER, *(doubt_about(name) for name in POWER)
    ]  # fmt: skip
    assert wide.candidate(doubt_about("vague")).acts == ((0, 3),)


@pytest.mark.parametrize("kind", [OnCloud, ByModes])
def test_what_a_vague_answer_explains_is_unknown(emulator, kind):
    # Off by half a unit here and there, as no answer is: only what is nearly unknown explains it.
    y = _expected(np.array([[0.5]]))[0] + [0.5, 0.5, 0.5]
    found = _found(_board(emulator, y), kind)
    credited, plain = (answers_of(one, POWER) for one in (found, replace(found, doubts={})))
    # Its expected answer is nothing: nearly all is its doubt's, but for what its bend may be.
    assert plain.inclusion["vague"] > 0.9
    assert credited.inclusion["vague"] < 0.1
    assert credited.unknown > plain.unknown
    lost = plain.inclusion["vague"] - credited.inclusion["vague"]
    assert credited.doubts["vague"] == pytest.approx(lost)
    for answers in (credited, plain):
        assert sum(answers.single.values()) + sum(answers.pairs.values()) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", [OnCloud, ByModes])
def test_what_an_answer_explains_by_its_shape_stays_its_own(emulator, kind):
    y = _expected(np.array([[0.5]]))[0] + 2.0 * ANSWER
    found = _found(_board(emulator, y), kind)
    credited, plain = (answers_of(one, POWER) for one in (found, replace(found, doubts={})))
    assert plain.inclusion["known"] > 0.9
    # Its doubt alone is eighty nats behind: what it loses is no number.
    assert credited.inclusion["known"] == pytest.approx(plain.inclusion["known"], abs=1e-9)


def test_where_a_doubt_explains_nothing_all_stays_as_it_is(emulator):
    found = _found(_board(emulator, _expected(np.array([[0.5]]))[0] + 0.02))
    nothing = {names: tuple(-np.inf for _ in names) for names in [("known",), ("known", "vague")]}
    told = replace(found, doubts={n: x for n, x in nothing.items() if n in found.weighed})
    assert answers_of(told, POWER).single == answers_of(replace(found, doubts={}), POWER).single
