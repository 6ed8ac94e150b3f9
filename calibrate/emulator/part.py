"""One output of an emulator: a number, or a curve by its components."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.checks import check_enough
from calibrate.emulator.components import Components, components_of
from calibrate.emulator.process import LeftOut, Process, Runs
from calibrate.emulator.training import train_process
from calibrate.emulator.types import Inputs, Output

__all__ = ["Part", "train_part"]


@dataclass(frozen=True)
class Part:
    """A trained output.

    Attributes
    ----------
    output : Output
    components : Components
        Of a curve; a number is its own single component.
    processes : tuple of Process
        One per component.
    inputs : Inputs
        n runs that gave a value.
    y : (n, L) float64
    """

    output: Output
    components: Components
    processes: tuple[Process, ...]
    inputs: Inputs
    y: Array

    @property
    def is_curve(self) -> bool:
        """Whether it has several columns."""
        return len(self.components.centre) > 1

    @property
    def noise(self) -> Array:
        """Variance of one run about the expected output, (L,)."""
        return np.asarray(self.components.basis**2 @ [one.form.noise for one in self.processes])

    @property
    def luck(self) -> Array:
        """Covariance of one run about the expected output, (L, L)."""
        basis = self.components.basis
        sizes = np.array([one.form.noise for one in self.processes])
        return np.asarray((basis * sizes) @ basis.T + np.diag(self.components.truncation))

    def predict(self, inputs: Inputs) -> tuple[Array, Array]:
        """Return mean (n, L) and factors (n, L, F) of the expected output at n inputs.

        The factors of a number are its standard error, (n, 1, 1).
        """
        return self.assembled(*self.scores(inputs))

    def scores(self, inputs: Inputs) -> tuple[Array, Array]:
        """Return mean and variance of every component at n inputs, (n, F) each."""
        each = [one.predict(inputs) for one in self.processes]
        return np.column_stack([m for m, _ in each]), np.column_stack([v for _, v in each])

    def assembled(self, mean: Array, variance: Array) -> tuple[Array, Array]:
        """Return what `predict` does from means and variances of the components."""
        basis = self.components.basis
        return mean @ basis.T + self.components.centre, np.sqrt(variance)[:, None, :] * basis

    @property
    def left_out(self) -> LeftOut:
        """Every run predicted from those at other points; arrays are (n, L)."""
        basis = self.components.basis
        left = [one.left_out for one in self.processes]

        def spread(per_process: list[Array]) -> Array:
            return np.asarray(np.column_stack(per_process) @ (basis**2).T)

        return LeftOut(
            self.y,
            np.column_stack([one.mean for one in left]) @ basis.T + self.components.centre,
            spread([one.variance for one in left]) + self.components.truncation,
            spread([one.noise for one in left]),
        )

    def reduction(self, candidates: Inputs, at: Inputs) -> list[tuple[Array, Array]]:
        """Return, per component, its share in each column's variance, (L,), and its fall."""
        squares = (self.components.basis**2).T
        return [
            (share, one.reduction(candidates, at))
            for share, one in zip(squares, self.processes, strict=True)
        ]

    def updated(self, inputs: Inputs, y: Array) -> Part:
        """Return the output with new runs, nan where they failed; hyperparameters held."""
        good = np.asarray(np.isfinite(y).all(axis=1))
        inputs, y = inputs.rows(good), y[good]
        together = _distinct(self.inputs.joined(inputs), np.vstack([self.y, y]))
        added = together[len(self.y) :]
        if not added.any():
            return self
        new, values = inputs.rows(added), y[added]
        scores = self.components.scores(values)
        believed = np.full(len(values), fill_value=True)
        processes = tuple(
            one.updated(Runs(new, values, believed))
            for one, values in zip(self.processes, scores.T, strict=True)
        )
        return Part(
            self.output,
            self.components,
            processes,
            self.inputs.joined(new),
            np.vstack([self.y, values]),
        )


def _distinct(inputs: Inputs, y: Array) -> Array:
    """Return which runs are no copy of an earlier one, (n,) bool.

    The same inputs with the same seed and the same outputs are one run that was counted twice; as
    repeats they would say that there is no noise.
    """
    rows = np.column_stack([inputs.u, inputs.strengths, inputs.seeds, y])
    _, first = np.unique(rows, axis=0, return_index=True)
    found = np.isnan(inputs.seeds)
    found[first] = True
    return found


def train_part(output: Output, inputs: Inputs, y: Array) -> Part:
    """Train an output on the runs that gave all of its columns.

    Parameters
    ----------
    output : Output
    inputs : Inputs
        n runs.
    y : (n, L) float64
        Its columns; a run with nan in one of them is left out.

    Raises
    ------
    CalibrationError
        When too few runs gave a value.
    """
    good = np.asarray(np.isfinite(y).all(axis=1))
    kept, values = inputs.rows(good), y[good]
    distinct = _distinct(kept, values)
    kept, values = kept.rows(distinct), values[distinct]
    check_enough(output.name, kept.u, len(y))
    components = components_of(values)
    scores = components.scores(values)
    processes = tuple(train_process(kept, one) for one in scores.T)
    return Part(output, components, processes, kept, values)
