"""The numbers that contacts keep, in the order in which LIGGGHTS has them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from minidem.kernels.columns import (
    ADHESION,
    COHESION,
    LARGEST,
    LATEST,
    NORMAL,
    ROLLING,
    SLIDING_ONLY,
    TANGENTIAL,
    WITH_ROLLING,
)
from minidem.kernels.models import (
    EASO,
    EDINBURGH,
    EPSD,
    HISTORY,
    HOOKE_HYSTERESIS,
    LUDING,
    ROLL_LUDING,
    TAN_LUDING,
)

__all__ = ["BRIDGE", "PULL", "TORSION", "history_slots"]

BRIDGE: Final = -1
"""Whether there is a liquid bridge; every contact that is kept has one."""
PULL: Final = -2
"""The pull-off force of the pair of materials, N."""
TORSION: Final = -3
"""Of rolling friction ``luding``, which does not use it."""


def history_slots(switches: Sequence[int]) -> list[int]:
    """Return the columns of ``Pairs.hist`` that stand for the history values of LIGGGHTS.

    Parameters
    ----------
    switches : sequence of int
        Contact model, see `minidem.kernels.contact.records.Switches`; not ``thornton_ning``,
        whose history is kept in another form.

    Returns
    -------
    list of int
        A column per value; below zero `BRIDGE`, `PULL` or `TORSION`, which minidem does not keep.
    """
    normal, rolling = switches[NORMAL], switches[ROLLING]
    found: list[int] = []
    if normal >= HOOKE_HYSTERESIS:
        found.append(LARGEST)
    if normal >= EDINBURGH:
        found.append(LATEST)
    if normal >= LUDING:
        found += [ADHESION, PULL]
    if switches[COHESION] >= EASO:
        found.append(BRIDGE)
    if switches[TANGENTIAL] in (HISTORY, TAN_LUDING):
        found += range(SLIDING_ONLY)
    if rolling >= EPSD:
        found += range(SLIDING_ONLY, WITH_ROLLING)
    if rolling == ROLL_LUDING:
        found += [TORSION] * 3
    return found
