"""The run loop: asks the kernels for many steps, and acts when something happens in between."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from minidem import tables
from minidem.adapting import Adapter
from minidem.boundaries import apply_boundaries
from minidem.errors import RunInterrupted, SimulationError
from minidem.fixes.inserts import Insert
from minidem.fixes.simple import CheckTimestep, Post
from minidem.fixes.walls import MassFlow, MeshSurface, MoveMesh, WallGran
from minidem.flow import drain
from minidem.kernels.control import (
    DONE,
    DRAIN,
    OUTSIDE,
    PAUSE,
    REALS,
    REBUILD,
    REBUILD_NOW,
    REBUILD_ON,
    WHOLES,
)
from minidem.kernels.extended import IMPACT, MODEL_AT
from minidem.kernels.law import COLUMNS
from minidem.kernels.rebuild import INCOMPLETE, MADE, NEEDS
from minidem.kernels.step import advance_for
from minidem.kernels.tables import Control, Motions, Posts
from minidem.mesh.images import make_images
from minidem.models import active_switches, coefficient_table
from minidem.motion import fill_table
from minidem.outside import add_forces, needs_python
from minidem.state import Floats
from minidem.world import World

__all__ = ["Event", "Runner"]

_W = {name: i for i, name in enumerate(WHOLES)}
_R = {name: i for i, name in enumerate(REALS)}
_NEVER = 2**62
_BREATH = 4_000_000  # particle-steps, about half a second


class Event(Protocol):
    """Something that happens at the end of certain steps: output, checks."""

    def next_step(self, step: int) -> int:
        """Return the first step after `step` at which it happens."""

    def act(self, world: World, step: int) -> None:
        """Do it."""


@dataclass
class Runner:
    """Runs a world.

    Attributes
    ----------
    world : World
        What to run.
    progress : callable or None
        Called with step and last step now and then.
    stop : callable or None
        Asked about twice a second whether to stop between two steps.
    """

    world: World
    progress: Callable[[int, int], None] | None = None
    stop: Callable[[], bool] | None = None
    control: Control = field(default_factory=lambda: Control(np.zeros(64, np.int64), np.zeros(24)))
    motions: Motions | None = None
    posts: Posts | None = None
    adapter: Adapter = field(init=False)
    _advance: Callable[..., None] | None = None
    _coef: Floats = field(default_factory=lambda: np.zeros((1, len(COLUMNS))))
    _flow_key: tuple[str, ...] = ()
    _width: int = 3

    def __post_init__(self) -> None:
        """Provide for diameters that change."""
        self.adapter = Adapter(self.world)

    # -- preparation ---------------------------------------------------------------------------

    def prepare(self) -> None:
        """Turn the fixes into tables and choose the compiled loop."""
        world = self.world
        box = world.need_box()
        if world.pair.switches is None:
            msg = "no pair style is defined; give 'pair_style gran model hertz tangential history'"
            raise ValueError(msg)
        self._coef = coefficient_table(world.materials, world.types, tables.used_models(world))
        switches = active_switches(world.pair.switches, self._coef)
        self.control.whole[MODEL_AT : MODEL_AT + len(switches)] = switches
        extended = bool(switches[9] or switches[10])
        self._width = IMPACT + 1 if extended else (6 if switches[2] >= 2 else 3)
        base = (0,) * 9 if extended else switches[:9]
        periodic = bool(box.period()[3:].any())
        self._advance = advance_for(base, periodic=periodic, extended=extended)
        make_images(world, self._reach())
        world.lists.set_tables(*tables.wall_tables(world))
        self.motions = tables.motion_tables(world)
        self.posts = tables.post_tables(world)
        self._prepare_flows()
        self._fill_control()

    def _reach(self) -> float:
        """Return how far beyond the box a mesh may matter, m."""
        world = self.world
        state = world.state
        radii = [float(insert.largest()) for insert in world.of_kind(Insert)]
        largest = max([float(state.row[: state.n, 3].max(initial=0.0)), *radii])
        return float(2.0 * largest + world.neighbor.skin)

    def _prepare_flows(self) -> None:
        """Set up the counters; markers of counters that stay are kept."""
        world = self.world
        names = tuple(flow.name for flow in world.of_kind(MassFlow))
        if names != self._flow_key:
            state = world.state
            marker = np.full((len(names), state.cap), -1, np.int8)
            for i, name in enumerate(names):
                if name in self._flow_key:
                    marker[i] = state.marker[self._flow_key.index(name)]
            state.marker = marker
            self._flow_key = names
        world.lists.set_flows(world.state, *tables.flow_tables(world))

    def _fill_control(self) -> None:
        """Write the numbers that do not change within a run."""
        world = self.world
        whole, real = self.control.whole, self.control.real
        near = world.neighbor
        whole[_W["delay"]] = near.delay
        whole[_W["every"]] = near.every
        whole[_W["check"]] = int(near.check)
        whole[_W["clear"]] = int(near.reach > 1.0)
        whole[_W["nve"]] = tables.nve_bit(world)
        whole[_W["frozen"]] = tables.frozen_bit(world)
        whole[_W["types"]] = world.types
        whole[_W["motions"]] = len(world.of_kind(MoveMesh))
        whole[_W["flows"]] = len(world.of_kind(MassFlow))
        whole[_W["leading"]] = int(tables.gravity_leads(world))
        outside = needs_python(world)
        whole[_W["outside"]] = int(outside)
        # forces worked out in Python are not the kernels' business
        whole[_W["late"]] = late = tables.late_posts(world)
        whole[_W["posts"]] = late if outside else len(world.of_kind(Post))
        real[_R["dt"]] = world.dt
        real[_R["trigger2"]] = 0.25 * near.skin * near.skin
        real[_R["reach2"]] = near.reach * near.reach
        real[_R["skin"]] = near.skin
        real[_R["reach"]] = near.reach

    # -- setup ---------------------------------------------------------------------------------

    def setup(self) -> None:
        """Make lists and forces at the start of a run; histories are used but do not advance."""
        world = self.world
        self._rebuild()
        self._rest_meshes()
        self._adapt(setup=True)
        whole = self.control.whole
        whole[_W["step"]] = world.step
        whole[_W["entry"]] = 2
        whole[_W["airborne"]] = self._airborne()
        self._call()
        while whole[_W["code"]] == OUTSIDE:
            self._outside()
            self._call()
        self._store_forces()
        whole[_W["ago"]] = 0
        whole[_W["renew"]] = -1

    def _rest_meshes(self) -> None:
        """Zero the velocity of meshes whose motion was defined before their wall."""
        world = self.world
        order = {name: i for i, name in enumerate(world.fixes)}
        for move in world.of_kind(MoveMesh):
            for wall in world.of_kind(WallGran):
                if move.mesh in wall.meshes and order[move.name] < order[wall.name]:
                    number = world.meshes.names.index(move.mesh)
                    world.meshes.table.vel[world.meshes.table.owner == number] = 0.0

    def _airborne(self) -> int:
        state = self.world.state
        return int(state.flight[: state.n, 4].max()) if state.n else -1

    # -- stepping ------------------------------------------------------------------------------

    def run(self, last: int, events: Iterable[Event], inserters: list[Any]) -> None:
        """Advance the world to step `last`.

        Parameters
        ----------
        last : int
            Step to reach.
        events : iterable of Event
            What happens at the end of steps.
        inserters : list
            Insertion fixes, with ``next_step`` and ``act``.
        """
        world = self.world
        events = list(events)
        whole = self.control.whole
        whole[_W["entry"]] = 0
        due = {id(event): event.next_step(world.step) for event in events}
        while world.step < last:
            stop = min([last, *due.values(), world.step + self._breath()])
            middle = min(
                (ins.next_step for ins in inserters if ins.next_step is not None), default=_NEVER
            )
            self._go_to(stop, middle, inserters)
            for event in events:
                if due[id(event)] <= world.step:
                    event.act(world, world.step)
                    due[id(event)] = event.next_step(world.step)
            if self.stop is not None and self.stop():
                raise RunInterrupted(world.step)
            if self.progress is not None:
                self.progress(world.step, last)

    def _breath(self) -> int:
        """Return after how many steps to look for Ctrl-C and tell the progress."""
        return max(100, _BREATH // max(1, self.world.state.n))

    def _go_to(self, stop: int, middle: int, inserters: list[Any]) -> None:
        """Call the kernels until `stop` is reached."""
        world = self.world
        whole = self.control.whole
        whole[_W["stop"]] = self._window(stop)
        whole[_W["middle"]] = middle
        while True:
            self._call()
            world.step = int(whole[_W["step"]])
            code = whole[_W["code"]]
            if code == REBUILD:
                middle = self._interrupted(middle, inserters)
            elif code == OUTSIDE:
                self._outside()
            elif code == PAUSE:
                self._adapt()
            elif code == DRAIN:
                drain(world, world.lists.flows)
            elif code == DONE:
                if world.step >= stop:
                    break
                whole[_W["stop"]] = self._window(stop)
        if len(world.lists.flows.spec):
            drain(world, world.lists.flows)
        self._store_clocks()
        self._store_forces()

    def _interrupted(self, middle: int, inserters: list[Any]) -> int:
        """Do what new lists need Python for, insert if it is time; return the next such step."""
        world = self.world
        whole = self.control.whole
        # events hold rows of the particle table, and a rebuild reorders the rows
        drain(world, world.lists.flows)
        self._check_motion()
        if self.adapter.active and self._lists_hold(middle):
            self._adapt()
            return middle
        if world.step == middle:
            for inserter in inserters:
                if inserter.next_step == world.step:
                    inserter.act(world, world.step)
            whole[_W["airborne"]] = self._airborne()
        self._rebuild()
        self._adapt()
        steps = [inserter.next_step for inserter in inserters]
        middle = min((step for step in steps if step is not None), default=_NEVER)
        whole[_W["middle"]] = middle
        return middle

    def _lists_hold(self, middle: int) -> bool:
        """Return True if new lists were asked for only because some particle has grown."""
        whole = self.control.whole
        forced = self.world.step in (middle, int(whole[_W["renew"]])) or not whole[_W["check"]]
        return not forced and self.adapter.lists_hold()

    def _adapt(self, *, setup: bool = False) -> None:
        """Change the diameters that follow a variable, if it is time."""
        if not self.adapter.active:
            self.control.whole[_W["pause"]] = _NEVER
            return
        self.adapter.apply(setup=setup)
        self.control.whole[_W["pause"]] = self.adapter.next_step(self.world.step)
        limits = self.adapter.limits()
        self.control.real[_R["trigger2"]] = limits.min(initial=0.25 * self.world.neighbor.skin**2)

    def _window(self, stop: int) -> int:
        """Return the step up to which table motions are worked out, at most `stop`."""
        if self.motions is None:
            return stop
        self.motions, stop = fill_table(self.world, self.motions, stop)
        return stop

    def _call(self) -> None:
        """Enter the compiled loop."""
        world = self.world
        self.control.whole[_W["n"]] = world.state.n
        if self._advance is None or self.motions is None or self.posts is None:
            msg = "the run was not prepared"
            raise ValueError(msg)
        lists = world.lists
        whole = self.control.whole
        whole[_W["turned"]] = lists.turned
        whole[_W["builds"]] = 0
        self._advance(
            self.control, world.state.table(), world.state.more, *lists.all_pairs,
            *lists.all_walls, world.meshes.table, self.motions, lists.flows, self.posts,
            self._coef,
        )  # fmt: skip
        lists.turned = int(whole[_W["turned"]])
        lists.builds += int(whole[_W["builds"]])

    def _outside(self) -> None:
        """Work out the forces that kernels cannot; they go on with the walls or after them."""
        whole = self.control.whole
        late = int(whole[_W["late"]])
        if whole[_W["entry"]] < 0:
            add_forces(self.world, self.posts, int(whole[_W["leading"]]), late)
        else:
            add_forces(self.world, self.posts, late)

    def _rebuild(self) -> None:
        """Make new lists, with memory as needed, for the particles that stay in the box."""
        world = self.world
        state = world.state
        whole = self.control.whole
        entry = int(whole[_W["entry"]])
        mode = REBUILD_ON
        if whole[_W["made"]] != INCOMPLETE:
            mode = REBUILD_NOW
            state.reserve(1)
            state.more.alive[: state.n] = apply_boundaries(world)[: state.n]
            self._take_out()
            if world.meshes.images and world.of_kind(MoveMesh):
                make_images(world, self._reach())
            self._place_box()
        while True:
            world.lists.make_room(state, self._width)
            whole[_W["entry"]] = mode
            whole[_W["before"]] = world.lists.before
            self._call()
            if whole[_W["made"]] == MADE:
                break
            if whole[_W["made"]] == INCOMPLETE:
                mode = REBUILD_ON
        state.n = int(state.more.needs[NEEDS.index("count")])
        self.adapter.hold()
        state.more.alive[:] = 1
        world.lists.before = state.n
        whole[_W["entry"]] = entry

    def _take_out(self) -> None:
        """Let the particles go that a flow counter deletes."""
        world = self.world
        state = world.state
        for flow in world.of_kind(MassFlow):
            if not flow.doomed:
                continue
            gone = np.flatnonzero(np.isin(state.ids[: state.n], list(flow.doomed)))
            flow.deleted_number += len(gone)
            flow.deleted_mass += float(state.row[gone, 7].sum())
            state.more.alive[gone] = 0
            state.drop_ranks([int(i) for i in gone])
            flow.doomed.clear()

    def _place_box(self) -> None:
        """Tell the kernels where the box is now."""
        world = self.world
        box = world.need_box()
        period = box.period()
        real = self.control.real
        real[3:6] = period[3:]
        real[6:9] = [1.0 / length if length > 0.0 else 0.0 for length in period[3:]]
        # with diameters that change the lists are Python's business too
        moves = self.adapter.active or any(kind not in ("pp", "ff") for kind in box.boundary)
        moves |= bool(world.meshes.images and world.of_kind(MoveMesh))
        more = world.state.more
        more.box[:] = [*box.lo, *box.hi, *(period[3:] > 0.0), float(moves), 0.0, 0.0]
        world.state.more = more._replace(ranges=tables.flow_ranges(world))

    def _check_motion(self) -> None:
        """Refuse to go on with NaN, or with a particle faster than the lists allow."""
        world = self.world
        state = world.state
        moved2 = self.control.real[_R["moved2"]]
        limit = world.neighbor.skin
        if moved2 <= limit * limit:
            return
        row = state.row[: state.n]
        bad = np.flatnonzero(~np.isfinite(row[:, :7]).all(axis=1))
        if len(bad):
            raise SimulationError(
                world.step, int(state.ids[bad[0]]),
                "position or velocity is not a finite number; the time step is probably too "
                "large (compare fix check/timestep/gran) or particles overlap strongly",
            )  # fmt: skip
        speed = np.sqrt((row[:, 4:7] ** 2).sum(axis=1)) * world.dt
        worst = int(np.argmax(speed))
        if speed[worst] > limit:
            raise SimulationError(
                world.step, int(state.ids[worst]),
                f"moves {speed[worst]:.3g} m in one step, farther than the neighbour skin of "
                f"{limit:.3g} m; reduce the time step or enlarge the skin ('neighbor')",
            )  # fmt: skip

    def _store_forces(self) -> None:
        """Keep the total forces before body forces in their fixes."""
        if self.posts is not None and not self.control.whole[_W["outside"]]:
            for i, post in enumerate(self.world.of_kind(Post)):
                post.before[1:] = self.posts.total[i]

    def _store_clocks(self) -> None:
        """Keep clocks of motions and loads of meshes in their fixes."""
        world = self.world
        if self.motions is not None:
            for i, move in enumerate(world.of_kind(MoveMesh)):
                move.clock = float(self.motions.clock[i])
                move.value[:3] = self.motions.value[i, :3]
        for i, name in enumerate(world.meshes.names):
            fix = world.fixes.get(name)
            if isinstance(fix, MeshSurface) and fix.stress:
                fix.load = world.lists.walls.load[i, :6].copy()


def check_events(world: World) -> list[Event]:
    """Return the end-of-step events of check/timestep/gran fixes."""
    return [_Check(fix) for fix in world.of_kind(CheckTimestep)]


@dataclass
class _Check:
    fix: CheckTimestep

    def next_step(self, step: int) -> int:
        """Return the next multiple of its interval."""
        return (step // self.fix.every + 1) * self.fix.every

    def act(self, world: World, step: int) -> None:
        """Compare the time step with the critical ones."""
        from minidem.timestep import critical_fractions

        del step
        self.fix.values = critical_fractions(world)
