"""The compiled loop of a run with its tables."""

from __future__ import annotations

from collections.abc import Sequence
from operator import is_
from time import perf_counter
from typing import Any

import numpy as np

from minidem.contact.coefficients import active_switches
from minidem.fixes.facets import load_table, store_loads
from minidem.fixes.flow.tables import prepare_flows
from minidem.fixes.forces.body import add_forces, post_tables, store_forces
from minidem.fixes.motions import fill_table, motion_tables, store_clocks
from minidem.fixes.wall import used_models, wall_tables
from minidem.fixes.wet.reach import set_reach
from minidem.kernels.columns import (
    BASIC_SWITCHES,
    BUILDS,
    COHESION,
    ENTRY,
    LATE_POSTS,
    LEADING,
    LOST,
    LOST_AT,
    LOST_ID,
    LOST_STEP,
    NEEDS_PYTHON,
    NORMAL,
    PAIR_MODEL,
    PARTICLES,
    REAL,
    ROLLING,
    SLIDING_ONLY,
    TURNED,
    WHOLE,
    WITH_IMPACT,
    WITH_PLASTICITY,
    WITH_ROLLING,
    WITH_YIELD,
    three,
)
from minidem.kernels.models import EASO, EPSD, EPSD2, HOOKE, HOOKE_HYSTERESIS, THORNTON_NING
from minidem.kernels.scene import Lists, Tables
from minidem.kernels.step.phases import GENERAL, Model
from minidem.kernels.tables import Control, Motions, Posts
from minidem.record import record
from minidem.run.code import Code, code_of
from minidem.run.control import fill_control
from minidem.run.ready import contact_table
from minidem.run.threads import Crew
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Loop", "empty_control", "history_width"]


def empty_control() -> Control:
    """Return the numbers that Python and the loop exchange, all zero."""
    return Control(np.zeros(WHOLE, np.int64), np.zeros(REAL))


def history_width(world: World) -> int:
    """Return how many numbers a contact of particles remembers with the pair style there is."""
    return _history(active_switches(used_models(world)[0], contact_table(world)))


def _history(switches: Sequence[int]) -> int:
    """Return how many numbers a contact's history has."""
    if switches[NORMAL] == THORNTON_NING:
        return WITH_YIELD
    if switches[NORMAL] >= HOOKE_HYSTERESIS:
        return WITH_PLASTICITY
    if any(switches[BASIC_SWITCHES:]):
        return WITH_IMPACT
    return WITH_ROLLING if switches[ROLLING] >= EPSD else SLIDING_ONLY


def _has_own_loop(switches: Sequence[int]) -> bool:
    """Return True if a loop may be compiled for a model."""
    known = switches[NORMAL] <= HOOKE and switches[ROLLING] <= EPSD2
    return known and not any(switches[BASIC_SWITCHES:])


def _alike(new: Sequence[Any], old: Sequence[Any]) -> bool:
    """Return True if two tuples hold the same objects."""
    return all(map(is_, new, old))


@record
class Loop:
    """The loop that is compiled for the contact model of a run, and its tables.

    Attributes
    ----------
    world : World
        What it runs.
    control : Control
        Numbers that Python and the loop exchange.
    crew : Crew
        Threads that share the work.
    code : Code
        The kernels that may run it.
    coefficients : ndarray
        See `minidem.contact.coefficients.coefficient_table`.
    motions, posts : Motions, Posts
        Tables of the kernels.
    width : int
        Numbers of a contact's history.
    """

    world: World
    control: Control
    crew: Crew
    code: Code
    coefficients: Floats
    motions: Motions
    posts: Posts
    width: int
    _known: Tables | None = None

    @classmethod
    def prepare(cls, world: World, control: Control, crew: Crew) -> Loop:
        """Choose the compiled loop and turn the fixes into tables.

        Raises
        ------
        InputError
            Without pair style, or if a material property is missing.
        """
        coefficients = contact_table(world)
        used = used_models(world)
        set_reach(world, used, coefficients)
        switches = active_switches(used[0], coefficients)
        control.whole[PAIR_MODEL : PAIR_MODEL + len(switches)] = switches
        base = switches[:BASIC_SWITCHES]
        own = Model(base, bool(world.need_box().period().any()))
        wet = any(model[COHESION] >= EASO for model in used)
        model = own if _has_own_loop(switches) and not wet else GENERAL
        code = code_of(model, several=crew.threads > 1)
        world.lists.set_tables(*wall_tables(world, base), load_table(world))
        prepare_flows(world)
        motions, posts = motion_tables(world), post_tables(world)
        fill_control(world, control, motions, posts)
        world.law = control, coefficients
        return cls(world, control, crew, code, coefficients, motions, posts, _history(switches))

    def call(self) -> None:
        """Enter the compiled loop."""
        world, whole = self.world, self.control.whole
        lists = world.lists
        whole[PARTICLES] = world.state.n
        whole[TURNED] = lists.turned
        whole[BUILDS] = 0
        tables = self._tables()
        loop, began = self.code.pick(tables), perf_counter()
        self.crew.call(loop.help_out, loop.advance, tables)
        self.code.worked(perf_counter() - began, tables)
        lists.turned = int(whole[TURNED])
        if builds := int(whole[BUILDS]):
            lists.builds += builds
            lists.before = world.state.n  # more than before, where insertions came in between
        if whole[LOST]:
            self._lose()

    def _tables(self) -> Tables:
        """Return the tables of the kernels; the same as before while nothing is new in them."""
        world = self.world
        lists, pairs, walls = world.lists, world.lists.all_pairs, world.lists.all_walls
        known = self._known
        first, second = map(Lists, pairs, walls)
        if known is not None:
            # tuples of the same arrays are the same
            first = known.first if _alike(first, known.first) else first
            second = known.second if _alike(second, known.second) else second
        found = Tables(
            self.control, world.state.table(), world.state.more, first, second,
            world.meshes.table, self.motions, lists.flows, self.posts, self.coefficients,
            self.crew.team,
        )  # fmt: skip
        if known is None or not _alike(found, known):
            self._known = known = found
        return known

    def _lose(self) -> None:
        """Keep count of the particles that left the box in the loop."""
        world, whole = self.world, self.control.whole
        world.lost += int(whole[LOST])
        place = self.control.real[three(LOST_AT)].copy()
        world.last_lost = int(whole[LOST_STEP]), int(whole[LOST_ID]), place
        whole[LOST] = 0
        # fewer where lists were made without them; else that is left to Python
        world.state.n = world.lists.before = int(whole[PARTICLES])

    def window(self, stop: int) -> int:
        """Return the step up to which motions are worked out, at most `stop`."""
        self.motions, stop = fill_table(self.world, self.motions, stop)
        return stop

    def add_forces(self) -> None:
        """Work out the forces that kernels cannot; they go on with the walls or after them."""
        whole = self.control.whole
        late = int(whole[LATE_POSTS])
        if whole[ENTRY] < 0:
            add_forces(self.world, self.posts, int(whole[LEADING]), late)
        else:
            add_forces(self.world, self.posts, late)

    def store_setup(self) -> None:
        """Keep what the kernels have worked out at the setup of a run."""
        store_loads(self.world, setup=True)
        self.store_forces()

    def store_forces(self) -> None:
        """Keep the total forces before body forces in their fixes."""
        if not self.control.whole[NEEDS_PYTHON]:
            store_forces(self.world, self.posts)

    def store(self) -> None:
        """Keep what the kernels have worked out in the fixes."""
        store_clocks(self.world, self.motions)
        store_loads(self.world)
        self.store_forces()
