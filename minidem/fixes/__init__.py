"""Fixes, one module per word of LIGGGHTS or family of words, each with a line here.

A module holds what belongs to its word: parser, object, rows in the tables of the kernels, state
in a restart file and removal. See `minidem.world.fix.Fix` for what a fix may do. A module is
imported when a script uses one of its words.
"""

from minidem.fixes import carried as carried
from minidem.fixes import flow as flow
from minidem.fixes import forces as forces
from minidem.insertion import DISTRIBUTION_STYLES, STYLES
from minidem.world.fix import FIXES

FIXES.later("minidem.fixes.adapt", "adapt")
FIXES.later("minidem.fixes.check_timestep", "check/timestep/gran")
FIXES.later("minidem.fixes.diameter", "diam/max")
FIXES.later("minidem.fixes.insert", *STYLES)
FIXES.later("minidem.fixes.integrate", "nve/sphere", "nve", "nve/noforce", "nve/limit")
FIXES.later("minidem.fixes.mesh", "mesh/surface", "mesh/surface/planar", "mesh/surface/stress")
FIXES.later("minidem.fixes.move", "move/mesh", "move/mesh/gran")
FIXES.later("minidem.fixes.printing", "print")
FIXES.later("minidem.fixes.property_global", "property/global", "custom_property/global")
FIXES.later("minidem.fixes.servo.servo", "mesh/surface/stress/servo")
FIXES.later("minidem.fixes.templates", "particletemplate/sphere", *DISTRIBUTION_STYLES)
FIXES.later("minidem.fixes.wall", "wall/gran")
