"""``info``: what a script has set up so far, as text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from minidem.world.world import World

__all__ = ["CATEGORIES", "info_text"]


def info_text(world: World, wanted: Sequence[str]) -> str:
    """Return the lines of some of the `CATEGORIES`; empty for those that minidem has none of."""
    parts = ["\n".join([*CATEGORIES[name](world), ""]) for name in wanted]
    return "\n".join(part for part in parts if part.strip())


def _group_of(world: World, bit: int) -> str:
    return next((name for name, one in world.groups.items() if one == bit), "?")


def _system(world: World) -> list[str]:
    lines = [
        "System information:", f"Units      = {world.materials.units}", "Atom style = sphere",
        f"Atoms = {world.state.n},  types = {world.types},  style = gran", "", "Dimensions = 3",
    ]  # fmt: skip
    box = world.box
    if box is None:
        return [*lines, "Box has not yet been created"]
    size = " x ".join(f"{b - a:g}" for a, b in zip(box.lo, box.hi, strict=True))
    faces = " ".join(",".join(both) for both in box.boundary)
    return [
        *lines, f"Orthogonal box = {size}", f"Boundaries = {faces}",
        *(
            f"{c}lo, {c}hi = {a:g}, {b:g}"
            for c, a, b in zip("XYZ", box.lo, box.hi, strict=True)
        ),
    ]  # fmt: skip


def _groups(world: World) -> list[str]:
    names = [f"Group[{k:2}]: {name} " for k, name in enumerate(world.groups)]
    return ["Group information:", *names]


def _regions(world: World) -> list[str]:
    names = [f"Region[{k:3}]: {name}" for k, name in enumerate(world.regions)]
    return ["Region information:", *names]


def _computes(world: World) -> list[str]:
    lines = [
        f"Compute[{k:3}]: {name},  style = {one.style},  group = {_group_of(world, one.bit)}"
        for k, (name, one) in enumerate(world.computes.items())
    ]
    return ["Compute information:", *lines]


def _dumps(world: World) -> list[str]:
    lines = [
        f"Dump[{k:3}]: {name},  file = {one.path},  style = {one.style},  "
        f"group = {_group_of(world, one.bit)},  every = {one.schedule.every}"
        for k, (name, one) in enumerate(world.dumps.items())
    ]
    return ["Dump information:", *lines]


def _fixes(world: World) -> list[str]:
    lines = [
        f"Fix[{k:3}]: {name},  style = {one.style},  group = {_group_of(world, one.bit)}"
        for k, (name, one) in enumerate(world.fixes.items())
    ]
    return ["Fix information:", *lines]


def _variables(world: World) -> list[str]:
    known = world.interpreter.variable_styles()
    lines = [
        f"Variable[{k:3}]: {name:<10}  style = {style}"
        for k, (name, style) in enumerate(known.items())
    ]
    return ["Variable information:", *lines]


def _nothing(world: World) -> list[str]:
    """Return no lines: about the program itself there is nothing that a script needs."""
    del world
    return []


CATEGORIES: Final[dict[str, Callable[[World], list[str]]]] = {
    "configuration": _nothing,
    "communication": _nothing,
    "system": _system,
    "groups": _groups,
    "regions": _regions,
    "computes": _computes,
    "dumps": _dumps,
    "fixes": _fixes,
    "variables": _variables,
    "time": _nothing,
}
"""What may be asked for, in the order of LIGGGHTS."""
