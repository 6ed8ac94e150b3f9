"""``compute ID GROUP pair/gran/local`` and ``wall/gran/local``: what single contacts do."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import ClassVar, Final, Self

import numpy as np

from minidem.contact.actions import Actions, mesh_contacts, pair_contacts
from minidem.contact.history import BRIDGE, PULL, TORSION, YIELDING, history_slots, yielding
from minidem.errors import InputError
from minidem.fixes.wall import meshes_of_the_last_wall
from minidem.kernels.columns import (
    NORMAL,
    PARTICLE,
    POSITION,
    RADIUS,
    SLIDING_ONLY,
    TOUCHED,
    VELOCITY,
    WALL_TYPE,
)
from minidem.kernels.models import (
    PULL_OFF,
    SURFACE_ENERGY,
    THORNTON_NING,
)
from minidem.record import record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.compute import COMPUTES, Compute
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["PairContacts", "WallContacts"]

_WORDS: Final = (
    *("pos", "vel", "id", "force", "force_normal", "force_tangential", "torque", "torque_normal"),
    *("torque_tangential", "history", "contactArea", "delta", "contactPoint"),
)
_USUAL: Final = ("pos", "vel", "id", "force", "torque", "history", "contactArea")


Values = dict[str, Floats]


@record
class _Contacts(Compute):
    """Values per contact.

    Attributes
    ----------
    wanted : tuple of str
        Keywords in the order of LIGGGHTS.
    """

    wanted: tuple[str, ...] = _USUAL

    per_contact: ClassVar[bool] = True

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read the keywords."""
        given = []
        while not words.done():
            word = words.choice((*_WORDS, "verbose", "heatFlux", "ms_id"))
            if word in ("heatFlux", "ms_id"):
                msg = (
                    f"compute {head.style}: '{word}' belongs to heat or clumps, which minidem "
                    "lacks; without them LIGGGHTS 3.8.0 breaks off as well"
                )
                raise InputError(msg)
            given.append(word)
        return cls(*head, tuple(word for word in _WORDS if word in given) or _USUAL)

    def actions(self, world: World) -> Actions:
        """Return the contacts of the group."""
        raise NotImplementedError

    def others(self, world: World, found: Actions) -> Ints:
        """Return the types of what is touched, from 0."""
        raise NotImplementedError

    def radii(self, world: World, found: Actions) -> Floats:
        """Return effective radii, m."""
        raise NotImplementedError

    def ends(self, world: World, found: Actions) -> Values:
        """Return positions, velocities and ids of both sides, area, m2, and contact point, m."""
        raise NotImplementedError

    def local(self, world: World) -> Values:
        """Return the values by the names that LIGGGHTS gives them in VTK files."""
        found = self.actions(world)
        normal = found.arm / np.linalg.norm(found.arm, axis=1)[:, None]
        ends = self.ends(world, found)
        makers: dict[str, Callable[[], Values]] = {
            "pos": lambda: _some(ends, "pos1", "pos2"),
            "vel": lambda: _some(ends, "vel1", "vel2"),
            "id": lambda: _some(ends, "id1", "id2", "periodic"),
            "force": lambda: {"force": found.force},
            "force_normal": lambda: {"force_normal": _along(found.force, normal)},
            "force_tangential": lambda: {
                "force_tangential": found.force - _along(found.force, normal)
            },
            "torque": lambda: {"torque": found.torque},
            "torque_normal": lambda: {"torque_normal": _along(found.torque, normal)},
            "torque_tangential": lambda: {
                "torque_tangential": found.torque - _along(found.torque, normal)
            },
            "history": lambda: {
                "history": _history(
                    world, found, self.others(world, found), ends["delta"], self.radii(world, found)
                )
            },
            "contactArea": lambda: _some(ends, "contact_area"),
            "delta": lambda: _some(ends, "delta"),
            "contactPoint": lambda: _some(ends, "contact_point"),
        }
        return {name: value for word in self.wanted for name, value in makers[word]().items()}


