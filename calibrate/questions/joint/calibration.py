"""Joint calibration: all targets of all materials at once, from as few runs as the answer needs.

First design, emulators, posterior; then batches of runs where the answer is uncertain, until the
next batch is not expected to change it; then the engine itself at the optimum and at draws from
the posterior, and more runs there until the emulators' error is below the measurements'.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from threadpoolctl import threadpool_limits

from calibrate.arrays import Array
from calibrate.inference.intervals import LEVELS
from calibrate.planning.infill import on_grid
from calibrate.planning.stop import Outlook
from calibrate.questions.core.design import (
    ADDED_SEED,
    first_cases,
    joint_rng,
    refuse_few_points,
)
from calibrate.questions.core.forms import Form, FormKey
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, Runs, make_runs, read_stored_curve
from calibrate.questions.joint.check import behind, check_cases, checked_z
from calibrate.questions.joint.knowledge import Knowledge, learnt, result_of
from calibrate.questions.joint.refine import Batch, error_ratios, next_batch
from calibrate.questions.joint.result import JointResult
from calibrate.questions.joint.summary import names_outside
from calibrate.runs.runner import Runner
from calibrate.study.data import StudyData
from liggghts_io import CaseSpec

__all__ = ["calibrate_jointly"]

BATCHES: Final = 20
"""The budget is spent in about so many batches."""
LEAST_BATCH: Final = 8
CHECKS: Final = 6
"""Most rounds of the final check. On 16 planted truths six err less than three by a twelfth, for
four runs more (`benchmarks/joint_planted.py`)."""
ENOUGH: Final = 1.0
"""Emulator's variance over the measurement's at the checked points, below which a check stands."""
CLOSE: Final = 0.5
"""Nats by which other values may be more probable than the checked ones once their runs are learnt
from; beyond it they are checked in turn."""
STANDS: Final = LEVELS[0]
"""Level of the intervals in which the checked point must lie then: of the narrowest ones that are
printed beside it."""


@dataclass
class _Work:
    """A calibration under way.

    Attributes
    ----------
    data : StudyData
    forms : dict
    runner : Runner
    read : CurveReader
    tell : callable
    rng : numpy Generator
    asked : int
        Runs asked for so far that count against the budget.
    """

    data: StudyData
    forms: dict[FormKey, Form]
    runner: Runner
    read: CurveReader
    tell: Callable[[str], None]
    rng: np.random.Generator
    asked: int = 0

    def make(self, specs: Sequence[CaseSpec], label: str) -> Runs:
        """Run cases."""
        return make_runs(specs, label, self.runner, self.forms, self.read)

    def learn(self, runs: Runs) -> Knowledge:
        """Return what runs say."""
        return learnt(self.data, self.forms, runs, self.rng)

    @property
    def left(self) -> int:
        """Runs of the budget that were not asked for."""
        return self.data.study.design.runs - self.asked

    def batch(self, known: Knowledge, left: int) -> Batch:
        """Return the runs that would help most, no more than are left."""
        count = max(math.ceil(self.data.study.design.runs / BATCHES), LEAST_BATCH)
        seed = self.data.study.run.seed + ADDED_SEED + self.asked
        return next_batch(
            self.data.study, known.problem, known.emulators, known.posterior.samples,
            min(count, left), self.rng, seed,
        )  # fmt: skip

    def outlook(self, known: Knowledge, batch: Batch | None) -> Outlook:
        """Return what is expected of the next batch."""
        design = self.data.study.design
        ratio = max(error_ratios(known.problem, known.posterior.samples).values(), default=0.0)
        return Outlook(
            spent=self.asked,
            budget=design.runs,
            batch=len(batch.specs) if batch else 0,
            names=known.posterior.names if batch else (),
            moves=batch.moves if batch else (),
            error_ratio=ratio,
            tolerance=design.tolerance,
        )

    def add(self, known: Knowledge, batch: Batch, label: str) -> Knowledge:
        """Run a batch and learn from it."""
        self.asked += len(batch.specs)
        return self.learn(known.runs.joined(self.make(batch.specs, label)))


def calibrate_jointly(
    data: StudyData,
    runner: Runner,
    *,
    earlier: Runs | None = None,
    read: CurveReader = read_stored_curve,
    tell: Callable[[str], None] = lambda _line: None,
) -> JointResult:
    """Calibrate all materials of a study against all of its targets.

    Parameters
    ----------
    data : StudyData
        The study and what was measured, from `load_data`.
    runner : Runner
        Runs cases, normally a `Campaign`.
    earlier : Runs, optional
        Runs that are there already, of stages for example; they count as points of the same space
        and not against the budget.
    read : callable
        Reads a curve of a run.
    tell : callable
        Receives a line about each step.

    Raises
    ------
    CalibrationError
        When the first design is too small, before anything is run, or too few runs succeeded.
    """
    forms = forms_of(data)
    rng = joint_rng(data.study)
    work = _Work(data, forms, runner, read, tell, rng)
    specs = first_cases(data.study, forms, rng)
    refuse_few_points(forms, [*specs, *(() if earlier is None else earlier.specs)])
    work.asked = len(specs)
    runs = work.make(specs, "First design")
    # Matrices are small and many: threads of the linear algebra only get in each other's way.
    with threadpool_limits(limits=1):
        known = work.learn(runs if earlier is None else runs.joined(earlier))
        known, outlook = _refined(work, known)
        return _checked(work, known, outlook)


def _refined(work: _Work, known: Knowledge) -> tuple[Knowledge, Outlook]:
    """Add batches until the next one is not expected to change an answer."""
    while True:
        outlook = work.outlook(known, None)
        batch = None if outlook.stop else work.batch(known, work.left)
        if batch is not None:
            outlook = work.outlook(known, batch)
        work.tell(outlook.words)
        if batch is None or outlook.stop or not batch.specs:
            return known, outlook
        known = work.add(known, batch, "Runs where the answer is uncertain")


def _checked(work: _Work, known: Knowledge, outlook: Outlook) -> JointResult:
    """Run the engine at the optimum and at draws, until the emulators know it well enough.

    Its runs are learnt from, too. Where they move the answer away from the point that was checked,
    the new optimum is checked. The first check and such a look again come on top of the budget;
    runs that a check asks for, and the check after them, are paid from what is left. The result is
    the checked values that are the most probable after all runs.
    """
    design = work.data.study.design
    draws, unseen, enough, size = design.check_draws, np.empty(0), True, 0
    tried: list[Array] = []
    for number in range(CHECKS):
        best = _rounded(known)
        tried.append(best)
        space = known.problem.space
        drawn = space.values_of(on_grid(space.units(known.posterior.draws(draws, work.rng))))
        points = np.vstack([best[None], drawn])
        specs = check_cases(work.data.study, known.problem, known.emulators, points)
        fresh = work.make(specs, "Final check")
        if number == 0:
            unseen, size = checked_z(known.emulators, fresh), len(specs)
        elif not enough:
            work.asked += len(specs)
        known = work.learn(known.runs.joined(fresh))
        ratios = error_ratios(known.problem, points)
        worst = max(ratios, key=ratios.__getitem__)
        left = work.left - size  # another check has to follow
        enough = ratios[worst] <= ENOUGH or left < LEAST_BATCH
        moved = behind(known.problem, best, _rounded(known)) > CLOSE or names_outside(
            best, known.posterior, STANDS
        )
        if (enough and not moved) or number == CHECKS - 1:
            break
        if moved:
            work.tell(
                "Final check: after its runs other values are more probable; the check is "
                "repeated there"
            )
        draws = 0 if enough else design.check_draws
        if not enough:
            work.tell(
                f"Final check: the emulator's variance of {worst} is {ratios[worst]:.2g} of the "
                "measurement's; runs are added"
            )
            known = work.add(known, work.batch(known, left), "Runs near the solution")
    best = min(tried, key=lambda values: behind(known.problem, values, tried[0]))
    return result_of(work.data, known, best, unseen, outlook.words, work.asked, work.rng)


def _rounded(known: Knowledge) -> Array:
    """Return the most probable values on thousandths of the ranges, where these lie inside."""
    space, best = known.problem.space, known.posterior.best
    near = space.values_of(on_grid(space.units(best[None])))[0]
    outside = names_outside(near, known.posterior, STANDS)
    return np.where([name in outside for name in known.posterior.names], best, near)
