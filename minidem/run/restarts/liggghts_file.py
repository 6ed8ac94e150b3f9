"""The binary restart files of LIGGGHTS 3, as plain arrays.

Such a file has, without names or padding, in the byte order of the machine:

- the header: pairs of a number, which says what follows, and a value, until -1;
- the groups, the masses of atom types, the styles of forces;
- the states of fixes: id, style, bytes;
- ids and styles of the fixes that keep something with each atom;
- per process of the run a block of numbers, in which each atom begins with their count, then has
  what every sphere has, and then what each of these fixes keeps, which begins with its own count.

Whole numbers within a block stand in the bytes of a float64. The layout is that of
``WriteRestart``, ``AtomVecSphere::pack_restart`` and ``Modify::write_restart`` of
LIGGGHTS-PUBLIC 3.8.0. Nothing in a file is trusted: counts are checked before memory is taken.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Final

import numpy as np

from minidem.errors import InputError
from minidem.run.restarts.binary import Reader, damaged
from minidem.run.restarts.header import read_header
from minidem.run.restarts.liggghts_state import Kept, LiggghtsState
from minidem.world.state import Floats, Ints

__all__ = ["is_liggghts", "parse_restart"]

_BEGIN: Final = struct.pack("<i", 0)  # the first header entry is the version
_X, _ID, _TYPE, _MASK, _IMAGE, _V, _RADIUS, _MASS, _DENSITY, _SPIN, _OWN = (
    1, 4, 5, 6, 7, 8, 11, 12, 13, 14, 17,
)  # fmt: skip
_MOST: Final = 2**31 - 1
_HUGE: Final = 1e100  # its square is still a number


def is_liggghts(head: bytes) -> bool:
    """Tell from the first bytes of a file, 64 or more, whether LIGGGHTS wrote it."""
    return head.startswith(_BEGIN) and b"Version LIGGGHTS" in head[:64]


def parse_restart(data: bytes, blocks: Callable[[int], bytes] | None = None) -> LiggghtsState:
    """Return what a restart file of LIGGGHTS says.

    Parameters
    ----------
    data : bytes
        The file; or, of a run that wrote a file per process, the one called ``base``.
    blocks : callable, optional
        Returns the file of a process; without it the blocks stand in `data`.

    Raises
    ------
    InputError
        If the file is cut or damaged, or of what minidem does not have.
    """
    reader = Reader(data)
    found = LiggghtsState()
    processes, atoms, tag = read_header(reader, found)
    _groups(reader, found)
    _forces(reader, found.types)
    kept = _fixes(reader, found)
    parts = []
    for process in range(processes):
        source = reader if blocks is None else Reader(blocks(process))
        parts.append(source.reals(source.integer()))
    found.block = np.concatenate(parts) if parts else np.zeros(0)
    _atoms(found, atoms, tag, kept)
    return found


def _groups(reader: Reader, found: LiggghtsState) -> None:
    """Read the groups; names that were deleted leave gaps."""
    count, bit = reader.integer(), 1
    while len(found.groups) < count and bit <= _MOST:
        length = reader.integer()
        if length:
            name = reader.raw(length)[:-1].decode("utf-8", errors="replace")
            found.groups[name] = bit
        bit *= 2
    if found.groups.get("all") != 1 or len(found.groups) != count:
        damaged("its groups make no sense")


def _forces(reader: Reader, types: int) -> None:
    """Go past masses of types and styles of forces; scripts give them again."""
    while reader.integer() >= 0:
        reader.raw(8 * types)
    while reader.integer() >= 0:
        style = reader.text()
        if style != "gran":
            msg = f"restart file has forces of style '{style[:40]}'; minidem has 'gran' only"
            raise InputError(msg)
        reader.raw(8 + 4 * (types * (types + 1) // 2))


def _fixes(reader: Reader, found: LiggghtsState) -> list[tuple[str, str]]:
    """Read the states of fixes; return id and style of those that keep something with atoms."""
    for _ in range(max(reader.integer(), 0)):
        name, style = reader.text(), reader.text()
        if style.startswith("multisphere"):
            msg = (
                f"restart file has clumps (fix {name[:40]} {style[:40]}); minidem has spheres only"
            )
            raise InputError(msg)
        data = reader.raw(reader.integer())
        whole = data[: len(data) // 8 * 8]
        found.fixes[name] = style, np.frombuffer(whole, "<f8").astype(np.float64)
    kept = []
    for _ in range(max(reader.integer(), 0)):
        kept.append((reader.text(), reader.text()))
        reader.integer()
    return kept


def _atoms(found: LiggghtsState, count: int, tag: int, kept: list[tuple[str, str]]) -> None:
    """Take the atoms out of the block."""
    block = found.block
    start = _chain(block, count)
    size = np.diff(np.append(start, len(block)))
    if (size < _OWN).any():
        damaged("atoms have too few numbers")
    whole = block.view(np.int64)

    def vectors(column: int) -> Floats:
        three: Floats = block[start[:, None] + column + np.arange(3)]
        return three

    found.position, found.velocity, found.omega = vectors(_X), vectors(_V), vectors(_SPIN)
    found.radius, found.mass, found.density = (
        block[start + column] for column in (_RADIUS, _MASS, _DENSITY)
    )
    found.ids, found.kind, found.mask = (whole[start + column] for column in (_ID, _TYPE, _MASK))
    found.image = _images(whole[start + _IMAGE], tag)
    if not _sound(found):
        damaged("values of atoms make no sense")
    at, end = start + _OWN, start + size
    for name, style in kept:
        if (at >= end).any():
            damaged(f"nothing is kept for fix {name}")
        length = _counts(block[at])
        if (length < 1).any() or (at + length > end).any():
            damaged(f"what fix {name} keeps with an atom has no end")
        found.kept[name] = Kept(style, at, length)
        at = at + length


def _chain(block: Floats, count: int) -> Ints:
    """Return where the atoms begin."""
    if count > len(block) // _OWN:
        damaged(f"it has no room for its {count} atoms")
    sizes = np.where(np.isfinite(block), block, 0.0)
    found, at = [], 0
    for _ in range(count):
        if at >= len(block) or sizes[at] < 1.0:
            damaged(f"it has fewer atoms than its {count}")
        found.append(at)
        at += int(sizes[at])
    if at != len(block):
        damaged(f"it has more than its {count} atoms")
    return np.array(found, np.int64)


def _counts(values: Floats) -> Ints:
    """Return whole numbers, 0 for what is none."""
    known = np.isfinite(values) & (values >= 0.0) & (values < _MOST)
    return np.where(known, values, 0.0).astype(np.int64)


def _images(packed: Ints, tag: int) -> Ints:
    """Return the crossings that LIGGGHTS packs into one number, shape (n, 3)."""
    bits = 10 if tag == 4 else 21
    zero, mask = 1 << (bits - 1), (1 << bits) - 1
    return np.stack([((packed >> (bits * axis)) & mask) - zero for axis in range(3)], axis=1)


def _sound(found: LiggghtsState) -> bool:
    """Tell whether particles can be what the file says."""
    numbers = (found.position, found.velocity, found.omega)
    positive = (found.radius, found.mass, found.density)
    return (
        all((np.abs(one) < _HUGE).all() for one in numbers)
        and all(((one > 0.0) & (one < _HUGE)).all() for one in positive)
        and bool(((found.kind >= 1) & (found.kind <= found.types)).all())
        and bool(((found.ids >= 1) & (found.ids <= _MOST)).all())
        and bool((np.diff(np.sort(found.ids)) > 0).all())
    )
