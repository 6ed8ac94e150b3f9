"""What would settle what the data do not determine, in words."""

from __future__ import annotations

from typing import Final

from calibrate.inference.determined import nothing_said
from calibrate.inference.space import Space
from calibrate.study.model import Study

__all__ = ["remedies", "undetermined_words"]

_OF_CONTACT: Final = {
    "mu_pp": "a flat-bottomed drawdown box, for flow and two angles,",
    "mu_roll_pp": "a rotating drum at two speeds",
    "mu_pw": "a tilting plate with a raft of grains glued together",
    "mu_roll_pw": "single grains on a tilting plate",
    "e_pp": "two grains that collide, filmed at high speed,",
    "e_pw": "single grains dropped on the plate, filmed at high speed,",
}


def remedies(study: Study) -> dict[str, str]:
    """Return an experiment whose outcome depends on it nearly alone, by parameter or effect."""
    return _OF_CONTACT | {name: one.settled_by for name, one in study.layout.effects.items()}


def undetermined_words(study: Study, space: Space, name: str) -> str:
    """Return the sentence for an unknown that the data do not determine."""
    return nothing_said(space, space.index(name), remedies(study))
