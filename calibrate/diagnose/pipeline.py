"""The diagnosis from end to end: recalibrate, table, verdict, gain.

`diagnose(problem, runner)` asks the runner for the runs of a local design around the start,
refits all parameters jointly, moves the design while the fit leaves it, and only then looks at
candidates.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from calibrate.arrays import Array
from calibrate.diagnose.absorption import Absorption, absorption
from calibrate.diagnose.fit import Fit, Task, fit, fit_from
from calibrate.diagnose.gain import Gain, gain
from calibrate.diagnose.local.design import DesignOptions, two_level
from calibrate.diagnose.local.pool import Pool
from calibrate.diagnose.problem import Problem, Runner
from calibrate.diagnose.residuals import Residual, residuals
from calibrate.diagnose.scores import frame
from calibrate.diagnose.stack import Stack, stack
from calibrate.diagnose.verdict import Court, Levels, Verdict, judge, null_frames
from calibrate.diagnose.verify import engine_residuals

# A fit that moves by less than this part of a design's half width has found its place.
_STAYS = 0.25


@dataclass(frozen=True)
class Options:
    """How much work a diagnosis does.

    Attributes
    ----------
    design : DesignOptions
    levels : Levels
    check_seeds : int
        Fresh seeds for the engine's residuals at the fitted points; below two they are skipped.
    rounds : int
        Designs at most: the first around the start, more where a fit leaves the runs so far.
    infill : int
        How often the base model is run where its fit puts it, and fitted again, before
        candidates are looked at: a surrogate is least sure between designs.
    confirm : int
        How often suspects are run where their fits put them before the verdict is final.
    also : tuple of mapping
        Parameter values around which lighter designs are run from the beginning, for example
        where an earlier diagnosis led.
    margin : float
        How far outside the runs a fit may go, in half widths of a design: the surrogate's error
        grows there as its curvature prior says.
    stride : float
        How far outside the runs a next design may be centred, in its half widths.
    """

    design: DesignOptions = field(default_factory=DesignOptions)
    levels: Levels = field(default_factory=Levels)
    check_seeds: int = 0
    rounds: int = 5
    infill: int = 3
    confirm: int = 2
    also: tuple[Mapping[str, float], ...] = ()
    margin: float = 0.5
    stride: float = 1.5


@dataclass(frozen=True)
class Local:
    """Base fit with the surrogates it rests on.

    Attributes
    ----------
    stack : Stack
    base : Fit
    wide : Fit
        The base fit allowed one stride further out, on the extrapolated surrogate; the same as
        `base` where that was not stopped at the edge of the runs.
    low, high : ndarray, shape (d,)
        Trusted region.
    rounds, runs : int
        Designs and runs used.
    failed : tuple of str
        Reasons of failed runs.
    """

    stack: Stack
    base: Fit
    wide: Fit
    low: Array
    high: Array
    rounds: int
    runs: int
    failed: tuple[str, ...]

    @property
    def settled(self) -> bool:
        """Whether the base fit lies inside the trusted region."""
        return not self.base.edge


@dataclass(frozen=True)
class Diagnosis:
    """Everything a report needs.

    Attributes
    ----------
    problem : Problem
    local : Local
    residuals : tuple of Residual
        Base model, all parameters refitted.
    after : tuple of Residual
        With the best named cause; empty without one.
    absorption : Absorption
    verdict : Verdict
    gains : tuple of Gain
        Held-out gain of every named cause.
    levels : Levels
        Error rates the verdict worked to.
    engine_before, engine_after : tuple of Residual
        The engine's own residuals at the fitted points, base model and best named cause, with
        fresh seeds; empty when they were not asked for.
    """

    problem: Problem
    local: Local
    residuals: tuple[Residual, ...]
    after: tuple[Residual, ...]
    absorption: Absorption
    verdict: Verdict
    gains: tuple[Gain, ...]
    levels: Levels
    engine_before: tuple[Residual, ...] = ()
    engine_after: tuple[Residual, ...] = ()

    @property
    def theta(self) -> dict[str, float]:
        """Jointly refitted parameters of the base model."""
        return self.problem.theta(self.local.base.u)


def _starts(problem: Problem, low: Array, high: Array) -> list[Array]:
    """Return starts of the joint fit: the given one, the middle of the runs, and their corners.

    Friction and rolling friction trade against each other, so the misfit has several valleys.
    """
    middle, reach = 0.5 * (low + high), 0.35 * (high - low)
    corners = [middle + reach * row for row in two_level(len(low))]
    return [problem.start, middle, *corners]


def recalibrate(
    pool: Pool, options: Options, progress: Callable[[str], None] | None = None
) -> Local:
    """Fit all parameters jointly; run a new design wherever the fit leaves the runs so far."""
    problem = pool.problem
    if not pool.designs:
        pool.first(problem.start, options.design)
        for theta in options.also:
            pool.extend(problem.unit(theta), options.design)
    while True:
        low, high = pool.box()
        beyond = options.margin * options.design.half_width
        low, high = np.maximum(low - beyond, 0.0), np.minimum(high + beyond, 1.0)
        together = stack(problem, pool.surrogates(options.design.half_width))
        base = fit_from(Task(together, low, high), _starts(problem, low, high))
        if progress is not None:
            progress(f"design {pool.designs}: misfit {base.power:.1f}, {pool.runs} runs")
        wide = base
        if base.edge:
            margin = options.stride * options.design.half_width
            reach = (np.maximum(low - margin, 0.0), np.minimum(high + margin, 1.0))
            wide = fit(Task(together, *reach), base.u)
        if not base.edge or pool.designs >= options.rounds:
            break
        pool.extend(wide.u, options.design)
    return Local(together, base, wide, low, high, pool.designs, pool.runs, tuple(pool.failed))


def _filled(pool: Pool, options: Options, progress: Callable[[str], None] | None = None) -> Local:
    """Recalibrate, and run the base model at its fit until the fit stays where it is."""
    local = recalibrate(pool, options, progress)
    for _ in range(options.infill):
        u = local.base.u
        pool.infill(u, options.design)
        local = recalibrate(pool, options, progress)
        if float(np.abs(local.base.u - u).max()) < _STAYS * options.design.half_width:
            break
    return local


def diagnose(
    problem: Problem,
    runner: Runner,
    *,
    rng: np.random.Generator,
    options: Options | None = None,
    progress: Callable[[str], None] | None = None,
) -> Diagnosis:
    """Say what the simulation gets wrong, and which cause fits.

    Parameters
    ----------
    problem : Problem
    runner : callable
        Maps a list of case descriptions to their results in the same order; a failed run has a
        status other than ``ok``.
    rng : numpy Generator
        For the imagined studies behind every error rate.
    options : Options, optional
    progress : callable, optional
        Receives one line per step.

    Raises
    ------
    CalibrationError
        When too many runs of an experiment failed.
    """
    chosen = options or Options()
    pool = Pool(problem, runner)
    local = _filled(pool, chosen, progress)
    found = conclude(problem, local, rng, chosen.levels)
    for _ in range(chosen.confirm):
        if not found.verdict.suspects:
            break
        _confirm(pool, found, chosen)
        local = recalibrate(pool, chosen, progress)
        found = conclude(problem, local, rng, chosen.levels)
    return _verified(found, runner, chosen.check_seeds) if chosen.check_seeds >= 2 else found


def _verified(found: Diagnosis, runner: Runner, seeds: int) -> Diagnosis:
    """Add the engine's own residuals at the fitted points."""
    verdict = found.verdict
    before = engine_residuals(found.local.stack, runner, found.local.base.u, {}, seeds)
    after: list[Residual] = []
    best = verdict.suspects[0] if verdict.names else None
    if best is not None:
        on = {best.candidate: best.strength}
        after = engine_residuals(found.local.stack, runner, best.fitted.u, on, seeds)
    return replace(found, engine_before=tuple(before), engine_after=tuple(after))


