"""All hypotheses of a board after the data: none, every cause, the pairs that count, unknown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from calibrate.causes.candidates import Board
from calibrate.causes.weighing.cloud import Cloud
from calibrate.causes.weighing.hypotheses import Weighed
from calibrate.causes.weighing.modes import Mode

__all__ = ["Effort", "Evidences", "without"]


@dataclass(frozen=True, eq=False)
class Evidences:
    """Hypotheses after the data.

    Attributes
    ----------
    board : Board
    cloud : Cloud
        Draws that all of them share.
    weighed : mapping
        By the names of the members; () is the base model, slabs have names of their own.
    bases : tuple of Mode
        Of the base model, the best first.
    doubts : mapping
        Log evidences of a hypothesis with the doubt about a member's answer alone in its place, a
        number for each member; those are left out that cannot matter.
    """

    board: Board
    cloud: Cloud
    weighed: Mapping[tuple[str, ...], Weighed]
    bases: tuple[Mode, ...]
    doubts: Mapping[tuple[str, ...], tuple[float, ...]] = field(default_factory=dict)

    @property
    def base(self) -> Weighed:
        """The base model."""
        return self.weighed[()]


@dataclass(frozen=True)
class Effort:
    """How much work is done.

    Attributes
    ----------
    enough : float
        Effective draws of a hypothesis that matters; its log evidence is then known to one over
        the root of it.
    pairs : int
        Pairs that are weighed on the cloud, at most.
    """

    enough: float = 250.0
    pairs: int = 10


def without(names: tuple[str, ...]) -> list[tuple[str, ...]]:
    """Return a hypothesis once without each of its members."""
    return [names[:k] + names[k + 1 :] for k in range(len(names))]
