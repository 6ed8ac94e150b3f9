"""Where something is measured, and which parameters act there, one value for which instance.

A parameter has one value per instance. Its scope says what an instance is: a material, a surface,
both together ("HSP13/steel"), an experiment, that with one material, or everything ("").
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final, Literal, NamedTuple, TypeAlias

from calibrate.errors import CalibrationError, suggest
from liggghts_io.bulk import Bulk
from liggghts_io.effects import EFFECTS, Effect, effect_in, own_effects
from liggghts_io.experiments import Experiment
from liggghts_io.materials import CONTACT_PARAMETERS, GLUED

__all__ = ["MATERIAL_NUMBERS", "Layout", "Place", "Role", "ScopeName"]

ScopeName: TypeAlias = Literal[
    "material", "surface", "material+surface", "apparatus", "material+apparatus", "global"
]
Role: TypeAlias = Literal["contact", "material", "effect", "apparatus"]
"""What a parameter is to a case: a contact parameter, a number of the grains, and so on."""

MATERIAL_NUMBERS: Final = tuple(
    name
    for name in Bulk.model_fields
    if name not in ("name", "sieve", "d10_um", "d50_um", "d90_um", "sizes", "quantiles_of",
                    "lognormal_classes")
)  # fmt: skip
"""Numbers of a material that may be a parameter of their own."""


_SCOPES: Final[Mapping[str, ScopeName]] = {
    "everywhere": "global", "funnel": "apparatus", "material": "material", "wall": "surface",
}  # fmt: skip
"""Scope that an effect declares to that of a parameter of a study."""


class Place(NamedTuple):
    """What is measured where.

    Attributes
    ----------
    material, surface, experiment : str
        Names in the study.
    """

    material: str
    surface: str
    experiment: str


@dataclass(frozen=True)
class Layout:
    """What a study measures where, as far as parameters depend on it.

    Attributes
    ----------
    places : tuple of Place
        Those of all targets, each once.
    kinds : mapping
        Surface to its kind.
    experiments : mapping
        By name, those of the program and of the study.
    scopes : mapping
        Parameter to the scope that the study gives it; the others follow from the name.
    parameters : frozenset of str
        Everything that is a parameter of the study.
    """

    places: tuple[Place, ...]
    kinds: Mapping[str, str]
    experiments: Mapping[str, Experiment]
    scopes: Mapping[str, ScopeName]
    parameters: frozenset[str] = frozenset()

    @cached_property
    def effects(self) -> dict[str, Effect]:
        """Effects that a study may name: the registered ones, those of its own experiments."""
        found = dict(EFFECTS)
        for one in self.experiments.values():
            found |= own_effects(one)
        return found

    def acting(self, place: Place) -> tuple[str, ...]:
        """Return the contact parameters that matter at a place."""
        return self.experiments[place.experiment].acting(self.kinds[place.surface])

    def role(self, name: str) -> Role:
        """Return what a parameter is.

        Raises
        ------
        CalibrationError
            For a name that nothing here knows, with the nearest one.
        """
        found = self._role(name)
        if found is None:
            known = [*CONTACT_PARAMETERS, *self.effects, *MATERIAL_NUMBERS, *self._apparatus]
            lists = "; 'bulkcal apparatus EXPERIMENT' lists those of apparatus"
            msg = f"unknown parameter '{name}'{suggest(name, known) or lists}"
            raise CalibrationError(msg)
        return found

    def knows(self, name: str) -> bool:
        """Whether there is a parameter of that name."""
        return self._role(name) is not None

    def _role(self, name: str) -> Role | None:
        if name in CONTACT_PARAMETERS:
            return "contact"
        if name in EFFECTS or any(
            name == effect.name for one in self.experiments.values() for effect in one.effects
        ):
            return "effect"
        if name in MATERIAL_NUMBERS:
            return "material"
        return "apparatus" if name in self._apparatus else None

    @cached_property
    def _apparatus(self) -> list[str]:
        """Return apparatus parameters as a study may call them, bare and with their experiment."""
        names = [
            (one.name, parameter.name)
            for one in self.experiments.values()
            for parameter in one.parameters
        ]
        return [*(bare for _, bare in names), *(f"{one}.{bare}" for one, bare in names)]

    def has(self, experiment: str, name: str) -> bool:
        """Whether an experiment has an apparatus parameter, bare or with its experiment's name."""
        before, dot, bare = name.rpartition(".")
        if dot and before != experiment:
            return False
        return any(one.name == bare for one in self.experiments[experiment].parameters)

    def acts(self, name: str, place: Place) -> bool:
        """Whether a parameter matters at a place."""
        role = self.role(name)
        if role == "contact":
            return name in self.acting(place)
        if role == "effect":
            effect = effect_in(self.experiments[place.experiment], name)
            if effect is None or not effect.acts_on(self.kinds[place.surface]):
                return False
            return effect.scope != "wall" or self._touches_wall(place)
        return role == "material" or self.has(place.experiment, name)

    def _touches_wall(self, place: Place) -> bool:
        """Whether grains touch a wall under test; own experiments may have none."""
        glued = self.kinds[place.surface] == GLUED
        return glued or any(name.endswith("_pw") for name in self.acting(place))

    def scope(self, name: str) -> ScopeName:
        """Return between what a parameter may differ."""
        if name in self.scopes:
            return self.scopes[name]
        role = self.role(name)
        if role == "contact":
            return "material" if name.endswith("_pp") else "material+surface"
        if role == "material":
            return "material"
        if role == "effect":
            return _SCOPES[(EFFECTS.get(name) or self.effects[name]).scope]
        owners = {place.experiment for place in self.places if self.has(place.experiment, name)}
        return "global" if len(owners) > 1 else "apparatus"

    def instance(self, name: str, place: Place) -> str | None:
        """Return the instance of a parameter at a place; None where it does not matter."""
        if not self.acts(name, place):
            return None
        return {
            "material": place.material,
            "surface": place.surface,
            "material+surface": f"{place.material}/{place.surface}",
            "apparatus": place.experiment,
            "material+apparatus": f"{place.material}/{place.experiment}",
            "global": "",
        }[self.scope(name)]

    def instances(self, name: str) -> tuple[str, ...]:
        """Return the instances of a parameter, in the order of the targets."""
        found = (self.instance(name, place) for place in self.places)
        return tuple(dict.fromkeys(one for one in found if one is not None))

    def site(self, name: str, place: Place) -> str | None:
        """Return where a place stands for a measurement of a parameter, or of a cause.

        A cause may act in one funnel (called by experiment and kind of wall), with one material or
        on one wall alone, whatever a study that frees it would say.

        Parameters
        ----------
        name : str
        place : Place

        Returns
        -------
        str or None
            None where it does not act; the instance where it is a parameter of the study.
        """
        effect = effect_in(self.experiments[place.experiment], name)
        if effect is None or name in self.parameters:
            return self.instance(name, place)
        if not self.acts(name, place):
            return None
        return {
            "everywhere": "",
            "funnel": f"{place.experiment}_{self.kinds[place.surface]}",
            "material": place.material,
            "wall": place.surface,
        }[effect.scope]

    def ties(self, name: str, tie: str) -> tuple[tuple[str, ...], ...]:
        """Return the groups of instances that a tie holds together, each of two or more.

        Parameters
        ----------
        name : str
        tie : {"material", "surface"}
            Between what the instances of a group differ; all else is the same in it.
        """
        groups: dict[str, list[str]] = {}
        for instance in self.instances(name):
            material, slash, surface = instance.partition("/")
            if slash:
                rest = surface if tie == "material" else material
            else:
                rest = "" if self.scope(name) == tie else instance
            groups.setdefault(rest, []).append(instance)
        return tuple(tuple(group) for group in groups.values() if len(group) > 1)