def _confirm(pool: Pool, found: Diagnosis, options: Options) -> None:
    """Run the suspects where their fits put them; extrapolated signatures convict nobody."""
    keep = found.verdict.names or (found.verdict.suspects[0].candidate,)
    for number, suspect in enumerate(s for s in found.verdict.suspects if s.candidate in keep):
        fitted = suspect.fitted
        if number == 0 and fitted.edge and pool.designs < options.rounds:
            pool.extend(fitted.u, options.design)
        pool.probe(fitted.u, {suspect.candidate: suspect.strength}, options.design)


def conclude(problem: Problem, local: Local, rng: np.random.Generator, levels: Levels) -> Diagnosis:
    """Reach the verdict from an existing local fit; needs no run."""
    court = Court(local.stack, local.base, local.wide, local.low, local.high, levels, rng)
    here = frame(local.stack, local.base)
    nulls = null_frames(court)
    verdict = judge(court, nulls)
    gains = tuple(gain(local.stack, here, nulls, name) for name in verdict.names)
    after: Sequence[Residual] = ()
    if verdict.names:
        after = residuals(local.stack, verdict.suspects[0].fitted)
    return Diagnosis(
        problem=problem,
        local=local,
        residuals=tuple(residuals(local.stack, local.base)),
        after=tuple(after),
        absorption=absorption(problem, here, local.base.held),
        verdict=verdict,
        gains=gains,
        levels=levels,
    )
