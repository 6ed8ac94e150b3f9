"""``fix ID GROUP aveforce FX FY FZ [region REGION]``: all particles get the mean force."""

from __future__ import annotations

from typing import ClassVar

from minidem.errors import InputError
from minidem.fixes.forces.addforce import GivenForce
from minidem.fixes.forces.body import FORCE_BEFORE
from minidem.kernels.columns import FX, POST_VECTOR, TOTAL_FORCE
from minidem.world.fix import FIXES
from minidem.world.world import World

__all__ = ["AverageForce"]


@FIXES.register("aveforce")
class AverageForce(GivenForce):
    """The mean force on the group, with a force per particle on top."""

    indices: ClassVar[tuple[int, ...]] = (1, 2, 3)
    sets: ClassVar[bool] = True
    null: ClassVar[bool] = True

    def check(self, world: World) -> None:
        """Refuse atom-style variables, as LIGGGHTS does."""
        super().check(world)
        for name in filter(None, self.variables):
            if world.interpreter.variable_style(name) == "atom":
                msg = f"Variable '{name}' for fix aveforce is invalid style; use style equal"
                raise InputError(msg)

    def in_python(self) -> bool:
        """Return True: no kernel knows it."""
        return True

    def apply(self, world: World) -> None:
        """Work out the mean and give it to all."""
        who, force = self.affected(world), world.state.force
        before = force[who, TOTAL_FORCE].sum(axis=0)
        self.before[FORCE_BEFORE] = before
        if not len(who):
            return
        for c in range(3):
            if self.components & 1 << c:
                name = self.variables[c]
                more = self.numbers[POST_VECTOR + c]
                if name is not None:
                    more = float(world.interpreter.value(name))
                force[who, FX + c] = before[c] / len(who) + more
