"""Groups of particles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownWordError, suggest
from minidem.kernels.columns import POSITION
from minidem.words import integer
from minidem.world.world import World

__all__ = ["set_group"]

_PARTS = 3  # of N:M:K
_OPERANDS = {"union": 1, "subtract": 2, "intersect": 2}


def set_group(world: World, name: str, style: str, words: Sequence[str]) -> None:
    """Add particles to a group as they are now.

    Raises
    ------
    InputError
        For an unknown style, region or group.
    """
    state = world.state
    masks = state.mask[: state.n]
    known = ("region", "type", "id", "union", "subtract", "intersect", "initialize")
    if style not in known:
        msg = f"unknown group style '{style}'{suggest(style, known)}"
        raise UnknownWordError(msg)
    if style == "region":
        if not words or words[0] not in world.regions:
            msg = f"Group region ID '{' '.join(words[:1])}' does not exist"
            raise InputError(msg)
        chosen = world.regions[words[0]].match(state.row[: state.n, POSITION])
    elif style in ("union", "subtract", "intersect"):
        if len(words) < _OPERANDS[style]:
            msg = f"group {name} {style} needs at least {_OPERANDS[style]} groups"
            raise InputError(msg)
        sets = [(masks & world.bit(word)) != 0 for word in words]
        chosen = sets[0].copy() if sets else np.zeros(state.n, bool)
        for other in sets[1:]:
            if style == "union":
                chosen |= other
            elif style == "subtract":
                chosen &= ~other
            else:
                chosen &= other
    elif style == "initialize":
        chosen = np.zeros(state.n, bool)
    else:
        values = state.kind[: state.n] + 1 if style == "type" else state.ids[: state.n]
        chosen = _in_ranges(values, words)
    bit = world.group_bit(name)
    masks[chosen] |= bit
    world.log(f"{int(((masks & bit) != 0).sum())} atoms in group {name}")


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
