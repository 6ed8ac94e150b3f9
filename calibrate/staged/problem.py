"""A stage as a problem of the common likelihood: its free parameters, targets and earlier stages.

What the uncertainty of earlier stages does to all targets together, B C B', is a set of errors that
the readings share. Not in it: errors of the apparatus or of the contact law, and parameters held at
assumed values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Final, Protocol

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs
from calibrate.inference import Interval, Known, Place, Problem, Reading, Source, Space, Unknown
from calibrate.inference import sample as draw_posterior
from calibrate.questions.core.from_study import place_of
from calibrate.questions.core.problem import error_name, joins, reading_of
from calibrate.staged.earlier import Earlier
from calibrate.staged.posterior.cloud import CloudPosterior
from calibrate.staged.posterior.grid import grid_posterior
from calibrate.staged.posterior.marginal import marginal_likelihood
from calibrate.staged.samples import Freed
from calibrate.staged.surrogates.emulated import HeldErrors, TargetSurrogate
from calibrate.study.data import StudyData
from calibrate.study.schema.targets import Target

__all__ = ["StagePosterior", "common_covariance", "posterior_of", "stage_problem", "with_errors_at"]

GRIDDED: Final = 2
"""Free parameters that can be looked at everywhere."""
NOTHING: Final = 1e-9
"""Size of a shared error, relative to the largest, below which it is none."""


class StagePosterior(Protocol):
    """Probability of the free parameters of a stage, each on [0, 1]."""

    @property
    def size(self) -> int:
        """Number d of parameters."""
        ...

    def interval(self, parameter: int, level: float) -> Interval:
        """Return the span of one parameter that holds `level`."""
        ...

    def best(self) -> Array:
        """Return the most probable values that lie in all 68 % intervals, (d,)."""
        ...

    def regions(self) -> int:
        """Return into how many separate regions the probability falls."""
        ...

    def sample(self, count: int, rng: np.random.Generator, flatten: float = 1.0) -> Array:
        """Draw points, (count, d)."""
        ...


def stage_problem(
    data: StudyData,
    targets: Sequence[Target],
    freed: Freed,
    surrogates: Sequence[TargetSurrogate],
    earlier: Earlier,
) -> Problem:
    """Return the problem of a stage: a place for each target.

    Parameters
    ----------
    data : StudyData
    targets : sequence of Target
    freed : Freed
    surrogates : sequence of TargetSurrogate
        In the order of the targets.
    earlier : Earlier
    """
    study = data.study
    names = {target.name for target in targets}
    unknowns = [
        Unknown(name, "", prior, study.label(name, instance))
        for (name, instance), prior in zip(freed.keys, freed.priors, strict=True)
    ]
    unknowns += [
        Unknown.shared_error(error_name(one))
        for one in study.shared
        if names & set(one.targets) and joins(study, one)
    ]
    loadings = _loadings([surrogate.gradient for surrogate in surrogates], earlier)
    first = len(unknowns)
    count = loadings[0].shape[1]
    unknowns += [Unknown.shared_error(f"error {k + 1} of earlier stages") for k in range(count)]
    space = Space(tuple(unknowns))
    sources = tuple(Source(k, 0.0, p.low, p.high, p.spacing) for k, p in enumerate(freed.priors))
    places = []
    for target, surrogate, loading in zip(targets, surrogates, loadings, strict=True):
        reading = reading_of(data, target, slice(0, len(loading)), space)
        handed_on = tuple((first + k, column) for k, column in enumerate(loading.T))
        reading = replace(reading, shared=(*reading.shared, *handed_on))
        places.append(Place(target.name, surrogate, sources, (), (reading,)))
    return Problem(space, tuple(places), _known(data, targets, freed))


def _loadings(gradients: Sequence[Array], earlier: Earlier) -> list[Array]:
    """Return what one standard deviation of each independent error does to each target, (L, r)."""
    stacked = np.vstack(gradients)
    values, axes = np.linalg.eigh(stacked @ earlier.moment() @ stacked.T)
    kept = values > NOTHING * max(float(values.max()), 0.0)
    root = axes[:, kept] * np.sqrt(values[kept])
    return np.split(root, np.cumsum([len(one) for one in gradients])[:-1])


def _known(data: StudyData, targets: Sequence[Target], freed: Freed) -> tuple[Known, ...]:
    """Return the independent measurements of what is free, each once."""
    study = data.study
    found: dict[int, Known] = {}
    for target in targets:
        place = place_of(target)
        for k, (name, instance) in enumerate(freed.keys):
            known = study.known_of(name, place)
            if known is not None and study.layout.instance(name, place) == instance:
                found.setdefault(k, Known(k, known.value, known.se))
    return tuple(found.values())


def common_covariance(reading: Reading) -> Array:
    """Return the covariance of the errors that a reading's levels, or others, share, (L, L)."""
    total = np.zeros((len(reading.y), len(reading.y)))
    if reading.extra is not None:
        total += reading.extra @ reading.extra.T
    for _, loading in reading.shared:
        total += np.outer(loading, loading)
    return total


def with_errors_at(problem: Problem, u: Array) -> Problem:
    """Return a problem whose emulators are everywhere as uncertain as at one point, (d,).

    Where nothing explains the data the likelihood would reward ignorance: the points with the
    widest error bars. Then every point gets the error bars of the nearest approach.
    """
    places = [
        replace(one, emulator=HeldErrors(one.emulator, one.emulator.predict(Inputs.at(u[None]))))
        for one in problem.places
    ]
    return replace(problem, places=tuple(places))


def posterior_of(problem: Problem, freed: Freed, rng: np.random.Generator) -> StagePosterior:
    """Return the posterior of the free parameters: on a grid, or drawn where there are many."""
    size = len(freed.keys)
    if size > GRIDDED:
        return CloudPosterior(draw_posterior(problem, rng), size)

    def density(u: Array, *, rough: bool = False) -> Array:
        values = freed.values(u)
        return marginal_likelihood(problem, values, rough=rough) + _log_prior(freed, values)

    shared = problem.space.size > size
    return grid_posterior(density, size, partial(density, rough=True) if shared else None)


def _log_prior(freed: Freed, values: Array) -> Array:
    """Return the log density of the prior per unit of the range, up to a constant, (n,)."""
    total = np.zeros(len(values))
    for prior, column in zip(freed.priors, values.T, strict=True):
        total += prior.log_density(column)
        if prior.kind != "uniform" and prior.spacing == "log":
            total += np.log(column)
    return total
