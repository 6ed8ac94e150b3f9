"""``fix ID GROUP diam/max``: in LIGGGHTS tells other fixes the largest diameter of insertions."""

from __future__ import annotations

from dataclasses import dataclass

from minidem.world.fix import FIXES, Fix

__all__ = ["LargestDiameter"]


@FIXES.register("diam/max")
@dataclass
class LargestDiameter(Fix):
    """Does nothing: a script cannot ask it, and what needs the diameter finds it itself."""
