"""What an effect is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from liggghts_io.errors import CaseError
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import Particle


def _no_clash(_particle: Particle) -> str:
    return ""


Apply: TypeAlias = Callable[[dict[str, Any], float, Setup], dict[str, Any]]


@dataclass(frozen=True)
class Effect:
    """A cause the base model leaves out.

    Attributes
    ----------
    name, title, unit, meaning : str
    scale : float
        Strength that would be physically ordinary; strengths are judged against it.
    low, high : float
        Allowed strengths; a sign constraint is a zero among them.
    settled_by : str
        An independent measurement on the bench that would confirm or exclude it.
    apply : callable
        Template variables, strength, setup to new template variables; strength 0 never gets here.
    experiments : tuple of str
        Experiments whose script changes, the others refuse the effect; empty for all of them.
    candidate : bool
        Whether the diagnosis tries it without being asked; each candidate costs runs.
    per_apparatus : bool
        Whether the diagnosis also tries it in each apparatus alone.
    extension : str
        The word of the script that LIGGGHTS 3.8.0 lacks, empty if it knows all of them.
    needs : tuple of str
        Optional fields of `Particle` without which the effect cannot act.
    clash : callable
        Particle to the reason why the base model of these grains holds the effect already, empty
        where it does not.
    """

    name: str
    title: str
    unit: str
    meaning: str
    scale: float
    low: float
    high: float
    settled_by: str
    apply: Apply
    experiments: tuple[str, ...] = ()
    candidate: bool = True
    per_apparatus: bool = False
    extension: str = ""
    needs: tuple[str, ...] = ()
    clash: Callable[[Particle], str] = _no_clash

    @property
    def sign(self) -> str:
        """Return "positive" when strengths below zero make no sense, else "both"."""
        return "positive" if self.low >= 0.0 else "both"

    def acts_in(self, experiment: str) -> bool:
        """Whether the effect changes the script of an experiment."""
        return not self.experiments or experiment in self.experiments

    def fits(self, particle: Particle) -> bool:
        """Whether the effect can be added to the base model of these grains."""
        return particle.has(self.needs) and not self.clash(
            replace(particle, sizes=particle.base_sizes)
        )

    def check_grains(self, particle: Particle) -> None:
        """Refuse grains of which too little is known, or that have the effect already.

        Raises
        ------
        CaseError
        """
        particle.need(self.needs, f"the effect {self.name}")
        reason = self.clash(particle)
        if reason:
            msg = f"effect {self.name}: {reason}"
            raise CaseError(msg)

    def check(self, strength: float) -> None:
        """Refuse a strength outside the allowed range.

        Raises
        ------
        CaseError
        """
        if not math.isfinite(strength) or not self.low <= strength <= self.high:
            msg = (
                f"effect {self.name}: strength {strength:g} {self.unit} outside "
                f"{self.low:g} to {self.high:g}"
            )
            raise CaseError(msg)
