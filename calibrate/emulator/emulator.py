"""All outputs of one experiment: trained on runs, asked for predictions, told of new runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import pandas as pd

from calibrate.arrays import Array
from calibrate.emulator.checks import check_inputs, check_outputs, check_runs
from calibrate.emulator.part import Part, train_part
from calibrate.emulator.quality import quality_of
from calibrate.emulator.types import Inputs, Output, Prediction
from calibrate.errors import CalibrationError

__all__ = ["Scores", "TrainedEmulator", "train_emulator"]

Scores: TypeAlias = tuple[tuple[Array, Array], ...]
"""Mean and variance of the components of each output, (n, F) each."""


@dataclass(frozen=True)
class TrainedEmulator:
    """What `train_emulator` gives.

    Attributes
    ----------
    parts : tuple of Part
        One per output.
    parameters, effects : int
        Columns of u and of the strengths.
    width : int
        Columns of y, M.
    """

    parts: tuple[Part, ...]
    parameters: int
    effects: int
    width: int

    @property
    def outputs(self) -> tuple[Output, ...]:
        """What is emulated."""
        return tuple(part.output for part in self.parts)

    @property
    def noise(self) -> Array:
        """Variance of one run about the expected outputs, (M,)."""
        found = np.empty(self.width)
        for part in self.parts:
            found[part.output.columns] = part.noise
        return found

    def luck(self, columns: slice) -> Array:
        """Return the covariance of one run about an expected output or a part of it, (L, L)."""
        asked = range(self.width)[columns]
        for part in self.parts:
            own = range(self.width)[part.output.columns]
            if asked[0] in own and asked[-1] in own:
                at = [own.index(column) for column in asked]
                return np.asarray(part.luck[np.ix_(at, at)])
        msg = f"emulator: columns {columns} are those of no output"
        raise ValueError(msg)

    @property
    def quality(self) -> pd.DataFrame:
        """How well left-out points are predicted, a row per output; see `quality_of`."""
        return pd.DataFrame([quality_of(part) for part in self.parts])

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the expected outputs at n inputs; their seeds do not matter.

        Raises
        ------
        CalibrationError
            For inputs of other shapes, or outside [0, 1].
        """
        return self.assembled(self.scores(inputs))

    def scores(self, inputs: Inputs) -> Scores:
        """Return mean and variance of the components of every output at n inputs.

        Raises
        ------
        CalibrationError
            For inputs of other shapes, or outside [0, 1].
        """
        check_inputs(inputs, self.parameters, self.effects)
        return tuple(part.scores(inputs) for part in self.parts)

    def assembled(self, scores: Scores) -> Prediction:
        """Return what `predict` does from means and variances of the components."""
        n, first = len(scores[0][0]), 0
        curves = sum(len(part.processes) for part in self.parts if part.is_curve)
        mean, variance = np.empty((n, self.width)), np.empty((n, self.width))
        factors = np.zeros((n, self.width, curves))
        for part, (middle, spread) in zip(self.parts, scores, strict=True):
            columns = part.output.columns
            mean[:, columns], own = part.assembled(middle, spread)
            if part.is_curve:
                variance[:, columns] = part.components.truncation
                factors[:, columns, first : first + own.shape[2]] = own
                first += own.shape[2]
            else:
                variance[:, columns] = own[:, :, 0] ** 2
        return Prediction(mean, variance, factors)

    def updated(self, inputs: Inputs, y: Array) -> TrainedEmulator:
        """Return the emulator with new runs, hyperparameters held.

        Parameters
        ----------
        inputs : Inputs
            n new runs.
        y : (n, M) float64
            Their outputs, nan where they failed.

        Raises
        ------
        CalibrationError
            For wrong shapes, inputs outside [0, 1], or an effect that no earlier run had on.
        """
        check_inputs(inputs, self.parameters, self.effects)
        check_runs(inputs, y, self.width)
        for part in self.parts:
            acting = {int(k) for one in part.processes for k in one.form.acting}
            new = sorted({*np.flatnonzero(inputs.strengths.any(axis=0)).tolist()} - acting)
            if new:
                msg = (
                    f"output '{part.output.name}': no earlier run had effect {new[0]} on, so that "
                    "nothing is known of it; train the emulator again with these runs"
                )
                raise CalibrationError(msg)
        parts = tuple(part.updated(inputs, y[:, part.output.columns]) for part in self.parts)
        return TrainedEmulator(parts, self.parameters, self.effects, self.width)

    def reduction(self, candidates: Inputs, at: Inputs) -> Array:
        """Return how much the variances at `at` are expected to fall by a run at each candidate.

        Parameters
        ----------
        candidates : Inputs
            n_candidates possible runs. Their noise counts; one with the seed of a run shares its
            offset. A candidate at the place of a run is a repeat.
        at : Inputs
            n_at places of prediction.

        Returns
        -------
        (n_candidates, n_at, M) float64
        """
        found = np.zeros((len(candidates), len(at), self.width))
        for columns, share, fall in self._falls(candidates, at):
            found[:, :, columns] += fall[:, :, None] * share
        return found

    def weighted_reduction(self, candidates: Inputs, at: Inputs, weights: Array) -> Array:
        """Return `reduction` summed over places and columns, without the large array.

        Parameters
        ----------
        candidates, at : Inputs
        weights : (n_at, M) float64
            For example one over n_at times the variance of a measurement.

        Returns
        -------
        (n_candidates,) float64
        """
        found = np.zeros(len(candidates))
        for columns, share, fall in self._falls(candidates, at):
            found += fall @ (weights[:, columns] @ share)
        return found

    def _falls(self, candidates: Inputs, at: Inputs) -> Iterator[tuple[slice, Array, Array]]:
        check_inputs(candidates, self.parameters, self.effects)
        check_inputs(at, self.parameters, self.effects)
        for part in self.parts:
            for share, fall in part.reduction(candidates, at):
                yield part.output.columns, share, fall


def train_emulator(inputs: Inputs, outputs: Sequence[Output], y: Array) -> TrainedEmulator:
    """Train an emulator. The same runs give the same emulator, in whatever order they come.

    Parameters
    ----------
    inputs : Inputs
        n runs.
    outputs : sequence of Output
        They share the columns of y among them.
    y : (n, M) float64
        Outputs on their model scales, nan where a run failed; a curve counts as failed if one of
        its values is missing.

    Raises
    ------
    CalibrationError
        For wrong shapes, inputs outside [0, 1], or too few runs of an output.
    """
    y = np.asarray(y, dtype=np.float64)
    check_inputs(inputs, inputs.u.shape[1], inputs.strengths.shape[1])
    check_runs(inputs, y, y.shape[1])
    check_outputs(outputs, y.shape[1])
    parts = tuple(train_part(one, inputs, y[:, one.columns]) for one in outputs)
    return TrainedEmulator(parts, inputs.u.shape[1], inputs.strengths.shape[1], y.shape[1])
