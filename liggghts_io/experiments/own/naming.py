"""Names in a definition: that each means something, and the same everywhere."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.common import common_parameters
from liggghts_io.experiments.numbers import same
from liggghts_io.experiments.own.reading import Definition, Mistakes
from liggghts_io.experiments.own.record import OwnExperiment
from liggghts_io.materials import CONTACT_PARAMETERS
from liggghts_io.measure.arithmetic import evaluate
from liggghts_io.measure.extract.base import Options
from liggghts_io.scripts.plain import check_variable, variables_of
from liggghts_io.toml_lines import Key

COMMON: Final = (
    *common_parameters(),
    same(
        "skin_d",
        "d",
        "neighbour skin",
        0.15,
        (0.01, 5.0),
        source="ours",
    ),
    same(
        "frames",
        "-",
        "number of dumps over the run",
        40.0,
        (1.0, 1e4),
        whole=True,
        source="ours",
    ),
)
"""Parameters that every template has; a definition may give them other values."""

PARTICLE_NAMES: Final[dict[str, Callable[[Mapping[str, Any]], float]]] = {
    "d32_m": lambda variables: float(variables["d32_m"]),
    "radius_m": lambda variables: 0.5 * float(variables["d32_m"]),
    "density": lambda variables: float(variables["density"]),
    "youngs_modulus": lambda variables: float(variables["youngs_modulus"]),
    "poisson_ratio": lambda variables: float(variables["poisson_ratio"]),
    "dt": lambda variables: float(variables["dt"]),
}
"""Numbers of the grains, and the time step that follows from them, that a plain script may take."""

NUMBERS: Final = (
    *CONTACT_PARAMETERS, "density", "youngs_modulus", "poisson_ratio", "cohesion_pp",
    "cohesion_pw", "restitution_exponent", "restitution_scatter",
    "tangential_stiffness", "air_drag", "skin", "d32_m",
)  # fmt: skip
"""Numbers among the variables of every template."""
RESERVED: Final = frozenset(
    {
        *NUMBERS, "sizes", "cohesive", "static_friction", "extensions", "gravity", "seed", "dt",
        "restitution_speed", "weakening_speed", "mu_static_pp", "mu_static_pw", "air_density",
        "air_viscosity", "about_grains",
    }
)  # fmt: skip
"""Variables of every template, which no parameter may be named after."""


def script_names(found: Definition) -> dict[str, str]:
    """Return what a plain script calls each parameter and each contact parameter that acts."""
    head = found.head
    contact = dict.fromkeys(word for kind in head.acting.values() for word in kind)
    names = {word: head.variables.get(word, word) for word in contact}
    return names | {name: one.variable or name for name, one in found.parameters.items()}


def check_names(own: OwnExperiment, found: Definition, mistakes: Mistakes) -> None:
    """Note names that mean nothing, or two things."""
    for word, names in (
        ("observable", [one.name for one, _ in found.observables]),
        ("curve", [one.name for one, _ in found.curves]),
        ("effect", [one.name for one in found.effects]),
        ("mesh", [one.file for one in found.meshes]),
    ):
        _once(names, word, mistakes)
    curves = [one.name for one, _ in found.curves]
    for k, (one, _) in enumerate(found.observables):
        if one.part_of and one.part_of not in curves:
            hint = nearest(one.part_of, curves) if curves else "; there is no [[curve]]"
            mistakes.add(("observable", k, "part_of"), f"unknown curve {one.part_of!r}{hint}")
    for name in found.parameters:
        if not name.isidentifier() or name in RESERVED:
            msg = f"{name!r} is a name that scripts use for something else; choose another"
            mistakes.add(("parameters", name), msg)
    _check_formulas(own, found, mistakes)
    if own.template:
        _check_template(found, mistakes)
    else:
        _check_plain(own, found, mistakes)


def _once(names: Iterable[str], word: str, mistakes: Mistakes) -> None:
    counts = Counter(names)
    for k, name in enumerate(names):
        if counts[name] > 1:
            mistakes.add((word, k), f"{name!r} stands in {counts[name]} [[{word}]]; keep one")


def _check_formulas(own: OwnExperiment, found: Definition, mistakes: Mistakes) -> None:
    """Try the formulas with a value of 1 for every name."""
    common = [one.name for one in COMMON] if own.template else []
    names = dict.fromkeys(["d32_m", *common, *found.parameters], 1.0)
    asked: list[tuple[str, list[Options]]] = [
        ("observable", [one for _, one in found.observables]),
        ("curve", [one for _, one in found.curves]),
    ]
    places: list[tuple[Key, str]] = [
        ((word, k), text)
        for word, extractors in asked
        for k, one in enumerate(extractors)
        for text in one.formulas()
    ]
    window = found.head.picture.window or ()
    places += [(("picture",), one) for one in window if isinstance(one, str)]
    for key, text in places:
        try:
            evaluate(text, names)
        except CaseError as err:
            if "unknown name" in str(err) or "has no value; write" in str(err):
                mistakes.add(key, str(err))


def _check_template(found: Definition, mistakes: Mistakes) -> None:
    plain = [("seeds",)] * bool(found.head.seeds) + [("variables",)] * bool(found.head.variables)
    for key in plain:
        mistakes.add(key, f"{key[0]} is for ordinary scripts; a template names what it uses itself")
    known = list(dict.fromkeys([*NUMBERS, *(one.name for one in COMMON), *found.parameters]))
    for name, one in found.parameters.items():
        if one.variable is not None:
            msg = f"variable = {one.variable!r} is for ordinary scripts; use {name} in the template"
            mistakes.add(("parameters", name, "variable"), msg)
    _check_effects(found, known, mistakes)


def _check_plain(own: OwnExperiment, found: Definition, mistakes: Mistakes) -> None:
    lines = variables_of(own.script)
    known = [*CONTACT_PARAMETERS, *PARTICLE_NAMES]
    for word in found.head.variables:
        if word not in known:
            mistakes.add(("variables", word), f"unknown quantity {word!r}{nearest(word, known)}")
    wanted: list[tuple[Key, str]] = [
        *((_key_of(name, found), script) for name, script in script_names(found).items()),
        *((("variables", w), v) for w, v in found.head.variables.items() if w in PARTICLE_NAMES),
        *((("seeds",), name) for name in found.head.seeds),
    ]
    for key, name in wanted:
        try:
            check_variable(lines, name)
        except CaseError as err:
            mistakes.add(key, str(err))
    twice = Counter(name for _, name in wanted)
    for key, name in wanted:
        if twice[name] > 1:
            mistakes.add(key, f"variable {name!r} of the script is given {twice[name]} values")
    numbers = [name for name, line in lines.items() if line.value is not None]
    _check_effects(found, [*script_names(found), *numbers], mistakes)
    for k, effect in enumerate(found.effects):
        if effect.variable in RESERVED - set(script_names(found)):
            msg = f"{effect.variable!r} has a meaning of its own; rename it in the script"
            mistakes.add(("effect", k, "variable"), msg)


def _key_of(name: str, found: Definition) -> Key:
    if name in found.parameters:
        return ("parameters", name)
    return ("variables", name) if name in found.head.variables else ("contact",)


def _check_effects(found: Definition, known: list[str], mistakes: Mistakes) -> None:
    for k, effect in enumerate(found.effects):
        if effect.name in found.parameters:
            msg = f"{effect.name!r} is a parameter, too; a study names both, choose another name"
            mistakes.add(("effect", k, "name"), msg)
        if effect.variable not in known:
            hint = nearest(effect.variable, known)
            msg = f"variable = {effect.variable!r}: the script takes no such number{hint}"
            mistakes.add(("effect", k, "variable"), msg)
