"""The liquid of particles, as the fixes that LIGGGHTS makes for models with liquid bridges.

They are ``liquidtransfer`` and the properties ``surfaceLiquidContent``, ``liquidFlux`` and
``liquidSource``, which outputs read and ``set ... property/atom`` changes. They are there from the
first run on.
"""

from __future__ import annotations

import numpy as np

from minidem.errors import InputError
from minidem.fixes.wall import used_models
from minidem.kernels.columns import COHESION, LIQUID_CONTENT, LIQUID_FLUX, LIQUID_SOURCE
from minidem.kernels.models import EASO
from minidem.record import record
from minidem.words import Words
from minidem.world.fix import Fix
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["LiquidFix", "is_wet", "provide_liquid"]

_TRANSFER = "liquidtransfer"
_COLUMNS = {
    "surfaceLiquidContent": LIQUID_CONTENT,
    "liquidFlux": LIQUID_FLUX,
    "liquidSource": LIQUID_SOURCE,
}


@record
class LiquidFix(Fix):
    """One column of the liquid of particles.

    Attributes
    ----------
    column : int
        Of ``Particles.liquid``: volumes over that of the particle, fluxes of them in 1/s.
    """

    column: int = LIQUID_CONTENT

    def per_atom(self, world: World, name: str) -> Floats | None:
        """Return the column."""
        if name not in (self.name, f"{self.name}[0]"):
            return None
        return world.state.liquid[: world.state.n, self.column].copy()

    def value(self, world: World, index: int) -> float:
        """Return the sum of the contents as the scalar of ``liquidtransfer``."""
        if self.name != _TRANSFER or index != 0:
            return super().value(world, index)
        return float(np.sum(world.state.liquid[: world.state.n, self.column]))

    def assign(self, world: World, name: str, who: Ints, words: Words) -> bool:
        """Read a new value for some particles if it is that of this property."""
        if name != self.name or self.name == _TRANSFER:
            return False
        world.state.liquid[who, self.column] = words.number()
        return True

    def modify(self, world: World, words: Words) -> None:
        """Refuse to change how liquid moves."""
        del world
        msg = f"fix_modify {self.name} {words.peek()} is not in minidem: liquid moves in every step"
        raise InputError(msg)

    def remove(self, world: World) -> None:
        """Take all of the liquid away; the next run begins with what it is at first."""
        if self.name != _TRANSFER:
            msg = f"fix {self.name} belongs to fix {_TRANSFER}; unfix that instead"
            raise InputError(msg)
        for name in _COLUMNS:
            world.fixes.pop(name, None)


def is_wet(world: World) -> bool:
    """Tell whether liquid moves between particles."""
    return bool(world.of_kind(LiquidFix))


def provide_liquid(world: World) -> None:
    """Give particles their liquid if a model with liquid bridges is in use for the first time.

    After ``read_restart`` they have it already. LIGGGHTS writes down the first content with seven
    digits.
    """
    given = world.materials.values.get("surfaceLiquidContentInitial")
    wanted = any(switches[COHESION] >= EASO for switches in used_models(world))
    if not wanted or given is None or _TRANSFER in world.fixes:
        return
    state = world.state
    state.moisture = float(f"{float(given.ravel()[0]):e}")
    if world.restored is None or _TRANSFER not in world.restored.fixes:
        state.liquid[: state.n] = state.moisture, 0.0, 0.0
    everyone = world.bit("all")
    world.fixes[_TRANSFER] = LiquidFix(_TRANSFER, "transportequation/scalar", everyone)
    for name, column in _COLUMNS.items():
        world.fixes[name] = LiquidFix(name, "property/atom", everyone, column)
