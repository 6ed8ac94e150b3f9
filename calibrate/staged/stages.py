"""One stage of a calibration: design, runs, surrogates, points near the optimum, result.

Values and intervals come from the one likelihood of `calibrate.inference`, so that a value lies in
its intervals. The minimum of the sum of squared relative residuals (Grobbel et al., Powder
Technology 2019, eq. 18) over the surrogates is given beside them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import CurveReader, make_runs, read_stored_curve
from calibrate.runs.runner import Runner
from calibrate.staged.answer import result_of
from calibrate.staged.bench import Bench, Fitted
from calibrate.staged.design import latin_hypercube, spread
from calibrate.staged.earlier import Earlier
from calibrate.staged.result import StageResult
from calibrate.staged.samples import Planned, freed_by, samples_of
from calibrate.staged.surrogates.emulated import fit_target
from calibrate.study.cases import case_spec
from calibrate.study.data import StudyData
from calibrate.study.model import places_of

__all__ = ["run_stage"]

SEEDS_PER_STAGE: Final = 10_000  # seeds of different stages never meet
REPEAT_SEED: Final = 5_000
INFILL_ROUNDS: Final = 2  # the second round looks where the first one moved the optimum
CLOUD: Final = 400  # draws among which new points are chosen
FLATTEN: Final = 0.5  # infill is drawn from the square root of the posterior, round the optimum


def run_stage(
    data: StudyData,
    number: int,
    earlier: Earlier,
    runner: Runner,
    read: CurveReader = read_stored_curve,
) -> StageResult:
    """Calibrate the free parameters of a stage.

    Parameters
    ----------
    data : StudyData
        The study and what was measured.
    number : int
        Which of its stages, from 0.
    earlier : Earlier
        Result of the stages before.
    runner : Runner
        Runs cases and returns their table.
    read : CurveReader
        Reads curves of finished cases.

    Returns
    -------
    StageResult

    Raises
    ------
    CalibrationError
        When too few runs succeeded for a surrogate.
    """
    study = data.study
    stage, seed = study.stages[number], study.run.seed
    rng = np.random.default_rng([seed, number])
    draws = np.random.default_rng([seed, number, 2])  # a sampler moves no point of the design
    bench = Bench(data, stage, freed_by(study, stage), earlier)
    first_seed = seed + number * SEEDS_PER_STAGE
    forms = forms_of(data)

    def run(cases: Sequence[Planned], label: str) -> pd.DataFrame:
        return make_runs([one.spec for one in cases], label, runner, forms, read).table

    planned = _first_design(bench, first_seed, rng)
    runs = run(planned, stage.title)
    for part in np.array_split(np.arange(stage.infill), INFILL_ROUNDS):
        if not len(part):
            continue
        fitted = _fit(bench, planned, runs)
        extra = _infill(fitted, planned, len(part), first_seed, (rng, draws))
        more = run(extra, f"{stage.title}, points near the optimum")
        planned = [*planned, *extra]
        runs = pd.concat([runs, more], ignore_index=True)
    return result_of(_fit(bench, planned, runs), planned, runs, draws)


def _first_design(bench: Bench, seed: int, rng: np.random.Generator) -> list[Planned]:
    stage, size = bench.stage, len(bench.freed.keys)
    u = latin_hypercube(np.array([[0.0, 1.0]] * size), stage.points, rng)
    values, z = bench.earlier.draw(stage.points, rng)
    planned = _cases(bench, u, (values, z), seed, "design")
    again = spread(u, np.full((1, size), 0.5), stage.repeats)
    earlier = values[again], z[again]
    return planned + _cases(bench, u[again], earlier, seed + REPEAT_SEED, "repeat")


def _cases(
    bench: Bench, u: Array, earlier: tuple[Array, Array], seed: int, kind: str
) -> list[Planned]:
    """Return the cases of all experiments of the stage at points `u`."""
    planned = []
    for i, point in enumerate(bench.freed.values(u)):
        values = dict(zip(bench.earlier.keys, map(float, earlier[0][i]), strict=True))
        values |= dict(zip(bench.freed.keys, map(float, point), strict=True))
        for place in places_of(bench.targets):
            spec = case_spec(bench.data.study, place, values, seed + i)
            planned.append(Planned(place, spec, u[i], earlier[1][i], kind))
    return planned


def _fit(bench: Bench, planned: Sequence[Planned], runs: pd.DataFrame) -> Fitted:
    samples = [samples_of(bench.data, target, planned, runs) for target in bench.targets]
    seed = bench.data.study.run.seed
    return Fitted(bench, tuple(fit_target(one, seed) for one in samples))


def _infill(
    fitted: Fitted,
    planned: Sequence[Planned],
    count: int,
    seed: int,
    chance: tuple[np.random.Generator, np.random.Generator],
) -> list[Planned]:
    """Return new points around the best one, apart from each other and from the old ones."""
    rng, draws = chance
    posterior = fitted.posterior(draws)
    cloud = posterior.sample(CLOUD, rng, FLATTEN)
    best = posterior.best()
    scale = np.maximum(cloud.std(axis=0), 1e-3)
    old = np.array([p.u for p in planned])
    chosen = cloud[spread(cloud / scale, np.vstack([old, best[None]]) / scale, count - 1)]
    u = np.vstack([best[None], chosen])
    earlier = fitted.bench.earlier.draw(len(u), rng)
    return _cases(fitted.bench, u, earlier, seed + REPEAT_SEED // 2 + len(planned), "infill")
