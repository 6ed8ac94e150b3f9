"""What an emulator takes and gives: plain arrays with names.

Nothing here knows of studies, materials or runs. A column of `Inputs.u` may be a contact parameter
or a number of a material; a column of `Inputs.strengths` is an effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from calibrate.arrays import Array

__all__ = ["Emulator", "Inputs", "Output", "Prediction"]


@dataclass(frozen=True)
class Inputs:
    """Where runs were made, or where predictions are asked for.

    Attributes
    ----------
    u : (n, d) float64
        Parameters, and numbers of the material, each on [0, 1] over its range.
    strengths : (n, m) float64
        Effects in units of their ordinary strength; 0 where an effect is off. m may be 0.
    seeds : (n,) float64
        Runs with one seed share an offset; nan is a seed of its own, and what predictions have.
    """

    u: Array
    strengths: Array
    seeds: Array

    @classmethod
    def at(cls, u: Array, strengths: Array | None = None, effects: int = 0) -> Inputs:
        """Return inputs for predictions.

        Parameters
        ----------
        u : (n, d) array_like
        strengths : (n, m) array_like, optional
            All effects off by default.
        effects : int
            How many effects there are, where `strengths` is not given.
        """
        u = np.atleast_2d(np.asarray(u, dtype=np.float64))
        off = np.zeros((len(u), effects))
        given = off if strengths is None else np.atleast_2d(np.asarray(strengths, np.float64))
        return cls(u, given, np.full(len(u), np.nan))

    def __len__(self) -> int:
        """Return n."""
        return len(self.u)

    def rows(self, which: Array | slice) -> Inputs:
        """Return some of the rows, by a mask, by indices or by a slice."""
        return Inputs(self.u[which], self.strengths[which], self.seeds[which])

    def joined(self, other: Inputs) -> Inputs:
        """Return these rows with those of others below."""
        return Inputs(
            np.vstack([self.u, other.u]),
            np.vstack([self.strengths, other.strengths]),
            np.concatenate([self.seeds, other.seeds]),
        )


@dataclass(frozen=True)
class Output:
    """What is emulated, on its model scale.

    Attributes
    ----------
    name : str
    columns : slice
        Its columns of y: one for a number, several neighbours for a curve.
    """

    name: str
    columns: slice


@dataclass(frozen=True)
class Prediction:
    """Expected outputs, without the luck of a seed, and how well the emulator knows them.

    The covariance of one row is ``diag(variance) + factors @ factors.T``. Numbers of different
    outputs are independent; the values of one curve have `factors` in common.

    Attributes
    ----------
    mean : (n, M) float64
        Expected outputs.
    variance : (n, M) float64
        Independent part of their variance.
    factors : (n, M, F) float64
        Common part; F may be 0.
    """

    mean: Array
    variance: Array
    factors: Array

    @property
    def total(self) -> Array:
        """Variance of each expected output, independent and common part, shape (n, M)."""
        return np.asarray(self.variance + np.einsum("nmf,nmf->nm", self.factors, self.factors))

    def columns(self, which: slice | Sequence[int]) -> Prediction:
        """Return the prediction of some columns only."""
        return Prediction(self.mean[:, which], self.variance[:, which], self.factors[:, which])


class Emulator(Protocol):
    """What a likelihood needs of an emulator."""

    def predict(self, inputs: Inputs) -> Prediction:
        """Return the expected outputs at n inputs."""
        ...
