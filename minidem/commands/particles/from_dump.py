"""``read_dump FILE STEP FIELDS [KEYWORDS]``: particles as a dump has them of one step."""

from __future__ import annotations

from typing import Final

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.commands.creation import add_particles
from minidem.commands.particles.snapshot import Snapshot, find_snapshot
from minidem.commands.runs import set_step
from minidem.errors import InputError
from minidem.kernels.columns import POSITION, RADIUS, VELOCITY
from minidem.record import record
from minidem.run.engine import Engine
from minidem.run.renumbered import note_contacts
from minidem.script.paths import inside
from minidem.words import Words
from minidem.world.lists import Noted
from minidem.world.periodic import box_text, wrapped
from minidem.world.state import Bools, Floats, Ints
from minidem.world.world import World

_PLACES: Final = ("x", "y", "z")
_MOVES: Final = ("vx", "vy", "vz")
_TURNS: Final = ("ix", "iy", "iz")
_FIELDS: Final = (*_PLACES, *_MOVES, "radius", *_TURNS)
_KINDS: Final = ("", "s", "u", "su")
"""What may stand behind the name of a position: as it is, scaled, unwrapped, both."""
_SWITCHES: Final = ("box", "replace", "purge", "trim", "add")
_LABELLED: Final = ("scaled", "wrapped")
_MOST_FLAG: Final = 511  # crossings of a periodic face that LIGGGHTS keeps
_USAGE: Final = "read_dump FILE STEP x y z vx vy vz radius [box no] [replace no] [add yes]"


@record
class _Wanted:
    """What the words ask for: fields, and what becomes of particles and box."""

    fields: tuple[str, ...]
    box: bool = True
    replace: bool = True
    purge: bool = False
    trim: bool = False
    add: bool = False


@record(frozen=True)
class _Content:
    """The numbers of a snapshot; rows are particles.

    Attributes
    ----------
    numbers : mapping of str to ndarray
        Positions in m, velocities in m/s and radii in m, of the fields that were asked for.
    turns : ndarray of int64, shape (n, 3)
        Image flags.
    turned : list of int
        Directions in which the particles that there are take these flags.
    """

    ids: Ints
    numbers: dict[str, Floats]
    turns: Ints
    turned: list[int]


@COMMANDS.register("read_dump")
def _read_dump(engine: Engine, words: Words) -> None:
    words.need(3, _USAGE)
    world = engine.world
    box, state = world.need_box(), world.state
    name, step = words.take("a file"), words.interval(least=0)
    wanted = _read_words(words)
    engine.report.screen("Scanning dump file ...")
    snapshot = find_snapshot(inside(world.root, name), name, step, state.n)
    content = _content(snapshot, wanted.fields)
    kind = _types(snapshot, world.types) if wanted.add else None
    engine.report.screen("Reading snapshot from dump file ...")
    set_step(world, step)
    if wanted.box:
        if snapshot.faces and snapshot.faces != box.boundary:
            world.warn("Read_dump boundary flags in dump file do not match simulation")
        box.lo[:], box.hi[:] = snapshot.bounds
    before = state.n
    noted = note_contacts(world) if wanted.purge and world.lists.noted is None else None
    former = state.ids[state.output_order()]
    purged = _purge(world) if wanted.purge else 0
    old = state.ids[: state.n].copy()
    there = np.isin(old, content.ids)
    replaced = _replace(world, content) if wanted.replace else 0
    trimmed = _drop(world, ~there) if wanted.trim else 0
    added = _append(world, content, ~np.isin(content.ids, old), kind) if kind is not None else 0
    if noted is not None and added:
        _take_over(world, noted, former)
    _into_the_box(world)
    world.log(f"  {box_text(box)}")
    for count, what in (
        (before, "before read"), (snapshot.count, "in snapshot"), (purged, "purged"),
        (replaced, "replaced"), (trimmed, "trimmed"), (added, "added"), (state.n, "after read"),
    ):  # fmt: skip
        world.log(f"  {count} atoms {what}")
    if added or replaced:
        world.warn(
            "read_dump: a dump's radius changes no mass, as in LIGGGHTS: particles keep theirs, "
            "new ones have that of a sphere of 1 m and 1 kg/m3; 'set group all density RHO' gives "
            "them the mass of their radius"
        )


def _read_words(words: Words) -> _Wanted:
    """Read fields and keywords."""
    fields: list[str] = []
    while words.peek() in _FIELDS:
        fields.append(words.take("a field"))
    keywords = (*_SWITCHES, *_LABELLED, "format", "label")
    if not words.done() and words.peek() not in keywords:
        words.choice((*_FIELDS, *keywords), "field or keyword")
    if "radius" not in fields:
        msg = "read_dump: the radius field is required to be read"
        raise InputError(msg)
    if len(set(fields)) < len(fields):
        msg = "Duplicate fields in read_dump command"
        raise InputError(msg)
    found = _Wanted(tuple(fields))
    while not words.done():
        key = words.choice(keywords)
        if key == "label":
            msg = "read_dump label: LIGGGHTS 3.8.0 refuses it as well; name the dump's column so"
            raise InputError(msg)
        if key == "format":
            words.expect("native")
        elif key in _LABELLED:
            words.yes_no()  # counts for columns with labels only
        else:
            setattr(found, key, words.yes_no())
    if found.purge and (found.replace or found.trim):
        msg = "If read_dump purges it cannot replace or trim; add 'replace no'"
        raise InputError(msg)
    return found


