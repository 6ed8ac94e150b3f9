"""The runs a local surrogate needs: paired points around a centre, common seeds.

A two-level orthogonal array estimates every slope from all its runs, so one slope costs as
little noise as all runs together allow; one-at-a-time differences would need several times as
many runs for the same error (Plackett and Burman, Biometrika 33, 1946, 305). Axial points
separate curvature from the mean. Candidates are switched on at the centre with the same seeds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.problem import Candidate, Problem
from liggghts_io import CaseSpec

# First row of the cyclic 12-run array (Plackett and Burman 1946, table for N = 12).
_PB12 = (1, 1, -1, 1, 1, 1, -1, -1, -1, 1, -1)


@dataclass(frozen=True)
class DesignOptions:
    """Size of the local designs.

    Attributes
    ----------
    half_width : float
        Half width of a design in units of the parameter's range.
    seeds : int
        Common seeds at every point of the first design; later ones use one.
    centre_seeds : int
        Seeds at the centre of the first design; the first `seeds` are shared.
    effect_seeds : int
        Seeds with a candidate switched on, shared with the centre.
    first_seed : int
        Seeds count up from here.
    axial_later : bool
        Whether later designs have axial points too; without them they cost half and take their
        curvature from the first design.
    """

    half_width: float = 0.14
    seeds: int = 2
    centre_seeds: int = 6
    effect_seeds: int = 3
    first_seed: int = 1
    axial_later: bool = True


@dataclass(frozen=True)
class Point:
    """One planned run.

    Attributes
    ----------
    u : ndarray, shape (n_parameters,)
        All base parameters on [0, 1].
    seed : int
        Seed of the run.
    effects : mapping
        Effect -> strength, empty for the base model.
    """

    u: Array
    seed: int
    effects: Mapping[str, float] = field(default_factory=dict)


def two_level(n: int) -> Array:
    """Orthogonal two-level array for `n` factors, shape (runs, n), entries -1 and 1.

    A full factorial up to three factors, a half fraction for four, the 12-run array up to 11.

    Raises
    ------
    ValueError
        For more than 11 factors.
    """
    if n > len(_PB12):
        msg = f"{n} factors: the local design knows at most {len(_PB12)}"
        raise ValueError(msg)
    if n <= 4:
        base = min(n, 3)
        grid = np.array(np.meshgrid(*[[-1.0, 1.0]] * base, indexing="ij"))
        full = grid.reshape(base, -1).T
        return full if n <= 3 else np.column_stack([full, full.prod(axis=1)])
    rows = [np.roll(_PB12, k) for k in range(11)]
    return np.vstack([*rows, -np.ones(11)])[:, :n].astype(np.float64)


def probe_levels(candidate: Candidate) -> tuple[float, float]:
    """Two strengths at which a candidate is switched on: both signs, or half and full."""
    if candidate.two_sided:
        return candidate.step, -candidate.step
    sign = 1.0 if candidate.upper > 0.0 else -1.0
    return sign * candidate.step, 0.5 * sign * candidate.step


def plan(problem: Problem, experiment: str, centre: Array, options: DesignOptions) -> list[Point]:
    """Plan the first design of one experiment around `centre`, shape (n_parameters,)."""
    seeds = _seeds(options, options.seeds)
    points = [Point(u, s) for u in _around(problem, experiment, centre, options) for s in seeds]
    points += [Point(centre, s) for s in _seeds(options, options.centre_seeds)]
    for candidate in problem.probes_in(experiment):
        for level in probe_levels(candidate):
            points += probe(centre, {candidate.effect: level}, options)
    return points


def extend(problem: Problem, experiment: str, centre: Array, options: DesignOptions) -> list[Point]:
    """Plan a lighter design around a new centre: one seed for each point, no candidates."""
    first = options.first_seed
    around = _around(problem, experiment, centre, options, axial=options.axial_later)
    points = [Point(u, first) for u in around]
    return points + probe(centre, {}, options)


def probe(centre: Array, effects: Mapping[str, float], options: DesignOptions) -> list[Point]:
    """Plan paired runs at one point with effects at given strengths."""
    return [Point(centre, s, effects) for s in _seeds(options, options.effect_seeds)]


def _seeds(options: DesignOptions, count: int) -> range:
    return range(options.first_seed, options.first_seed + count)


def _around(
    problem: Problem,
    experiment: str,
    centre: Array,
    options: DesignOptions,
    *,
    axial: bool = True,
) -> list[Array]:
    """Corners of the orthogonal array and axial points, cut at the parameters' limits."""
    names = [p.name for p in problem.parameters]
    free = [names.index(n) for n in problem.active[experiment]]
    offsets = two_level(len(free))
    if axial:
        offsets = np.vstack([offsets, np.eye(len(free)), -np.eye(len(free))])
    points = []
    for offset in offsets:
        u = centre.copy()
        # A point outside the allowed range is moved to its edge; the fit sees where it is.
        u[free] = np.clip(centre[free] + options.half_width * offset, 0.0, 1.0)
        points.append(u)
    return points


def specify(problem: Problem, experiment: str, points: Sequence[Point]) -> list[CaseSpec]:
    """Turn planned points into case descriptions; strength zero stays the base model."""
    base = problem.experiments[experiment]
    specs = []
    for point in points:
        theta = {**base.parameters, **problem.theta(point.u)}
        # Ten digits: the same point reached by another route is the same stored case.
        theta = {k: float(f"{v:.10g}") for k, v in theta.items()}
        on = {k: float(f"{v:.10g}") for k, v in point.effects.items() if v != 0.0}
        effects = {**base.effects, **on}
        specs.append(replace(base, parameters=theta, effects=effects, seed=point.seed))
    return specs
