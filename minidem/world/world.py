"""Everything a script has set up: one object that commands change and the run loop reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from minidem.contact.model import Materials
from minidem.errors import suggest
from minidem.world.fix import Fix
from minidem.world.lists import Lists
from minidem.world.mesh.store import MeshStore
from minidem.world.state import Box, Floats, State

__all__ = ["Neighbor", "PairStyle", "Thermo", "World"]


@dataclass
class Neighbor:
    """``neighbor`` and ``neigh_modify``.

    Attributes
    ----------
    skin : float
        m.
    delay, every : int
        Steps.
    check : bool
        Rebuild only if a particle moved half a skin.
    reach : float
        ``contact_distance_factor``.
    """

    skin: float = 0.001
    delay: int = 10
    every: int = 1
    check: bool = True
    reach: float = 1.0


@dataclass
class PairStyle:
    """``pair_style gran``: model switches, None before the command."""

    switches: list[int] | None = None


@dataclass
class Thermo:
    """``thermo``, ``thermo_style`` and ``thermo_modify``."""

    every: int = 0
    columns: tuple[str, ...] = ("step", "atoms", "ke", "vol")
    lost: str = "error"
    norm: bool = False
    modified: bool = False
    flush: bool = False


@dataclass
class World:
    """State of a script.

    Attributes
    ----------
    root : Path
        Folder that the script may read and write.
    state, box : State, Box or None
        Particles and box.
    types : int
        Number of atom types.
    step, dt : int, float
        Current step and time step, s.
    groups : dict
        Group name to bit.
    regions, fixes, computes, dumps : dict
        By id, in the order of the script.
    fresh : tuple of int
        Step of the last insertion, and the highest particle id before it.
    """

    root: Path
    state: State = field(default_factory=State)
    box: Box | None = None
    types: int = 0
    step: int = 0
    dt: float = 1e-3
    begin_step: int | None = None
    end_step: int | None = None
    boundary: tuple[str, ...] = ("pp", "pp", "pp")
    neighbor: Neighbor = field(default_factory=Neighbor)
    pair: PairStyle = field(default_factory=PairStyle)
    materials: Materials = field(default_factory=Materials)
    thermo: Thermo = field(default_factory=Thermo)
    meshes: MeshStore = field(default_factory=MeshStore)
    lists: Lists = field(default_factory=Lists)
    groups: dict[str, int] = field(default_factory=lambda: {"all": 1})
    regions: dict[str, Any] = field(default_factory=dict)
    fixes: dict[str, Fix] = field(default_factory=dict)
    computes: dict[str, Any] = field(default_factory=dict)
    dumps: dict[str, Any] = field(default_factory=dict)
    log: Callable[[str], None] = lambda text: None
    warn: Callable[[str], None] = lambda text: None
    interpreter: Any = None
    lists_valid: bool = False
    lost: int = 0
    fresh: tuple[int, int] = (-1, 0)
    restarts: tuple[int, str] | None = None

    def bit(self, group: str) -> int:
        """Return the bit of a group.

        Raises
        ------
        ValueError
            If there is no such group.
        """
        if group not in self.groups:
            msg = f"Could not find group '{group}'{suggest(group, self.groups)}"
            raise ValueError(msg)
        return self.groups[group]

    def group_bit(self, group: str) -> int:
        """Return the bit of a group, made if it is new."""
        if group not in self.groups:
            if len(self.groups) >= 30:
                msg = "Too many groups (limit 30)"
                raise ValueError(msg)
            self.groups[group] = 1 << len(self.groups)
        return self.groups[group]

    def need_box(self) -> Box:
        """Return the box.

        Raises
        ------
        ValueError
            Before ``create_box``.
        """
        if self.box is None:
            msg = "command before simulation box is defined; use create_box first"
            raise ValueError(msg)
        return self.box

    def of_kind(self, kind: type[Any]) -> list[Any]:
        """Return the fixes of a class in the order of the script."""
        return [fix for fix in self.fixes.values() if isinstance(fix, kind)]

    def member(self, bit: int) -> Floats:
        """Return which particles belong to a group, shape (n,) of bool."""
        found: Floats = (self.state.mask[: self.state.n] & bit) != 0
        return found

    def unwrapped(self) -> Floats:
        """Return positions without the wrapping of periodic directions, shape (n, 3), m."""
        length = self.need_box().period()[3:]
        found: Floats = (
            self.state.row[: self.state.n, :3] + self.state.image[: self.state.n] * length
        )
        return found

    def time(self) -> float:
        """Return the simulated time, s."""
        return self.step * self.dt

    def kinetic_energy(self) -> float:
        """Return the translational kinetic energy, J."""
        row = self.state.row[: self.state.n]
        return float(0.5 * np.sum(row[:, 7] * np.sum(row[:, 4:7] ** 2, axis=1)))
