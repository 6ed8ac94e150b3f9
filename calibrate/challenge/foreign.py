"""What a laboratory may get wrong that no candidate of the diagnosis describes.

Each kind changes the case of a run. Who fits cannot import this module (import-linter holds it).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

from liggghts_io import CaseSpec

__all__ = ["FOREIGN", "Foreign"]

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


def _scaled_apparatus(name: str, usual: float) -> Change:
    """Return what scales a number of an apparatus that is `usual` otherwise."""

    def change(spec: CaseSpec, strength: float) -> CaseSpec:
        value = spec.apparatus.get(name, usual) * strength
        return replace(spec, apparatus={**spec.apparatus, name: value})

    return change


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
        Foreign("box_width", "boxes are narrower or wider than drawn", _IMPACT, 0.6, 0.9,
                _scaled_apparatus("box_width_m", 0.06)),
        Foreign("rough_plate", "the impact plate is another one: its friction", _IMPACT, 0.4, 2.0,
                _scaled_parameter("mu_pw")),
        Foreign("worn_conveyor", "the conveyor's plate is worn: its friction", _CONVEYOR, 0.6, 1.6,
                _scaled_parameter("mu_pw")),
        Foreign("elastic_plate", "the impact plate is another one: its restitution", _IMPACT, 0.6,
                1.3, _scaled_parameter("e_pw")),
        Foreign("other_sieve_cut", "grains of the heap are of another sieve cut", _HEAP, 0.8, 1.25,
                _larger),
        Foreign("denser_batch", "grains of another density", _ALL, 0.5, 2.0, _denser),
        Foreign("rough_walls", "side walls of the heap hold grains", _HEAP, 1.2, 3.0,
                _scaled_apparatus("mu_side", 0.3)),
        Foreign("wide_pipe", "the pipe above the impact plate is another one", _IMPACT, 0.6, 1.5,
                _scaled_apparatus("pipe_radius_m", 0.008)),
    )
}  # fmt: skip
"""By name."""
