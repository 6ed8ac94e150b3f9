"""One set of names and units for the columns of grains, however they were dumped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import prod
from typing import Final

import numpy as np
import numpy.typing as npt
import pandas as pd

from liggghts_io.errors import CaseError, DamagedFile, nearest

FloatArray = npt.NDArray[np.float64]

SI: Final = "si"
UNITS: Final[dict[str, tuple[float, float, float]]] = {
    SI: (1.0, 1.0, 1.0),
    "cgs": (1e-2, 1e-3, 1.0),
    "lj": (1.0, 1.0, 1.0),
    "micro": (1e-6, 1e-15, 1e-6),
    "nano": (1e-9, 1e-21, 1e-9),
}
"""Systems of LIGGGHTS: metres of its length, kilograms of its mass and seconds of its time; `lj`
has no units."""

_LENGTH, _SPEED, _SPIN = (1, 0, 0), (1, 0, -1), (0, 0, -1)
_FORCE, _TORQUE, _MASS, _DENSITY = (1, 1, -2), (2, 1, -2), (0, 1, 0), (-3, 1, 0)
_POWERS: Final[dict[str, tuple[int, int, int]]] = {
    **dict.fromkeys(("x", "y", "z", "radius", "diameter"), _LENGTH),
    **dict.fromkeys(("vx", "vy", "vz", "speed"), _SPEED),
    **dict.fromkeys(("omegax", "omegay", "omegaz"), _SPIN),
    **dict.fromkeys(("fx", "fy", "fz"), _FORCE),
    **dict.fromkeys(("tqx", "tqy", "tqz"), _TORQUE),
    "mass": _MASS,
    "density": _DENSITY,
}
"""Powers of length, mass and time of the columns whose meaning is known."""
_NAMED: Final = {
    _LENGTH: "m", _SPEED: "m/s", _SPIN: "rad/s", _FORCE: "N", _TORQUE: "N m", _MASS: "kg",
    _DENSITY: "kg/m3",
}  # fmt: skip
_VECTORS: Final = {
    "v": "v", "u": "v", "velocity_lin": "v", "velocity": "v", "linvelvec": "v", "f": "f",
    "force": "f", "omega": "omega", "velocity_ang": "omega", "angularvelocity": "omega",
    "angvelvec": "omega", "tq": "tq", "torque": "tq", "i": "i", "x": "",
}  # fmt: skip
"""Arrays of three numbers in VTK files of LIGGGHTS, MercuryDPM, YADE and OpenFOAM, in small
letters, and what their columns begin with."""
_OTHER_NAMES: Final = {
    "radii": "radius", "Radius": "radius", "Diameter": "diameter", "Mass": "mass",
    "Density": "density", "xu": "x", "yu": "y", "zu": "z",
}  # fmt: skip
_OF_OPENFOAM: Final = {"d": "diameter", "rho": "density"}
"""Names of its clouds; too short to mean that beside sizes under another name."""
_SCALED: Final = (("xs", "ys", "zs"), ("xsu", "ysu", "zsu"))
_WHOLE: Final = frozenset(("id", "type", "mol", "proc", "ix", "iy", "iz"))
_MOST_WHOLE: Final = 2.0**53  # from here on not every whole number is a floating point one


def unit_of(column: str, units: str) -> str:
    """Return the unit in which a column is given, "-" for a number, "" where nobody knows."""
    if column in _WHOLE:
        return "-"
    powers = _POWERS.get(column)
    return _NAMED[powers] if powers is not None and units != "lj" else ""


def checked_units(word: str, place: str = "") -> str:
    """Return a system of units that is known.

    Parameters
    ----------
    word : str
    place : str
        The file that says it, if one does.

    Raises
    ------
    CaseError
        For another one, with the nearest.
    """
    if word not in UNITS:
        where, remedy = (f"{place}: ", "; --units NAME says which they are") if place else ("", "")
        msg = f"{where}units {word!r}: cannot be converted{nearest(word, list(UNITS))}{remedy}"
        raise CaseError(msg)
    return word


def split_vectors(arrays: Mapping[str, FloatArray]) -> pd.DataFrame:
    """Return arrays (n,) and (n, k) of grains as columns, vectors by their components."""
    columns: dict[str, FloatArray] = {}
    for name, values in arrays.items():
        if values.ndim == 1:
            columns[name] = values
            continue
        stem = _VECTORS.get(name.lower())
        if f"{stem}x" in columns:
            stem = None  # two arrays may mean the same
        for k, part in enumerate(values.T):
            axis = "xyz"[k] if values.shape[1] == len("xyz") else str(k + 1)
            columns[f"{name}_{axis}" if stem is None else f"{stem}{axis}"] = part
    return pd.DataFrame(columns)


def in_si(grains: pd.DataFrame, units: str, box: FloatArray | None = None) -> pd.DataFrame:
    """Return grains with the names of `dump custom` and in SI units.

    Parameters
    ----------
    grains : DataFrame
        As they stand in a file.
    units : str
        System of units of the file.
    box : (n, 3, 4) float64, optional
        Corner of the box of each grain and its edges, in columns, to which scaled coordinates
        refer.

    Returns
    -------
    DataFrame
        Whole numbers are such; columns of unknown meaning, such as `c_1`, stay as they are.
    """
    columns = {str(name): grains[name].to_numpy() for name in grains}
    if box is not None:
        columns |= _unscaled(columns, box)
    _rename(columns, _OTHER_NAMES)
    if not {"radius", "diameter"} & set(columns):
        _rename(columns, _OF_OPENFOAM)
    for name, values in columns.items():
        factor = _factor(name, units)
        if factor != 1.0:
            columns[name] = values * factor
        elif name in _WHOLE and _are_whole(values):
            columns[name] = values.astype(np.int64)
    return pd.DataFrame(columns)


def _rename(columns: dict[str, FloatArray], names: Mapping[str, str]) -> None:
    """Give columns their other names, unless there are columns of these already."""
    for old, new in names.items():
        if old in columns and new not in columns:
            columns[new] = columns.pop(old)


def _are_whole(values: FloatArray) -> bool:
    return not np.mod(values, 1.0).any() and bool((np.abs(values) < _MOST_WHOLE).all())


def check_ids(grains: pd.DataFrame, place: str) -> None:
    """Refuse a frame in which a grain stands twice.

    Raises
    ------
    DamagedFile
        With the first id that is there twice; 0 is none.
    """
    if "id" not in grains or grains["id"].is_unique:
        return
    ids = grains["id"][grains["id"] != 0]
    twice = ids[ids.duplicated()]
    if len(twice):
        msg = f"{place}: the id {twice.iloc[0]:g} stands there twice; take one of the rows out"
        raise DamagedFile(msg)


def _factor(name: str, units: str) -> float:
    powers = _POWERS.get(name, (0, 0, 0))
    return prod(unit**power for unit, power in zip(UNITS[units], powers, strict=True))


def _unscaled(columns: Mapping[str, FloatArray], box: FloatArray) -> dict[str, FloatArray]:
    """Return coordinates from those that are parts of the edges of the box."""
    found = {}
    for names in _SCALED:
        for axis, name in enumerate("xyz"):
            # In a tilted box x depends on the others, too.
            needed = [k for k in range(3) if k == axis or box[:, axis, 1 + k].any()]
            if name not in columns and all(names[k] in columns for k in needed):
                parts = [columns[names[k]] * box[:, axis, 1 + k] for k in needed]
                found[name] = np.asarray(box[:, axis, 0] + sum(parts))
    return found


def sizes_of(grains: pd.DataFrame, diameter: float | None, place: str) -> pd.Series:
    """Return the radii of grains [m].

    Parameters
    ----------
    grains : DataFrame
    diameter : float, optional
        Of all grains [m], for a dump without sizes.
    place : str
        Name of the dump, for the message.

    Raises
    ------
    CaseError
        If the dump has no sizes and none is given, or one is not positive.
    """
    if "radius" in grains:
        radius = grains["radius"]
    elif "diameter" in grains:
        radius = grains["diameter"] / 2.0
    elif diameter is not None:
        radius = pd.Series(diameter / 2.0, index=grains.index, dtype=np.float64)
    else:
        msg = f"{place}: no column radius or diameter; give the grains' diameter with --diameter M"
        raise CaseError(msg)
    if (radius <= 0.0).any():
        msg = f"{place}: a radius of {radius.min():g} m, which is not positive; take its row out"
        raise CaseError(msg)
    return radius


def missing_of(grains: pd.DataFrame, needed: Sequence[str]) -> list[str]:
    """Return the columns that are asked for and not there."""
    return [name for name in needed if name not in grains]
