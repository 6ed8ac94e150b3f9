"""What surrogates are fitted to, and how well they do."""

from __future__ import annotations

from dataclasses import dataclass, field

from calibrate.arrays import Array

__all__ = ["Quality", "Samples"]


@dataclass(frozen=True)
class Samples:
    """Simulated values of one target, on the scale of its surrogate.

    Attributes
    ----------
    x : (n, d) float64
        Free parameters scaled to [0, 1]; repeated runs repeat the row.
    y : (n,) or (n, L) float64
        Observable on the transformed scale, finite; of a curve at its L levels.
    nuisance : (n, m) float64
        Parameters of earlier stages in units of their standard deviation, zero at their chosen
        value; m may be 0.
    """

    x: Array
    y: Array
    nuisance: Array


@dataclass(frozen=True)
class Quality:
    """How well a surrogate predicts runs that it has not seen (leave-one-out).

    Attributes
    ----------
    q2 : float
        1 for a perfect prediction, 0 for one no better than the mean.
    z_rms : float
        1 when the predicted error bars are right.
    inflation : float
        max(1, z_rms^2) n / (n - fitted), with 1 + 2 d numbers fitted to the same points and taken
        as known by smt (trend and correlation lengths); multiplies the predicted variance.
    noise_sd : float
        Scatter of one run on the transformed scale.
    points, runs : int
        Distinct points and runs behind the surrogate.
    kind : str
        Kind of Kriging that predicts best.
    observed, predicted, predicted_sd : (n,) float64
        Left-out values, their predictions and error bars, on the transformed scale.
    """

    q2: float
    z_rms: float
    inflation: float
    noise_sd: float
    points: int
    runs: int
    kind: str
    observed: Array = field(repr=False)
    predicted: Array = field(repr=False)
    predicted_sd: Array = field(repr=False)
