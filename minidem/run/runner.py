"""The run loop: asks the kernels for many steps, and acts when something happens in between."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from minidem.errors import RunInterrupted
from minidem.fixes.adapt import Adapter
from minidem.fixes.carrier import Carrier
from minidem.fixes.flow.tables import drain
from minidem.fixes.wall import rest_meshes
from minidem.kernels.columns import (
    AIRBORNE_STEP,
    CODE,
    ENTRY,
    INSERT_STEP,
    LIST_AGE,
    LIST_CHECK,
    MOVED2,
    PAUSE_STEP,
    RENEW_STEP,
    STEP,
    STOP_STEP,
    TRIGGER2,
)
from minidem.kernels.control import (
    AT_SETUP,
    AT_START,
    DONE,
    DRAIN,
    OUTSIDE,
    PAUSE,
    REBUILD,
)
from minidem.kernels.tables import Control
from minidem.record import field, record
from minidem.run.boundaries import reach_beyond
from minidem.run.loop import Loop, empty_control
from minidem.run.motion_check import check_motion
from minidem.run.rebuild import kernels_make_lists, make_lists
from minidem.run.renumbered import insert
from minidem.run.spatial_order import place_bins
from minidem.run.threads import Crew
from minidem.world.event import NEVER, Event
from minidem.world.fix import Fix, all_fixes
from minidem.world.images import make_images
from minidem.world.values.flights import last_flight
from minidem.world.values.seen import Seen
from minidem.world.world import World

__all__ = ["Runner"]

_BREATH = 4_000_000  # particle-steps, about half a second
_LEAST_BREATH = 100  # steps


@record
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
    control : Control
        Numbers that Python and the compiled loop exchange.
    loop : Loop
        The compiled loop of the present run.
    adapter : Adapter
        Diameters that change.
    inserting : list of Fix
        Fixes that may add particles.
    carriers : list of Carrier
        Fixes that act in every step, outside of the kernels.
    watched : bool
        Whether output asks for contacts as they were inside of a step.
    """

    world: World
    progress: Callable[[int, int], None] | None = None
    stop: Callable[[], bool] | None = None
    crew: Crew = field(default_factory=Crew)
    control: Control = field(default_factory=empty_control)
    loop: Loop = field(init=False)
    adapter: Adapter = field(init=False)
    inserting: list[Fix] = field(default_factory=list)
    carriers: list[Carrier] = field(default_factory=list)
    watched: bool = False

    def prepare(self) -> None:
        """Turn the fixes into tables and choose the compiled loop."""
        make_images(self.world, reach_beyond(self.world))
        self.carriers = self.world.of_kind(Carrier)
        self.adapter = Adapter(self.world)
        fixes, own = all_fixes(self.world), Fix.next_insertion
        self.inserting = [x for x in fixes if type(x).next_insertion is not own]
        self.watched = any(x.looks_inside for x in [*fixes, *self.world.computes.values()])
        self.loop = Loop.prepare(self.world, self.control, self.crew)

    # -- setup ---------------------------------------------------------------------------------

    def setup(self) -> None:
        """Make lists and forces at the start of a run; histories are used but do not advance."""
        world = self.world
        place_bins(world)
        make_lists(world, self.loop, self.adapter, self.carriers)
        rest_meshes(world, before_walls=True)
        self._adapt(setup=True)
        whole = self.control.whole
        whole[STEP] = world.step
        whole[ENTRY] = AT_SETUP
        whole[AIRBORNE_STEP] = last_flight(world)
        self.loop.call()
        while whole[CODE] == OUTSIDE:
            self.loop.add_forces()
            self.loop.call()
        self.loop.store_setup()
        rest_meshes(world, before_walls=False)
        whole[LIST_AGE] = 0
        whole[RENEW_STEP] = -1

    # -- stepping ------------------------------------------------------------------------------

    def run(self, last: int, events: Iterable[Event]) -> None:
        """Advance the world to step `last`.

        Parameters
        ----------
        last : int
            Step to reach.
        events : iterable of Event
            What happens at the end of steps.
        """
        world = self.world
        events = list(events)
        whole = self.control.whole
        whole[ENTRY] = AT_START
        due = {id(event): event.next_step(world.step) for event in events}
        while world.step < last:
            stop = min([last, *due.values(), world.step + self._breath()])
            self._go_to(stop)
            for event in events:
                if due[id(event)] <= world.step:
                    event.act(world)
                    due[id(event)] = event.next_step(world.step)
            if self.stop is not None and self.stop():
                raise RunInterrupted(world.step)
            if self.progress is not None:
                self.progress(world.step, last)

    def _breath(self) -> int:
        """Return after how many steps to look for Ctrl-C and tell the progress."""
        return max(_LEAST_BREATH, _BREATH // max(1, self.world.state.n))

    def _next_insertion(self) -> int:
        """Return the next step in which a fix adds particles."""
        return min([fix.next_insertion() for fix in self.inserting], default=NEVER)

    def _next_forced(self) -> int:
        """Return the next step with new lists: particles come, or a restart file is written."""
        world = self.world
        schedules = [one[0] for one in (world.restarts, world.restart_turns) if one is not None]
        steps = [schedule.next_step(world.step) for schedule in schedules]
        return min(self._next_insertion(), *steps, NEVER)

    def _go_to(self, stop: int) -> None:
        """Call the kernels until `stop` is reached."""
        world = self.world
        whole = self.control.whole
        whole[STOP_STEP] = self._set_out(stop)
        whole[INSERT_STEP] = self._next_forced()
        self._pause(stop)
        while True:
            self.loop.call()
            world.step = int(whole[STEP])
            code = whole[CODE]
            if code in (REBUILD, PAUSE):
                self._before_forces(stop, again=code == REBUILD)
            elif code == OUTSIDE:
                self.loop.add_forces()
            elif code == DRAIN:
                drain(world, world.lists.flows)
            elif code == DONE:
                for fix in self.carriers:
                    fix.after(world, self.control)
                if world.step >= stop:
                    break
                whole[STOP_STEP] = self._set_out(stop)
        if len(world.lists.flows.spec):
            drain(world, world.lists.flows)
        self.loop.store()

    def _set_out(self, stop: int) -> int:
        """Begin a step for the fixes that act in every one; return up to where kernels may go."""
        for fix in self.carriers:
            fix.before(self.world)
        return self.loop.window(self.world.step + 1 if self.carriers else stop)

    def _pause(self, stop: int) -> None:
        """Choose the next step in which the kernels return before the forces."""
        changes = self.adapter.next_step(self.world.step)
        self.control.whole[PAUSE_STEP] = min(changes, stop) if self.watched else changes

    def _before_forces(self, stop: int, *, again: bool) -> None:
        """Act between the move and the forces of a step; `again` if lists have to be made anew."""
        act = self._interrupted if again else self._adapt
        act()
        self._pause(stop)
        if self.watched and self.world.step == stop:
            self.world.seen = Seen.now(stop, self.world.state, self.control)

    def _interrupted(self) -> None:
        """Do what new lists need Python for; insert if it is time."""
        world = self.world
        whole = self.control.whole
        # a counter that takes particles out has to know whom before lists are made anew
        drain(world, world.lists.flows)
        check_motion(world, self.control.real[MOVED2])
        if self.adapter.active and self._lists_hold():
            self._adapt()
            return
        if world.step == self._next_insertion():
            for fix in self.inserting:
                if fix.next_insertion() == world.step:
                    insert(world, fix)
            whole[AIRBORNE_STEP] = last_flight(world)
            if not self.watched and kernels_make_lists(world, self.loop):
                whole[INSERT_STEP] = self._next_forced()
                return
        make_lists(world, self.loop, self.adapter, self.carriers)
        self._adapt()
        whole[INSERT_STEP] = self._next_forced()

    def _lists_hold(self) -> bool:
        """Return True if new lists were asked for only because some particle has grown."""
        whole = self.control.whole
        steps = (int(whole[INSERT_STEP]), int(whole[RENEW_STEP]))
        forced = self.world.step in steps or not whole[LIST_CHECK]
        return not forced and self.adapter.lists_hold()

    def _adapt(self, *, setup: bool = False) -> None:
        """Change the diameters that follow a variable, if it is time."""
        if not self.adapter.active:
            return
        self.adapter.apply(setup=setup)
        limits = self.adapter.limits()
        self.control.real[TRIGGER2] = limits.min(initial=0.25 * self.world.neighbor.skin**2)