@COMPUTES.register("pair/gran/local")
class PairContacts(_Contacts):
    """Contacts between particles of the group."""

    def actions(self, world: World) -> Actions:
        """Return the contacts of which both particles belong to the group."""
        found = pair_contacts(world)
        member = world.member(self.bit)
        return found.chosen(member[found.who[:, PARTICLE]] & member[found.who[:, TOUCHED]])

    def others(self, world: World, found: Actions) -> Ints:
        """Return the types of the second particles."""
        return world.state.kind[found.who[:, TOUCHED]].astype(np.int64)

    def radii(self, world: World, found: Actions) -> Floats:
        """Return effective radii, m."""
        r1, r2 = world.state.row[found.who.T, RADIUS]
        both: Floats = r1 * r2 / (r1 + r2)
        return both

    def ends(self, world: World, found: Actions) -> Values:
        """Return what belongs to the two particles."""
        row, ids = world.state.row, world.state.ids
        first, second = row[found.who[:, PARTICLE]], row[found.who[:, TOUCHED]]
        r1, r2 = first[:, RADIUS], second[:, RADIUS]
        r = np.linalg.norm(found.arm, axis=1)
        lens = (r - r1 - r2) * (r + r1 - r2) * (r - r1 + r2) * (r + r1 + r2)
        here = first[:, POSITION]
        there = here - found.arm
        return {
            "pos1": _wrapped(world, here),
            "pos2": _wrapped(world, second[:, POSITION]),
            "vel1": first[:, VELOCITY],
            "vel2": second[:, VELOCITY],
            "id1": ids[found.who[:, PARTICLE]].astype(np.float64),
            "id2": ids[found.who[:, TOUCHED]].astype(np.float64),
            "periodic": found.across.astype(np.float64),
            "contact_area": -pi / 4.0 * lens / (r * r),
            "delta": r1 + r2 - r,
            "contact_point": (here * r2[:, None] + there * r1[:, None]) / (r1 + r2)[:, None],
        }


@COMPUTES.register("wall/gran/local")
class WallContacts(_Contacts):
    """Contacts of particles of the group with the meshes of a wall."""

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read the keywords; there must be a wall of meshes."""
        if not meshes_of_the_last_wall(world):
            msg = f"compute {head.style} needs a fix wall/gran with meshes that comes before it"
            raise InputError(msg)
        return super().read(world, head, words)

    def actions(self, world: World) -> Actions:
        """Return the contacts with particles of the group."""
        found = mesh_contacts(world, meshes_of_the_last_wall(world))
        return found.chosen(world.member(self.bit)[found.who[:, PARTICLE]])

    def others(self, world: World, found: Actions) -> Ints:
        """Return the types of the meshes."""
        owner = world.meshes.table.owner[found.who[:, TOUCHED]]
        kinds: Ints = world.lists.walls.mesh[owner, WALL_TYPE]
        return kinds

    def radii(self, world: World, found: Actions) -> Floats:
        """Return the radii of the particles, m."""
        one: Floats = world.state.row[found.who[:, PARTICLE], RADIUS]
        return one

    def ends(self, world: World, found: Actions) -> Values:
        """Return what belongs to mesh and particle; id1 is the number of the mesh, from 0."""
        store = world.meshes
        row = world.state.row[found.who[:, PARTICLE]]
        names = [store.names[owner] for owner in store.table.owner[found.who[:, TOUCHED]]]
        meshes = meshes_of_the_last_wall(world)
        first = np.array([store.span(name)[0] for name in names], np.int64)
        r = np.linalg.norm(found.arm, axis=1)
        point = row[:, POSITION] - found.arm
        return {
            "pos1": point,
            "pos2": row[:, POSITION],
            "vel1": found.speed,
            "vel2": row[:, VELOCITY],
            "id1": np.array([meshes.index(name) for name in names], np.float64),
            "id2": (found.who[:, TOUCHED] - first).astype(np.float64),
            "periodic": world.state.ids[found.who[:, PARTICLE]].astype(np.float64),
            "contact_area": (row[:, RADIUS] ** 2 - r * r) * pi,
            "delta": row[:, RADIUS] - r,
            "contact_point": point,
        }


def _history(world: World, found: Actions, others: Ints, overlap: Floats, radius: Floats) -> Floats:
    """Return what contacts keep, in the order in which LIGGGHTS has it."""
    if world.pair.switches is None or world.law is None:
        return found.memory[:, :SLIDING_ONLY]
    row = world.state.kind[found.who[:, PARTICLE]] * world.types + others
    constant = {BRIDGE: 1.0, PULL: world.law[1][row, PULL_OFF], TORSION: 0.0}
    if world.pair.switches[NORMAL] == THORNTON_NING:
        numbers = yielding(found.memory, overlap, world.law[1][row, SURFACE_ENERGY], radius)
        constant |= dict(zip(YIELDING, numbers.T, strict=True))
    slots = history_slots(world.pair.switches)
    kept = np.empty((len(row), len(slots)))
    for slot, column in enumerate(slots):
        kept[:, slot] = constant[column] if column < 0 else found.memory[:, column]
    return kept


def _some(values: Values, *names: str) -> Values:
    return {name: values[name] for name in names}


def _along(vectors: Floats, normal: Floats) -> Floats:
    """Return the parts of vectors along normals."""
    size = (vectors * normal).sum(axis=1)
    found: Floats = normal * size[:, None]
    return found


def _wrapped(world: World, points: Floats) -> Floats:
    """Return points within the box."""
    box = world.need_box()
    period = box.period()
    turns = np.floor((points - box.lo) / np.where(period > 0.0, period, 1.0))
    found: Floats = points - np.where(period > 0.0, turns, 0.0) * period
    return found
