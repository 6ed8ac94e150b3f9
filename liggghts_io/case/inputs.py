"""The spec of a case: what is to be run, checked and with all defaults filled in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from liggghts_io.effects import Effect, effect_named, effects_in
from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments import (
    Experiment,
    OwnExperiment,
    Setup,
    experiment_named,
    own_experiment,
)
from liggghts_io.materials import CONTACT_PARAMETERS, ONE, Particle, check_contact, kind_of

LARGEST_SEED: Final = 2**31 - 1


@dataclass(frozen=True)
class CaseSpec:
    """Everything that determines a run.

    Attributes
    ----------
    experiment : str
        Name in the registry of experiments, "heap" for example, or that of `own`.
    particle : Particle
        The grains with all their numbers, so that a case needs no table to be run again.
    surface : str
        "flat" or "glued"; "steel" and "alumina" are flat. Only the kind matters for a run.
    scale : str
        "quick", "lab" or "paper".
    parameters : Mapping[str, float]
        mu_pp, mu_roll_pp, mu_pw, mu_roll_pw, e_pp, e_pw; a glued surface needs no wall value and
        ignores those given.
    apparatus : Mapping[str, float]
        Overrides of documented apparatus parameters.
    effects : Mapping[str, float]
        Strength by effect; zero strengths are dropped, so that strength 0 is the base model.
    seed : int
    engine : str
        "minidem" or "liggghts".
    own : OwnExperiment, optional
        A user's own experiment, with all that its folder holds.
    """

    experiment: str
    particle: Particle
    surface: str
    scale: str
    parameters: Mapping[str, float]
    apparatus: Mapping[str, float] = field(default_factory=dict)
    effects: Mapping[str, float] = field(default_factory=dict)
    seed: int = 1
    engine: str = "minidem"
    own: OwnExperiment | None = None

    @property
    def kind(self) -> str:
        """Kind of the wall under test.

        Raises
        ------
        CaseError
            For an unknown surface.
        """
        return kind_of(self.surface)


def experiment_of(spec: CaseSpec) -> Experiment:
    """Return the experiment of a case, the user's own where it has one.

    Raises
    ------
    CaseError
        For an unknown name, or an own experiment with mistakes.
    """
    if spec.own is None:
        return experiment_named(spec.experiment)
    if spec.own.name != spec.experiment:
        msg = f"experiment = {spec.experiment!r}: the own experiment is named {spec.own.name!r}"
        raise CaseError(msg)
    return own_experiment(spec.own)


def contact_parameters(spec: CaseSpec) -> dict[str, float]:
    """Return the contact parameters the case depends on.

    Raises
    ------
    CaseError
        For an unknown or missing parameter, or a value LIGGGHTS would refuse.
    """
    for name in spec.parameters:
        if name not in CONTACT_PARAMETERS:
            hint = nearest(name, CONTACT_PARAMETERS)
            msg = f"parameters: unknown contact parameter {name!r}{hint}"
            raise CaseError(msg)
    needed = experiment_of(spec).acting(spec.kind)
    missing = [name for name in needed if name not in spec.parameters]
    if missing:
        msg = f"parameters: {', '.join(missing)} missing for the surface {spec.surface!r}"
        raise CaseError(msg)
    values = {name: float(spec.parameters[name]) for name in needed}
    for name, value in values.items():
        try:
            check_contact(name, value)
        except CaseError as err:
            msg = f"parameters: {err}"
            raise CaseError(msg) from err
    return values


def check_particle(
    particle: Particle, experiment: str, surface: str, effects: Mapping[str, float]
) -> None:
    """Refuse a particle of which a case of a registered experiment needs more than is known.

    Raises
    ------
    CaseError
        Naming what is missing and what needs it; also for an unknown experiment or effect.
    """
    _check_needs(particle, experiment_named(experiment), surface, effects)


def _check_needs(
    particle: Particle, experiment: Experiment, surface: str, effects: Mapping[str, float]
) -> None:
    place = f"the experiment {experiment.name} on {surface}"
    particle.need(experiment.needs(kind_of(surface)), place)
    known = effects_in(experiment)
    for name, strength in effects.items():
        if strength != 0.0 and name in known:
            known[name].check_grains(particle)


def setup_of(spec: CaseSpec) -> Setup:
    """Return the inputs of the experiment with all defaults filled in.

    Raises
    ------
    CaseError
        For anything in the spec that is unknown or out of range.
    """
    if not 1 <= spec.seed <= LARGEST_SEED:
        msg = f"seed = {spec.seed}: give a whole number from 1 to {LARGEST_SEED}"
        raise CaseError(msg)
    experiment, kind = experiment_of(spec), spec.kind
    active_effects(spec)
    _check_needs(spec.particle, experiment, spec.surface, spec.effects)
    return Setup(
        particle=_as_simulated(spec, experiment),
        kind=kind,
        contact=contact_parameters(spec),
        apparatus=experiment.apparatus(spec.scale, spec.apparatus),
        seed=spec.seed,
    )


def _as_simulated(spec: CaseSpec, experiment: Experiment) -> Particle:
    """Return the grains with their sizes decided, where the spec leaves that open."""
    if spec.particle.sizes:
        return spec.particle
    base = replace(spec.particle, sizes=spec.particle.base_sizes)
    if experiment.templated and not any(one.clash(base) for one in active_effects(spec)):
        return base
    return replace(base, sizes=ONE)


def active_effects(spec: CaseSpec) -> dict[Effect, float]:
    """Return the effects with a strength other than zero, in the order of the registry.

    Raises
    ------
    CaseError
        For an unknown effect, a strength outside its range, or an effect that cannot act in the
        experiment.
    """
    experiment = experiment_of(spec)
    acting = effects_in(experiment)
    for name, strength in spec.effects.items():
        effect = acting.get(name) or effect_named(name)
        effect.check(float(strength))
        if strength != 0.0 and name not in acting:
            where = ", ".join(effect.experiments) or "experiments with a template"
            msg = (
                f"effect {name} = {strength:g} cannot act in the experiment {experiment.name}; it "
                f"acts in {where}: leave it out or set it to 0"
            )
            raise CaseError(msg)
        if strength != 0.0 and not effect.acts_on(spec.kind):
            msg = (
                f"effect {name} = {strength:g} cannot act on the wall {spec.surface!r}; it acts on "
                f"{', '.join(effect.walls)} ones: leave it out or set it to 0"
            )
            raise CaseError(msg)
    return {
        effect: float(spec.effects[name])
        for name, effect in acting.items()
        if spec.effects.get(name, 0.0)
    }
