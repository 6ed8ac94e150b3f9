"""What fixes get of a restart file: what it has for them, once the script has given them again."""

from __future__ import annotations

from minidem.world.fix import all_fixes
from minidem.world.world import World

__all__ = ["apply_restart"]


def apply_restart(world: World, *, last: bool = True) -> None:
    """Hand the states of a restart file to the fixes that the script has given again.

    Parameters
    ----------
    world : World
        State of the running script.
    last : bool
        True at the beginning of a run: what has found no fix until then is forgotten.

    Raises
    ------
    InputError
        If a mesh has another number of triangles than in the restart file, or its contacts another
        history than the contact model.
    """
    restored = world.restored
    if restored is None:
        return
    restored.rest(world, last)
    if last:
        world.restored = None
    for fix in all_fixes(world):
        saved = restored.fixes.get(fix.name)
        if saved is not None and saved["style"] == fix.style:
            if saved["state"]:
                fix.restore(saved["state"])
            del restored.fixes[fix.name]
