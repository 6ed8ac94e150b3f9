"""From the words of a script to a region."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownWordError, suggest
from minidem.insertion.region.region import DEFAULT_SEED, Motion, OncePerStep, Region
from minidem.insertion.region.shapes import READERS, Frame, Shape
from minidem.insertion.region.table import Part
from minidem.insertion.region.tets import read_tets
from minidem.insertion.seeds import ParkMiller, read_seed
from minidem.kernels.columns import LOWER, UPPER, X
from minidem.kernels.insertion.shapes import (
    BLOCK,
    CONE,
    CYLINDER,
    INTERSECT,
    PLANE,
    PRISM,
    SPHERE,
    TETS,
    UNION,
    WEDGE,
)
from minidem.record import field, record
from minidem.words import Words

__all__ = ["STYLES", "Site", "make_region"]

_KINDS = {
    "block": BLOCK, "cylinder": CYLINDER, "sphere": SPHERE, "cone": CONE, "prism": PRISM,
    "plane": PLANE, "wedge": WEDGE, "mesh/tet": TETS, "union": UNION, "intersect": INTERSECT,
}  # fmt: skip
STYLES = tuple(_KINDS)
"""Region styles that are understood."""
_OPTIONS = ("units", "side", "seed", "volume_limit", "move", "rotate")
_MOST_PARTS = 1000
Floats = NDArray[np.float64]


def _no_value(name: str) -> float:
    msg = f"region: there is no variable '{name[:40]}'"
    raise InputError(msg)


@record(frozen=True)
class Site:
    """What the words of a region may refer to.

    Attributes
    ----------
    known : mapping
        Regions defined before, for union and intersect.
    box : (2, 3) ndarray or None
        Simulation box; None before it exists, then ``INF`` and ``EDGE`` are errors.
    spacing : ndarray, shape (3,)
        Box units per lattice unit, m.
    value : callable
        Gives the value of an equal-style variable now.
    step : callable
        Gives the present step.
    style : callable
        Gives the style of a variable, None if there is none.
    path : callable
        Gives the full path of a file of the case.
    """

    known: Mapping[str, Region]
    box: Floats | None
    spacing: Floats = field(default_factory=lambda: np.ones(3))
    value: Callable[[str], float] = _no_value
    step: Callable[[], int] = lambda: 0
    style: Callable[[str], str | None] = lambda name: None
    path: Callable[[str], Path] = Path


def make_region(words: Sequence[str], site: Site) -> Region:
    """Make a region from the words of a script.

    Parameters
    ----------
    words : sequence of str
        Style and what follows it: ``block 0 1 0 1 0 INF units box side in``.
    site : Site
        What they may refer to.

    Returns
    -------
    Region

    Raises
    ------
    InputError
        With the word and what was expected.
    """
    source = Words(words, "region")
    style = source.take("a region style")
    if style not in _KINDS:
        msg = f"unknown region style '{style[:40]}'{suggest(style[:80], STYLES)}"
        raise UnknownWordError(msg)
    scaled = ("units", "lattice") in pairwise(words)
    scale = site.spacing if scaled else np.ones(3)
    if style == "mesh/tet":
        return _meshed(source, site, scaled=scaled)
    if style in READERS:
        shape = READERS[style](source, Frame(site.box, scale, site.value))
        parts: tuple[Region, ...] = ()
    else:
        shape = Shape((), None)
        parts = _parts(source, site.known)
    options = _Options(source, site, scale, shape.radius)
    if parts and options.motion is not None:
        msg = "region union or intersect cannot move; move the regions that it is made of"
        raise InputError(msg)
    extent = _joint_extent(style, parts) if parts else shape.extent
    return Region(
        Part(_KINDS[style], options.interior, shape.numbers, tuple(p.part for p in parts)),
        extent if options.interior else None,
        ParkMiller(options.seed),
        parts,
        options.motion,
    )


def _meshed(source: Words, site: Site, *, scaled: bool) -> Region:
    """Make a region of the tetrahedra of a file."""
    if scaled:
        msg = "region mesh/tet: lattice units are not possible; use 'units box'"
        raise InputError(msg)
    tets = read_tets(source, site.box, site.path)
    options = _Options(source, site, np.ones(3), "")
    nodes = tets.nodes
    extent = np.array([nodes.min(axis=(0, 1)), nodes.max(axis=(0, 1))])
    return Region(
        Part(TETS, options.interior, tets=tets),
        extent if options.interior else None,
        ParkMiller(options.seed),
        motion=options.motion,
        volume=tets.volume,
    )


def _parts(source: Words, known: Mapping[str, Region]) -> tuple[Region, ...]:
    count = source.integer()
    if not 2 <= count <= _MOST_PARTS:
        msg = f"region union and intersect need at least 2 regions, got {count}"
        raise InputError(msg)
    parts = []
    for _ in range(count):
        name = source.take("the name of a region")
        if name not in known:
            msg = f"unknown region '{name[:40]}'{suggest(name[:80], known)}"
            raise InputError(msg)
        parts.append(known[name])
    return tuple(parts)


class _Options:
    """What may follow a shape.

    Parameters
    ----------
    source : Words
        At the first option.
    site : Site
        What they may refer to.
    scale : ndarray, shape (3,)
        Box units per unit of the numbers, m.
    radius : str
        Variable that gives the radius of the shape; empty for none.
    """

    def __init__(self, source: Words, site: Site, scale: Floats, radius: str) -> None:
        self.interior, self.seed = True, DEFAULT_SEED
        shift: tuple[str | None, ...] = (None, None, None)
        angle, turn = "", (np.zeros(3), np.zeros(3))
        while not source.done():
            word = source.choice(_OPTIONS)
            if word == "units":
                source.choice(("box", "lattice"), "units")
            elif word == "side":
                self.interior = source.choice(("in", "out"), "side") == "in"
            elif word == "seed":
                self.seed = read_seed(source.take("a seed"))
            elif word == "volume_limit":
                source.positive()
            elif word == "move":
                shift = tuple(_variable(source) for _ in range(3))
            else:
                angle = source.variable()
                turn = scale * np.array(source.numbers(3)), _direction(source)
        value = OncePerStep(site.value, site.step)
        motion = Motion(value, shift, angle, *turn, radius, float(scale[X]))
        for name in (*shift, angle, radius):
            if name and site.style(name) is None:
                msg = f"region: there is no variable '{name[:40]}'; define it before the region"
                raise InputError(msg)
            if name and site.style(name) in ("atom", "atomfile"):
                msg = f"region: the variable '{name[:40]}' must be of style equal"
                raise InputError(msg)
        self.motion = motion if motion.moves() else None


def _variable(source: Words) -> str | None:
    """Read ``v_NAME`` or NULL."""
    if source.peek() == "NULL":
        source.take("NULL")
        return None
    return source.variable()


def _direction(source: Words) -> Floats:
    """Read the direction of an axis."""
    x, y, z = source.numbers(3)
    size = float(np.sqrt(x * x + y * y + z * z))
    if not 0.0 < size < np.inf:
        msg = f"region rotate: the axis {x:g} {y:g} {z:g} has no direction"
        raise InputError(msg)
    return np.array([x / size, y / size, z / size])


def _joint_extent(style: str, parts: Sequence[Region]) -> Floats | None:
    """Return the bounding box of a union or intersection."""
    boxes = [part.extent for part in parts if part.extent is not None]
    if style == "union":
        if len(boxes) < len(parts):
            return None
        return np.array([np.min(boxes, axis=0)[LOWER], np.max(boxes, axis=0)[UPPER]])
    if not boxes:
        return None
    return np.array([np.max(boxes, axis=0)[LOWER], np.min(boxes, axis=0)[UPPER]])
