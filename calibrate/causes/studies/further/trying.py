"""Further experiments under trial: cases at draws of each answer, their results, their worth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, TypeAlias

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.causes.diagnosis import SAMPLES, Diagnosis
from calibrate.causes.offers import Names, Offer, Read, Trial
from calibrate.causes.studies.further.expectations import Seen, offer_of
from calibrate.causes.studies.further.options import Option, case_of
from calibrate.runs.runner import Runner
from calibrate.scales import Scale, scale_of
from calibrate.study.model import Study
from liggghts_io import CaseSpec
from liggghts_io.case.spec import script_of

__all__ = ["FEW", "FURTHER_SEED", "Key", "Trying"]

FEW: Final = 3
"""Draws of each answer in a round; the leading experiments get a second one."""
FURTHER_SEED: Final = 5_000_000
"""Added to the study's seed; far from those of designs, stages, checks and effects."""
APART_SEEDS: Final = 100
"""Between the seeds of two answers; more than there are draws of one."""
DRAWN: Final = 7
"""Keeps these draws apart from others with the diagnosis's seed."""
LABEL: Final = "Further experiments"

Key: TypeAlias = tuple[str, Names]
"""Name of an option, and an answer."""


@dataclass
class Trying:
    """Experiments under trial, and what they gave so far.

    Attributes
    ----------
    study : Study
    found : Diagnosis
    answers : tuple of tuple of str
        Those that are tried.
    runner : Runner
    draws : dict
        Answer to the draws that it is tried at, in their order.
    prior : float64
        Probability of each parameter in its prior, by draw; the same for all answers.
    results : dict
        Of each option and answer, (n, d).
    runs : int
    """

    study: Study
    found: Diagnosis
    answers: tuple[Names, ...]
    runner: Runner
    draws: dict[Names, list[tuple[Array, Array]]]
    prior: Array
    results: dict[Key, Array] = field(default_factory=dict)
    runs: int = 0

    @classmethod
    def of(
        cls, study: Study, found: Diagnosis, answers: tuple[Names, ...], runner: Runner
    ) -> Trying:
        """Choose the draws."""
        rng = np.random.default_rng([found.seed, DRAWN])
        at = rng.permutation(SAMPLES)[: 2 * FEW]
        prior = rng.random((2 * FEW, len(study.parameters)))
        draws = {}
        for names in answers:
            values, strengths = found.samples(names)
            draws[names] = list(zip(values[at], strengths[at], strict=True))
        return cls(study, found, answers, runner, draws, prior)

    def cases(self, option: Option, draws: range) -> dict[Key, list[CaseSpec]]:
        """Return the cases of an option.

        Raises
        ------
        CalibrationError, CaseError
            Where one cannot be made.
        """
        first = self.study.run.seed + FURTHER_SEED
        found: dict[Key, list[CaseSpec]] = {}
        for number, names in enumerate(self.answers):
            for k in draws:
                spec = case_of(
                    option, self.found, names, self.draws[names][k], self.prior[k],
                    first + APART_SEEDS * number + k,
                )  # fmt: skip
                script_of(spec)
                found.setdefault((option.name, names), []).append(spec)
        return found

    def run(self, cases: Mapping[Key, Sequence[CaseSpec]], options: Sequence[Option]) -> None:
        """Run cases and keep what they gave."""
        flat = [spec for specs in cases.values() for spec in specs]
        if not flat:
            return
        table, begin = self.runner(flat, LABEL), 0
        self.runs += len(flat)
        reads = {option.name: list(option.entry.se) for option in options}
        for key, specs in cases.items():
            rows = _numbers(table.iloc[begin : begin + len(specs)], reads[key[0]])
            begin += len(specs)
            before = self.results.get(key)
            self.results[key] = rows if before is None else np.vstack([before, rows])

    def offer(self, option: Option, shares: Mapping[Names, float]) -> Offer | None:
        """Return what an option is worth after its runs."""
        reads, scales = _reads(self.study, option)
        results = {names: self.results[option.name, names] for names in self.answers}
        seen = Seen(results, scales, tuple(read.se for read in reads))
        entry = option.entry
        # A study holds one setting of each experiment.
        alone = bool(entry.apparatus or entry.times)
        command = "" if alone else f"bulkcal apparatus {entry.experiment}"
        words = entry.words
        if ":" in option.name:
            words = f"{words}: {option.place.material} on {option.place.surface}"
        trial = Trial(option.name, words, entry.hours, reads, command)
        rng = np.random.default_rng([self.found.seed, DRAWN])
        return offer_of(trial, shares, seen, rng)


def _numbers(table: pd.DataFrame, names: Sequence[str]) -> Array:
    """Return what runs gave, (n, d); nan of those that failed."""
    rows = table.reindex(columns=list(names)).to_numpy(dtype=float, copy=True)
    rows[(table["status"] != "ok").to_numpy()] = np.nan
    return rows


def _reads(study: Study, option: Option) -> tuple[tuple[Read, ...], tuple[Scale, ...]]:
    """Return what is read and on which scale, as the study does where it reads that, too."""
    reads, scales = [], []
    for name, se in option.entry.se.items():
        observable = study.experiments[option.entry.experiment].observable(name)
        asked = (option.entry.experiment, name)
        own = [t.scale for t in study.numbers if (t.experiment, t.observable) == asked and t.scale]
        reads.append(Read(name, observable.unit, se))
        scales.append(own[0] if own else scale_of(observable.unit))
    return tuple(reads), tuple(scales)
