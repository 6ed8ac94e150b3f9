"""One stage of a calibration: design, runs, surrogates, most probable values, intervals.

Values and intervals come from one likelihood (`posterior`), so that a value lies in its intervals.
The minimum of the sum of squared relative residuals (Grobbel et al., Powder Technology 2019,
eq. 18) over the surrogates is given beside them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.runs.runner import Runner
from calibrate.scales import backward, forward, slope
from calibrate.staged.crossing import judge, least_squares_sentence
from calibrate.staged.design import from_unit, latin_hypercube, spread
from calibrate.staged.earlier import Earlier
from calibrate.staged.optimum import minimise
from calibrate.staged.posterior import LEVELS, Interval, Posterior, grid_posterior, log_likelihood
from calibrate.staged.result import StageResult, TargetFit
from calibrate.staged.samples import Freed, Planned, freed_by, samples_of
from calibrate.staged.surface import Surrogate, fit_surrogate
from calibrate.study.cases import case_spec
from calibrate.study.measured.scalars import Measured
from calibrate.study.model import Study, places_of
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target

__all__ = ["run_stage"]

SEEDS_PER_STAGE = 10_000  # seeds of different stages never meet
REPEAT_SEED = 5_000
INFILL_ROUNDS = 2  # the second round looks where the first one moved the optimum
FAR = 5.0  # standard deviations beyond which no surrogate error is a likely reason
SHARE = 0.90  # of the interval outside which the paper's point is remarked upon
FLATTEN = 0.5  # infill is drawn from the square root of the posterior, to surround the optimum


@dataclass(frozen=True)
class _Bench:
    """What all steps of a stage share."""

    study: Study
    stage: Stage
    freed: Freed
    measured: Mapping[str, Measured]
    earlier: Earlier
    base_seed: int

    @property
    def targets(self) -> list[Target]:
        return [self.study.target_named(name) for name in self.stage.targets]


def run_stage(
    study: Study,
    number: int,
    measured: Mapping[str, Measured],
    earlier: Earlier,
    runner: Runner,
) -> StageResult:
    """Calibrate the two free parameters of a stage.

    Parameters
    ----------
    study : Study
        The study.
    number : int
        Which of its stages, from 0.
    measured : mapping
        Measured values by target name.
    earlier : Earlier
        Result of the stages before.
    runner : Runner
        Runs cases and returns their table.

    Returns
    -------
    StageResult

    Raises
    ------
    CalibrationError
        When too few runs succeeded for a surrogate.
    """
    stage, seed = study.stages[number], study.run.seed
    rng = np.random.default_rng([seed, number])
    freed = freed_by(study, stage)
    bench_ = _Bench(study, stage, freed, measured, earlier, seed + number * SEEDS_PER_STAGE)
    planned = _first_design(bench_, rng)
    runs = runner([p.spec for p in planned], stage.title)
    for round_ in range(INFILL_ROUNDS if stage.infill else 0):
        fitted = _fit(bench_, planned, runs)
        share = [len(part) for part in np.array_split(np.arange(stage.infill), INFILL_ROUNDS)]
        extra = _infill(bench_, fitted, planned, share[round_], rng)
        more = runner([p.spec for p in extra], f"{stage.title}, points near the optimum")
        planned = [*planned, *extra]
        runs = pd.concat([runs, more], ignore_index=True)
    return _result(bench_, _fit(bench_, planned, runs), planned, runs)


def _first_design(bench_: _Bench, rng: np.random.Generator) -> list[Planned]:
    stage = bench_.stage
    u = latin_hypercube(np.array([[0.0, 1.0], [0.0, 1.0]]), stage.points, rng)
    values, z = bench_.earlier.draw(stage.points, rng)
    planned = _cases(bench_, u, (values, z), 0, "design")
    centre = np.full((1, 2), 0.5)
    again = spread(u, centre, stage.repeats)
    return planned + _cases(bench_, u[again], (values[again], z[again]), REPEAT_SEED, "repeat")


def _cases(
    bench_: _Bench, u: Array, earlier: tuple[Array, Array], seed: int, kind: str
) -> list[Planned]:
    """Return the cases of all experiments of the stage at points `u`."""
    study, freed = bench_.study, bench_.freed
    free = from_unit(u, freed.bounds)
    planned = []
    for i, point in enumerate(free):
        values = dict(zip(bench_.earlier.keys, map(float, earlier[0][i]), strict=True))
        values |= dict(zip(freed.keys, map(float, point), strict=True))
        for place in places_of(bench_.targets):
            spec = case_spec(study, place, values, bench_.base_seed + seed + i)
            planned.append(Planned(place, spec, u[i], earlier[1][i], kind))
    return planned


def _fit(bench_: _Bench, planned: Sequence[Planned], runs: pd.DataFrame) -> list[Surrogate]:
    return [
        fit_surrogate(samples_of(target, planned, runs), bench_.study.run.seed)
        for target in bench_.targets
    ]


def _infill(
    bench_: _Bench,
    surrogates: Sequence[Surrogate],
    planned: Sequence[Planned],
    count: int,
    rng: np.random.Generator,
) -> list[Planned]:
    """Return new points around the best one, apart from each other and from the old ones."""
    posterior = _posterior(bench_, surrogates)
    cloud = posterior.sample(400, rng, FLATTEN)
    best = posterior.best()
    scale = np.maximum(cloud.std(axis=0), 1e-3)
    old = np.array([p.u for p in planned])
    chosen = cloud[spread(cloud / scale, np.vstack([old, best[None]]) / scale, count - 1)]
    u = np.vstack([best[None], chosen]) if count else np.empty((0, 2))
    seed = REPEAT_SEED // 2 + len(planned)
    return _cases(bench_, u, bench_.earlier.draw(len(u), rng), seed, "infill")


def _values(bench_: _Bench) -> Array:
    return np.array([bench_.measured[t.name].value for t in bench_.targets])


def _predictors(bench_: _Bench, surrogates: Sequence[Surrogate]) -> Callable[[Array], Array]:
    def predict(u: Array) -> Array:
        columns = [
            backward(target.model_scale, surrogate.predict(u)[0])
            for target, surrogate in zip(bench_.targets, surrogates, strict=True)
        ]
        return np.column_stack(columns)

    return predict


def _likelihood_parts(
    bench_: _Bench, surrogates: Sequence[Surrogate], u: Array
) -> tuple[Array, Array, Array]:
    """Return residuals, variances of each target and the covariance from earlier stages."""
    residuals, variances = [], []
    for target, surrogate in zip(bench_.targets, surrogates, strict=True):
        known = bench_.measured[target.name]
        mean, variance = surrogate.predict(u)
        residuals.append(mean - float(forward(target.model_scale, np.array(known.value))))
        variances.append(variance + (slope(target.model_scale, known.value) * known.se) ** 2)
    gradients = np.array([surrogate.gradient for surrogate in surrogates])
    common = gradients @ bench_.earlier.moment() @ gradients.T
    return np.column_stack(residuals), np.column_stack(variances), common


def _posterior(bench_: _Bench, surrogates: Sequence[Surrogate]) -> Posterior:
    optimum, _ = minimise(_predictors(bench_, surrogates), _values(bench_))
    residual, held, common = _likelihood_parts(bench_, surrogates, optimum[None])
    z = residual / np.sqrt(held + np.diag(common))
    far = bool(np.abs(z).max() > FAR)

    def function(u: Array) -> Array:
        residual, variance, common = _likelihood_parts(bench_, surrogates, u)
        # Where nothing explains the data the likelihood would reward ignorance: the points with
        # the widest error bars. Then every point gets the error bars of the nearest approach.
        variance = np.broadcast_to(held, variance.shape) if far else variance
        return log_likelihood(residual, variance, common)

    return grid_posterior(function)


def _result(
    bench_: _Bench,
    surrogates: Sequence[Surrogate],
    planned: Sequence[Planned],
    runs: pd.DataFrame,
) -> StageResult:
    predict = _predictors(bench_, surrogates)
    posterior = _posterior(bench_, surrogates)
    best = posterior.best()
    names, bounds = bench_.freed.names, bench_.freed.bounds

    def in_units(point: Array) -> dict[str, float]:
        return dict(zip(names, map(float, from_unit(point[None], bounds)[0]), strict=True))

    least, objective = minimise(predict, _values(bench_))
    fits = _target_fits(bench_, surrogates, best)
    intervals = _intervals(posterior, names, bounds)
    verdict = judge(bench_.targets, _values(bench_), predict, [f.z for f in fits], posterior)
    common = {name: levels[SHARE] for name, levels in intervals.items()}
    more = least_squares_sentence(in_units(least), common, SHARE)
    return StageResult(
        stage=bench_.stage,
        freed=bench_.freed,
        fits=tuple(fits),
        best=best,
        found=in_units(best),
        intervals=intervals,
        least_squares=in_units(least),
        objective=objective,
        posterior=posterior,
        verdict=replace(verdict, sentences=(*verdict.sentences, *more)),
        planned=tuple(planned),
        runs=runs,
    )


def _target_fits(bench_: _Bench, surrogates: Sequence[Surrogate], best: Array) -> list[TargetFit]:
    residual, variance, common = _likelihood_parts(bench_, surrogates, best[None])
    z = residual[0] / np.sqrt(variance[0] + np.diag(common))
    fits = []
    for i, (target, surrogate) in enumerate(zip(bench_.targets, surrogates, strict=True)):
        mean, var = surrogate.predict(best[None])
        value = float(backward(target.model_scale, mean)[0])
        per_unit = slope(target.model_scale, value)
        fits.append(
            TargetFit(
                target=target,
                measured=bench_.measured[target.name],
                surrogate=surrogate,
                predicted=value,
                predicted_sd=float(np.sqrt(var[0] + common[i, i])) / per_unit,
                z=float(z[i]),
            )
        )
    return fits


def _intervals(
    posterior: Posterior, names: Sequence[str], bounds: Array
) -> dict[str, dict[float, Interval]]:
    """Return the intervals in the parameters' own units."""
    result: dict[str, dict[float, Interval]] = {}
    for i, name in enumerate(names):
        low, width = float(bounds[i, 0]), float(bounds[i, 1] - bounds[i, 0])
        result[name] = {}
        for level in LEVELS:
            unit = posterior.interval(i, level)
            ends = (low + width * unit.low, low + width * unit.high)
            result[name][level] = Interval(*ends, unit.open_low, unit.open_high)
    return result
