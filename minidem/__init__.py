"""minidem: a discrete element engine that reads LIGGGHTS scripts and behaves like LIGGGHTS.

The names below are loaded when they are asked for, so that the command can load them its own way.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from minidem.checking import check_script
    from minidem.errors import (
        DemError,
        InputError,
        OutputError,
        ResourceError,
        RunInterrupted,
        ScriptError,
        SimulationError,
    )
    from minidem.simulate import RunSummary, run_script

__all__ = [
    "DemError",
    "InputError",
    "OutputError",
    "ResourceError",
    "RunInterrupted",
    "RunSummary",
    "ScriptError",
    "SimulationError",
    "check_script",
    "run_script",
]

_PLACES = {
    "DemError": "minidem.errors",
    "InputError": "minidem.errors",
    "OutputError": "minidem.errors",
    "ResourceError": "minidem.errors",
    "RunInterrupted": "minidem.errors",
    "RunSummary": "minidem.simulate",
    "ScriptError": "minidem.errors",
    "SimulationError": "minidem.errors",
    "check_script": "minidem.checking",
    "run_script": "minidem.simulate",
}


def __getattr__(name: str) -> Any:
    """Load one of the public names."""
    if name in _PLACES:
        return getattr(import_module(_PLACES[name]), name)
    msg = f"module 'minidem' has no attribute {name!r}"
    raise AttributeError(msg)
