"""``change_box GROUP OPERATION ...``: another box for the particles that are there."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.commands.setup import read_faces
from minidem.errors import InputError, UnknownWordError
from minidem.kernels.columns import POSITION
from minidem.record import field, record
from minidem.run.boundaries import SMALL, apply_boundaries
from minidem.run.engine import Engine
from minidem.words import Words
from minidem.world.periodic import box_text, wrapped
from minidem.world.state import Box, Floats
from minidem.world.world import World

_AXES = ("x", "y", "z")
_TILTED = ("xy", "xz", "yz", "triclinic")
_UPRIGHT = "ortho"  # which the box is
_OPERATIONS = (*_AXES, "boundary", "set", "remap", "force", _UPRIGHT, *_TILTED)
_ONE, _TWO = 1, 2  # directions that keep the volume


@record
class _Operation:
    """One operation.

    Attributes
    ----------
    kind : str
        Direction, or ``boundary``, ``set`` or ``remap``.
    style : str
        ``final``, ``delta`` or ``scale``.
    given : list of float
        Its numbers.
    faces : tuple of str
        New boundaries.
    linked : list of int
        Directions that change so that the volume stays.
    """

    kind: str
    style: str = ""
    given: list[float] = field(default_factory=list)
    faces: tuple[str, ...] = ()
    linked: list[int] = field(default_factory=list)


@COMMANDS.register("change_box")
def _change_box(engine: Engine, words: Words) -> None:
    words.need(2, "change_box GROUP x final LO HI [boundary p p f] [remap]")
    world = engine.world
    box, bit = world.need_box(), world.bit(words.take("a group"))
    engine.report.screen("Changing box ...")
    operations = _read(words)
    scale = np.ones(3)
    if not words.done():
        words.expect("units")
        if words.choice(("box", "lattice"), "units") == "lattice":
            scale = world.lattice.spacing
    _settle(world)
    saved = box.lo.copy(), box.hi.copy()
    for one in operations:
        if one.kind in _AXES:
            _resize(box, one, scale)
            world.log(f"  {box_text(box)}")
        elif one.kind == "boundary":
            _reface(world, box, one.faces)
        elif one.kind != _UPRIGHT:
            if one.kind == "remap":
                _remap(world, bit, saved)
            saved = box.lo.copy(), box.hi.copy()
    _settle(world)


def _read(words: Words) -> list[_Operation]:
    """Read all operations."""
    made: list[_Operation] = []
    while not words.done() and words.peek() != "units":
        key = words.choice(_OPERATIONS, "operation")
        if key in _TILTED:
            msg = f"change_box {key}: a box that is tilted is not supported; use x, y and z"
            raise UnknownWordError(msg)
        if key == "boundary":
            made.append(_Operation(key, faces=read_faces(words)))
        elif key in _AXES:
            _read_size(key, words, made)
        elif key != "force":
            made.append(_Operation(key))
    if not made:
        msg = "change_box: no operation is given, such as 'x final LO HI'"
        raise InputError(msg)
    return made


def _read_size(key: str, words: Words, made: list[_Operation]) -> None:
    """Read how one direction changes."""
    style = words.choice(("final", "delta", "scale", "volume"), "style")
    if style == "scale":
        made.append(_Operation(key, style, [words.positive()]))
    elif style != "volume":
        made.append(_Operation(key, style, words.numbers(2)))
    else:
        last = made[-1] if made else _Operation("")
        if not last.style or len(last.linked) == _TWO or last.kind == key:
            msg = (
                f"change_box {key} volume: it must follow one change of another direction, at most "
                "twice"
            )
            raise InputError(msg)
        last.linked.append(_AXES.index(key))


def _settle(world: World) -> None:
    """Bring the particles into the box, and shrink-wrap it; those outside are lost."""
    state, box = world.state, world.need_box()
    state.row[: state.n, POSITION], turns = wrapped(box, state.row[: state.n, POSITION])
    state.image[: state.n] += turns
    before, lost = state.n, world.lost
    state.more.alive[:before] = 1
    apply_boundaries(world)
    if world.lost > lost:
        keep = state.more.alive[:before] != 0
        world.lists.keep_only(keep)
        state.take(np.flatnonzero(keep))
        world.warn(f"Lost atoms via change_box: original {before} current {state.n}")
    state.more.alive[:] = 1


def _resize(box: Box, one: _Operation, scale: Floats) -> None:
    """Change the length in one direction, and in those that keep the volume."""
    axis, volume = _AXES.index(one.kind), box.volume
    if one.style == "scale":
        _stretch(box, axis, one.given[0])
    else:
        low, high = (float(scale[axis]) * number for number in one.given)
        box.lo[axis] = low if one.style == "final" else box.lo[axis] + low
        box.hi[axis] = high if one.style == "final" else box.hi[axis] + high
    if not box.lo[axis] < box.hi[axis]:
        msg = f"change_box: {one.kind} from {box.lo[axis]:g} to {box.hi[axis]:g} m is no length"
        raise InputError(msg)
    if one.linked:
        _begin(box)
        factor = volume / box.volume
        for linked in one.linked:
            _stretch(box, linked, factor if len(one.linked) == _ONE else sqrt(factor))
    _begin(box)


def _begin(box: Box) -> None:
    """Take the box as a new one: shrink-wrapped faces get their clearance, as in LIGGGHTS."""
    box.least_lo, box.least_hi = box.lo.copy(), box.hi.copy()
    small = SMALL * (box.hi - box.lo)
    for axis, faces in enumerate(box.boundary):
        box.lo[axis] -= small[axis] if faces.startswith("s") else 0.0
        box.hi[axis] += small[axis] if faces.endswith("s") else 0.0


def _stretch(box: Box, axis: int, factor: float) -> None:
    """Change the length in one direction about the middle."""
    middle = 0.5 * (box.lo[axis] + box.hi[axis])
    box.lo[axis] = middle + factor * (box.lo[axis] - middle)
    box.hi[axis] = middle + factor * (box.hi[axis] - middle)


def _reface(world: World, box: Box, faces: Sequence[str]) -> None:
    """Give the box other boundaries; what is periodic no longer counts crossings."""
    for axis, face in enumerate(faces):
        if box.boundary[axis] == "pp" != face:
            world.state.image[: world.state.n, axis] = 0
    box.boundary = world.boundary = tuple(faces)
    _begin(box)


def _remap(world: World, bit: int, saved: tuple[Floats, Floats]) -> None:
    """Move the particles of a group with the box, from a saved one to that of now."""
    box, state = world.need_box(), world.state
    who = np.flatnonzero(world.member(bit))
    part = (1.0 / (saved[1] - saved[0])) * (state.row[who, POSITION] - saved[0])
    state.row[who, POSITION] = (box.hi - box.lo) * part + box.lo
