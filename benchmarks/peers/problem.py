"""What a method is given: ranges, measured numbers, and simulations that are counted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.apparatus import PLACES, RANGES, TARGETS, Measurement, Place
from benchmarks.peers.simulator import Run, Simulator

Array = NDArray[np.float64]

LARGEST_SEED: Final = 2**31 - 1


@dataclass
class Cost:
    """What has been simulated so far.

    Attributes
    ----------
    runs : int
        Runs of single places, failed ones too.
    failed : int
    particle_steps : float
        Steps times grains of all of them.
    """

    runs: int = 0
    failed: int = 0
    particle_steps: float = 0.0


@dataclass(frozen=True)
class Problem:
    """A calibration: find the parameters from the measured numbers.

    Attributes
    ----------
    measured, error : Mapping[str, float]
        Value and standard error of every target.
    simulator : Simulator
    seeds : numpy.random.Generator
        Gives every run its own seed.
    cost : Cost
        Counts what `simulate` runs.
    """

    measured: Mapping[str, float]
    error: Mapping[str, float]
    simulator: Simulator
    seeds: np.random.Generator
    cost: Cost = field(default_factory=Cost)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of `bounds` and of all parameter vectors."""
        return tuple(RANGES)

    @property
    def bounds(self) -> Array:
        """Lower and upper limit of every parameter, (6, 2)."""
        return np.array(list(RANGES.values()))

    def simulate(self, theta: Array, targets: Sequence[str] = tuple(TARGETS)) -> Array:
        """Run each place that these targets need once and return the targets, (len(targets),).

        Parameters
        ----------
        theta : (6,) float64
            Parameters in their own units; what lies outside the ranges is refused.
        targets : sequence of str
            By default all, at the price of one parameter vector.

        Returns
        -------
        (n,) float64
            In the order of `targets`; nan where a run failed.
        """
        low, high = self.bounds.T
        if not np.all((theta >= low) & (theta <= high)):
            msg = f"{theta} lies outside the ranges {RANGES}"
            raise ValueError(msg)
        wanted = {TARGETS[name].place for name in targets}
        seen = {
            place: self._observe(place, dict(zip(self.names, map(float, theta), strict=True)))
            for place in PLACES
            if place in wanted
        }
        return observed(seen, [TARGETS[name] for name in targets])

    def _observe(self, place: str, parameters: Mapping[str, float]) -> Mapping[str, float]:
        return self.run(PLACES[place], parameters, draw_seed(self.seeds)).observables

    def run(self, place: Place, parameters: Mapping[str, float], seed: int) -> Run:
        """Run one place, at the price of one run."""
        run = self.simulator.run(place, parameters, seed)
        self.cost.runs += 1
        self.cost.failed += not run.observables
        self.cost.particle_steps += run.particle_steps
        return run

    def standardised(self, values: Array) -> Array:
        """Return all targets as differences from the measured in standard errors, (7,)."""
        return (values - np.array(list(self.measured.values()))) / np.array(
            list(self.error.values())
        )


@dataclass(frozen=True)
class Answer:
    """What a method says after spending a budget.

    Attributes
    ----------
    budget : int
        The checkpoint, in parameter vectors over all places.
    theta : (6,) float64
    interval : (6, 2) float64, optional
        90 % interval of every parameter, where the method has any.
    runs, failed : int
    particle_steps : float
        What it cost.
    """

    budget: int
    theta: Array
    interval: Array | None
    runs: int
    failed: int
    particle_steps: float


class Method(Protocol):
    """A way to calibrate.

    Attributes
    ----------
    name : str
    sequential : bool
        Whether its answers are stages of one calibration; otherwise each budget is one of its own.
    """

    name: str
    sequential: bool

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield an answer for each budget, in rising order.

        A budget of n allows the runs of n parameter vectors at all five places; `Problem.simulate`
        counts them. Equal problems and generators must give equal answers: an interrupted
        comparison starts a method again and takes stored runs.
        """


def answer(problem: Problem, budget: int, theta: Array, interval: Array | None = None) -> Answer:
    """Return an answer with the cost so far, moved into the ranges."""
    low, high = problem.bounds.T
    cost = problem.cost
    return Answer(
        budget, np.clip(theta, low, high), interval, cost.runs, cost.failed, cost.particle_steps
    )


def observed(seen: Mapping[str, Mapping[str, float]], measurements: Sequence[Measurement]) -> Array:
    """Return measurements from the observables of their places; nan where a run failed."""
    return np.array([seen[m.place].get(m.observable, np.nan) for m in measurements])


def draw_seed(rng: np.random.Generator) -> int:
    """Return the seed of one run."""
    return int(rng.integers(1, LARGEST_SEED))
