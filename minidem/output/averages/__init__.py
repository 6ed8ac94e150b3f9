"""Fixes that keep values for output: means over time, and values per particle; a line for each."""

from minidem.output.dump import DUMPS
from minidem.world.fix import FIXES

FIXES.later("minidem.output.averages.atom", "ave/atom")
FIXES.later("minidem.output.averages.correlation", "ave/correlate")
DUMPS.later("minidem.output.averages.dump_euler", "euler/vtk")
FIXES.later("minidem.output.averages.euler", "ave/euler")
FIXES.later("minidem.output.averages.histogram", "ave/histo")
FIXES.later("minidem.output.averages.spatial", "ave/spatial")
FIXES.later("minidem.output.averages.stored", "store/state", "property/atom")
FIXES.later("minidem.output.averages.time", "ave/time")
FIXES.later(
    "minidem.output.averages.tracers", "property/atom/tracer", "property/atom/regiontracer/time",
)  # fmt: skip
FIXES.later("minidem.output.averages.tracers_of_stream", "property/atom/tracer/stream")
