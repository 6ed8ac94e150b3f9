"""Fixes that add or set forces after contacts, one module per word, each with a line here."""

from minidem.contact.extensions import EXTENSIONS
from minidem.world.fix import FIXES

FIXES.later("minidem.fixes.forces.addforce", "setforce", "addforce")
FIXES.later("minidem.fixes.forces.aveforce", "aveforce")
FIXES.later("minidem.fixes.forces.buoyancy", "buoyancy")
FIXES.later("minidem.fixes.forces.drag", "drag")
FIXES.later("minidem.fixes.forces.drag_sphere", "drag/sphere")
EXTENSIONS.later("minidem.fixes.forces.drag_sphere", "drag/sphere")
FIXES.later("minidem.fixes.forces.freeze", "freeze")
FIXES.later("minidem.fixes.forces.gravity", "gravity")
FIXES.later("minidem.fixes.forces.lines", "lineforce", "planeforce")
FIXES.later("minidem.fixes.forces.momentum", "momentum")
FIXES.later("minidem.fixes.forces.sieve", "massflow/mesh/sieve")
FIXES.later("minidem.fixes.forces.springs", "spring", "spring/self")
FIXES.later("minidem.fixes.forces.store_force", "store/force")
FIXES.later("minidem.fixes.forces.viscous", "viscous")
FIXES.later("minidem.fixes.forces.wall_region", "wall/region")
