"""``fix ID GROUP drag/sphere density RHO viscosity MU [velocity VX VY VZ] [factor F]``.

Air drag of Schiller and Naumann, which LIGGGHTS 3.8.0 lacks: see `minidem.contact.extensions`.
"""

from __future__ import annotations

from typing import ClassVar

from minidem.contact.extensions import EXTENSIONS, Extension
from minidem.errors import InputError
from minidem.fixes.forces.body import BodyForce
from minidem.kernels.columns import DRAG_DENSITY, DRAG_FACTOR, DRAG_GAS, DRAG_VISCOSITY, three
from minidem.registry import Head
from minidem.words import Words
from minidem.world.fix import FIXES
from minidem.world.world import World

__all__ = ["DragSphere"]

_KEYWORDS = {
    "factor": slice(DRAG_FACTOR, DRAG_FACTOR + 1),
    "density": slice(DRAG_DENSITY, DRAG_DENSITY + 1),
    "viscosity": slice(DRAG_VISCOSITY, DRAG_VISCOSITY + 1),
    "velocity": three(DRAG_GAS),
}
"""Keyword to its place in ``numbers``: F, density, kg/m3, viscosity, Pa s, gas velocity, m/s."""


EXTENSIONS.register("drag/sphere")(
    Extension(
        "drag/sphere",
        "`fix ID GROUP drag/sphere density RHO viscosity MU [velocity VX VY VZ] [factor F]`",
        (),
        "F C_D rho pi d^2 / 8 |u - v| (u - v), C_D = 24 / Re (1 + 0.15 Re^0.687)",
        "u is the velocity of the gas, 0 if not given, F 1; above Re = 1000 C_D is 0.44; there "
        "is no buoyancy",
        "Schiller and Naumann, Z. VDI 77 (1935) 318",
    )
)


@FIXES.register("drag/sphere")
class DragSphere(BodyForce):
    """Drag of a gas, worked out by the kernel."""

    kernel: ClassVar[str] = "drag/sphere"

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> DragSphere:
        """Read the properties of the gas."""
        del world
        made = cls(*head)
        made.numbers[_KEYWORDS["factor"]] = 1.0
        while not words.done():
            key = words.choice(tuple(_KEYWORDS))
            place = _KEYWORDS[key]
            count = place.stop - place.start
            words.need(count, f"drag/sphere ... {key} " + "VALUE " * count)
            made.numbers[place] = words.numbers(count)
        for key in ("density", "viscosity"):
            if not made.numbers[_KEYWORDS[key]] > 0.0:
                msg = f"drag/sphere needs '{key} VALUE' with a value above zero"
                raise InputError(msg)
        factor = float(made.numbers[DRAG_FACTOR])
        if factor < 0.0:
            msg = f"drag/sphere: factor {factor:g} is negative; drag may only slow down"
            raise InputError(msg)
        return made
