"""Values per particle: the columns of a dump, and what formulas and computes ask for by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownNameError, suggest
from minidem.kernels.columns import (
    FX,
    FY,
    FZ,
    MASS,
    POSITION,
    RADIUS,
    TX,
    TY,
    TZ,
    VX,
    VY,
    VZ,
    WX,
    WY,
    WZ,
    X,
    Y,
    Z,
)
from minidem.registry import Registry
from minidem.words import integer, one_of
from minidem.world.fix import all_fixes
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = [
    "COLUMNS",
    "Column",
    "atom_vector",
    "check_columns",
    "column",
    "is_whole",
    "split_indices",
]

Values = Callable[[World], NDArray[Any]]

_PREFIXES = ("c_", "f_", "v_")
_OF_FORMULAS = ("r",)  # no columns
_SHOWN = 40  # characters of a word that a message shows


class Column(NamedTuple):
    """A column.

    Attributes
    ----------
    values : callable
        Returns one value per particle in the internal order, shape (n,).
    whole : bool
        Whether they are whole numbers.
    """

    values: Values
    whole: bool = False


COLUMNS: Registry[Column] = Registry("dump column")
"""Name to column; computes, fixes and variables come on top of them."""


def column(*names: str, whole: bool = False) -> Callable[[Values], Values]:
    """Return a decorator that makes a function of the world a column."""

    def enter(values: Values) -> Values:
        COLUMNS.register(*names)(Column(values, whole))
        return values

    return enter


def is_whole(name: str) -> bool:
    """Return True for a column of whole numbers."""
    return name in COLUMNS and COLUMNS[name].whole


def check_columns(
    words: Sequence[str], more: Sequence[str] = (), *, without: Sequence[str] = (),
    what: str = "dump column",
) -> tuple[str, ...]:  # fmt: skip
    """Return the names of columns if all are known.

    Parameters
    ----------
    words : sequence of str
        The names.
    more, without : sequence of str
        Further ones that the command has, and those that it does not have.
    what : str
        What they are, for messages.

    Raises
    ------
    InputError
        With the nearest known name.
    """
    known = [name for name in (*COLUMNS, *more) if name not in (*_OF_FORMULAS, *without)]
    for word in words:
        if word not in known and word[:2] not in _PREFIXES:
            msg = f"unknown {what} '{word[:_SHOWN]}'{suggest(word[:_SHOWN], known)}"
            raise InputError(msg)
    return tuple(words)


def split_indices(word: str, least: int = 1) -> tuple[str, tuple[int, ...]]:
    """Split ``f_ID[1][2]`` into name and indices, from `least` on.

    Raises
    ------
    InputError
        If what stands in brackets is no whole number, or too low.

    Examples
    --------
    >>> split_indices("c_sum[3]")
    ('c_sum', (3,))
    """
    base, *rest = word.split("[")
    if not all(part.endswith("]") for part in rest):
        msg = f"'{word[:40]}': expected NAME or NAME[1]"
        raise InputError(msg)
    indices = tuple(integer(part[:-1], f"index of '{word[:40]}'") for part in rest)
    if any(index < least for index in indices):
        msg = f"'{word[:40]}': indices count from 1"
        raise InputError(msg)
    return base, indices


def atom_vector(world: World, name: str) -> Floats:
    """Return one value per particle, in the internal order.

    Parameters
    ----------
    world : World
        What is asked about.
    name : str
        A column, ``c_ID``, ``c_ID[i]``, ``f_ID`` or ``v_NAME``.

    Raises
    ------
    UnknownNameError
        For an unknown name.
    """
    if name in COLUMNS:
        return np.array(COLUMNS[name].values(world), np.float64)
    mask, parenthesis, inside = name.partition("(")
    if parenthesis:
        return _masked(world, mask, inside.removesuffix(")").split(","))
    if name.startswith("v_"):
        values: Floats = world.interpreter.atom_values(name[2:])
        return values
    base, indices = split_indices(name, least=0)  # [0] is the whole of a vector
    if base.startswith("c_") and base[2:] in world.computes:
        per_atom: Floats = world.computes[base[2:]].per_atom(world, indices[0] if indices else 0)
        return per_atom
    if base.startswith("f_"):
        for fix in all_fixes(world):
            found = fix.per_atom(world, name[2:])
            if found is not None:
                return found
    raise UnknownNameError(_why_not(world, name))


def _why_not(world: World, name: str) -> str:
    """Return why a name has no values per particle."""
    base, _ = split_indices(name, least=0)
    kind, known = {
        "c_": ("compute", tuple(world.computes)), "f_": ("fix", tuple(world.fixes)),
    }.get(base[:2], ("column", tuple(COLUMNS)))  # fmt: skip
    wanted = base[2:] if kind != "column" else base
    if kind == "fix" and wanted in known:
        style = world.fixes[wanted].style
        return f"'{name[:40]}': fix {wanted[:40]} ({style}) has no values per particle"
    return f"'{name[:40]}': there is no {kind} '{wanted[:40]}'{suggest(wanted, known)}"


def _masked(world: World, mask: str, args: Sequence[str]) -> Floats:
    """Return 1 for the particles of a group (``gmask``), a region (``rmask``) or both."""
    member = np.ones(world.state.n, bool)
    if mask != "rmask":
        member &= world.member(world.bit(args[0]))
    if mask != "gmask":
        region = one_of(args[-1], tuple(world.regions), "region")
        member &= world.regions[region].match(world.state.row[: world.state.n, POSITION])
    return member.astype(np.float64)


# -- the columns -----------------------------------------------------------------------------------


def _register(array: str, columns: Mapping[str, int], *, whole: bool = False) -> None:
    """Make the columns of an array of `State` known."""
    for name, at in columns.items():
        column(name, whole=whole)(partial(_of_state, array, at))


def _of_state(array: str, at: int, world: World) -> NDArray[Any]:
    found: NDArray[Any] = getattr(world.state, array)[: world.state.n, at]
    return found


_register(
    "row", {"x": X, "y": Y, "z": Z, "radius": RADIUS, "vx": VX, "vy": VY, "vz": VZ, "mass": MASS}
)
_register("force", {"fx": FX, "fy": FY, "fz": FZ, "tqx": TX, "tqy": TY, "tqz": TZ})
_register("spin", {"omegax": WX, "omegay": WY, "omegaz": WZ})
_register("image", {"ix": X, "iy": Y, "iz": Z}, whole=True)
column("r")(COLUMNS["radius"].values)


@column("id", whole=True)
def _id(world: World) -> NDArray[np.int64]:
    return world.state.ids[: world.state.n]


@column("type", whole=True)
def _type(world: World) -> NDArray[np.int32]:
    return world.state.kind[: world.state.n] + np.int32(1)


@column("density")
def _density(world: World) -> Floats:
    return world.state.density[: world.state.n]


@column("diameter")
def _diameter(world: World) -> Floats:
    found: Floats = 2.0 * world.state.row[: world.state.n, RADIUS]
    return found


def _unwrapped(c: int, world: World) -> Floats:
    return world.unwrapped()[:, c]


def _scaled(c: int, world: World) -> Floats:
    """Return positions as parts of the box."""
    box = world.need_box()
    # the inverse first, so that the last digit is that of LIGGGHTS
    found: Floats = (world.state.row[: world.state.n, c] - box.lo[c]) * (
        1.0 / (box.hi[c] - box.lo[c])
    )
    return found


def _scaled_unwrapped(c: int, world: World) -> Floats:
    """Return positions as parts of the box, with the boxes that they have passed."""
    found: Floats = _scaled(c, world) + world.state.image[: world.state.n, c]
    return found


for _c, _axis in enumerate("xyz"):
    column(f"{_axis}u")(partial(_unwrapped, _c))
    column(f"{_axis}su")(partial(_scaled_unwrapped, _c))
    column(f"{_axis}s")(partial(_scaled, _c))
