"""Calibration: study file, campaign, surrogates, stages, report and the `bulkcal` command.

The names below are loaded when they are asked for: numerical libraries take a second to import.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from calibrate.api import LoadedStudy, load
    from calibrate.cli.calibrate_study import calibrate_study
    from calibrate.cli.diagnose_study import diagnose_study
    from calibrate.errors import CalibrationError
    from calibrate.study.data import load_data
    from calibrate.study.load import load_study

__all__ = [
    "CalibrationError",
    "LoadedStudy",
    "calibrate_study",
    "diagnose_study",
    "load",
    "load_data",
    "load_study",
]

_PLACES = {
    "CalibrationError": "calibrate.errors",
    "LoadedStudy": "calibrate.api",
    "calibrate_study": "calibrate.cli.calibrate_study",
    "diagnose_study": "calibrate.cli.diagnose_study",
    "load": "calibrate.api",
    "load_data": "calibrate.study.data",
    "load_study": "calibrate.study.load",
}


def __getattr__(name: str) -> Any:
    """Load one of the public names."""
    if name in _PLACES:
        return getattr(import_module(_PLACES[name]), name)
    msg = f"module 'calibrate' has no attribute {name!r}"
    raise AttributeError(msg)
