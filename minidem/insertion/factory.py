"""From the words of a script to an insertion command."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownNameError, suggest
from minidem.insertion import STYLES
from minidem.insertion.distribution import Distribution
from minidem.insertion.in_region import Pack, RateRegion
from minidem.insertion.inserter import Inserter
from minidem.insertion.region import Region
from minidem.insertion.seeds import MESH_SEED, ParkMiller
from minidem.insertion.settings import Settings, read_settings
from minidem.record import record
from minidem.words import Words

__all__ = ["Surroundings", "make_inserter"]

_TARGETS = ("volumefraction_region", "particles_in_region", "mass_in_region")
_BORDER = "check_dist_from_subdomain_border"


@record(frozen=True)
class Surroundings:
    """What an insertion command may refer to.

    Attributes
    ----------
    distributions : mapping
        Particle distributions by name of the fix.
    regions : mapping
        Regions by name.
    face : callable
        Triangles (n, 3, 3) of a mesh by name of the fix; UnknownNameError for an unknown one.
    step : int
        Present step.
    dt : float
        Time step, s.
    rim : callable
        Which edges (n, 3) of a planar mesh are not shared; None for a mesh that is not declared
        planar.
    random : callable
        Generator of a mesh.
    """

    distributions: Mapping[str, Distribution]
    regions: Mapping[str, Region]
    face: Callable[[str], NDArray[np.float64]]
    step: int
    dt: float
    rim: Callable[[str], NDArray[np.bool_] | None] = lambda mesh: None
    random: Callable[[str], ParkMiller] = lambda mesh: ParkMiller(MESH_SEED)


def make_inserter(name: str, style: str, words: Sequence[str], around: Surroundings) -> Inserter:
    """Make an insertion command.

    Parameters
    ----------
    name : str
        Name of the fix.
    style : str
        One of `STYLES`.
    words : sequence of str
        What follows the style.
    around : Surroundings
        What the words may refer to.

    Raises
    ------
    InputError
        With the word and what was expected.
    """
    source = Words(words, style)
    settings = read_settings(source, style, around.distributions, around.step, around.dt)
    if style == "insert/stream":
        return _stream(name, settings, source, around)
    if style not in STYLES:
        msg = f"unknown insertion style '{style[:40]}'{suggest(style[:80], STYLES)}"
        raise InputError(msg)
    return _in_region(name, style, settings, source, around)


def _in_region(
    name: str, style: str, settings: Settings, source: Words, around: Surroundings
) -> Inserter:
    region: Region | None = None
    tries, border, warn = 100_000, True, True
    targets: list[tuple[str, float]] = []
    keywords = ("region", "ntry_mc", _BORDER, "warn_region", *_TARGETS)
    while not source.done():
        word = source.choice(keywords)
        if word == "region":
            region = _region(source, around)
        elif word == "ntry_mc":
            tries = _tries(source, style)
        elif word == _BORDER:
            border = source.yes_no()
        elif word == "warn_region":
            warn = source.yes_no()
        else:
            targets.append((word, _target(word, source, style)))
    if region is None:
        msg = f"{style}: keyword 'region' is missing"
        raise InputError(msg)
    if style == "insert/rate/region":
        return RateRegion(name, settings, region, tries, border)
    if len(targets) != 1:
        msg = f"{style}: give exactly one of {', '.join(_TARGETS)}"
        raise InputError(msg)
    return Pack(name, settings, region, tries, border, target=targets[0], warn_region=warn)


def _target(word: str, source: Words, style: str) -> float:
    """Read how full the region shall be."""
    value = float(source.count()) if word == "particles_in_region" else source.number()
    if value <= 0.0:
        msg = f"{style}: {word} must be above zero, got {value:g}"
        raise InputError(msg)
    if word == "volumefraction_region" and value > 1.0:
        msg = f"{style}: a volume fraction of {value:g} is above one"
        raise InputError(msg)
    return value


def _region(source: Words, around: Surroundings) -> Region:
    name = source.take("the name of a region")
    if name not in around.regions:
        msg = f"unknown region '{name[:40]}'{suggest(name[:80], around.regions)}"
        raise InputError(msg)
    return around.regions[name]


def _tries(source: Words, style: str) -> int:
    tries = source.count()
    if not 1000 <= tries <= 1_000_000_000:
        msg = f"{style}: ntry_mc must be at least 1000, got {tries}"
        raise InputError(msg)
    return tries


def _stream(name: str, settings: Settings, source: Words, around: Surroundings) -> Inserter:
    style = "insert/stream"
    face: NDArray[np.float64] | None = None
    length, duration, tries, mesh = 0.0, 0, 100_000, ""
    keywords = ("insertion_face", "extrude_length", "duration", "duration_time", "parallel")
    while not source.done():
        word = source.choice((*keywords, "ntry_mc", "save_template"))
        if word == "insertion_face":
            mesh = source.take("the name of a mesh")
            try:
                face = around.face(mesh)
            except UnknownNameError as err:
                msg = f"{style}: unknown mesh '{mesh[:40]}'"
                raise InputError(msg) from err
        elif word == "extrude_length":
            length = source.positive()
        elif word in ("duration", "duration_time"):
            value = source.positive()
            duration = int(value if word == "duration" else value / around.dt)
        elif word == "ntry_mc":
            tries = _tries(source, style)
        else:
            source.yes_no()
    if face is None:
        msg = f"{style}: keyword 'insertion_face' is missing"
        raise InputError(msg)
    active = around.rim(mesh) if settings.all_in else None
    if settings.all_in and active is None:
        msg = f"{style}: using all_in yes requires you to use a fix mesh/surface/planar"
        raise InputError(msg)
    from minidem.insertion.stream import Stream  # few scripts have one
    from minidem.insertion.stream_face import make_face

    planar = make_face(face, active)
    return Stream(name, settings, planar, length, duration, tries, around.random(mesh))
