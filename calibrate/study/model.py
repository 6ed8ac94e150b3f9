"""The study: what was measured where, what is free, in which stages.

A study is one TOML file beside its measured data (CSV). Everything in it is checked before the
first run: keys, types, names and limits of single values in `schema`, what belongs together in
`checks`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PrivateAttr, ValidationInfo, model_validator

from calibrate.study.places import Layout, Place
from calibrate.study.schema.materials import Material, Surface
from calibrate.study.schema.parameters import Parameter
from calibrate.study.schema.settings import Apparatus, Design, Known, Likelihood, Run, Shared
from calibrate.study.schema.stages import Stage
from calibrate.study.schema.targets import Target, experiments_in, own_in
from calibrate.study.schema.words import Name, Table, Words, also_named
from liggghts_io import OwnExperiment
from liggghts_io.experiments import EXPERIMENTS, Experiment

__all__ = ["KnownByName", "Study", "places_of"]


def _listed(given: Any) -> Any:
    if not isinstance(given, dict):
        return given
    return {name: one if isinstance(one, list) else [one] for name, one in given.items()}


KnownByName = Annotated[dict[str, list[Known]], BeforeValidator(_listed)]


def places_of(targets: Iterable[Target]) -> tuple[Place, ...]:
    """Return where targets were measured, each place once."""
    return tuple(dict.fromkeys(Place(t.material, t.surface, t.experiment) for t in targets))


class Study(Table):
    """A calibration study as read from its file; tables that repeat have their plural here.

    Attributes
    ----------
    name, title : str
        Short name, and words for a reader; without them the name.
    run : Run
    design : Design
    likelihood : Likelihood
    materials : list of Material
    surfaces : list of Surface
    rigs : list of Apparatus
        What the file says under ``[[experiment]]``.
    targets : list of Target
    shared : list of Shared
    parameters : dict of str to Parameter
    known : dict of str to list of Known
        Independent measurements, by parameter or effect.
    effects : dict of str to float
        Model extensions that are switched on, with their strength.
    stages : list of Stage
        In the order in which they run.
    """

    name: Name
    title: Words
    run: Run = Run()
    design: Design = Design()
    likelihood: Likelihood = Likelihood()
    materials: Annotated[list[Material], Field(alias="material", min_length=1)]
    surfaces: Annotated[list[Surface], Field(alias="surface", min_length=1)]
    rigs: Annotated[list[Apparatus], Field(alias="experiment", default_factory=list)]
    targets: Annotated[list[Target], Field(alias="target", min_length=1)]
    shared: list[Shared] = Field(default_factory=list)
    parameters: Annotated[dict[str, Parameter], Field(alias="parameter", default_factory=dict)]
    known: KnownByName = Field(default_factory=dict)
    effects: dict[str, float] = Field(default_factory=dict)
    stages: Annotated[list[Stage], Field(alias="stage", default_factory=list)]
    _experiments: Mapping[str, Experiment] = PrivateAttr(default=EXPERIMENTS)
    _own: Mapping[str, OwnExperiment] = PrivateAttr(default_factory=dict)

    @model_validator(mode="before")
    @classmethod
    def _titled(cls, data: Any) -> Any:
        return also_named(data, "title", "name")

    @model_validator(mode="after")
    def _known_experiments(self, info: ValidationInfo) -> Study:
        self._experiments, self._own = experiments_in(info), own_in(info)
        return self

    @property
    def experiments(self) -> Mapping[str, Experiment]:
        """Experiments by name: those of the program, and the study's own."""
        return self._experiments

    @property
    def own(self) -> Mapping[str, OwnExperiment]:
        """The study's own experiments by name, with all that their folders hold."""
        return self._own

    @property
    def layout(self) -> Layout:
        """What is measured where, as far as parameters depend on it."""
        scopes = {name: one.scope for name, one in self.parameters.items() if one.scope}
        kinds = {surface.name: surface.kind for surface in self.surfaces}
        return Layout(self.places, kinds, self.experiments, scopes, frozenset(self.parameters))

    @property
    def places(self) -> tuple[Place, ...]:
        """Material, surface and experiment of every target, each once."""
        return places_of(self.targets)

    @property
    def numbers(self) -> list[Target]:
        """Targets that are numbers."""
        return [target for target in self.targets if not target.is_curve]

    @property
    def curves(self) -> list[Target]:
        """Targets that are curves."""
        return [target for target in self.targets if target.is_curve]

    def target_named(self, name: str) -> Target:
        """Return the target called `name`; `name` is one that the study was checked for."""
        return next(t for t in self.targets if t.name == name)

    def material_named(self, name: str) -> Material:
        """Return the material called `name`, as `target_named`."""
        return next(m for m in self.materials if m.name == name)

    def surface_named(self, name: str) -> Surface:
        """Return the surface called `name`, as `target_named`."""
        return next(s for s in self.surfaces if s.name == name)

    def instances(self, name: str) -> tuple[str, ...]:
        """Return the instances of a parameter, such as "HSP13/steel", in the order of targets."""
        return self.layout.instances(name)

    def label(self, name: str, instance: str) -> str:
        """Return a parameter's instance in words; its name alone where there is only one."""
        return name if len(self.instances(name)) < 2 else f"{name} {instance}"

    def overrides(self, experiment: str) -> dict[str, float]:
        """Return what the study changes in the apparatus of an experiment."""
        found = {rig.name: rig.apparatus for rig in self.rigs}
        return dict(found.get(experiment, {}))

    def value_of(self, name: str, material: str, surface: str, experiment: str) -> float | None:
        """Return the value of a parameter at a place as the study gives it.

        What is not said has the default of its experiment, an effect is off, and a contact
        parameter has none.

        Parameters
        ----------
        name : str
            Parameter or effect.
        material, surface, experiment : str
            The place.

        Raises
        ------
        CalibrationError
            For an unknown parameter.
        """
        layout, place = self.layout, Place(material, surface, experiment)
        instance = layout.instance(name, place)
        given = self.parameters[name].value if name in self.parameters else {}
        if instance is not None and (instance in given or "" in given):
            return given.get(instance, given.get(""))
        role = layout.role(name)
        if role == "effect":
            return self.effects.get(name, 0.0)
        if role == "material":
            number = getattr(self.material_named(material), name)
            return None if number is None else float(number)
        if role == "apparatus" and layout.has(experiment, name):
            bare = name.rpartition(".")[2]
            apparatus = self.experiments[experiment].apparatus
            return apparatus(self.run.scale, self.overrides(experiment))[bare]
        return None

    def range_of(
        self, name: str, instance: str, stage: Stage | None = None
    ) -> tuple[float, float] | None:
        """Return the range of an instance, of a stage where that has one; None if it is fixed."""
        if stage is not None and name in stage.range:
            return stage.range[name]
        given = self.parameters[name].range if name in self.parameters else {}
        return given.get(instance, given.get(""))

    def published_of(self, name: str, instance: str) -> float | None:
        """Return the published value of an instance, None where there is none."""
        given = self.parameters[name].published if name in self.parameters else {}
        return given.get(instance, given.get(""))

    def known_of(self, name: str, place: Place) -> Known | None:
        """Return the independent measurement of a parameter or effect at a place."""
        for one in self.known.get(name, []):
            asked = zip((one.material, one.surface, one.experiment), place, strict=True)
            if all(wanted is None or wanted == here for wanted, here in asked):
                return one
        return None

    @property
    def free(self) -> tuple[tuple[str, str], ...]:
        """Name and instance of everything that has a range, for a joint calibration."""
        return tuple(
            (name, instance)
            for name, one in self.parameters.items()
            if one.range
            for instance in self.instances(name)
            if self.range_of(name, instance) is not None
        )

    def ties(self, name: str) -> tuple[tuple[str, ...], ...]:
        """Return the groups of instances that a tie holds together."""
        tie = self.parameters[name].tie if name in self.parameters else None
        return self.layout.ties(name, tie) if tie else ()

    def freed(self, stage: Stage) -> dict[str, str]:
        """Return the instance that a stage frees of each of its parameters."""
        layout = self.layout
        here = [self.target_named(name) for name in stage.targets]
        return {
            name: next(
                one for p in places_of(here) if (one := layout.instance(name, p)) is not None
            )
            for name in stage.free
        }
