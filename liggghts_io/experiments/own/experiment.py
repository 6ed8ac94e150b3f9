"""From the texts of an own experiment to an experiment like the built-in ones."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any, Final

from liggghts_io.experiments.base import Experiment, Write
from liggghts_io.experiments.common import common_variables
from liggghts_io.experiments.numbers import Adjustment, Curve, Observable, Parameter
from liggghts_io.experiments.own.definition import NEEDS, ParameterTable
from liggghts_io.experiments.own.effect_table import EffectTable
from liggghts_io.experiments.own.naming import (
    COMMON,
    PARTICLE_NAMES,
    check_names,
    script_names,
)
from liggghts_io.experiments.own.observing import charting, observing, view_of
from liggghts_io.experiments.own.reading import Definition, Mistakes, read_definition
from liggghts_io.experiments.own.record import DEFINITION, TEMPLATE, OwnExperiment
from liggghts_io.experiments.setup import Build, Setup
from liggghts_io.files import sha256_text
from liggghts_io.materials import CONTACT_PARAMETERS
from liggghts_io.scripts.filters import prime_seeds
from liggghts_io.scripts.forbidden import check_script
from liggghts_io.scripts.foreign import render_foreign
from liggghts_io.scripts.plain import rewritten, variables_of

_LEFT_OUT: Final = dict.fromkeys(
    CONTACT_PARAMETERS,
    f"'contact' in {DEFINITION} leaves it out; add it there, or set it before it is used",
)


@functools.lru_cache(maxsize=32)
def own_experiment(own: OwnExperiment) -> Experiment:
    """Return the experiment that a folder describes.

    Raises
    ------
    CaseError
        With every mistake in the definition.
    """
    script = TEMPLATE if own.template else f"{own.name}.in"
    return check_experiment(own, f"{own.name}/{DEFINITION}", f"{own.name}/{script}")


def check_experiment(own: OwnExperiment, place: str, script_place: str) -> Experiment:
    """Return the experiment that a folder describes, its mistakes told at a place.

    Parameters
    ----------
    own : OwnExperiment
    place, script_place : str
        Names of definition and script, for messages.

    Raises
    ------
    CaseError
        With every mistake, each with file and line.
    """
    found, mistakes = read_definition(own.definition, place)
    check_names(own, found, mistakes)
    mistakes.tell()
    if not own.template:
        check_script(own.script, script_place)
    parameters = _parameters(own, found, mistakes)
    mistakes.tell()
    return Experiment(
        name=own.name,
        title=found.head.title,
        caption=found.head.caption or found.head.title,
        parameters=parameters,
        observables=tuple(
            Observable(one.name, one.unit, one.meaning, one.low, one.high, one.part_of)
            for one, _ in found.observables
        ),
        build=_building(own, found),
        write=_writing(own, found, script_place),
        observe=observing(found),
        chart=charting(found),
        view=view_of(found),
        needs=lambda _kind: tuple(NEEDS[word] for word in found.head.needs),
        curves=_curves(found),
        contact=found.head.acting,
        effects=tuple(_adjustment(one) for one in found.effects),
        templated=own.template,
        definition_digest=sha256_text(own.definition),
    )


def _curves(found: Definition) -> tuple[Curve, ...]:
    return tuple(
        Curve(
            one.name, one.unit, one.meaning, one.x_name, one.x_unit, one.levels, f"{one.name}.csv",
            "x", "y", one.scale, one.low, one.high,
        )
        for one, _ in found.curves
    )  # fmt: skip


def _adjustment(one: EffectTable) -> Adjustment:
    return Adjustment(
        one.name, one.title, one.unit, one.meaning, one.settled_by, one.variable, one.how,
        one.step, *one.bounds, one.candidate, one.settled_se, one.settled_hours,
    )  # fmt: skip


def _parameters(own: OwnExperiment, found: Definition, mistakes: Mistakes) -> tuple[Parameter, ...]:
    """Return the parameters of the folder, and those that every template has."""
    lines = {} if own.template else variables_of(own.script)
    given = []
    for name, one in found.parameters.items():
        line = lines.get(one.variable or name)
        values = _values(one, line.value if line else None)
        if values is None:
            mistakes.add(("parameters", name), "no value; add default = ...")
            continue
        given.append(
            Parameter(name, one.unit, one.meaning, *values, one.limits, one.whole, one.source)
        )
    common = () if not own.template else COMMON
    return (*(one for one in common if one.name not in found.parameters), *given)


def _values(one: ParameterTable, written: float | None) -> tuple[float, float, float] | None:
    """Return the value at each scale, None where there is none."""
    if one.quick is not None and one.lab is not None and one.paper is not None:
        return one.quick, one.lab, one.paper
    value = written if one.default is None else one.default
    return None if value is None else (value, value, value)


def _building(own: OwnExperiment, found: Definition) -> Callable[[Setup], Build]:
    written = {} if own.template else _written(own, found)

    def build(setup: Setup) -> Build:
        given = {word: setup.contact.get(word, 0.0) for word in CONTACT_PARAMETERS}
        full = Setup(
            setup.particle, setup.kind, given, {**_defaults(), **setup.apparatus}, setup.seed
        )
        variables = common_variables(full)
        acting = {*setup.contact, *(CONTACT_PARAMETERS if setup.glued else ())}
        for word in CONTACT_PARAMETERS:
            if word not in acting:
                del variables[word]
        variables |= {"d32_m": setup.particle.d32_m, **written, **setup.apparatus}
        return Build(variables, {}, dict(own.meshes))

    return build


def _defaults() -> dict[str, float]:
    return {one.name: one.quick for one in COMMON}


def _written(own: OwnExperiment, found: Definition) -> dict[str, float]:
    """Return the numbers that a plain script holds itself and that effects change."""
    lines = variables_of(own.script)
    return {
        one.variable: value
        for one in found.effects
        if one.variable in lines and (value := lines[one.variable].value) is not None
    }


def _writing(own: OwnExperiment, found: Definition, place: str) -> Write:
    if own.template:

        def write_template(variables: Mapping[str, Any]) -> str:
            script = render_foreign(own.script, variables, place, _LEFT_OUT)
            check_script(script, f"{place}, as written")
            return script

        return write_template
    names = script_names(found)
    effects = {one.variable for one in found.effects} - set(found.parameters)

    def write_plain(variables: Mapping[str, Any]) -> str:
        values = {names[name]: float(variables[name]) for name in names if name in variables}
        for name, value_of in PARTICLE_NAMES.items():
            if name in found.head.variables:
                values[found.head.variables[name]] = value_of(variables)
        values |= {name: float(variables[name]) for name in effects if name not in names}
        seeds = prime_seeds(int(variables["seed"]), len(found.head.seeds))
        values |= dict(zip(found.head.seeds, map(float, seeds), strict=True))
        return rewritten(own.script, values)

    return write_plain
