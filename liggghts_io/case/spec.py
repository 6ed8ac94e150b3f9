"""What determines a run: the spec of a case, the script that follows from it, and its id."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from liggghts_io.case.mark import script_digest, with_mark
from liggghts_io.case.runner import ENGINES
from liggghts_io.case.sources import code_of
from liggghts_io.effects import EFFECTS, check_engine, effect_named
from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments import Build, Setup, experiment_named
from liggghts_io.files import canonical_json, sha256_bytes, sha256_text
from liggghts_io.materials import (
    CONTACT_PARAMETERS,
    GLUED,
    GLUED_PARAMETERS,
    SURFACES,
    Particle,
    check_contact,
    plain_particle,
)
from liggghts_io.scripts.filters import time_step
from liggghts_io.scripts.templating import render
from liggghts_io.stl import stl_text

FORMAT: Final = 2
"""Of what a case id is the hash of; raised when that changes its form."""

MOST_STEPS: Final = 1e9
MOST_GRAINS: Final = 1e8
"""More than a month on one core, and more memory than a large machine has."""
BYTES_PER_GRAIN: Final = 2000.0
"""What minidem keeps for one, neighbours and contacts included (docs/performance.md)."""
LARGEST_SEED: Final = 2**31 - 1


@dataclass(frozen=True)
class CaseSpec:
    """Everything that determines a run.

    Attributes
    ----------
    experiment : str
        Name in the registry of experiments, "heap" for example.
    particle : Particle
        The grains with all their numbers, so that a case needs no table to be run again.
    surface : str
        "steel", "alumina" or "glued".
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
    needed = GLUED_PARAMETERS if spec.surface == GLUED else CONTACT_PARAMETERS
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
    """Refuse a particle of which a case needs more than is known.

    Raises
    ------
    CaseError
        Naming what is missing and what needs it; also for an unknown experiment or effect.
    """
    place = f"the experiment {experiment} on {surface}"
    particle.need(experiment_named(experiment).needs(surface), place)
    for name, strength in effects.items():
        effect = effect_named(name)
        if strength != 0.0 and effect.acts_in(experiment):
            particle.need(effect.needs, f"the effect {name}")


def setup_of(spec: CaseSpec) -> Setup:
    """Return the inputs of the experiment with all defaults filled in.

    Raises
    ------
    CaseError
        For anything in the spec that is unknown or out of range.
    """
    if spec.surface not in SURFACES:
        msg = f"unknown surface {spec.surface!r}{nearest(spec.surface, SURFACES)}"
        raise CaseError(msg)
    if not 1 <= spec.seed <= LARGEST_SEED:
        msg = f"seed = {spec.seed}: give a whole number from 1 to {LARGEST_SEED}"
        raise CaseError(msg)
    check_particle(spec.particle, spec.experiment, spec.surface, spec.effects)
    return Setup(
        particle=spec.particle,
        surface=spec.surface,
        contact=contact_parameters(spec),
        apparatus=experiment_named(spec.experiment).apparatus(spec.scale, spec.apparatus),
        seed=spec.seed,
    )


def active_effects(spec: CaseSpec) -> dict[str, float]:
    """Return the effects with a strength other than zero, in the order of the registry.

    Raises
    ------
    CaseError
        For an unknown effect, a strength outside its range, or an effect that cannot act in the
        experiment.
    """
    for name, strength in spec.effects.items():
        effect = effect_named(name)
        effect.check(float(strength))
        if strength != 0.0 and not effect.acts_in(spec.experiment):
            msg = (
                f"effect {name} = {strength:g} cannot act in the experiment {spec.experiment}; it "
                f"acts in {', '.join(effect.experiments)}: leave it out or set it to 0"
            )
            raise CaseError(msg)
    return {name: float(spec.effects[name]) for name in EFFECTS if spec.effects.get(name, 0.0)}


