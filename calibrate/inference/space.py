"""Everything that is unknown at once: a cube of independent probabilities and the values it means.

Coordinates of the cube are as many as values: one per unknown, in order, then two per tie, its
mean and its spread. A tied unknown is

    u = mean + spread x delta,   delta ~ N(0, 1) cut so that u stays inside [0, 1]

on the unit range of its members (not centred: delta, not u, is the coordinate of the cube), so a
small spread leaves no funnel for a sampler to fall into.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import special

from calibrate.arrays import Array
from calibrate.errors import CalibrationError, unknown_name
from calibrate.inference.priors import TINY, Prior, from_unit, to_unit, truncated_normal

__all__ = ["Space", "Tie", "Unknown"]


@dataclass(frozen=True)
class Unknown:
    """One number that is to be inferred.

    Attributes
    ----------
    name : str
        Parameter, effect or nuisance, such as ``mu_pp``.
    instance : str
        Whose it is, such as ``HSP13/steel``; empty where there is one only.
    prior : Prior
    label : str
        In words, for people.
    nuisance : bool
        Whether nobody asks for it, such as the error of a balance in standard deviations.
    """

    name: str
    instance: str
    prior: Prior
    label: str = ""
    nuisance: bool = False

    @property
    def key(self) -> str:
        """Name in tables: ``mu_pw[HSP13/steel]``."""
        return f"{self.name}[{self.instance}]" if self.instance else self.name

    @staticmethod
    def shared_error(name: str) -> Unknown:
        """Return an error that several readings have in common, in standard deviations."""
        return Unknown(name, "", Prior.normal(0.0, 1.0), nuisance=True)


@dataclass(frozen=True)
class Tie:
    """Unknowns that are alike up to a spread that is inferred.

    Attributes
    ----------
    name : str
    members : tuple of int
        Positions of the unknowns; their priors must be equal. The prior becomes that of the mean.
    spread : float
        Width of the half-normal prior of their spread, on the unit range.
    """

    name: str
    members: tuple[int, ...]
    spread: float = 0.1


@dataclass(frozen=True)
class Space:
    """All unknowns and their ties; K values and one cube coordinate for each.

    Attributes
    ----------
    unknowns : tuple of Unknown
    ties : tuple of Tie

    Raises
    ------
    CalibrationError
        For doubled names, and for ties that tie nothing or unlike unknowns.
    """

    unknowns: tuple[Unknown, ...]
    ties: tuple[Tie, ...] = ()

    def __post_init__(self) -> None:
        """Check names and ties."""
        keys = self.names
        double = sorted({key for key in keys if keys.count(key) > 1})
        if double:
            msg = f"unknowns: {', '.join(double)} more than once; give each instance its own name"
            raise CalibrationError(msg)
        for tie in self.ties:
            _check(tie, self.unknowns)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all columns of values: unknowns, then mean and spread of each tie."""
        hyper = [f"{what} of {tie.name}" for tie in self.ties for what in ("mean", "spread")]
        return (*(one.key for one in self.unknowns), *hyper)

    @property
    def size(self) -> int:
        """Number K of values and of coordinates of the cube."""
        return len(self.unknowns) + 2 * len(self.ties)

    @cached_property
    def priors(self) -> tuple[Prior, ...]:
        """Prior of every column of values; that of a tied unknown is its range's."""
        found = [one.prior for one in self.unknowns]
        for tie in self.ties:
            found += [self.unknowns[tie.members[0]].prior, Prior.half_normal(tie.spread, 0.0, 1.0)]
        return tuple(found)

    @property
    def asked(self) -> tuple[int, ...]:
        """Columns that are no nuisance."""
        count = len(self.unknowns)
        nuisance = {i for i, one in enumerate(self.unknowns) if one.nuisance}
        return tuple(i for i in range(self.size) if i >= count or i not in nuisance)

    def index(self, name: str) -> int:
        """Return the column of a name.

        Raises
        ------
        CalibrationError
            With the nearest name, if there is none.
        """
        if name not in self.names:
            msg = f"unknowns: {unknown_name(name, self.names)}"
            raise CalibrationError(msg)
        return self.names.index(name)

    def transform(self, cube: Array) -> Array:
        """Return the values, (n, K), that points of the unit cube, (n, K), stand for."""
        cube = np.clip(np.asarray(cube, dtype=float), TINY, 1.0 - TINY)
        values = np.empty_like(cube)
        tied = {i for tie in self.ties for i in tie.members}
        for i, prior in enumerate(self.priors):
            if i not in tied:
                values[:, i] = prior.quantile(cube[:, i])
        for number, tie in enumerate(self.ties):
            at = len(self.unknowns) + 2 * number
            prior = self.priors[at]
            mean = to_unit(values[:, [at]], prior.low, prior.high, prior.spacing)
            spread = np.maximum(values[:, [at + 1]], TINY)
            members = list(tie.members)
            delta = truncated_normal(cube[:, members], -mean / spread, (1.0 - mean) / spread)
            unit = np.clip(mean + spread * delta, 0.0, 1.0)
            values[:, members] = from_unit(unit, prior.low, prior.high, prior.spacing)
        return values

    def from_normal(self, z: Array) -> Array:
        """Return the values of points whose prior is the unit normal, (n, K)."""
        return self.transform(special.ndtr(z))

    def draw(self, count: int, rng: np.random.Generator) -> Array:
        """Return values drawn from the prior, (count, K)."""
        return self.transform(rng.random((count, self.size)))

    def unit(self, values: Array, column: int) -> Array:
        """Return values of one column on its unit range; without one, in prior deviations."""
        prior = self.priors[column]
        if prior.bounded:
            return to_unit(values, prior.low, prior.high, prior.spacing)
        return (values - prior.mean) / prior.sd

    def units(self, values: Array) -> Array:
        """Return values on their unit ranges; without a finite range, in prior deviations."""
        scaled = [self.unit(values[:, i], i) for i in range(self.size)]
        return np.column_stack(scaled)

    def values_of(self, units: Array) -> Array:
        """Undo `units`."""
        scaled = [
            from_unit(units[:, i], p.low, p.high, p.spacing)
            if p.bounded
            else p.mean + p.sd * units[:, i]
            for i, p in enumerate(self.priors)
        ]
        return np.column_stack(scaled)

    def log_density(self, values: Array) -> Array:
        """Return the prior's log density, (n,), up to a constant, of values (n, K).

        That of a tied unknown is the density of its delta, so the density of a spread of zero is
        finite.
        """
        tied = {i for tie in self.ties for i in tie.members}
        free = [i for i in range(self.size) if i not in tied]
        total = np.zeros(len(values))
        for i in free:
            total += self.priors[i].log_density(values[:, i])
        units = self.units(values)
        for number, tie in enumerate(self.ties):
            at = len(self.unknowns) + 2 * number
            spread = np.maximum(values[:, at + 1], TINY)
            delta = (units[:, list(tie.members)] - units[:, [at]]) / spread[:, None]
            total -= 0.5 * np.sum(delta**2, axis=1)
        return np.asarray(total)


def _check(tie: Tie, unknowns: tuple[Unknown, ...]) -> None:
    """Refuse a tie that says nothing or cannot hold."""
    place = f"tie '{tie.name}'"
    if len(set(tie.members)) < 2 or len(set(tie.members)) < len(tie.members):
        msg = f"{place}: needs two or more different unknowns; leave the tie out"
        raise CalibrationError(msg)
    priors = {unknowns[i].prior for i in tie.members}
    if len(priors) > 1 or not next(iter(priors)).bounded:
        msg = f"{place}: its unknowns need one and the same finite range and prior"
        raise CalibrationError(msg)
    if not tie.spread > 0.0:
        msg = f"{place}: spread is {tie.spread:g}; it must be above 0"
        raise CalibrationError(msg)
