"""What a laboratory may get wrong that no candidate of the diagnosis describes.

Each kind changes the case of a run. Who fits cannot import this module (import-linter holds it).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from liggghts_io import CaseSpec

__all__ = ["FOREIGN", "Foreign"]

BOX_1_FAR: Final = 0.0565
BOX_2_NEAR: Final = 0.0585
"""Where the wall between the first two boxes stands [m]."""
Change: TypeAlias = Callable[[CaseSpec, float], CaseSpec]
"""Case and strength to the case as it was."""


@dataclass(frozen=True)
class Foreign:
    """A kind of mistake that is in no library.

    Attributes
    ----------
    name, meaning : str
    experiments : tuple of str
        Where it acts.
    low, high : float
        Strengths that are drawn.
    change : callable
    """

    name: str
    meaning: str
    experiments: tuple[str, ...]
    low: float
    high: float
    change: Change

    def acting(self, spec: CaseSpec, strength: float) -> CaseSpec:
        """Return the case of a run as it really was."""
        return self.change(spec, strength) if spec.experiment in self.experiments else spec


def _apparatus(name: str) -> Change:
    """Return what sets a number of an apparatus."""

    def change(spec: CaseSpec, strength: float) -> CaseSpec:
        return replace(spec, apparatus={**spec.apparatus, name: strength})

    return change


def _moved_divider(spec: CaseSpec, strength: float) -> CaseSpec:
    """Move the wall between the first two boxes, farther from the pipe by `strength` [m]."""
    sides = {"box_1_far_m": BOX_1_FAR + strength, "box_2_near_m": BOX_2_NEAR + strength}
    return replace(spec, apparatus={**spec.apparatus, **sides})


def _scaled_parameter(name: str) -> Change:
    """Return what scales a contact parameter in one experiment alone."""

    def change(spec: CaseSpec, strength: float) -> CaseSpec:
        if name not in spec.parameters:
            return spec
        value = spec.parameters[name] * strength
        return replace(spec, parameters={**spec.parameters, name: value})

    return change


def _denser(spec: CaseSpec, strength: float) -> CaseSpec:
    particle = replace(spec.particle, density=spec.particle.density * strength)
    return replace(spec, particle=particle)


def _larger(spec: CaseSpec, strength: float) -> CaseSpec:
    """Take grains of another sieve cut."""
    particle = spec.particle
    classes = tuple((strength * d, share) for d, share in particle.size_classes)
    larger = replace(particle, d32_m=strength * particle.d32_m, size_classes=classes)
    return replace(spec, particle=larger)


_CONVEYOR: Final = ("conveyor",)
_HEAP: Final = ("heap",)
_IMPACT: Final = ("plate_impact",)
_ALL: Final = ("heap", "conveyor", "plate_impact")

FOREIGN: Final = {
    one.name: one
    for one in (
        Foreign("box_width", "boxes are narrower than drawn [m]", _IMPACT, 0.033, 0.05,
                _apparatus("box_width_m")),
        Foreign("moved_divider", "a wall between boxes stands elsewhere [m]", _IMPACT, 0.003, 0.007,
                _moved_divider),
        Foreign("pipe_length", "grains fall through another pipe [m]", _IMPACT, 0.04, 0.07,
                _apparatus("pipe_length_m")),
        Foreign("short_plate", "the impact plate ends earlier [m]", _IMPACT, 0.003, 0.006,
                _apparatus("plate_down_m")),
        Foreign("rough_plate", "the impact plate is another one: its friction", _IMPACT, 0.3, 0.6,
                _scaled_parameter("mu_pw")),
        Foreign("elastic_plate", "the impact plate is another one: its restitution", _IMPACT, 0.5,
                0.8, _scaled_parameter("e_pw")),
        Foreign("sine_motion", "the drive has less of its second harmonic", _CONVEYOR, 0.0, 0.12,
                _apparatus("harmonic_2")),
        Foreign("late_harmonic", "the second harmonic comes late [deg]", _CONVEYOR, 120.0, 200.0,
                _apparatus("phase_2_deg")),
        Foreign("third_harmonic", "the drive has a third harmonic", _CONVEYOR, 0.08, 0.2,
                _apparatus("harmonic_3")),
        Foreign("worn_conveyor", "the conveyor's plate is worn: its friction", _CONVEYOR, 1.4, 2.0,
                _scaled_parameter("mu_pw")),
        Foreign("other_sieve_cut", "grains on the conveyor are of another sieve cut", _CONVEYOR,
                1.2, 1.4, _larger),
        Foreign("rough_walls", "side walls of the heap hold grains", _HEAP, 0.25, 0.8,
                _apparatus("mu_side")),
        Foreign("other_batch", "grains of the heap roll less easily", _HEAP, 1.5, 2.5,
                _scaled_parameter("mu_roll_pp")),
        Foreign("light_batch", "grains of another density", _ALL, 0.5, 0.8, _denser),
    )
}  # fmt: skip
"""By name."""
