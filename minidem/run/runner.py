"""The run loop: asks the kernels for many steps, and acts when something happens in between."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from minidem.contact.model import active_switches, coefficient_table
from minidem.errors import RunInterrupted
from minidem.fixes.adapt import Adapter
from minidem.fixes.body import Post
from minidem.fixes.insert import Insert
from minidem.fixes.massflow import drain
from minidem.fixes.move import fill_table, rest_meshes, store_clocks
from minidem.fixes.variable_forces import add_forces
from minidem.fixes.wall import MassFlow, MoveMesh
from minidem.kernels.contact.extended import IMPACT, MODEL_AT
from minidem.kernels.contact.law import COLUMNS
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
from minidem.kernels.lists.rebuild import INCOMPLETE, MADE, NEEDS
from minidem.kernels.step.phases import Model
from minidem.kernels.step.step import advance_for
from minidem.kernels.step.team import helper_for
from minidem.kernels.tables import Control, Lists, Motions, Posts, Tables
from minidem.run import control as tables
from minidem.run.boundaries import apply_boundaries, place_box, take_out
from minidem.run.events import Event
from minidem.run.motion_check import check_motion
from minidem.run.threads import Crew
from minidem.world.images import make_images
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Runner"]

_W = {name: i for i, name in enumerate(WHOLES)}
_R = {name: i for i, name in enumerate(REALS)}
_NEVER = 2**62
_BREATH = 4_000_000  # particle-steps, about half a second


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
    crew : Crew
        Threads that share the work.
    """

    world: World
    progress: Callable[[int, int], None] | None = None
    stop: Callable[[], bool] | None = None
    control: Control = field(default_factory=lambda: Control(np.zeros(64, np.int64), np.zeros(24)))
    motions: Motions | None = None
    posts: Posts | None = None
    crew: Crew = field(default_factory=Crew)
    adapter: Adapter = field(init=False)
    _advance: Callable[..., None] | None = None
    _help: Callable[..., None] | None = None
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
        model = Model(base, bool(box.period()[3:].any()), extended)
        several = self.crew.threads > 1
        self._advance = advance_for(model, several=several)
        self._help = helper_for(model) if several else None
        make_images(world, self._reach())
        world.lists.set_tables(*tables.wall_tables(world, base))
        self.motions = tables.motion_tables(world)
        self.posts = tables.post_tables(world)
        self._prepare_flows()
        tables.fill_control(world, self.control)

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

    # -- setup ---------------------------------------------------------------------------------

    def setup(self) -> None:
        """Make lists and forces at the start of a run; histories are used but do not advance."""
        world = self.world
        self._rebuild()
        rest_meshes(world)
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
        store_clocks(world, self.motions)
        self._store_forces()

    def _interrupted(self, middle: int, inserters: list[Any]) -> int:
        """Do what new lists need Python for, insert if it is time; return the next such step."""
        world = self.world
        whole = self.control.whole
        # events hold rows of the particle table, and a rebuild reorders the rows
        drain(world, world.lists.flows)
        check_motion(world, self.control.real[_R["moved2"]])
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
        advance, motions, posts = self._advance, self.motions, self.posts
        if advance is None or motions is None or posts is None:
            msg = "the run was not prepared"
            raise ValueError(msg)
        lists = world.lists
        whole = self.control.whole
        whole[_W["turned"]] = lists.turned
        whole[_W["builds"]] = 0
        parts, mesh, coef = world.state.table(), world.meshes.table, self._coef
        first, second = map(Lists, lists.all_pairs, lists.all_walls)
        tables = Tables(
            self.control, parts, world.state.more, first, second, mesh, motions, lists.flows, posts,
            coef, self.crew.team,
        )  # fmt: skip
        self.crew.call(self._help, advance, tables)
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
            take_out(world)
            moving = bool(world.meshes.images and world.of_kind(MoveMesh))
            if moving:
                make_images(world, self._reach())
            # with diameters that change the lists are Python's business too
            place_box(world, self.control.real, alone=not moving and not self.adapter.active)
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

    def _store_forces(self) -> None:
        """Keep the total forces before body forces in their fixes."""
        if self.posts is not None and not self.control.whole[_W["outside"]]:
            for i, post in enumerate(self.world.of_kind(Post)):
                post.before[1:] = self.posts.total[i]
