"""``read_restart``: find the file, and tell whose it is."""

from __future__ import annotations

from pathlib import Path

from minidem.errors import InputError
from minidem.run.restarts.continued import continue_liggghts
from minidem.run.restarts.liggghts_file import is_liggghts
from minidem.run.restarts.own_file import read_own
from minidem.script.paths import CaseFolder, inside
from minidem.world.world import World

__all__ = ["read_restart"]

_HEAD = 64  # bytes that tell whose a file is
_STEP, _PROCESS, _BASE = "*", "%", "base"


def read_restart(world: World, name: str) -> None:
    """Take particles, box, groups and step from a restart file of minidem or of LIGGGHTS.

    Parameters
    ----------
    world : World
        A script before ``create_box``.
    name : str
        The file as the script names it. ``*`` stands for the highest step that there is a file of,
        ``%`` for the files of a run of LIGGGHTS that wrote one per process.

    Raises
    ------
    InputError
        If the file is missing, damaged or of another format.
    """
    if _STEP in name:
        name = _latest(world.root, name)
    first = name.replace(_PROCESS, _BASE, 1)
    if not is_liggghts(_read(world.root, first, _HEAD)):
        read_own(world, inside(world.root, first), first)
    elif _PROCESS in name:
        continue_liggghts(
            world,
            _read(world.root, first),
            lambda process: _read(world.root, name.replace(_PROCESS, str(process), 1)),
        )
    else:
        continue_liggghts(world, _read(world.root, first))


def _read(root: Path | CaseFolder, name: str, count: int = -1) -> bytes:
    """Return a file, or its first bytes."""
    try:
        with inside(root, name).open("rb") as file:
            return file.read(count)
    except OSError as err:
        msg = f"cannot read restart file '{name[:80]}': {err.strerror}"
        raise InputError(msg) from err


def _latest(root: Path | CaseFolder, name: str) -> str:
    """Return the name with the highest step for ``*`` that there is a file of."""
    folder, _, last = name.rpartition("/")
    begin, _, end = last.replace(_PROCESS, _BASE, 1).partition(_STEP)
    path = inside(root, folder or ".")
    try:
        names = [entry.name for entry in path.iterdir()]
    except OSError as err:
        msg = f"cannot search '{folder[:80]}' for restart files: {err.strerror}"
        raise InputError(msg) from err
    found = [
        one[len(begin) : len(one) - len(end)]
        for one in names
        if one.startswith(begin) and one.endswith(end) and len(one) > len(begin) + len(end)
    ]
    steps = [one for one in found if one.isdecimal() and one.isascii()]
    if not steps:
        msg = f"Found no restart file matching pattern '{name[:80]}'"
        raise InputError(msg)
    return name.replace(_STEP, max(steps, key=int), 1)
