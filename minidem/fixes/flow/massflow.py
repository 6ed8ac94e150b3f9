"""``fix ID GROUP massflow/mesh mesh MESH count once vec_side X Y Z ...``: counts particles.

The kernels note every passage in an event buffer; here they become counters and lines of a file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Final, Self, TextIO

import numpy as np

from minidem.errors import InputError
from minidem.files import writing
from minidem.fixes.mesh import known_mesh, planar
from minidem.fixes.move import unit
from minidem.kernels.columns import (
    EVENT_ID,
    EVENT_MASS,
    EVENT_RADIUS,
    EVENT_STATE,
    EVENT_STEP,
)
from minidem.record import field, record
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES, Fix, all_fixes
from minidem.world.state import Floats, Ints
from minidem.world.values.named import need_map
from minidem.world.world import World

__all__ = ["MassFlow", "flow_header", "flow_row"]

_KEYWORDS = (
    "mesh", "count", "vec_side", "point_at_outlet", "inside_out", "file", "append", "writeTime",
    "screen", "delete_atoms", "sum_property",
)  # fmt: skip
_KEPT: Final = ("mass", "number", "deleted_mass", "deleted_number", "rates", "base", "total")
_PARALLEL = 1e-6  # component of vec_side along the normal that is too small
_MARKER = "massflow_"  # f_massflow_ID is the marker of each particle at the counter ID


@FIXES.register("massflow/mesh")
@record
class MassFlow(Fix):
    """A counter of particles through a mesh.

    Attributes
    ----------
    mesh : str
        Mesh id.
    once : bool
        Count each particle at most once.
    side : ndarray, shape (3,)
        Side to which particles are counted.
    outlet : ndarray, shape (3,), or None
        A point on that side of a mesh that need not be plane, m.
    inside_out : bool
        Count to the other side of it.
    file : text file or None
        Gets a line for each passage.
    write_time : bool
        Whether the lines have the time.
    delete : bool
        Whether counted particles are taken out.
    mass, number, deleted_mass, deleted_number : float, int
        What has passed, and been taken out, so far; kg.
    doomed : list of int
        Ids of particles to be taken out when lists are made anew, in the order of passing.
    rates : tuple of float
        kg/s and 1/s between the last two steps at which the counter was asked.
    base : tuple
        Step, mass and number when the counter was asked last.
    summed : str
        A ``property/atom`` of one value per particle, empty for none.
    total : float
        Its sum over the particles that have passed.
    """

    mesh: str = ""
    once: bool = False
    side: Floats = field(default_factory=lambda: np.zeros(3))
    outlet: Floats | None = None
    inside_out: bool = False
    file: TextIO | None = None
    write_time: bool = False
    delete: bool = False
    mass: float = 0.0
    number: int = 0
    deleted_mass: float = 0.0
    deleted_number: int = 0
    doomed: list[int] = field(default_factory=list)
    rates: tuple[float, float] = (0.0, 0.0)
    base: tuple[int, float, int] = (0, 0.0, 0)
    summed: str = ""
    total: float = 0.0

    keywords: ClassVar[tuple[str, ...]] = _KEYWORDS

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> Self:
        """Read all keywords and refuse what LIGGGHTS refuses."""
        words.need(4, f"fix ID all {head.style} mesh MESH count once vec_side X Y Z")
        made = cls(*head)
        while not words.done():
            made.read_option(world, words.choice(cls.keywords), words)
        known_mesh(world, made.mesh)
        made.check_side(world)
        if made.delete and not made.once:
            msg = f"Fix massflow/mesh (id {head.name}): 'delete_atoms yes' requires 'count once'"
            raise InputError(msg)
        if made.file is not None:
            made.file.write(flow_header(write_time=made.write_time))
        return made

    def check_side(self, world: World) -> None:
        """Refuse a counter of which nobody knows to which side it counts."""
        name = f"Fix massflow/mesh (id {self.name})"
        if self.outlet is not None:
            if not self.once:
                msg = f"{name}: 'point_at_outlet' requires 'count once'"
                raise InputError(msg)
            return
        if self.inside_out:
            msg = f"{name}: 'inside_out' has no meaning without 'point_at_outlet X Y Z'"
            raise InputError(msg)
        if not self.side.any():
            msg = f"{name}: expecting 'vec_side X Y Z' or 'point_at_outlet X Y Z'"
            raise InputError(msg)
        if not planar(world, self.mesh):
            msg = (
                f"{name}: requires a planar face mass flow measurement, or 'point_at_outlet X Y Z'"
            )
            raise InputError(msg)
        lo, _ = world.meshes.span(self.mesh)
        if abs(float(world.meshes.table.normal[lo] @ self.side)) < _PARALLEL:
            msg = "need to change 'vec_side', it is currently in or too close to the mesh plane"
            raise InputError(msg)

    def check(self, world: World) -> None:
        """Refuse to take particles out where LIGGGHTS could not find them."""
        super().check(world)
        if self.delete:
            need_map(world, f"Fix massflow/mesh (id {self.name}): 'delete_atoms yes'", ("array",))

    def read_option(self, world: World, key: str, words: Words) -> None:
        """Read the value of one keyword."""
        if key == "mesh":
            self.mesh = words.take("a mesh")
        elif key == "count":
            self.once = words.choice(("once", "multiple"), key) == "once"
        elif key == "vec_side":
            words.need(3, "vec_side X Y Z")
            self.side = unit(words.numbers(3))
        elif key == "point_at_outlet":
            words.need(3, "point_at_outlet X Y Z")
            self.outlet = np.array(words.numbers(3))
        elif key == "inside_out":
            self.inside_out = True
        elif key in ("file", "append"):
            self.file = world.open_text(words.take("a file"), append=key == "append")
        elif key == "writeTime":
            self.write_time = True
        elif key == "delete_atoms":
            self.delete = words.yes_no()
        elif key == "screen":
            words.take("yes or no")
        else:
            self.summed = words.take("a property/atom")
            self._properties(world, np.zeros(0, np.int64))

    def _properties(self, world: World, ids: Ints) -> Floats:
        """Return the values of the property that is summed, one per id."""
        for fix in all_fixes(world):
            found = fix.property_of(ids, self.summed)
            if found is not None and found.shape[1] == 1:
                return found.ravel()
        msg = (
            f"massflow/mesh sum_property: no fix property/atom of kind scalar has the property "
            f"'{self.summed[:40]}'; define it before"
        )
        raise InputError(msg)

    def value(self, world: World, index: int) -> float:
        """Return mass, number, their rates since the last output, both deleted, a property."""
        before, mass, number = self.base
        if world.step != before:
            passed = (world.step - before) * world.dt
            self.rates = ((self.mass - mass) / passed, (self.number - number) / passed)
            self.base = (world.step, self.mass, self.number)
        values = [self.mass, self.number, *self.rates, self.deleted_mass, self.deleted_number]
        values += [self.total] if self.summed else []
        if not 1 <= index <= len(values):
            return super().value(world, index)
        return float(values[index - 1])

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return the marker of each particle: -1 unseen, 0 before, 1 behind, 2 counted for good."""
        if name != _MARKER + self.name or self.name not in world.flows:
            return None
        marker = world.state.marker[world.flows.index(self.name), : world.state.n]
        return np.asarray(marker, float)

    def meshes_used(self) -> tuple[str, ...]:
        """Return the mesh that particles pass."""
        return (self.mesh,)

    def state(self) -> dict[str, Any]:
        """Return the counters."""
        return {name: getattr(self, name) for name in _KEPT}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the counters."""
        for name in (name for name in _KEPT if name in saved):
            value = saved[name]
            setattr(self, name, tuple(value) if isinstance(value, list) else value)

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow the particles that are to be taken out."""
        self.doomed = [new[number] for number in self.doomed if number in new]

    def book(self, world: World, event: Sequence[float]) -> None:
        """Count one passage, a row of ``Flows.event``."""
        number = int(event[EVENT_ID])
        self.mass += event[EVENT_MASS]
        self.number += 1
        if self.summed:
            # it may have left the box since
            self.total += float(self._properties(world, np.array([number]))[0])
        if self.delete:
            self.doomed.append(number)
        if self.file is not None:
            time = event[EVENT_STEP] * world.dt if self.write_time else None
            values = (2.0 * event[EVENT_RADIUS], *event[EVENT_STATE])
            with writing(self.file.name):
                self.file.write(flow_row(number, time, values))


def flow_header(*, write_time: bool) -> str:
    """Return the first line of a file."""
    return "# ID" + (" time " if write_time else "") + " diameter x y z u v w  (ex ey ez, color)\n"


def flow_row(number: int, time: float | None, values: tuple[float, ...]) -> str:
    """Return one line: id, time if wanted, diameter, position, velocity."""
    shown = f"{number:d}" + ("" if time is None else f"  {time:4.4g} ")
    return shown + " " + " ".join(f"{v:4.4g}" for v in values) + "\n"
