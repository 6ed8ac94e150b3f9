"""What the engine writes: dumps, log, screen; each dump style has a line here.

A module is imported when a script uses one of its words.
"""

from minidem.output import averages as averages
from minidem.output.dump import DUMPS

DUMPS.later("minidem.output.dump_custom", "custom")
DUMPS.later("minidem.output.dump_local", "local", "local/gran/vtk")
DUMPS.later("minidem.output.dump_mesh", "mesh/vtk", "mesh/gran/VTK")
DUMPS.later("minidem.output.dump_stl", "mesh/stl", "stl")
DUMPS.later("minidem.output.dump_vtk", "custom/vtk", "atom/vtk", "decomposition/vtk")
DUMPS.later("minidem.output.dump_xyz", "xyz", "image", "movie")
