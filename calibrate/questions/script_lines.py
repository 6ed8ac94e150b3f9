"""Found numbers as lines of a LIGGGHTS script.

The numbers are plain data, so that a record on disk is enough: nobody needs the study, its runs or
its emulators to write the lines.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

from calibrate.errors import CalibrationError
from calibrate.study.model import Study
from calibrate.study.places import Place
from liggghts_io.sizes import coarse_restitution

__all__ = ["Script", "ScriptNumber", "script_from", "script_lines", "script_of"]

PAIR_PROPERTIES: Final = {
    "restitution": ("coefficientRestitution", "e_pp", "e_pw"),
    "sliding": ("coefficientFriction", "mu_pp", "mu_pw"),
    "rolling": ("coefficientRollingFriction", "mu_roll_pp", "mu_roll_pw"),
}
"""Fix id to the property of LIGGGHTS 3.8.0 and the parameters between grains and at a wall."""
COHESION: Final = ("cohesionEnergyDensity", "cohesion_J_m3", "wall_adhesion_J_m3")
"""The same for the cohesion model; without it there is no line."""
LEVEL: Final = 0.9
MODEL: Final = "hertz tangential history{} rolling_friction epsd2"
"""Contact model for which the numbers hold, as in the scripts of the experiments."""


@dataclass(frozen=True)
class ScriptNumber:
    """One number of a script and how it is known.

    Attributes
    ----------
    key : str
        Name of the unknown, or of the parameter that the study gives.
    value : float
    low, high : float or None
        90 % interval; None where there is none.
    known : {"given", "found", "not determined"}
    """

    key: str
    value: float
    low: float | None = None
    high: float | None = None
    known: str = "given"

    @property
    def words(self) -> str:
        """Say how it is known."""
        if self.known == "given":
            return f"{self.key}: given by the study"
        if self.known == "found":
            return f"{self.key}: {self.value:.4g} ({self.low:.4g} to {self.high:.4g})"
        return f"{self.key}: NOT DETERMINED by the data; the number is arbitrary within its range"


@dataclass(frozen=True)
class Script:
    """What a script needs to know of one material.

    Attributes
    ----------
    title, material : str
    surfaces : tuple of str
        Flat ones, in the order of their atom types, the first of which is 2.
    youngs_modulus, poisson_ratio : float
        [Pa] and [-], of grains and walls.
    numbers : mapping
        By parameter, with the surface behind a slash at a wall: ``mu_pp``, ``mu_pw/steel``.
    coarse_graining : float
        Of the grains with which they were found; the numbers are those of real grains.
    """

    title: str
    material: str
    surfaces: tuple[str, ...]
    youngs_modulus: float
    poisson_ratio: float
    numbers: Mapping[str, ScriptNumber]
    coarse_graining: float = 1.0

    def record(self) -> dict[str, Any]:
        """Return it as plain data; `script_from` undoes this."""
        return asdict(self)


def script_from(record: Mapping[str, Any]) -> Script:
    """Return what `Script.record` gave.

    Raises
    ------
    CalibrationError
        For anything else.
    """
    try:
        numbers = {name: ScriptNumber(**one) for name, one in record["numbers"].items()}
        return Script(**{**record, "surfaces": tuple(record["surfaces"]), "numbers": numbers})
    except (KeyError, TypeError, AttributeError) as err:
        msg = f"the record holds no numbers of a script ({err}); run 'bulkcal calibrate' again"
        raise CalibrationError(msg) from err


def script_of(
    study: Study, material: str, number_at: Callable[[str, Place], ScriptNumber | None]
) -> Script:
    """Return what a script needs to know of a material.

    Parameters
    ----------
    study : Study
    material : str
        Name of the material in the study.
    number_at : callable
        Parameter or effect and place to its number; None where the study has none.
    """
    places = [place for place in study.places if place.material == material]
    flat = [
        name
        for name in dict.fromkeys(place.surface for place in places)
        if study.surface_named(name).kind == "flat"
    ]
    numbers: dict[str, ScriptNumber | None] = {}
    for _, grains, wall in (*PAIR_PROPERTIES.values(), COHESION):
        numbers[grains] = _first(number_at, grains, places)
        for name in flat:
            here = [place for place in places if place.surface == name]
            numbers[f"{wall}/{name}"] = _first(number_at, wall, here)
    particle = study.material_named(material).bulk.particle
    return Script(
        title=study.title,
        material=material,
        surfaces=tuple(flat),
        youngs_modulus=particle.youngs_modulus,
        poisson_ratio=particle.poisson_ratio,
        numbers={name: one for name, one in numbers.items() if one is not None},
        coarse_graining=particle.coarse_graining,
    )


def _first(
    number_at: Callable[[str, Place], ScriptNumber | None], name: str, places: list[Place]
) -> ScriptNumber | None:
    """Return the number at the first place that has one."""
    return next((one for place in places if (one := number_at(name, place)) is not None), None)


def script_lines(script: Script) -> str:
    """Return the lines: material and contact properties of one material.

    Atom type 1 are the grains; every flat surface has the next type. What the data do not
    determine has a comment, since its number means nothing.
    """
    count = len(script.surfaces) + 1
    types = ", ".join(
        f"{k} = {name}" for k, name in enumerate((script.material, *script.surfaces), 1)
    )
    cohesive = any(name.partition("/")[0] in COHESION[1:] for name in script.numbers)
    lines = [
        f"# {script.title}: {script.material}; {LEVEL:.0%} intervals in brackets",
        f"# atom types: {types}",
        f"# pair_style gran model {MODEL.format(' cohesion sjkr' if cohesive else '')}",
        _per_type("youngs", "youngsModulus", script.youngs_modulus, count),
        _per_type("poisson", "poissonsRatio", script.poisson_ratio, count),
    ]
    for fix, names in PAIR_PROPERTIES.items():
        lines += _pair_lines(script, fix, names, None)
    if cohesive:
        lines += _pair_lines(script, "cohesion", COHESION, 0.0)
    lines += _coarse_lines(script)
    return "\n".join(lines) + "\n"


def _coarse_lines(script: Script) -> list[str]:
    """Return what has to be said where the grains were coarse."""
    factor, restitution = script.coarse_graining, script.numbers.get("e_pp")
    if factor == 1.0 or restitution is None:
        return []
    coarse = coarse_restitution(restitution.value, factor)
    return [
        f"# numbers are those of real grains, found with grains {factor:g} times as large; such",
        f"# grains take {coarse:.6g} between each other instead of {restitution.value:.6g}",
    ]


def _pair_lines(
    script: Script, fix: str, names: tuple[str, str, str], absent: float | None
) -> list[str]:
    """Return comments and the line of one property; `absent` stands for what the study lacks."""
    word, grains, wall = names
    keys = [grains, *(f"{wall}/{name}" for name in script.surfaces)]
    found = [script.numbers.get(key) for key in keys]
    lines = [f"# {one.words}" for one in found if one is not None]
    values = [absent if one is None else one.value for one in found]
    known = [value for value in values if value is not None]
    if len(known) < len(values):
        return [*lines, f"# {word}: the study gives no value; left out"]
    count = len(known)
    # Symmetric over types; walls do not touch each other, any number will do there.
    matrix = " ".join(f"{known[max(i, j)]:.6g}" for i in range(count) for j in range(count))
    return [*lines, f"fix {fix} all property/global {word} peratomtypepair {count} {matrix}"]


def _per_type(fix: str, word: str, value: float, count: int) -> str:
    """Return the line of a property that grains and walls share, as in the experiments."""
    numbers = " ".join([f"{value:.6g}"] * count)
    return f"fix {fix} all property/global {word} peratomtype {numbers}"
