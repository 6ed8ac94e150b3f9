"""What an effect is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from liggghts_io.errors import CaseError
from liggghts_io.experiments.setup import Observed, Setup
from liggghts_io.materials import ONE, Particle

Apply: TypeAlias = Callable[[dict[str, Any], float, Setup], dict[str, Any]]
Prepare: TypeAlias = Callable[[Setup, float], Setup]
Read: TypeAlias = Callable[[Observed, float, Setup], Observed]
Scope: TypeAlias = Literal["everywhere", "funnel", "material", "wall"]
"""Between what a strength may differ: nothing, the funnels of an experiment (one for each kind of
its walls), the materials, or the walls under test."""


def _no_clash(_particle: Particle) -> str:
    return ""


def unchanged(variables: dict[str, Any], _strength: float, _setup: Setup) -> dict[str, Any]:
    """Return the variables as they are: the effect acts elsewhere."""
    return variables


@dataclass(frozen=True)
class Effect:
    """A cause the base model leaves out.

    It acts in one of three ways: on the variables of the script (`apply`), on the apparatus as it
    really was, which nobody knew who measured (`prepare`), or on what the instruments showed
    (`read`), which costs no run.

    Attributes
    ----------
    name, title, unit, meaning : str
    scale : float
        Strength that would be physically ordinary; strengths are judged against it.
    low, high : float
        Allowed strengths; a sign constraint is a zero among them.
    settled_by : str
        An independent measurement on the bench that would confirm or exclude it.
    settled_se : float
        Standard error of that measurement, in the unit of the strength; 0 where nobody says, then
        the diagnosis takes a quarter of `scale`.
    settled_hours : float
        Hours that it takes, which tells what to measure next.
    apply : callable
        Template variables, strength, setup to new template variables; strength 0 never gets here.
    prepare : callable, optional
        Setup and strength to the setup that script and meshes are made from; observables are
        measured with the setup that was believed.
    read : callable, optional
        What a run says, strength and setup to what the instruments showed of it.
    experiments : tuple of str
        Experiments in which it acts, the others refuse the effect; empty for all of them.
    walls : tuple of str
        Kinds of the wall under test on which it acts; empty for all.
    candidate : bool
        Whether the diagnosis tries it without being asked; each candidate costs runs.
    scope : str
        Between what its strength may differ; the diagnosis tries one strength for all, and each
        alone.
    switch : bool
        Whether it is on or off and has no strength: 1 is on.
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
    settled_se: float = 0.0
    settled_hours: float = 1.0
    apply: Apply = unchanged
    prepare: Prepare | None = None
    read: Read | None = None
    experiments: tuple[str, ...] = ()
    walls: tuple[str, ...] = ()
    candidate: bool = True
    scope: Scope = "everywhere"
    switch: bool = False
    extension: str = ""
    needs: tuple[str, ...] = ()
    clash: Callable[[Particle], str] = _no_clash

    @property
    def sign(self) -> str:
        """Return "positive" when strengths below zero make no sense, else "both"."""
        return "positive" if self.low >= 0.0 else "both"

    def acts_in(self, experiment: str) -> bool:
        """Whether the effect can act in an experiment."""
        return not self.experiments or experiment in self.experiments

    def acts_on(self, kind: str) -> bool:
        """Whether the effect can act on a kind of wall under test."""
        return not self.walls or kind in self.walls

    @property
    def needs_runs(self) -> bool:
        """Whether runs with the effect differ from runs without it, and not readings alone."""
        return self.read is None

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
        # Sizes that nobody has decided are decided so that the effect can act.
        open_ = (particle.sizes,) if particle.sizes else (particle.base_sizes, ONE)
        reasons = [self.clash(replace(particle, sizes=one)) for one in open_]
        if all(reasons):
            msg = f"effect {self.name}: {reasons[0]}"
            raise CaseError(msg)

    def check(self, strength: float) -> None:
        """Refuse a strength outside the allowed range.

        Raises
        ------
        CaseError
        """
        if self.switch and strength not in (0.0, 1.0):
            msg = f"effect {self.name}: {strength:g}; it is on (1) or off (0)"
            raise CaseError(msg)
        if not math.isfinite(strength) or not self.low <= strength <= self.high:
            msg = (
                f"effect {self.name}: strength {strength:g} {self.unit} outside "
                f"{self.low:g} to {self.high:g}"
            )
            raise CaseError(msg)
