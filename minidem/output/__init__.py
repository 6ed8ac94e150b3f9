"""What the engine writes: dumps, log, screen; importing this package registers the dump styles."""

from minidem.output import averages as averages
from minidem.output import dump_custom as dump_custom
from minidem.output import dump_local as dump_local
from minidem.output import dump_mesh as dump_mesh
from minidem.output import dump_stl as dump_stl
from minidem.output import dump_vtk as dump_vtk
from minidem.output import dump_xyz as dump_xyz
