"""Samplers on problems whose evidence is known; for `python benchmarks/inference.py --samplers`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy import integrate, stats

from calibrate.arrays import Array
from calibrate.emulator.types import Inputs, Prediction
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Place, Problem, Reading, Source
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space, Unknown

KINDS = ("normal", "two humps", "ridge")
RIDGE, WIDTH = 0.16, 0.006  # a product of two frictions, each from 0.1 to 0.8
HUMPS = {0.25: 0.3, 0.75: 0.7}  # place -> weight


def _normal(x: Array, mean: float, sd: float) -> Array:
    return np.asarray(stats.norm.logpdf(x, mean, sd))


@dataclass
class Known:
    """A likelihood over the unit cube with known evidence; counts its calls."""

    kind: str
    size: int
    calls: int = field(default=0, init=False)

    @property
    def truth(self) -> float:
        """Return the logarithm of the evidence."""
        if self.kind != "ridge":
            return 0.0
        ends = np.array([0.1, 0.8])

        def along(a: float) -> float:
            friction = 0.1 + 0.7 * a
            inside = np.diff(stats.norm.cdf((ends * friction - RIDGE) / WIDTH))[0]
            return float(inside) / (0.7 * friction)

        return math.log(integrate.quad(along, 0.0, 1.0, limit=500)[0])

    def __call__(self, cube: Array) -> Array:
        """Return log likelihoods, (n,), of points (n, K)."""
        cube = np.atleast_2d(cube)
        self.calls += len(cube)
        if self.kind == "normal":
            return np.asarray(_normal(cube, 0.5, 0.05).sum(axis=1))
        rest = _normal(cube[:, 2:], 0.5, 0.06).sum(axis=1)
        if self.kind == "two humps":
            parts = [
                _normal(cube[:, :2], m, 0.05).sum(axis=1) + math.log(w) for m, w in HUMPS.items()
            ]
            return np.asarray(np.logaddexp(*parts) + rest)
        product = (0.1 + 0.7 * cube[:, 0]) * (0.1 + 0.7 * cube[:, 1])
        return np.asarray(_normal(product, RIDGE, WIDTH) + rest)


@dataclass(frozen=True)
class Told:
    """What a sampler says: log evidence, the share above the middle of the first unknown, doubt."""

    log_evidence: float
    upper: float
    doubted: bool = False


@dataclass(frozen=True, eq=False)
class _AsReading:
    """A likelihood dressed as an emulator: a reading of 0 with error 1 then has its density."""

    target: Known

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the misfit whose normal density is the likelihood, up to `_TOP`."""
        misfit = np.sqrt(2.0 * np.maximum(_top(self.target) - self.target(inputs.u), 0.0))
        return Prediction(
            misfit[:, None], np.zeros((len(misfit), 1)), np.zeros((len(misfit), 1, 0))
        )


def _top(target: Known) -> float:
    """Return a bound of the log likelihood."""
    return target.size * 2.2 + 6.0


def _own(target: Known) -> Told:
    space = Space(tuple(Unknown(f"x{i}", "", Prior.uniform(0.0, 1.0)) for i in range(target.size)))
    reading = Reading("l", slice(0, 1), np.zeros(1), np.ones(1))
    sources = tuple(Source(i) for i in range(target.size))
    problem = Problem(space, (Place("here", _AsReading(target), sources, (), (reading,)),))
    found = sample(problem, np.random.default_rng(1))
    shift = _top(target) + 0.5 * math.log(2.0 * math.pi)
    upper = float(np.mean(found.samples[:, 0] > 0.5))
    return Told(found.log_evidence + shift, upper, bool(found.doubt))


def _told(log_evidence: float, points: Array, weights: Array) -> Told:
    share = weights / weights.sum()
    return Told(float(log_evidence), float(share[points[:, 0] > 0.5].sum()))


def _dynesty(target: Known) -> Told:
    import dynesty

    sampler = dynesty.NestedSampler(
        lambda cube: float(target(cube)[0]), np.array, target.size, nlive=500,
        rstate=np.random.default_rng(1),
    )  # fmt: skip
    sampler.run_nested(dlogz=0.05, print_progress=False)
    found = sampler.results
    return _told(found.logz[-1], found.samples, found.importance_weights())


def _nautilus(target: Known) -> Told:
    import nautilus

    sampler = nautilus.Sampler(
        lambda cube: cube, target, n_dim=target.size, n_live=1000, n_networks=1,
        vectorized=True, pass_dict=False, seed=1,
    )  # fmt: skip
    sampler.run(verbose=False, n_eff=2000)
    points, log_w, _ = sampler.posterior()
    return _told(sampler.log_z, points, np.exp(log_w - log_w.max()))


def _ultranest(target: Known) -> Told:
    import ultranest
    from ultranest import popstepsampler

    sampler = ultranest.ReactiveNestedSampler(
        [f"x{i}" for i in range(target.size)], target, lambda cube: cube, vectorized=True
    )
    if target.size > 8:
        direction = popstepsampler.generate_mixture_random_direction
        sampler.stepsampler = popstepsampler.PopulationSliceSampler(
            popsize=100, nsteps=2 * target.size, generate_direction=direction
        )
    found: dict[str, Any] = sampler.run(show_status=False, viz_callback=False)
    return _told(found["logz"], found["samples"], np.ones(len(found["samples"])))


def _emcee(target: Known) -> Told:
    import emcee

    def log_p(cube: Array) -> Array:
        inside = ((cube > 0.0) & (cube < 1.0)).all(axis=1)
        result = np.full(len(cube), -np.inf)
        result[inside] = target(cube[inside])
        return result

    walkers = max(4 * target.size, 64)
    moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    sampler = emcee.EnsembleSampler(walkers, target.size, log_p, vectorize=True, moves=moves)
    sampler.run_mcmc(np.random.default_rng(1).random((walkers, target.size)), 8000)
    points = sampler.get_chain(flat=True, discard=4000)
    return _told(math.nan, points, np.ones(len(points)))


SAMPLERS: dict[str, Callable[[Known], Told]] = {
    "calibrate:bulkcal": _own,
    "dynesty": _dynesty,
    "nautilus": _nautilus,
    "ultranest": _ultranest,
    "emcee": _emcee,
}
"""Package, and the name under which it is printed -> how it is run."""
