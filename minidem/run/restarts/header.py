"""The header of restart files of LIGGGHTS: numbers that say what follows, each with its value."""

from __future__ import annotations

import re
from typing import Any, Final

import numpy as np

from minidem.errors import InputError
from minidem.run.restarts.binary import Reader, damaged
from minidem.run.restarts.liggghts_state import LiggghtsState
from minidem.world.settings import UNITS

__all__ = ["read_header"]

_VERSION: Final = re.compile(r"Version LIGGGHTS\S* (\d+)\.(\d+)")
_TEXTS: Final = {0: "version", 4: "units", 22: "style"}
_LONGS: Final = {5: "step", 23: "atoms", 25: "", 28: "", 31: "", 34: ""}  # 8 bytes; bonds unnamed
_SHORTS: Final = {
    1: "small", 2: "tag", 3: "big", 6: "dimension", 7: "processes",
    13: "periodic_x", 14: "periodic_y", 15: "periodic_z",
    16: "lower_x", 17: "upper_x", 18: "lower_y", 19: "upper_y", 20: "lower_z", 21: "upper_z",
    24: "types",
}  # fmt: skip
_REALS: Final = {37 + at: f"box_{at}" for at in range(6)}
_TILT: Final = 49  # and the next two: a box whose faces are not along the axes
_LAST: Final = 51
_SPHERES: Final = ("granular", "sphere")
_FACES: Final = "pfsm"


def read_header(reader: Reader, found: LiggghtsState) -> tuple[int, int, int]:
    """Take what the header says.

    Returns
    -------
    tuple of int
        How many processes and atoms there are, and bytes of an image flag.

    Raises
    ------
    InputError
        If it is damaged, or says what minidem does not have.
    """
    header = _entries(reader)
    _understand(header, found)
    return header["processes"], header["atoms"], header["tag"]


def _entries(reader: Reader) -> dict[str, Any]:
    """Return the entries of the header by name."""
    found: dict[str, Any] = {"big": 8, "tag": 4}
    while (key := reader.integer()) >= 0:
        if key in _TEXTS:
            found[_TEXTS[key]] = reader.text()
        elif key in _LONGS:
            found[_LONGS[key]] = reader.integer(found["big"])
        elif key > _LAST:
            damaged(f"entry {key} of its header is unknown")
        elif key < min(_REALS) or key in _SHORTS:
            found[_SHORTS.get(key, "")] = reader.integer()
        else:
            found[_REALS.get(key, "tilt" if key >= _TILT else "")] = reader.real()
        if found["big"] not in (4, 8) or found["tag"] not in (4, 8):
            damaged("whole numbers of this size do not occur")
    wanted = {*_TEXTS.values(), *_LONGS.values(), *_SHORTS.values(), *_REALS.values()} - {""}
    if missing := sorted(wanted - found.keys()):
        damaged(f"its header has no {missing[0]}")
    return found


def _understand(header: dict[str, Any], found: LiggghtsState) -> None:
    """Take what the header says; refuse what minidem does not have."""
    version = _VERSION.match(header["version"])
    if not version or int(version[1]) < 3:
        msg = f"restart files of '{header['version'][:60]}' cannot be read, those of LIGGGHTS 3 can"
        raise InputError(msg)
    if header["style"] not in _SPHERES:
        msg = f"restart file has atom_style {header['style'][:40]}; minidem has spheres only"
        raise InputError(msg)
    if "tilt" in header or header["dimension"] != 3:
        msg = "restart file has a tilted box or two dimensions; minidem has upright boxes in three"
        raise InputError(msg)
    if header["units"] not in UNITS:
        msg = f"restart file has units {header['units'][:40]}; minidem has {', '.join(UNITS)}"
        raise InputError(msg)
    found.version, found.units, found.step = header["version"], header["units"], header["step"]
    found.types = header["types"]
    corners = np.array([header[f"box_{at}"] for at in range(6)])
    found.lo, found.hi = corners[::2].copy(), corners[1::2].copy()
    sound = np.isfinite(corners).all() and (found.lo < found.hi).all()
    counts = (header["types"] > 0, header["processes"] > 0, header["atoms"] >= 0, found.step >= 0)
    if not sound or not all(counts):
        damaged("box or counts make no sense")
    faces = []
    for axis in "xyz":
        pair = header[f"lower_{axis}"], header[f"upper_{axis}"]
        if not all(0 <= face < len(_FACES) for face in pair):
            damaged(f"boundaries along {axis} make no sense")
        faces.append("".join(_FACES[face] for face in pair))
    found.boundary = tuple(faces)
