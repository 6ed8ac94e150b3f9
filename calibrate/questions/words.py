"""What would settle what the data do not determine, in words."""

from __future__ import annotations

from typing import Final

from liggghts_io.effects import EFFECTS

__all__ = ["undetermined_words"]

SETTLED_BY: Final = {
    "mu_pp": "a flat-bottomed drawdown box, for flow and two angles,",
    "mu_roll_pp": "a rotating drum at two speeds, or a heap of tall grains on a glued plate,",
    "mu_pw": "a tilting plate with a raft of grains glued together",
    "mu_roll_pw": "single grains on a tilting plate",
    "e_pp": "two grains that collide, filmed at high speed,",
    "e_pw": "single grains dropped on the plate, filmed at high speed,",
}
"""Experiments whose outcome depends on one parameter nearly alone."""


def undetermined_words(name: str) -> str:
    """Return the sentence for an unknown that the data do not determine.

    Parameters
    ----------
    name : str
        Of an unknown, with its instance in brackets where there are several.

    Examples
    --------
    >>> undetermined_words("mu_roll_pw")
    'mu_roll_pw: nothing in these data determines it; single grains on a tilting plate would.'
    """
    bare = name.partition("[")[0]
    remedy = SETTLED_BY.get(bare) or (EFFECTS[bare].settled_by if bare in EFFECTS else "")
    would = f"; {remedy} would" if remedy else ""
    return f"{name}: nothing in these data determines it{would}."