def build_case(spec: CaseSpec) -> Build:
    """Return template variables with the effects applied, and the meshes."""
    setup = setup_of(spec)
    build = experiment_named(spec.experiment).build(setup)
    variables = dict(build.variables)
    effects = active_effects(spec)
    for name, strength in effects.items():
        changed = EFFECTS[name].apply(variables, strength, setup)
        if changed == variables:
            msg = (
                f"effect {name} = {strength:g} changes nothing in the experiment "
                f"{spec.experiment} on {spec.surface} at scale {spec.scale!r}; leave it out"
            )
            raise CaseError(msg)
        variables = changed
    words = [EFFECTS[name].extension for name in effects]
    variables["extensions"] = [word for word in words if word]
    variables["dt"] = time_step(
        variables["sizes"],
        variables["density"],
        variables["youngs_modulus"],
        variables["poisson_ratio"],
        variables["timestep_fraction"],
    )
    _check_size(variables["duration"] / variables["dt"], variables["grain_count"])
    return Build(variables, build.meshes)


def _check_size(steps: float, grains: float) -> None:
    """Refuse a run that no machine ends."""
    for what, value, limit, remedy in (
        ("time steps", steps, MOST_STEPS, "shorten the experiment or raise timestep_fraction"),
        ("grains", grains, MOST_GRAINS, "pour less, or check the size of the grains"),
    ):
        if not value <= limit:
            msg = f"a run of {value:.3g} {what}; at most {limit:.0e} are taken: {remedy}"
            raise CaseError(msg)


def script_of(spec: CaseSpec) -> str:
    """Return the text of the case's script."""
    return render(experiment_named(spec.experiment).template, build_case(spec).variables)


def plain_spec(spec: CaseSpec, setup: Setup) -> dict[str, Any]:
    """Return a spec as JSON holds it, with what does not matter left out."""
    if spec.engine not in ENGINES:
        msg = f"unknown engine {spec.engine!r}{nearest(spec.engine, ENGINES)}"
        raise CaseError(msg)
    effects = active_effects(spec)
    check_engine(effects, spec.engine, f"engine = {spec.engine!r}")
    return asdict(spec) | {
        "particle": plain_particle(spec.particle),
        "parameters": dict(setup.contact),
        "apparatus": {name: float(value) for name, value in sorted(spec.apparatus.items())},
        "effects": effects,
        "seed": int(spec.seed),
    }


@dataclass(frozen=True)
class Case:
    """A spec worked out: its id and the files that an engine needs.

    Attributes
    ----------
    identity : str
        Case id, 64 hexadecimal digits.
    inputs : Mapping[str, Any]
        What the id is the hash of.
    script : str
        With the completion mark.
    meshes : Mapping[str, bytes]
        STL files by name.
    """

    identity: str
    inputs: Mapping[str, Any]
    script: str
    meshes: Mapping[str, bytes]


def describe(spec: CaseSpec) -> Case:
    """Work out a spec: script, meshes and the id that covers them and the code.

    Raises
    ------
    CaseError
        If the spec cannot be turned into a script.
    """
    setup = setup_of(spec)
    plain = plain_spec(spec, setup)
    build = build_case(spec)
    script = render(experiment_named(spec.experiment).template, build.variables)
    meshes = {
        f"{name}.stl": stl_text(name, triangles).encode()
        for name, triangles in build.meshes.items()
    }
    inputs = {
        "format": FORMAT,
        "spec": plain,
        "resolved_apparatus": dict(setup.apparatus),
        "script": script_digest(script),
        "meshes": {name: sha256_bytes(content) for name, content in meshes.items()},
        "code": code_of(spec.engine, spec.experiment),
    }
    identity = identity_of(inputs)
    return Case(identity, inputs, with_mark(script, identity), meshes)


def identity_of(inputs: Mapping[str, Any]) -> str:
    """Sha256 of the canonical JSON of the inputs, 64 hexadecimal digits."""
    return sha256_text(canonical_json(inputs))


def case_id(spec: CaseSpec) -> str:
    """Return the id of a case, 64 hexadecimal digits.

    It covers the spec, what the script makes an engine do, the meshes, the code of the
    observables and the engine; comments in a script do not count.

    Raises
    ------
    CaseError
        As `describe`.
    """
    return describe(spec).identity
