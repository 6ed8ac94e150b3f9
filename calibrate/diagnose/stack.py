"""All experiments side by side: one data vector, one covariance, one linear model.

y is measured, m(u, phi) simulated, both on the scales of the observables (`calibrate.scales`).
The covariance V of y - m adds measurement errors, declared common nuisances, and the surrogate's
covariance, which holds the seed noise of the simulated mean and everything the local design left
open.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from calibrate.arrays import Array
from calibrate.diagnose.local.model import LocalSurrogate, derivatives, features
from calibrate.diagnose.problem import Problem
from calibrate.scales import forward, slope

# Weak prior of a parameter on [0, 1]: centre and standard deviation; a uniform one has 0.29.
PRIOR_CENTRE = 0.5
PRIOR_SD = 0.5


@dataclass(frozen=True)
class Linear:
    """Model linearised at one point, n observables, d parameters, c candidates.

    Attributes
    ----------
    mean : ndarray, shape (n,)
    by_u : ndarray, shape (n, d)
        Slope of the mean per parameter on [0, 1].
    by_phi : ndarray, shape (n, c)
        Signatures: slope per unit strength of each candidate.
    surrogate : ndarray, shape (n, n)
        Covariance of `mean`.
    """

    mean: Array
    by_u: Array
    by_phi: Array
    surrogate: Array


@dataclass(frozen=True)
class Stack:
    """Data, errors and surrogates of all experiments.

    Attributes
    ----------
    problem : Problem
    surrogates : mapping
        Experiment -> its surrogate.
    y : ndarray, shape (n,)
        Measured values on the fit's scale.
    measured : ndarray, shape (n,)
        Their standard errors on the same scale.
    alike : ndarray, shape (n, n)
        Correlation of the measurement errors: points of one mass-time curve come from the same
        repeats and share their luck; their correlation is taken from the simulated runs.
    nuisance : ndarray, shape (n, n)
        Covariance of the declared common errors.
    repeats : ndarray of int, shape (n,)
        Measurements behind each standard error; 0 where it is known.
    """

    problem: Problem
    surrogates: Mapping[str, LocalSurrogate]
    y: Array
    measured: Array
    alike: Array
    nuisance: Array
    repeats: Array

    @functools.cached_property
    def blocks(self) -> dict[str, slice]:
        """Rows of each experiment in the stacked vectors."""
        found, at = {}, 0
        for experiment in self.problem.order():
            size = len(self.problem.observed_in(experiment))
            found[experiment] = slice(at, at + size)
            at += size
        return found

    def linearise(self, u: Array, strengths: Mapping[str, float] | None = None) -> Linear:
        """Value, slopes and covariance at `u`, shape (d,), with candidates switched on."""
        n, d = len(self.y), len(self.problem.parameters)
        mean, by_u = np.zeros(n), np.zeros((n, d))
        by_phi, surrogate = np.zeros((n, len(self.problem.candidates))), np.zeros((n, n))
        for experiment, rows in self.blocks.items():
            s = self.surrogates[experiment]
            on = self.problem.effects_in(experiment, strengths or {})
            v, p = s.local(u), s.scaled(on)
            f = features(v[None, :], p[None, :])[0][0]
            by_v, by_p = derivatives(v, p)
            mean[rows] = s.beta @ f
            by_u[rows, s.free] = s.beta @ by_v.T / s.half_width
            columns, effects = self._columns(experiment)
            if columns:
                by_phi[rows, columns] = (s.beta @ by_p.T / s.steps)[:, effects]
            surrogate[rows, rows] = s.error(f)
        return Linear(mean, by_u, by_phi, surrogate)

    def slopes(self, u: Array, strengths: Mapping[str, float], candidate: int | None) -> Linear:
        """`linearise` without the error, with the signature of one candidate or none: faster."""
        n, d = len(self.y), len(self.problem.parameters)
        mean, by_u, by_phi = (
            np.zeros(n),
            np.zeros((n, d)),
            np.zeros((n, 0 if candidate is None else 1)),
        )
        for experiment, rows in self.blocks.items():
            s = self.surrogates[experiment]
            on = self.problem.effects_in(experiment, strengths)
            v, p = s.local(u), s.scaled(on)
            by_v, by_p = derivatives(v, p)
            mean[rows] = s.beta @ features(v[None, :], p[None, :])[0][0]
            by_u[rows, s.free] = s.beta @ by_v.T / s.half_width
            columns, effects = self._columns(experiment)
            if candidate is not None and candidate in columns:
                k = effects[columns.index(candidate)]
                by_phi[rows, 0] = s.beta @ by_p[k] / s.steps[k]
        return Linear(mean, by_u, by_phi, np.zeros((0, 0)))

    @functools.cached_property
    def _acting(self) -> dict[str, tuple[list[int], list[int]]]:
        return {e: self._find_columns(e) for e in self.surrogates}

    def _columns(self, experiment: str) -> tuple[list[int], list[int]]:
        """Candidates that act in an experiment, and the effect each of them is there."""
        return self._acting[experiment]

    def _find_columns(self, experiment: str) -> tuple[list[int], list[int]]:
        effects = self.surrogates[experiment].effects
        acting = [
            (k, effects.index(c.effect))
            for k, c in enumerate(self.problem.candidates)
            if experiment in c.experiments
        ]
        return [k for k, _ in acting], [j for _, j in acting]

    def mean(self, u: Array, strengths: Mapping[str, float] | None = None) -> Array:
        """Return the simulated mean at `u` with candidates switched on, shape (n,)."""
        mean = np.zeros(len(self.y))
        for experiment, rows in self.blocks.items():
            s = self.surrogates[experiment]
            on = self.problem.effects_in(experiment, strengths or {})
            v, p = s.local(u), s.scaled(on)
            mean[rows] = s.beta @ features(v[None, :], p[None, :])[0][0]
        return mean

    def covariance(self, surrogate: Array) -> Array:
        """Covariance V of measured minus simulated, shape (n, n)."""
        bench = self.alike * np.outer(self.measured, self.measured)
        return np.asarray(bench + self.nuisance + surrogate)

    def draw_surrogates(self, u: Array, size: int, rng: np.random.Generator) -> Linear:
        """Random errors of value, slopes and signatures at `u`, leading axis `size`.

        The shapes are those of `Linear` with `size` in front; `surrogate` is left empty.
        """
        n, d = len(self.y), len(self.problem.parameters)
        mean, by_u = np.zeros((size, n)), np.zeros((size, n, d))
        by_phi = np.zeros((size, n, len(self.problem.candidates)))
        for experiment, rows in self.blocks.items():
            s = self.surrogates[experiment]
            v, p = s.local(u), np.zeros(len(s.effects))
            f = features(v[None, :], p[None, :])[0][0]
            by_v, by_p = derivatives(v, p)
            rooted = np.linalg.cholesky(s.correlation + 1e-9 * np.eye(len(s.correlation)))
            normal = rng.standard_normal((size, s.factor.shape[2], len(s.quantities)))
            shared = np.swapaxes(normal @ rooted.T, 1, 2)
            targets = np.vstack([f[None, :], by_v / s.half_width, by_p / s.steps[:, None]])
            # (q, targets, k) @ (B, q, k, 1): errors of all targets from one draw of weights.
            lever = np.einsum("tf,qfk->qtk", targets, s.factor)
            errors = np.einsum("qtk,bqk->bqt", lever, shared)
            mean[:, rows] = errors[:, :, 0]
            by_u[:, rows, s.free] = errors[:, :, 1 : 1 + len(v)]
            columns, effects = self._columns(experiment)
            if columns:
                by_phi[:, rows, columns] = errors[:, :, 1 + len(v) :][:, :, effects]
        return Linear(mean, by_u, by_phi, np.zeros((0, 0)))


def stack(problem: Problem, surrogates: Mapping[str, LocalSurrogate]) -> Stack:
    """Put data and surrogates of all experiments side by side."""
    ordered = [o for e in problem.order() for o in problem.observed_in(e)]
    slopes = np.array([slope(o.scale, o.value) for o in ordered])
    y = np.array([float(forward(o.scale, np.array(o.value))) for o in ordered])
    nuisance = np.zeros((len(ordered), len(ordered)))
    for one in problem.nuisances:
        shift = slopes * np.array([one.shifts.get(o.name, 0.0) for o in ordered])
        nuisance += np.outer(shift, shift)
    return Stack(
        problem=problem,
        surrogates=surrogates,
        y=y,
        measured=slopes * np.array([o.sem for o in ordered]),
        alike=_alike(problem, surrogates),
        nuisance=nuisance,
        repeats=np.array([float(o.repeats) for o in ordered]),
    )


def _alike(problem: Problem, surrogates: Mapping[str, LocalSurrogate]) -> Array:
    """Correlation of measurement errors: block of a curve, identity elsewhere."""
    parts = []
    for experiment in problem.order():
        observed = problem.observed_in(experiment)
        curve = np.array([o.on_curve for o in observed])
        together = np.outer(curve, curve)
        parts.append(np.where(together, surrogates[experiment].correlation, np.eye(len(curve))))
    return np.asarray(block_diag(*parts))
