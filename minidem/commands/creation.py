"""``lattice`` and ``create_atoms``: particles at given or regular places."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.insertion.region import Region
from minidem.memory import check_room
from minidem.record import field, record
from minidem.run.engine import Engine
from minidem.words import Words, one_of
from minidem.world.lattice import STYLES, Lattice
from minidem.world.periodic import wrapped
from minidem.world.state import Bools, Box, Floats, Ints, NewRows
from minidem.world.world import World

__all__ = ["add_particles"]

_DENSITY = 1.0  # kg/m3 and diameter 1 m of a particle that was only created, as in LIGGGHTS
_RADIUS = 0.5
_EDGE = 1e-6  # of a periodic box, by which its faces are moved for lattices
_OPTIONS = ("basis", "remap", "all_in", "units")


@COMMANDS.register("lattice")
def _lattice(engine: Engine, words: Words) -> None:
    words.need(2, "lattice sc SCALE")
    style = words.choice((*STYLES, "none", "sq", "sq2", "hex"), "style")
    if style in ("sq", "sq2", "hex"):
        msg = "Lattice style incompatible with simulation dimension; use sc, bcc, fcc or hcp"
        raise InputError(msg)
    scale = words.positive()
    lattice = Lattice.none(scale)
    if style != "none":
        lattice.basis = np.array(STYLES[style]).reshape(-1, 3)
        if style == "hcp":
            lattice.vectors = np.diag([1.0, np.sqrt(3.0), np.sqrt(8.0 / 3.0)])
        _read_lattice(lattice, style, engine.world.materials.units, words)
    engine.world.lattice = lattice
    spacing = " ".join(f"{c:g}" for c in lattice.spacing)
    engine.world.log(f"Lattice spacing in x,y,z = {spacing}")


def _read_lattice(lattice: Lattice, style: str, units: str, words: Words) -> None:
    """Read the options of a lattice with points."""
    spacing: Floats | None = None
    own = ("a1", "a2", "a3", "basis") if style == "custom" else ()
    while not words.done():
        key = words.choice(("origin", "orient", "spacing", *own))
        if key == "origin":
            lattice.origin = _parts(words)
        elif key == "orient":
            axis = "xyz".index(words.choice(("x", "y", "z"), "axis"))
            lattice.orient[axis] = [words.integer() for _ in range(3)]
        elif key == "spacing":
            spacing = np.array([words.positive() for _ in range(3)])
        elif key == "basis":
            lattice.basis = np.concatenate([lattice.basis, [_parts(words)]])
        else:
            lattice.vectors[int(key[1]) - 1] = words.numbers(3)
    lattice.check()
    if units == "lj":
        a1, a2, a3 = lattice.vectors
        volume = float(a1 @ np.cross(a2, a3))
        lattice.scale = float((len(lattice.basis) / volume / lattice.scale) ** (1.0 / 3.0))
    if spacing is None:
        lattice.measure()
    else:
        lattice.spacing = spacing * lattice.scale


def _parts(words: Words) -> Floats:
    """Read three numbers from 0 to below 1."""
    found = np.array(words.numbers(3))
    if not ((found >= 0.0) & (found < 1.0)).all():
        msg = f"lattice: {' '.join(f'{c:g}' for c in found)} must be parts of a cell, 0 to below 1"
        raise InputError(msg)
    return found


@record
class _Creation:
    """What ``create_atoms`` was told.

    Attributes
    ----------
    kind : int
        Atom type, from 1.
    kinds : dict
        Types of points of the unit cell, by number from 0.
    remap : bool
        Whether a single particle is brought into a periodic box.
    scaled : bool
        Whether its place is given in lattice units.
    """

    kind: int
    kinds: dict[int, int] = field(default_factory=dict)
    remap: bool = False
    scaled: bool = False

    def read(self, world: World, style: str, words: Words) -> None:
        """Read the options."""
        while not words.done():
            key = words.choice(_OPTIONS)
            if key == "basis":
                which = words.integer()
                if not 1 <= which <= len(world.lattice.basis):
                    msg = f"create_atoms: the lattice has no basis atom {which}"
                    raise InputError(msg)
                self.kinds[which - 1] = _type(world, words.integer())
            elif key == "remap":
                self.remap = words.yes_no()
            elif key == "units":
                self.scaled = words.choice(("box", "lattice"), "units") == "lattice"
            else:
                msg = f"create_atoms {style} {key} is not supported; make the region smaller"
                raise InputError(msg)


@COMMANDS.register("create_atoms")
def _create_atoms(engine: Engine, words: Words) -> None:
    words.need(2, "create_atoms TYPE single X Y Z | region ID | box")
    world = engine.world
    box = world.need_box()
    made = _Creation(_type(world, words.integer()))
    style = words.choice(("single", "region", "box", "random"), "style")
    before = world.state.n
    if style == "single":
        place = np.array([words.numbers(3)])
        made.read(world, style, words)
        _single(world, box, made, place)
    elif style == "random":
        msg = (
            "create_atoms random is refused: LIGGGHTS 3.8.0 takes its number of particles for the "
            "seed; use insert/pack with particles_in_region"
        )
        raise InputError(msg)
    else:
        region = _region(world, words.take("a region")) if style == "region" else None
        made.read(world, style, words)
        _on_lattice(world, box, made, region)
    world.log(f"Created {world.state.n - before} atoms")


def _type(world: World, kind: int) -> int:
    """Return an atom type if there is one."""
    if not 1 <= kind <= world.types:
        msg = f"create_atoms: type {kind} is not between 1 and {world.types}"
        raise InputError(msg)
    return kind


def _region(world: World, name: str) -> Region:
    """Return a region of the script."""
    found: Region = world.regions[one_of(name, tuple(world.regions), "create_atoms region")]
    return found


def _single(world: World, box: Box, made: _Creation, place: Floats) -> None:
    """Create one particle if it lies in the box."""
    if made.scaled:
        place = place * world.lattice.spacing
    if made.remap:
        place, _ = wrapped(box, place)
    inside = (place >= box.lo).all(axis=1) & (place < box.hi).all(axis=1)
    add_particles(world, place[inside], np.full(int(inside.sum()), made.kind))


def _on_lattice(world: World, box: Box, made: _Creation, region: Region | None) -> None:
    """Create a particle at every point of the lattice in the box, or in a region of it."""
    lattice = world.lattice
    if not len(lattice.basis):
        msg = "Cannot create atoms with undefined lattice; give 'lattice sc SCALE' first"
        raise InputError(msg)
    kinds = np.array([made.kinds.get(m, made.kind) for m in range(len(lattice.basis))])
    shift = box.period() * _EDGE
    places, types = [np.zeros((0, 3))], [np.zeros(0, np.int64)]
    count = 0
    for points, which in lattice.points(box.lo, box.hi):
        above, below = points >= box.lo - shift, points < box.hi - 2.0 * shift
        chosen: Bools = np.asarray((above & below).all(axis=1))
        chosen = _matching(points, chosen, region)
        places.append(points[chosen])
        types.append(kinds[which[chosen]])
        count += len(places[-1])
        check_room(count, world.state.n, "create_atoms")
    add_particles(world, np.concatenate(places), np.concatenate(types))


def _matching(points: Floats, chosen: Bools, region: Region | None) -> Bools:
    """Return which of the chosen points are in a region."""
    if region is not None:
        chosen[chosen] = region.match(points[chosen])
    return chosen


def add_particles(
    world: World, position: Floats, kind: Ints, size: tuple[Floats, Floats] | None = None
) -> slice:
    """Add particles at rest; return their rows.

    Parameters
    ----------
    world : World
        Where.
    position : ndarray, shape (n, 3)
        m.
    kind : ndarray of int64, shape (n,)
        Atom types, from 1.
    size : tuple of ndarray, optional
        Radius, m, and density, kg/m3; without it diameter 1 m and density 1 kg/m3.
    """
    count = len(position)
    radius, density = size or (np.full(count, _RADIUS), np.full(count, _DENSITY))
    mass = 4.0 / 3.0 * np.pi * radius**3 * density
    zero: NDArray[np.float64] = np.zeros((count, 3))
    first = world.state.n
    world.state.add(NewRows(position, radius, density, mass, kind, zero, zero.copy()))
    return slice(first, first + count)