def _content(snapshot: Snapshot, fields: tuple[str, ...]) -> _Content:
    """Return the numbers that were asked for, positions as they are in space."""
    ids = snapshot.whole("id")
    plain = [one for one in fields if one in _MOVES or one == "radius"]
    numbers = {one: snapshot.column(one) for one in plain}
    if not (numbers["radius"] >= 0.0).all():
        msg = f"{snapshot.name}: a radius is negative"
        raise InputError(msg)
    kinds = {one: _kind_of(snapshot, one) for one in _PLACES if one in fields}
    if len(set(kinds.values())) > 1:
        msg = "Read_dump x,y,z fields do not have consistent scaling/wrapping"
        raise InputError(msg)
    kind = next(iter(kinds.values()), "")
    low, high = snapshot.bounds
    for axis, one in enumerate(_PLACES):
        if one in kinds:
            place = snapshot.column(one + kind)
            numbers[one] = low[axis] + place * (high - low)[axis] if "s" in kind else place
    # LIGGGHTS takes places that are not read for unwrapped ones, which have no flags
    unwrapped = "u" in kind or not kinds
    turns = np.zeros((snapshot.count, 3), np.int64)
    for axis, one in enumerate(_TURNS):
        if one in fields and not unwrapped:
            turns[:, axis] = snapshot.whole(one)
    if np.abs(turns).max(initial=0) > _MOST_FLAG:
        msg = f"{snapshot.name}: an image flag is beyond {_MOST_FLAG}"
        raise InputError(msg)
    turned = [axis for axis, one in enumerate(_TURNS) if one in fields or unwrapped]
    return _Content(ids, numbers, turns, turned)


def _kind_of(snapshot: Snapshot, place: str) -> str:
    """Return what stands behind the name of a position in the snapshot."""
    found = next((kind for kind in _KINDS if place + kind in snapshot.labels), None)
    if found is None:
        names = ", ".join(place + kind for kind in _KINDS)
        msg = f"{snapshot.name}: no column for {place} (any of {names})"
        raise InputError(msg)
    return found


def _types(snapshot: Snapshot, types: int) -> Ints:
    found = snapshot.whole("type")
    if found.min(initial=1) < 1 or found.max(initial=1) > types:
        msg = f"{snapshot.name}: an atom type is not between 1 and {types}"
        raise InputError(msg)
    return found


def _drop(world: World, gone: Bools) -> int:
    """Delete particles; return how many."""
    state = world.state
    if gone.any():
        world.lists.keep_only(~gone)
        state.drop_in_passes([gone])
        state.take(np.flatnonzero(~gone))
    return int(gone.sum())


def _purge(world: World) -> int:
    """Delete all particles and what is noted of their contacts; return how many there were."""
    world.lists.noted = None
    return _drop(world, np.ones(world.state.n, bool))


def _replace(world: World, content: _Content) -> int:
    """Give particles the numbers that the snapshot has of them; return how many."""
    state = world.state
    place = {int(one): row for row, one in enumerate(state.ids[: state.n])}
    pairs = [(place[int(one)], k) for k, one in enumerate(content.ids) if int(one) in place]
    at, of = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    _set(world, at, content, of)
    for axis in content.turned:
        state.image[at, axis] = content.turns[of, axis]
    return len(at)


def _append(world: World, content: _Content, new: Bools, kind: Ints) -> int:
    """Add the particles that there are not yet, with ids of their own; return how many."""
    of = np.flatnonzero(new)
    if len(of):
        rows = add_particles(world, np.zeros((len(of), 3)), kind[of])
        at = np.arange(rows.start, rows.stop)
        _set(world, at, content, of)
        world.state.image[at] = content.turns[of]
    return len(of)


def _set(world: World, at: Ints, content: _Content, of: Ints) -> None:
    """Set the numbers of particles `at` to those of the rows `of`."""
    row = world.state.row
    columns = {"radius": RADIUS}
    columns |= dict(zip(_PLACES, range(POSITION.start, POSITION.stop), strict=True))
    columns |= dict(zip(_MOVES, range(VELOCITY.start, VELOCITY.stop), strict=True))
    for one, values in content.numbers.items():
        row[at, columns[one]] = values[of]


def _take_over(world: World, noted: Noted, former: Ints) -> None:
    """Give new particles the contacts of those that were in their places before, as LIGGGHTS does.

    Its lists of neighbours go by places, and are read once more when they are made anew. A place
    without a new particle still has the id of the former one.
    """
    state, lists = world.state, world.lists
    now = former.copy()
    now[: state.n] = state.ids[state.output_order()][: len(former)]
    place = np.argsort(former)
    owner, other = (
        place[np.searchsorted(former, ids, sorter=place)] for ids in (noted.owner, noted.other)
    )
    left = owner < state.n
    lists.begin(min(state.n, len(former)))
    lists.noted = noted._replace(
        owner=now[owner[left]], other=now[other[left]], touch=noted.touch[left],
        hist=noted.hist[left],
    )  # fmt: skip
    world.warn(
        "read_dump purge yes: as in LIGGGHTS 3.8.0 new particles take over what contacts of the "
        "former ones remember, the first new one that of the first former one; with 'delete_atoms "
        "group all' in place of 'purge yes' contacts begin anew"
    )


def _into_the_box(world: World) -> None:
    """Bring the particles into the periodic directions of the box."""
    state = world.state
    state.row[: state.n, POSITION], turns = wrapped(
        world.need_box(), state.row[: state.n, POSITION]
    )
    state.image[: state.n] += turns
