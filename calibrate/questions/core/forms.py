"""What is emulated: one form per experiment and kind of surface, its inputs and its outputs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.types import Output
from calibrate.errors import CalibrationError
from calibrate.inference.priors import Spacing, from_unit, to_unit
from calibrate.scales import Scale
from liggghts_io import CaseSpec

__all__ = ["PARTICLE_FIELDS", "Axis", "Emulated", "Form", "FormKey", "Switch", "value_in"]

PARTICLE_FIELDS: Final = {
    "d32_um": ("d32_m", 1e-6),
    "density_kg_m3": ("density", 1.0),
    "youngs_modulus_pa": ("youngs_modulus", 1.0),
    "poisson_ratio": ("poisson_ratio", 1.0),
    "flow_flat_g_s": ("flow_flat_kg_s", 1e-3),
    "flow_glued_g_s": ("flow_glued_kg_s", 1e-3),
    "impact_mass_g": ("impact_mass_kg", 1e-3),
    "coarse_graining": ("coarse_graining", 1.0),
}
"""Number of the grains as people give it: field of a particle, and its unit there."""

FormKey = tuple[str, str]
"""Experiment and kind of surface."""


@dataclass(frozen=True)
class Axis:
    """One input of an emulator.

    Attributes
    ----------
    name : str
        Contact parameter, apparatus parameter, or number of the material.
    low, high : float
        Values at 0 and 1.
    spacing : {"linear", "log"}
    """

    name: str
    low: float
    high: float
    spacing: Spacing = "linear"

    def unit(self, values: Array) -> Array:
        """Return values on [0, 1]."""
        return to_unit(values, self.low, self.high, self.spacing)

    def value(self, unit: Array) -> Array:
        """Undo `unit`."""
        return from_unit(unit, self.low, self.high, self.spacing)


@dataclass(frozen=True)
class Switch:
    """An effect whose strength is unknown.

    Attributes
    ----------
    name : str
    step : float
        Its ordinary strength, the unit in which emulators see it.
    low, high : float
        Limits of its strength.
    """

    name: str
    step: float
    low: float
    high: float

    def strength(self, part: float) -> float:
        """Return a strength from -1 (lower limit) to 1 (upper limit), 0 being off.

        Where no strength is below zero, -1 is half of the upper limit, and the other way round.
        """
        if part >= 0.0:
            return part * (self.high if self.high > 0.0 else 0.5 * self.low)
        return -part * (self.low if self.low < 0.0 else 0.5 * self.high)


@dataclass(frozen=True)
class Emulated:
    """One output: a number, or a curve at its levels.

    Attributes
    ----------
    name : str
        Observable or curve of the experiment.
    scale : Scale
        On which it is modelled.
    columns : slice
        Where it stands among the outputs of the form.
    levels : tuple of float
        Where a curve is read; empty for a number.
    """

    name: str
    scale: Scale
    columns: slice
    levels: tuple[float, ...] = ()

    @property
    def table_columns(self) -> list[str]:
        """Columns of a table of runs that hold it."""
        return [f"{self.name}@{level:g}" for level in self.levels] or [self.name]


@dataclass(frozen=True)
class Form:
    """What one emulator is of.

    Attributes
    ----------
    experiment, kind : str
        Experiment, and kind of its surface.
    axes : tuple of Axis
        Parameters that act there and differ or are unknown, then numbers of the material.
    switches : tuple of Switch
        Effects that act there and are unknown.
    outputs : tuple of Emulated
    """

    experiment: str
    kind: str
    axes: tuple[Axis, ...]
    switches: tuple[Switch, ...]
    outputs: tuple[Emulated, ...]

    @property
    def key(self) -> FormKey:
        """Experiment and kind, by which emulators are found."""
        return self.experiment, self.kind

    @property
    def width(self) -> int:
        """Number of columns of all outputs."""
        return self.outputs[-1].columns.stop if self.outputs else 0

    def output(self, name: str, scale: Scale, levels: tuple[float, ...] = ()) -> Emulated:
        """Return an output by name, scale and, for a curve, levels.

        A curve that was measured at the first of its levels alone is the first part of the output.

        Raises
        ------
        CalibrationError
            If it is not among the outputs.
        """
        alike = [one for one in self.outputs if (one.name, one.scale) == (name, scale)]
        for one in alike:
            if one.levels == levels:
                return one
        for one in alike:
            if levels and one.levels[: len(levels)] == levels:
                start = one.columns.start
                return replace(one, columns=slice(start, start + len(levels)), levels=levels)
        at = f" at {', '.join(f'{level:g}' for level in levels)}" if levels else ""
        msg = (
            f"{self.experiment} on a {self.kind} surface: nothing was learnt of {name}{at}; give "
            "runs of the study's own targets, at its own levels"
        )
        raise CalibrationError(msg)

    def emulator_outputs(self) -> list[Output]:
        """Return the outputs as the emulator takes them."""
        return [Output(one.name, one.columns) for one in self.outputs]

    def place_in(self, spec: CaseSpec) -> tuple[Array, Array]:
        """Return where a case lies: parameters on [0, 1] (d,) and strengths in steps (m,)."""
        u = [float(one.unit(np.array(value_in(spec, one.name)))) for one in self.axes]
        strengths = [spec.effects.get(one.name, 0.0) / one.step for one in self.switches]
        return np.array(u), np.array(strengths)


def value_in(spec: CaseSpec, name: str) -> float:
    """Return the value of a parameter or of a number of the material in a case; nan if it has none.

    Parameters
    ----------
    spec : CaseSpec
    name : str
        Contact parameter, apparatus parameter (with or without ``EXPERIMENT.``), or number of the
        grains as `Bulk` calls it.
    """
    if name in PARTICLE_FIELDS:
        field, unit = PARTICLE_FIELDS[name]
        number = getattr(spec.particle, field)
        return float("nan") if number is None else float(number) / unit
    here = {**spec.parameters, **spec.apparatus}
    return float(here.get(name, here.get(name.rpartition(".")[2], float("nan"))))
