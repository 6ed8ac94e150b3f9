"""Output of runs that have no records of this package: found, read frame by frame, measured."""

from liggghts_io.foreign.dump import Dump, FrameTable
from liggghts_io.foreign.measure import (
    Measured,
    Observed,
    measure_definition,
    measure_frames,
)
from liggghts_io.foreign.output import Output, read_output
from liggghts_io.foreign.overview import DumpFacts, facts_of, thermo_facts
from liggghts_io.foreign.run import Grains, as_frame

__all__ = [
    "Dump",
    "DumpFacts",
    "FrameTable",
    "Grains",
    "Measured",
    "Observed",
    "Output",
    "as_frame",
    "facts_of",
    "measure_definition",
    "measure_frames",
    "read_output",
    "thermo_facts",
]
