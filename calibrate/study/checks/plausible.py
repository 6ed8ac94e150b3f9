"""Measured values against what the study says of the experiment: what cannot be, and what is odd.

A mistake is what no error of a laboratory explains: more mass than was poured, or a time at which
nothing flows any more. The rest is told as a doubt, since a wrong flow or poured mass is also what
a diagnosis looks for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from calibrate.study.measured.curves import MeasuredCurve
from calibrate.study.measured.scalars import Measured
from calibrate.study.mistakes import Mistakes
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.schema.targets import Target
from liggghts_io.materials import FLAT

__all__ = ["Values", "check_amounts", "guessed_walls", "implausible"]

_SIGMAS: Final = 3.0
"""Standard errors by which a measured value may be off."""
_SURELY_MORE: Final = 1.25
"""Times the poured mass that no scale and no spill explains."""
_MORE: Final = 1.02
"""Times the poured mass that two good scales may differ by."""
_LOST: Final = 0.8
"""Part of the poured mass that is found again at least, where all places were weighed."""
_EARLY: Final = 0.9
"""Part of the time in which the funnel pours a mass, before which it cannot lie on the scale."""
_SURELY_LATE: Final = 10.0
"""Times the longest run, and the time in which the funnel is empty: no mass arrives so late."""
_ANGLES: Final = (5.0, 60.0)
"""Angles of repose of dry grains lie well between these [deg]."""
_GRAMS: Final = 1e3
_IMPACT, _CONVEYOR, _HEAP = "plate_impact", "conveyor", "heap"


@dataclass(frozen=True)
class Values:
    """Measured values of a study, by target, in the units of the simulated ones.

    Attributes
    ----------
    scalars : mapping
    curves : mapping
    """

    scalars: Mapping[str, Measured]
    curves: Mapping[str, MeasuredCurve]


@dataclass(frozen=True)
class _Finding:
    """What is wrong or odd with the value of a target."""

    target: str
    words: str
    sure: bool


def check_amounts(study: Study, values: Values, mistakes: Mistakes) -> None:
    """Note measured values that are impossible for what was poured.

    Parameters
    ----------
    study : Study
        Free of other mistakes.
    values : Values
    mistakes : Mistakes
    """
    numbers = {target.name: number for number, target in enumerate(study.targets)}
    for one in _findings(study, values):
        if one.sure:
            mistakes.add(("target", numbers[one.target]), f"target '{one.target}': {one.words}")


def implausible(study: Study, values: Values) -> list[str]:
    """Say which measured values are odd, though not impossible.

    Parameters
    ----------
    study : Study
    values : Values
    """
    found = [
        _Finding(name, one.doubt, sure=False) for name, one in values.scalars.items() if one.doubt
    ]
    found += [one for one in _findings(study, values) if not one.sure]
    return [f"target '{one.target}': {one.words}" for one in found]


def guessed_walls(study: Study) -> list[str]:
    """Say which walls are taken for flat ones only because nothing says that they are glued."""
    names = ", ".join(f"'{one.name}'" for one in study.surfaces if one.is_guessed)
    if not names:
        return []
    return [
        f"surface {names}: taken for flat, without glued grains; say so with kind = 'flat', or add "
        "kind = 'glued' if grains are glued on"
    ]


def _findings(study: Study, values: Values) -> list[_Finding]:
    found = []
    for place in study.places:
        here = [one for one in study.targets
                if Place(one.material, one.surface, one.experiment) == place]  # fmt: skip
        if place.experiment == _IMPACT:
            found += _of_masses(study, place, here, values)
        elif place.experiment == _CONVEYOR:
            found += _of_times(study, place, here, values)
        elif place.experiment == _HEAP:
            found += _of_angles(here, values)
    return found


def _largest(study: Study, name: str, place: Place) -> float:
    """Return a number of a material or apparatus, the largest where it is free."""
    ends = [study.value_of(name, *place)]
    for key in (name, f"{place.experiment}.{name}"):
        instance = study.layout.instance(key, place) if key in study.parameters else None
        if instance is not None:
            ends += [study.value_of(key, *place), *(study.range_of(key, instance) or ())]
    return max(end for end in ends if end is not None)


def _of_masses(study: Study, place: Place, here: list[Target], values: Values) -> list[_Finding]:
    """Compare masses of a plate impact with the poured one."""
    poured = _largest(study, "impact_mass_g", place)
    found = []
    masses: dict[str, Measured] = {}
    names: dict[str, str] = {}
    for target in here:
        if target.is_curve:
            curve = values.curves[target.name]
            at = int(np.argmax(curve.values - _SIGMAS * curve.se))
            most = Measured(float(curve.values[at]), float(curve.se[at]))
        else:
            most = values.scalars[target.name]
            masses.setdefault(target.observable, most)
            names.setdefault(target.observable, target.name)
        found += _too_much(target.name, f"{most.value:.4g} g", most, poured)
    if not found and len(masses) > 1:
        total = Measured(
            sum(one.value for one in masses.values()),
            float(np.sqrt(sum(one.se**2 for one in masses.values()))),
        )
        words = f"{', '.join(masses)} are {total.value:.4g} g together"
        last = names[list(masses)[-1]]
        found += _too_much(last, words, total, poured)
        every = {one.name for one in study.experiments[_IMPACT].observables}
        if set(masses) == every and total.value + _SIGMAS * total.se < _LOST * poured:
            words += f", and {poured:.4g} g were poured (impact_mass_g): where is the rest?"
            found.append(_Finding(last, words, sure=False))
    return found


def _too_much(target: str, words: str, mass: Measured, poured: float) -> list[_Finding]:
    least = mass.value - _SIGMAS * mass.se
    if least <= _MORE * poured:
        return []
    words += f", but {poured:.4g} g were poured (impact_mass_g); check both and their units"
    return [_Finding(target, words, sure=least > _SURELY_MORE * poured)]


def _of_times(study: Study, place: Place, here: list[Target], values: Values) -> list[_Finding]:
    """Compare times of a conveyor with flow, poured mass and the longest run."""
    kind = study.surface_named(place.surface).kind
    flow_name = f"flow_{kind}_g_s"
    factor = study.overrides(_CONVEYOR).get("mass_flow_factor", 1.0)
    flow = _largest(study, flow_name, place) * factor
    poured = _GRAMS * _largest(study, "poured_mass_kg", place)
    duration = "duration_flat_s" if kind == FLAT else "duration_glued_s"
    longest = _largest(study, duration, place)
    found = []
    for target in here:
        if target.is_curve:
            curve = values.curves[target.name]
            times = [Measured(*pair) for pair in zip(curve.values.tolist(), curve.se.tolist(),
                                                     strict=True)]  # fmt: skip
            levels = curve.levels.tolist()
        else:
            times = [values.scalars[target.name]]
            levels = [_GRAMS * _largest(study, "target_mass_kg", place)]
        for mass, time in zip(levels, times, strict=True):
            words, sure = _odd_time(time, mass, poured, longest, (flow_name, flow))
            if words:
                words = f"{mass:.4g} g after {time.value:.4g} s: {words}"
                found.append(_Finding(target.name, words.format(duration=duration), sure=sure))
                break
    return found


def _odd_time(
    time: Measured, mass: float, poured: float, longest: float, flow: tuple[str, float]
) -> tuple[str, bool]:
    """Return what is odd with the time [s] until a mass [g] lies on the scale, and whether surely.

    Parameters
    ----------
    time : Measured
    mass, poured : float
        [g]
    longest : float
        Time that is simulated [s].
    flow : (str, float)
        Its name and value [g/s].
    """
    name, rate = flow
    if mass > _MORE * poured:
        return f"the funnel holds {poured:.4g} g (poured_mass_kg); take less, or correct it", True
    if time.value - _SIGMAS * time.se > _SURELY_LATE * max(longest, poured / rate):
        return (
            f"{poured:.4g} g leave the funnel within {poured / rate:.3g} s ({name} = {rate:.4g}), "
            f"and a run lasts {longest:.4g} s; check the unit"
        ), True
    if time.value + _SIGMAS * time.se < _EARLY * mass / rate:
        return (
            f"the funnel pours them in {mass / rate:.3g} s ({name} = {rate:.4g}), so they cannot "
            "lie on the scale before; check flow, mass and zero of the time"
        ), False
    if time.value > longest:
        return f"no run lasts longer than {longest:.4g} s; raise {{duration}}", False
    return "", False


def _of_angles(here: list[Target], values: Values) -> list[_Finding]:
    """Compare angles of repose with those that grains have."""
    low, high = _ANGLES
    return [
        _Finding(
            one.name,
            f"{angle:.3g} deg, and dry grains have {low:g} to {high:g} deg; check the unit",
            sure=False,
        )
        for one in here
        if not one.is_curve
        and one.simulated_unit == "deg"
        and not low <= (angle := values.scalars[one.name].value) <= high
    ]
