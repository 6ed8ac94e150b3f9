"""Everything a script has set up: one object that commands change and the run loop reads."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from time import perf_counter
from typing import Any, TextIO, TypeVar

from minidem.errors import InputError, suggest
from minidem.files import open_text, writing
from minidem.kernels.columns import MASS, POSITION, VELOCITY
from minidem.kernels.tables import Control
from minidem.record import field, fields, record
from minidem.script.paths import CaseFolder, inside
from minidem.world.lattice import Lattice
from minidem.world.lists import Lists
from minidem.world.materials import Materials
from minidem.world.mesh.store import MeshStore
from minidem.world.roster import Roster
from minidem.world.settings import UNITS, Neighbor, PairStyle, Schedule, Sorting, Thermo
from minidem.world.state import Bools, Box, Floats, Ints, State

__all__ = ["Restored", "World"]

_MOST_GROUPS = 30  # bits of a group mask
_OF_THE_SCRIPT = ("root", "log", "warn", "interpreter")  # what ``clear`` leaves as it is

T = TypeVar("T")


@record
class Restored:
    """What a restart file still has for the script that goes on from it.

    Attributes
    ----------
    fixes : dict
        Id of a fix to its ``style`` and ``state``, see `minidem.world.fix.Fix.state`.
    rest : callable
        Does what is not done by fixes; told whether the first run begins, which comes last.
    """

    fixes: dict[str, dict[str, Any]]
    rest: Callable[[World, bool], None]


@record
class World:
    """State of a script.

    Attributes
    ----------
    root : CaseFolder
        Folder that the script may read and write.
    state, box : State, Box or None
        Particles and box.
    types : int
        Number of atom types.
    step, dt : int, float
        Current step and time step, s.
    clock : tuple of int and float
        A step and the simulated time at it, s; the time step has been the same since.
    begin_step, end_step : int or None
        First and last step of the run; None outside a run.
    set_up_at : int or None
        Step whose forces come from the set-up of a run, and so from the velocities at its end.
    seen : Seen or None
        What forces saw in the latest step that output looked at, see `minidem.world.values.seen`.
    series : tuple of (int, int) or None
        First and last step of the runs that the present one is part of, if ``run`` says so.
    boundary : tuple of str
        Two letters per direction, as in `Box`, for the box to come.
    neighbor, pair, thermo : Neighbor, PairStyle, Thermo
        What the commands of these names have set.
    materials : Materials
        Material properties.
    lattice : Lattice
        As the command ``lattice`` has set it.
    meshes : MeshStore
        Triangles.
    lists : Lists
        Neighbour lists.
    groups : dict
        Group name to bit.
    regions, fixes, computes, dumps : dict
        By id, in the order of the script; their base classes stand above the world.
    log, warn : callable
        Take a line for the log; a warning.
    interpreter : Interpreter or None
        Of the script; gives the values of variables.
    energies : set of str
        Fixes whose potential energy ``compute pe`` counts.
    lost : int
        Number of particles that have left the box.
    last_lost : tuple or None
        Step, id and position, m, of the particle that left last; None before.
    restart_turns : tuple or None
        When restart files are written in turns, and their names, that of the next file first.
    restarts : tuple or None
        When a restart file is written, and its name.
    granular : bool
        Whether an ``atom_style`` or a restart file has said so.
    hybrid : int
        How many styles of ``atom_style hybrid`` have radius and density; 0 for another style.
    atom_map : str
        ``array`` or ``hash`` if ``atom_modify map`` was given; else empty.
    sorting : Sorting
    newton, ghost_velocity : bool
        As the commands ``newton`` and ``communicate`` have set them.
    told : set of str
        Warnings that are given once.
    words_of_fixes : set of str
        Words of commands that name values of fixes.
    restored : Restored or None
        A restart file whose fixes the script has yet to give.
    flows : tuple of str
        Flow counters that the rows of ``state.marker`` belong to.
    files : dict
        Text files that stay open until the script ends.
    run_start : float
        Reading of the clock at the start of the run, s.
    fresh : tuple of int
        Step of the last insertion, and the highest particle id before it.
    law : tuple or None
        Numbers of the run loop and coefficients of pairs of types, as the kernels have them in
        the present run; None before the first.
    """

    root: CaseFolder
    state: State = field(default_factory=State)
    box: Box | None = None
    types: int = 0
    step: int = 0
    dt: float = 5e-3
    clock: tuple[int, float] = (0, 0.0)
    begin_step: int | None = None
    end_step: int | None = None
    set_up_at: int | None = None
    seen: Any = None
    series: tuple[int, int] | None = None
    boundary: tuple[str, ...] = ("pp", "pp", "pp")
    neighbor: Neighbor = field(default_factory=Neighbor)
    pair: PairStyle = field(default_factory=PairStyle)
    materials: Materials = field(default_factory=Materials)
    thermo: Thermo = field(default_factory=Thermo)
    lattice: Lattice = field(default_factory=Lattice.none)
    meshes: MeshStore = field(default_factory=MeshStore)
    lists: Lists = field(default_factory=Lists)
    groups: dict[str, int] = field(default_factory=lambda: {"all": 1})
    regions: dict[str, Any] = field(default_factory=dict)
    fixes: Roster = field(default_factory=Roster)
    computes: dict[str, Any] = field(default_factory=dict)
    dumps: dict[str, Any] = field(default_factory=dict)
    log: Callable[[str], None] = lambda text: None
    warn: Callable[[str], None] = lambda text: None
    interpreter: Any = None
    energies: set[str] = field(default_factory=set)
    lost: int = 0
    last_lost: tuple[int, int, Floats] | None = None
    fresh: tuple[int, int] = (-1, 0)
    restarts: tuple[Schedule, str] | None = None
    restart_turns: tuple[Schedule, list[str]] | None = None
    told: set[str] = field(default_factory=set)
    words_of_fixes: set[str] = field(default_factory=set)
    restored: Restored | None = None
    flows: tuple[str, ...] = ()
    atom_map: str = ""
    sorting: Sorting = field(default_factory=Sorting)
    newton: bool = True
    granular: bool = False
    hybrid: int = 0
    ghost_velocity: bool = False
    run_start: float = field(default_factory=perf_counter)
    law: tuple[Control, Floats] | None = None
    files: dict[Path, TextIO] = field(default_factory=dict)

    def clear(self) -> None:
        """Forget box, particles, fixes and settings; variables and the log stay."""
        self.close()
        fresh = World(self.root)
        for item in fields(World):
            if item.name not in _OF_THE_SCRIPT:
                setattr(self, item.name, getattr(fresh, item.name))

    def open_text(self, name: str, *, append: bool = False) -> TextIO:
        """Open a text file of the case for writing; it stays open until the script ends."""
        path = inside(self.root, name)
        if path not in self.files:
            self.files[path] = open_text(path, append=append)
        return self.files[path]

    def close(self) -> None:
        """Close all files; OutputError if what was still to be written finds no room."""
        with ExitStack() as stack:
            for path, file in self.files.items():
                stack.enter_context(writing(path.name))
                stack.callback(file.close)

    def bit(self, group: str) -> int:
        """Return the bit of a group.

        Raises
        ------
        InputError
            If there is no such group.
        """
        if group not in self.groups:
            msg = f"Could not find group '{group}'{suggest(group, self.groups)}"
            raise InputError(msg)
        return self.groups[group]

    def group_bit(self, group: str) -> int:
        """Return the bit of a group, made if it is new."""
        if group not in self.groups:
            if len(self.groups) >= _MOST_GROUPS:
                msg = f"Too many groups (limit {_MOST_GROUPS})"
                raise InputError(msg)
            used = sum(self.groups.values())
            self.groups[group] = ~used & (used + 1)  # the lowest free one
        return self.groups[group]

    def need_box(self) -> Box:
        """Return the box.

        Raises
        ------
        InputError
            Before ``create_box``.
        """
        if self.box is None:
            msg = "command before simulation box is defined; use create_box first"
            raise InputError(msg)
        return self.box

    def of_kind(self, kind: type[T]) -> list[T]:
        """Return the fixes of a class in the order of the script."""
        return self.fixes.of_kind(kind)

    def member(self, bit: int) -> Bools:
        """Return which particles belong to a group, shape (n,)."""
        found: Bools = (self.state.mask[: self.state.n] & bit) != 0
        return found

    def unwrapped(self) -> Floats:
        """Return positions without the wrapping of periodic directions, shape (n, 3), m."""
        length = self.need_box().period()
        found: Floats = (
            self.state.row[: self.state.n, POSITION] + self.state.image[: self.state.n] * length
        )
        return found

    def lose(self, gone: Ints) -> None:
        """Count particles that have left the box."""
        worst = int(gone[0])
        self.lost += len(gone)
        self.last_lost = (
            self.step, int(self.state.ids[worst]), self.state.row[worst, POSITION].copy()
        )  # fmt: skip

    def set_units(self, units: str) -> None:
        """Take the units of a script, and the time step and skin that come with them."""
        self.materials.units = units
        self.dt, self.neighbor.skin = UNITS[units]

    def warn_once(self, text: str) -> None:
        """Give a warning that was not given yet."""
        if text not in self.told:
            self.told.add(text)
            self.warn(text)

    def time(self) -> float:
        """Return the simulated time, s."""
        since, then = self.clock
        return then + (self.step - since) * self.dt

    def change_timestep(self, dt: float) -> None:
        """Go on with another time step; the time simulated so far stays."""
        if dt != self.dt:
            self.clock = (self.step, self.time())
            self.dt = dt

    def kinetic_energy(self) -> float:
        """Return the translational kinetic energy, J."""
        row = self.state.row[: self.state.n]
        return float(0.5 * (row[:, MASS] * (row[:, VELOCITY] ** 2).sum(axis=1)).sum())
