"""An emulator of the base model, and what effects add to it, each learnt by itself.

The base is trained on runs without any of these effects, an effect on twins of them. So neither
the base nor another effect depends on which effects are looked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.emulator import Scores, TrainedEmulator
from calibrate.emulator.part import Part
from calibrate.emulator.signature import Signature, Twins, learn_signature
from calibrate.emulator.types import Inputs, Prediction

__all__ = ["Change", "WithEffects", "learn_change"]


MOST: Final = 2
SHARE: Final = 0.01
"""Shapes of a curve that are learnt besides the base model's: at most so many, and of at least such
a share of what the effect changes."""


@dataclass(frozen=True)
class Direction:
    """A shape of a curve that an effect changes and the base model does not vary in.

    Attributes
    ----------
    columns : slice
        Of the curve.
    shape : (L,) float64
    signature : Signature
    """

    columns: slice
    shape: Array
    signature: Signature


@dataclass(frozen=True)
class Change:
    """What one effect adds to all outputs.

    Attributes
    ----------
    signatures : tuple of tuple of Signature
        One for each component of each output.
    more : tuple of Direction
        Shapes of curves that are in no component.
    """

    signatures: tuple[tuple[Signature, ...], ...]
    more: tuple[Direction, ...]

    def parts(
        self, base: TrainedEmulator, u: Array, at: tuple[float, float] | None = None
    ) -> tuple[Array, Array, Array]:
        """Return what is added per strength, and per squared strength, and how uncertain it is.

        Parameters
        ----------
        base : TrainedEmulator
        u : (n, d) float64
        at : (float, float), optional
            Strengths, in ordinary ones, at which that is what is expected; see `Signature.parts`.

        Returns
        -------
        slope, bend : (n, M) float64
        doubt : (n, M, Q) float64
            Q independent deviations of what is added at the larger of these strengths, per
            strength; levels of a curve go wrong together.
        """
        ways = self._ways(base)
        slope, bend = np.zeros((2, len(u), base.width))
        doubt = np.zeros((len(u), base.width, len(ways)))
        for k, (one, columns, shape) in enumerate(ways):
            straight, bent, size = one.parts(u, at)
            slope[:, columns] += np.multiply.outer(straight, shape)
            bend[:, columns] += np.multiply.outer(bent, shape)
            doubt[:, columns, k] = np.multiply.outer(size, shape)
        return slope, bend, doubt

    def _ways(self, base: TrainedEmulator) -> list[tuple[Signature, slice, Array]]:
        """Return every signature with the columns it changes, and by what shape."""
        ways = [
            (one, part.output.columns, shape)
            for part, own in zip(base.parts, self.signatures, strict=True)
            for shape, one in zip(part.components.basis.T, own, strict=True)
        ]
        return ways + [(way.signature, way.columns, way.shape) for way in self.more]

    def added(self, scores: Scores, u: Array, strength: Array) -> Scores:
        """Return components with the effect on.

        Parameters
        ----------
        scores : Scores
            Without it, at n inputs.
        u : (n, d) float64
        strength : (n,) float64
        """
        found = []
        for (mean, variance), own in zip(scores, self.signatures, strict=True):
            each = [one.predict(u, strength) for one in own]
            found.append(
                (
                    mean + np.column_stack([m for m, _ in each]),
                    variance + np.column_stack([v for _, v in each]),
                )
            )
        return tuple(found)

    def shaped(self, prediction: Prediction, u: Array, strength: Array) -> Prediction:
        """Return a prediction with the shapes that are in no component."""
        if not self.more:
            return prediction
        mean, factors = prediction.mean.copy(), [prediction.factors]
        for way in self.more:
            middle, variance = way.signature.predict(u, strength)
            mean[:, way.columns] += np.multiply.outer(middle, way.shape)
            own = np.zeros((*mean.shape, 1))
            own[:, way.columns, 0] = np.multiply.outer(np.sqrt(variance), way.shape)
            factors.append(own)
        return Prediction(mean, prediction.variance, np.concatenate(factors, axis=2))


@dataclass(frozen=True)
class Doubt:
    """What is uncertain of a change, without the change: a guess that it is nothing, as unsure.

    Attributes
    ----------
    of : Change
    """

    of: Change

    def parts(
        self, base: TrainedEmulator, u: Array, at: tuple[float, float] | None = None
    ) -> tuple[Array, Array, Array]:
        """Return no change, and how uncertain it is; see `Change.parts`."""
        slope, bend, doubt = self.of.parts(base, u, at)
        return np.zeros_like(slope), np.zeros_like(bend), doubt

    def added(self, scores: Scores, u: Array, strength: Array) -> Scores:
        """Return components that are less certain, see `Change.added`."""
        less = self.of.added(scores, u, strength)
        return tuple((mean, wider) for (mean, _), (_, wider) in zip(scores, less, strict=True))

    def shaped(self, prediction: Prediction, u: Array, strength: Array) -> Prediction:
        """Return a prediction that is less certain, see `Change.shaped`."""
        less = self.of.shaped(prediction, u, strength)
        return Prediction(prediction.mean, less.variance, less.factors)


@dataclass(frozen=True)
class WithEffects:
    """An emulator of a base model and of effects that may be added to it.

    Columns from `effects` on stand for the doubt about the effect so many columns before, alone.

    Attributes
    ----------
    base : TrainedEmulator
    changes : mapping of int to Change
        By column of the strengths behind those of the base; a column without one changes nothing.
    effects : int
        Number of columns of the strengths, those of the base included.
    """

    base: TrainedEmulator
    changes: Mapping[int, Change]
    effects: int

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the expected outputs at n inputs."""
        on = [(k, inputs.strengths[:, k]) for k in self.changes if inputs.strengths[:, k].any()]
        return self.switched(self.scores(inputs), inputs.u, on)

    def luck(self, columns: slice) -> Array:
        """Return the covariance of one run about an expected output without effects, (L, L)."""
        return self.base.luck(columns)

    def scores(self, inputs: Inputs) -> Scores:
        """Return mean and variance of the components without these effects, see `Scores`."""
        own = inputs.strengths[:, : self.base.effects]
        return self.base.scores(Inputs(inputs.u, own, inputs.seeds))

    def switched(
        self, scores: Scores, u: Array, strengths: Sequence[tuple[int, Array]]
    ) -> Prediction:
        """Return the expected outputs with effects on.

        Parameters
        ----------
        scores : Scores
            Without effects, at n inputs.
        u : (n, d) float64
        strengths : sequence of (int, (n,) float64)
            Columns and strengths.
        """
        known = [(self._change(k), x) for k, x in strengths]
        on = [(change, x) for change, x in known if change is not None]
        for change, strength in on:
            scores = change.added(scores, u, strength)
        prediction = self.base.assembled(scores)
        for change, strength in on:
            prediction = change.shaped(prediction, u, strength)
        return prediction

    def parts(
        self, column: int, u: Array, at: tuple[float, float] | None = None
    ) -> tuple[Array, Array, Array]:
        """Return what an effect adds, see `Change.parts`."""
        change = self._change(column)
        if change is None:
            none = np.zeros((len(u), self.base.width))
            return none, none, none[:, :, None]
        return change.parts(self.base, u, at)

    def _change(self, column: int) -> Change | Doubt | None:
        if column < self.effects:
            return self.changes.get(column)
        of = self.changes.get(column - self.effects)
        return None if of is None else Doubt(of)


