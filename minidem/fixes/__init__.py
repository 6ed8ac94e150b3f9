"""Fixes, one module per word of LIGGGHTS; importing this package registers them all.

A module holds what belongs to its word: parser, object, rows in the tables of the kernels, state
in a restart file and removal. See `minidem.world.fix.Fix` for what a fix may do.
"""

from minidem.fixes import adapt as adapt
from minidem.fixes import carried as carried
from minidem.fixes import check_timestep as check_timestep
from minidem.fixes import diameter as diameter
from minidem.fixes import forces as forces
from minidem.fixes import insert as insert
from minidem.fixes import integrate as integrate
from minidem.fixes import massflow as massflow
from minidem.fixes import mesh as mesh
from minidem.fixes import move as move
from minidem.fixes import printing as printing
from minidem.fixes import property_global as property_global
from minidem.fixes import servo as servo
from minidem.fixes import templates as templates
from minidem.fixes import wall as wall
