"""Fixes that put particles, or the box, somewhere in every step, each with a line here."""

from minidem.world.fix import FIXES

FIXES.later("minidem.fixes.carried.deform", "deform")
FIXES.later("minidem.fixes.carried.move", "move")