def learn_change(base: TrainedEmulator, twins: Twins) -> Change:
    """Learn what an effect adds to all outputs.

    Parameters
    ----------
    base : TrainedEmulator
    twins : Twins
        n of them; `change` and `luck` are (n, M), nan where one of a pair gave no value.
    """
    found, more = [], []
    for part in base.parts:
        whole = twins.rows(
            np.asarray(np.isfinite(twins.change[:, part.output.columns]).all(axis=1))
        )
        own = whole.by(np.eye(base.width)[:, part.output.columns])
        inside = own.by(part.components.analysis.T)
        each = np.eye(len(part.processes))
        found.append(
            tuple(
                learn_signature(one.form.hyper.lengths, one.form.scale, inside.by(each[k]))
                for k, one in enumerate(part.processes)
            )
        )
        if part.is_curve and len(whole) > 1:
            more += _directions(part, own, inside)
    return Change(tuple(found), tuple(more))


def _directions(part: Part, twins: Twins, inside: Twins) -> list[Direction]:
    """Return the shapes in which a curve changes and the base model does not vary."""
    change = twins.change - twins.luck
    left = change - (inside.change - inside.luck) @ part.components.basis.T
    total = float(np.sum(change**2))
    _, singular, shapes = np.linalg.svd(left, full_matrices=False)
    lengths = np.mean([one.form.hyper.lengths for one in part.processes], axis=0)
    outside = np.eye(len(part.components.basis)) - part.components.basis @ part.components.analysis
    found = []
    for size, shape in zip(singular[:MOST], shapes, strict=False):
        if size**2 < SHARE * total or total == 0.0:
            break
        scale = float(np.sqrt(np.mean((left @ shape) ** 2)))
        own = twins.by(outside.T @ shape)
        found.append(Direction(part.output.columns, shape, learn_signature(lengths, scale, own)))
    return found
