"""``read_data FILE [add]``: box and particles from a text file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.commands.creation import add_particles
from minidem.errors import InputError, suggest
from minidem.kernels.columns import MASS, OMEGA, RADIUS, VELOCITY
from minidem.memory import check_room
from minidem.output.data_file import check_columns_of_file
from minidem.record import field, record
from minidem.run.engine import Engine
from minidem.script.paths import inside
from minidem.words import Words, integer, number
from minidem.world.periodic import box_text, wrapped
from minidem.world.state import Box, Floats, Ints
from minidem.world.world import World

_ATOM, _FLAGGED, _VELOCITY = 7, 10, 7
"""Words of a line: id type diameter density x y z, with image flags, id vx vy vz wx wy wz."""
_SECTIONS = ("Atoms", "Velocities")
_BOUNDS = ("xlo xhi", "ylo yhi", "zlo zhi")
_COUNTS = ("atoms", "atom types")
_FOREIGN = re.compile(
    r"(bond|angle|dihedral|improper)|ellipsoids|lines|triangles|bodies|extra bond per atom"
)
_NUMBERS = 5  # diameter density x y z
_SHOWN = 5  # ids in a message
_EDGE = 1e-6  # of a periodic box, beyond which a particle may lie
_MOST_FLAG = 511  # crossings of a periodic face that LIGGGHTS keeps


@record
class _Data:
    """What a data file holds.

    Attributes
    ----------
    atoms, types : int
        Numbers of the header.
    bounds : ndarray, shape (2, 3)
        Lower and upper corner of the box, m.
    atom, velocity : list of list of str
        Lines of the sections, in words.
    """

    atoms: int = 0
    types: int = 0
    bounds: Floats = field(default_factory=lambda: np.array([[-0.5] * 3, [0.5] * 3]))
    atom: list[list[str]] = field(default_factory=list)
    velocity: list[list[str]] = field(default_factory=list)


class _Reader:
    """Reads a data file line by line.

    Parameters
    ----------
    path : Path
        The file.
    name : str
        Its name, as the script has it.
    """

    def __init__(self, path: Path, name: str) -> None:
        self.name = name
        self.at = 0
        try:
            text = path.read_text(encoding="utf-8", errors="replace")
        except OSError as err:
            msg = f"Cannot open file {name}: {err.strerror}"
            raise InputError(msg) from err
        self.lines = text.split("\n")

    def fail(self, what: str) -> NoReturn:
        """Raise an error that names the file and the line last read."""
        msg = f"{self.name}:{self.at}: {what}"
        raise InputError(msg)

    def next(self) -> str | None:
        """Return the next line without its comment; None at the end."""
        if self.at >= len(self.lines):
            return None
        self.at += 1
        return self.lines[self.at - 1].split("#", 1)[0].strip()

    def keyword(self) -> str:
        """Return the next line that is not empty, '' at the end."""
        while (line := self.next()) == "":
            pass
        return line or ""

    def rows(self, count: int, widths: Sequence[int], what: str) -> list[list[str]]:
        """Read the lines of a section; the first one says how many words each has."""
        self.next()  # the empty line below the title
        found: list[list[str]] = []
        width = 0
        for _ in range(count):
            line = self.next()
            if line is None:
                self.fail(f"the file ends after {len(found)} of {count} {what}")
            row = line.split()
            width = width or len(row)
            if width not in widths or len(row) < width:
                self.fail(f"{what} need {' or '.join(map(str, widths))} words, found {len(row)}")
            found.append(row[:width])
        return found

    def read(self) -> _Data:
        """Read the whole file."""
        data = _Data()
        self.next()  # a title
        title = self.header(data)
        while title:
            if title not in _SECTIONS:
                near = suggest(title[:40], _SECTIONS)
                self.fail(
                    f"section '{title[:40]}' is not supported{near} (known: Atoms, Velocities)"
                )
            if title == "Atoms":
                data.atom = self.rows(data.atoms, (_ATOM, _FLAGGED), "atoms")
            else:
                if not data.atom:
                    self.fail("Must read Atoms before Velocities")
                data.velocity = self.rows(data.atoms, (_VELOCITY,), "velocities")
            title = self.keyword()
        if data.atoms and not data.atom:
            self.fail("No atoms in data file")
        return data

    def header(self, data: _Data) -> str:
        """Read the header; return the title of the first section."""
        while line := self.keyword():
            words = line.split()
            foreign = _FOREIGN.search(line)
            bound = next((key for key in _BOUNDS if key in line), "")
            if foreign:
                if words[0] != "0":
                    self.fail(f"'{line[:40]}': the file is not of spheres")
            elif bound and len(words) >= 2:
                self._within(data.bounds, _BOUNDS.index(bound), words)
            elif "xy xz yz" in line:
                self.fail("a tilted box is not supported")
            elif _COUNTS[0] in line:
                data.atoms = self.whole(words[0], "atoms")
            elif _COUNTS[1] in line:
                data.types = self.whole(words[0], "atom types")
            else:
                return line
        return ""

    def _within(self, bounds: Floats, axis: int, words: Sequence[str]) -> None:
        lo, hi = self.value(words[0]), self.value(words[1])
        if not lo < hi:
            self.fail(f"Box bounds are invalid: {words[0]} is not below {words[1]}")
        bounds[:, axis] = lo, hi

    def whole(self, word: str, what: str) -> int:
        """Return a word as a whole number that is not negative."""
        try:
            found = integer(word, what)
        except InputError as err:
            self.fail(str(err))
        if found < 0:
            self.fail(f"{what}: {found} is negative")
        return found

    def value(self, word: str) -> float:
        """Return a word as a number."""
        try:
            return number(word, "data file")
        except InputError as err:
            self.fail(str(err))


@COMMANDS.register("read_data")
def _read_data(engine: Engine, words: Words) -> None:
    words.need(1, "read_data FILE [add]")
    world = engine.world
    name = words.take("a file")
    add = not words.done() and words.choice(("add", "fix"), "option") == "add"
    if not add and not words.done():
        msg = "read_data: sections for fixes are not supported; leave out 'fix ID ...'"
        raise InputError(msg)
    if (world.box is not None) != add:
        msg = (
            "read_data add needs a box; use create_box or read_data first" if add
            else "Cannot read_data after simulation box is defined; use 'read_data FILE add'"
        )  # fmt: skip
        raise InputError(msg)
    if add:
        name = name.replace("*", str(world.step), 1)
    check_columns_of_file(world, "read_data")
    reader = _Reader(inside(world.root, name), name)
    data = reader.read()
    check_room(data.atoms, world.state.n, f"read_data {name}")
    if add:
        _check_types(reader, world.types, data)
    else:
        _make_box(reader, world, data)
    _add(reader, world, data)
    world.log(f"  {world.state.n} atoms")
    if data.velocity:
        world.log(f"  {len(data.velocity)} velocities")


def _check_types(reader: _Reader, types: int, data: _Data) -> None:
    if data.types > types:
        reader.fail(f"Data file contains more atom types ({data.types}) than the box has ({types})")


def _make_box(reader: _Reader, world: World, data: _Data) -> None:
    """Make the box that the header describes."""
    if data.types < 1:
        reader.fail("the header gives no 'atom types'")
    world.types = data.types
    world.step = 0
    lo, hi = data.bounds
    world.box = Box(lo.copy(), hi.copy(), world.boundary, lo.copy(), hi.copy())
    world.log(f"  {box_text(world.box)}")


def _add(reader: _Reader, world: World, data: _Data) -> None:
    """Add the particles of the file to the world."""
    if not data.atom:
        return
    box, state = world.need_box(), world.state
    ids = np.array([reader.whole(name, "atom id") for name, *_ in data.atom])
    kind = np.array([reader.whole(word, "atom type") for _, word, *_ in data.atom])
    numbers = [[reader.value(word) for word in words[:_NUMBERS]] for _, _, *words in data.atom]
    # atom_style hybrid has the places in front of the diameter
    turned = np.roll(np.array(numbers), 2 if world.hybrid else 0, axis=1)
    diameter, density, x, y, z = turned.T
    if len(set(ids.tolist())) < len(ids) or ids.min() <= state.top_id:
        reader.fail("an atom id is not above zero, given twice, or in use already")
    if kind.min() < 1 or kind.max() > world.types:
        reader.fail(f"an atom type is not between 1 and {world.types}")
    if diameter.min() < 0.0 or density.min() <= 0.0:
        reader.fail("a diameter is negative, or a density not above zero")
    position, turns = wrapped(box, np.stack([x, y, z], axis=1))
    shift = box.period() * _EDGE
    inside = (position >= box.lo - shift).all(axis=1) & (position < box.hi + shift).all(axis=1)
    if not inside.all():
        lost = ids[~inside].tolist()[:_SHOWN]
        reader.fail(f"Did not assign all atoms correctly: {lost} lie outside of the box")
    at = add_particles(world, position, kind, (0.5 * diameter, density))
    radius = state.row[at, RADIUS]
    # left to right, as LIGGGHTS multiplies
    mass = 4.0 * np.pi / 3.0 * radius * radius * radius * density
    state.row[at, MASS] = np.where(radius == 0.0, density, mass)
    state.ids[at] = ids
    state.image[at] = turns + _flags(reader, data)
    _set_velocities(reader, world, at, data)


def _flags(reader: _Reader, data: _Data) -> Ints:
    """Return the image flags of the file, shape (n, 3)."""
    if len(data.atom[0]) == _ATOM:
        return np.zeros((len(data.atom), 3), np.int64)
    try:
        found = np.array([[integer(word, "flag") for word in row[_ATOM:]] for row in data.atom])
    except InputError as err:
        reader.fail(str(err))
    if np.abs(found).max() > _MOST_FLAG:
        reader.fail(f"an image flag is beyond {_MOST_FLAG}")
    return found


def _set_velocities(reader: _Reader, world: World, at: slice, data: _Data) -> None:
    """Give the new particles the velocities of the file."""
    if not data.velocity:
        return
    state = world.state
    place = {int(name): at.start + i for i, name in enumerate(state.ids[at])}
    for name, *words in data.velocity:
        where = place.get(reader.whole(name, "atom id"))
        if where is None:
            reader.fail(f"Invalid atom ID in Velocities section of data file: {name}")
        state.row[where, VELOCITY], state.spin[where, OMEGA] = np.array(
            [reader.value(word) for word in words]
        ).reshape(2, 3)
