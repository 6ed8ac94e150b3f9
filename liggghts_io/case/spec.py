"""What determines a run: the spec of a case, the script that follows from it, and its id."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Final

from liggghts_io.case.inputs import (
    CaseSpec,
    active_effects,
    check_particle,
    experiment_of,
    setup_of,
)
from liggghts_io.case.mark import script_digest, with_mark
from liggghts_io.case.runner import ENGINES
from liggghts_io.case.sources import code_of
from liggghts_io.effects import check_engine
from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments import Build, Setup, plain_own
from liggghts_io.experiments.common import about_grains, as_simulated
from liggghts_io.files import canonical_json, sha256_bytes, sha256_text
from liggghts_io.materials import ONE, Particle, plain_particle
from liggghts_io.measure.schedule import load_of
from liggghts_io.scripts.filters import time_step
from liggghts_io.stl import stl_text

__all__ = [
    "BYTES_PER_GRAIN",
    "FORMAT",
    "Case",
    "CaseSpec",
    "build_case",
    "case_id",
    "check_particle",
    "describe",
    "experiment_of",
    "identity_of",
    "script_of",
    "setup_of",
]

FORMAT: Final = 3
"""Of what a case id is the hash of; raised when that changes its form."""

MOST_STEPS: Final = 1e9
MOST_GRAINS: Final = 1e8
"""More than a month on one core, and more memory than a large machine has."""
BYTES_PER_GRAIN: Final = 2000.0
"""What minidem keeps for one, neighbours and contacts included (docs/performance.md)."""


def build_case(spec: CaseSpec) -> Build:
    """Return template variables with the effects applied, and the meshes."""
    setup = setup_of(spec)
    experiment = experiment_of(spec)
    effects = active_effects(spec)
    for effect, strength in effects.items():
        if effect.prepare is not None:
            setup = effect.prepare(setup, strength)
    build = experiment.build(setup)
    if not experiment.templated:
        _check_plain(spec, setup.particle)
    variables = as_simulated(build.variables, setup)
    for effect, strength in effects.items():
        changed = effect.apply(variables, strength, setup)
        if changed == variables and effect.prepare is None and effect.read is None:
            msg = (
                f"effect {effect.name} = {strength:g} changes nothing in the experiment "
                f"{spec.experiment} on {spec.surface} at scale {spec.scale!r}; leave it out"
            )
            raise CaseError(msg)
        variables = changed
    words = [effect.extension for effect in effects]
    variables["extensions"] = [word for word in words if word]
    variables["about_grains"] = about_grains(variables["sizes"], spec.particle.coarse_graining)
    variables["dt"] = time_step(
        variables["sizes"],
        variables["density"],
        variables["youngs_modulus"],
        variables["poisson_ratio"],
        variables["timestep_fraction"],
    )
    if not experiment.definition_digest:
        _check_size(variables["duration"] / variables["dt"], variables["grain_count"])
    return Build(variables, build.meshes, build.stl)


def _check_plain(spec: CaseSpec, particle: Particle) -> None:
    """Refuse other grains in an ordinary script, which says itself how many it pours."""
    for what, value, plain in (
        ("sizes", particle.sizes, ONE), ("coarse_graining", particle.coarse_graining, 1.0),
    ):  # fmt: skip
        if value != plain:
            msg = (
                f"{what} = {value!r} of {particle.name!r} cannot act in the experiment "
                f"{spec.experiment}, an ordinary script with grains of its own; make it a "
                f"template, or take {what} = {plain!r}"
            )
            raise CaseError(msg)


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
    return _script(spec, build_case(spec))


def _script(spec: CaseSpec, build: Build) -> str:
    """Return the text of a script, that of a folder checked for its size."""
    experiment = experiment_of(spec)
    script = experiment.write(build.variables)
    if experiment.definition_digest:
        load = load_of(script)
        _check_size(load.steps, load.grains)
    return script


def plain_spec(spec: CaseSpec, setup: Setup) -> dict[str, Any]:
    """Return a spec as JSON holds it, with what does not matter left out."""
    if spec.engine not in ENGINES:
        msg = f"unknown engine {spec.engine!r}{nearest(spec.engine, ENGINES)}"
        raise CaseError(msg)
    effects = {effect.name: strength for effect, strength in active_effects(spec).items()}
    check_engine(effects, spec.engine, f"engine = {spec.engine!r}")
    return {one.name: getattr(spec, one.name) for one in fields(spec)} | {
        "particle": plain_particle(setup.particle),
        "surface": setup.kind,
        "parameters": dict(setup.contact),
        "apparatus": {name: float(value) for name, value in sorted(spec.apparatus.items())},
        "effects": effects,
        "seed": int(spec.seed),
        "own": None if spec.own is None else plain_own(spec.own),
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
    experiment = experiment_of(spec)
    script = _script(spec, build)
    meshes = {
        f"{name}.stl": stl_text(name, triangles).encode()
        for name, triangles in build.meshes.items()
    } | dict(build.stl)
    inputs = {
        "format": FORMAT,
        "spec": plain,
        "resolved_apparatus": dict(setup.apparatus),
        "script": script_digest(script),
        "meshes": {name: sha256_bytes(content) for name, content in meshes.items()},
        "code": code_of(spec.engine, experiment),
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
