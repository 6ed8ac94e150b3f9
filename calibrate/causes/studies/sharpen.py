"""More runs where evidence hangs on the emulators: at the base model and at the leading causes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.causes.bank import sways
from calibrate.causes.diagnosis import Evidences
from calibrate.causes.verdict import probabilities
from calibrate.causes.visibility import visibility
from calibrate.questions.core.emulate import Emulators
from calibrate.questions.core.runs import Runs
from calibrate.questions.joint.offers import Question, choose_runs
from calibrate.study.model import Study
from liggghts_io import CaseSpec

__all__ = ["BATCH", "MORE", "Outlook", "outlook_of", "sharpening_cases"]

BATCH: Final = 16
"""Runs that are made before everything is weighed again."""
MORE: Final = 64
"""Most runs of this kind, where nobody asks for another number."""
SHARP: Final = 0.5
"""Sway of a log evidence ratio that is small enough in any case, in nats."""
FIRM: Final = 3.0
CLEAR: Final = 3.0
"""An answer stands that leads by so many nats and so many sways: nothing else is near."""
LEADING: Final = 0.05
"""Probability from which a cause is worth runs."""
MOST_LEADING: Final = 4
"""Causes that share a batch, at most: each run of the base model serves them all."""
POINTS_SEED: Final = 2_500_000
"""Seeds of these runs follow the study's after so many; far from those of other questions."""


@dataclass(frozen=True)
class Outlook:
    """What leads, and how firmly.

    Attributes
    ----------
    leaders : tuple of str
        Candidates whose probability matters, the most probable first.
    log_ratio : float
        Log evidence of the first of them against the base model, in nats.
    sway : float
        How much the log evidences of the leaders may differ with other runs, the largest.
    margin : float
        Log of the ratio of the two most probable answers, in nats.
    """

    leaders: tuple[str, ...]
    log_ratio: float
    sway: float
    margin: float

    @property
    def settled(self) -> bool:
        """Whether other runs would hardly give another answer."""
        sharp = self.sway <= SHARP or self.margin >= FIRM + CLEAR * self.sway
        return not self.leaders or sharp


def outlook_of(found: Evidences) -> Outlook:
    """Return what leads after the runs that are there, and how firmly.

    Parameters
    ----------
    found : Evidences
    """
    seen = visibility(found.board, found.base)
    shares, _ = probabilities(found.board, found.weighed, seen)
    names = [name for name in shares if (name,) in found.weighed][:MOST_LEADING]
    leaders = tuple(name for k, name in enumerate(names) if k == 0 or shares[name] >= LEADING)
    others = [found.weighed[name,] for name in leaders]
    first, second = sorted(shares.values(), reverse=True)[:2]
    return Outlook(
        leaders,
        others[0].log_evidence - found.base.log_evidence if others else 0.0,
        max(sways(found.base, others, found.seed), default=0.0),
        math.log(first / max(second, math.ulp(0.0))),
    )


def sharpening_cases(
    study: Study,
    emulators: Emulators,
    runs: Runs,
    found: Evidences,
    names: Sequence[str],
    count: int,
    made: int,
) -> tuple[CaseSpec, ...]:
    """Return the runs that make base model and leading causes more certain for what they cost.

    Parameters
    ----------
    study : Study
        With all effects free.
    emulators : Emulators
    runs : Runs
        What was run so far; it tells what a run costs.
    found : Evidences
    names : sequence of str
        The causes.
    count : int
        Most runs.
    made : int
        Runs of this kind that were made before; their seeds come first.
    """
    first = study.run.seed + POINTS_SEED + made
    asked = [found.base, *(found.weighed[name,] for name in names)]
    questions = [Question(one.problem, one.samples, 1.0 / len(asked)) for one in asked]
    rng = np.random.default_rng([found.seed, made])
    return choose_runs(study, emulators, runs, questions, count, rng, first).specs
