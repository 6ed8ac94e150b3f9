"""Groups of particles."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError
from minidem.kernels.columns import POSITION
from minidem.words import integer, one_of
from minidem.world.world import World

__all__ = ["set_group"]

_PARTS = 3  # of N:M:K
_OPERANDS = {"union": 1, "subtract": 2, "intersect": 2}
_NUMBERED = ("type", "id")
_STYLES = ("region", *_NUMBERED, "variable", *_OPERANDS, "initialize", "delete")
_ORDERS: dict[str, Callable[[Any, int], Any]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq,
}  # fmt: skip
_BETWEEN = "<>"


def set_group(world: World, name: str, style: str, words: Sequence[str]) -> None:
    """Add particles to a group as they are now, or delete it.

    Raises
    ------
    InputError
        For an unknown style, region, variable or group.
    """
    world.need_box()
    one_of(style, _STYLES, "group style")
    if style == "delete":
        _delete(world, name)
        return
    chosen = _chosen(world, f"group {name} {style}", style, words)
    bit = world.group_bit(name)
    masks = world.state.mask[: world.state.n]
    masks[chosen] |= bit
    if style == "subtract":  # what was in the group before goes as well
        for word in words[1:]:
            masks[(masks & world.bit(word)) != 0] &= ~bit
    world.log(f"{int(((masks & bit) != 0).sum())} atoms in group {name}")


def _chosen(world: World, what: str, style: str, words: Sequence[str]) -> NDArray[np.bool_]:
    """Return which particles are meant."""
    state = world.state
    if style in ("region", "variable", "initialize") and len(words) != (style != "initialize"):
        msg = f"{what}: expected {'one name' if style != 'initialize' else 'nothing'} behind it"
        raise InputError(msg)
    if style == "region":
        if words[0] not in world.regions:
            msg = f"Group region ID '{words[0][:40]}' does not exist"
            raise InputError(msg)
        inside: NDArray[np.bool_] = world.regions[words[0]].match(state.row[: state.n, POSITION])
        return inside
    if style == "variable":
        return _by_variable(world, what, words[0])
    if style in _OPERANDS:
        return _combined(world, what, style, words)
    if style == "initialize":
        return np.zeros(state.n, bool)
    values = state.kind[: state.n] + 1 if style == "type" else state.ids[: state.n]
    if not words:
        msg = f"{what}: expected numbers, ranges N:M:K or a comparison such as < 5"
        raise InputError(msg)
    if words[0] in (*_ORDERS, _BETWEEN, "!="):
        return _compared(values, what, words)
    return _in_ranges(values, words)


def _by_variable(world: World, what: str, name: str) -> NDArray[np.bool_]:
    """Return where a variable of style atom is not zero."""
    if world.interpreter.variable_style(name) not in ("atom", "atomfile"):
        msg = f"{what}: '{name[:40]}' is no variable of style atom"
        raise InputError(msg)
    found: NDArray[np.bool_] = world.interpreter.atom_values(name) != 0.0
    return found


def _combined(world: World, what: str, style: str, words: Sequence[str]) -> NDArray[np.bool_]:
    """Return the particles of a union, intersection or difference of groups."""
    if len(words) < _OPERANDS[style]:
        msg = f"{what} needs at least {_OPERANDS[style]} groups"
        raise InputError(msg)
    sets = [world.member(world.bit(word)) for word in words]
    found: NDArray[np.bool_]
    if style == "union":
        found = np.logical_or.reduce(sets)
    elif style == "intersect":
        found = np.logical_and.reduce(sets)
    else:
        found = sets[0] & ~np.logical_or.reduce(sets[1:])
    return found


def _compared(values: NDArray[Any], what: str, words: Sequence[str]) -> NDArray[np.bool_]:
    """Return which values fulfil ``< 5`` or lie in ``<> 3 5``, both bounds included."""
    if words[0] == "!=":
        msg = f"{what} !=: LIGGGHTS 3.8.0 takes these that are equal; use 'subtract all GROUP'"
        raise InputError(msg)
    wanted = 2 if words[0] == _BETWEEN else 1
    if len(words) != 1 + wanted:
        msg = f"{what} {words[0]}: expected {wanted} whole number{'s' * (wanted > 1)} behind it"
        raise InputError(msg)
    low, *high = (integer(word, f"{what} {words[0]}") for word in words[1:])
    found: NDArray[np.bool_]
    found = (values >= low) & (values <= high) if high else _ORDERS[words[0]](values, low)
    return found


def _delete(world: World, name: str) -> None:
    """Take a group away that nothing uses."""
    bit = world.bit(name)
    if name == "all":
        msg = "Cannot delete group all"
        raise InputError(msg)
    for kind, table in (("fix", world.fixes), ("compute", world.computes), ("dump", world.dumps)):
        user = next((one for one, found in table.items() if found.bit == bit), None)
        if user is not None:
            msg = f"group {name} is used by {kind} {user}; 'un{kind} {user}' first"
            raise InputError(msg)
    world.state.mask[: world.state.n] &= ~bit
    del world.groups[name]


def _in_ranges(values: NDArray[Any], words: Sequence[str]) -> NDArray[np.bool_]:
    """Return which values are in ``3``, ``2:5`` or ``1:9:2``."""
    found = np.zeros(len(values), bool)
    for word in words:
        parts = [integer(part, "expected N, N:M or N:M:K") for part in word.split(":")]
        if len(parts) > _PARTS or parts[2:] == [0]:
            msg = f"expected N, N:M or N:M:K with K above zero, found '{word[:40]}'"
            raise InputError(msg)
        first, last, step = parts[0], parts[min(1, len(parts) - 1)], ([*parts, 1, 1, 1])[2]
        if len(parts) == 1:
            last, step = first, 1
        elif len(parts) == 2:
            step = 1
        found |= (values >= first) & (values <= last) & ((values - first) % step == 0)
    return found
