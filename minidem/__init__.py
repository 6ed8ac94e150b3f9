"""minidem: a discrete element engine that reads LIGGGHTS scripts and behaves like LIGGGHTS."""

from minidem.errors import DemError as DemError
from minidem.errors import ScriptError as ScriptError
from minidem.errors import SimulationError as SimulationError
from minidem.simulate import RunSummary as RunSummary
from minidem.simulate import run_script as run_script

__all__ = ["DemError", "RunSummary", "ScriptError", "SimulationError", "run_script"]
