"""Error rates the verdict works to."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Levels"]


@dataclass(frozen=True)
class Levels:
    """Error rates the verdict works to, and the number of imagined studies.

    Attributes
    ----------
    name : float
        Probability above which a cause is named: as much as a set holds. Of six false names of the
        fourth to sixth blind suite (510 studies that hide no cause of the library) four had less,
        and so had twelve of 144 right ones from 5.6 standard errors on.
    both : float
        Probability above which causes are named that are this probable side by side. What is in no
        library has looked like one cause, and in none of these studies like two.
    lasting : float
        A cause is named only if its probability is above this on average over other runs, too.
    credible : float
        Probability that a set holds.
    other : float
        Most that none may have where a set is given.
    chance : float
        Chance that a candidate looks so good although nothing is hidden.
    explained : float
        A cause is named only if data as far from the model are at least this likely with it, and a
        set only if they are with one of its causes or pairs.
    misfit : float
        Without a cause, a misfit less likely than this is called unknown.
    unknown : float
        Probability above which it is called unknown.
    doubt : float
        Least probability of none with which nothing is said to be wrong. Of the fourth blind suite
        26 studies had less and no other verdict: two of them hid nothing (`docs/challenge.md`).
    studies : int
        Imagined studies.
    unknowns : int
        Most unknowns with which causes are told. With 71 of five materials the best values of the
        base model are found within 1.5 nats by three seeds; more was not tried.
    """

    name: float = 0.95
    both: float = 0.9
    lasting: float = 0.75
    credible: float = 0.95
    other: float = 0.05
    chance: float = 0.03
    explained: float = 0.05
    misfit: float = 0.01
    unknown: float = 0.5
    doubt: float = 0.25
    studies: int = 1000
    unknowns: int = 80
