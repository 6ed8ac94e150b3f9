"""One log of a scale: from its file to a mass-time curve."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from scipy.optimize import isotonic_regression

from calibrate.errors import CalibrationError
from calibrate.laboratory.instrument.cells import is_stamp, seconds_in
from calibrate.laboratory.instrument.quantities import MASS
from calibrate.laboratory.instrument.series import Form, Series, read_series
from calibrate.laboratory.scale.clean import cleaned
from calibrate.laboratory.scale.curve import MassCurve, mass_curve
from calibrate.laboratory.scale.doubts import refuse_early_onset
from calibrate.laboratory.scale.timing import with_spread_stamps
from liggghts_io.decimals import mark_of, number_in

__all__ = ["read_mass_curve"]

_DAY: Final = 86400.0
_FALLS: Final = 0.1
"""Sum of squares about a falling curve over that about a rising one, in the log of a mass that
falls."""


def read_mass_curve(path: Path, form: Form, opened: str = "") -> MassCurve:
    """Read the log of a scale.

    Parameters
    ----------
    path : Path
        CSV file with columns of time and mass.
    form : Form
    opened : str
        When the funnel was opened: seconds as the log counts, or a time stamp as in the log.
        Empty: at the zero of its clock, for time stamps at the first row.

    Raises
    ------
    CalibrationError
        With file, line, value and remedy.
    """
    series = with_spread_stamps(read_series(path, [MASS], form))
    opened_s = _opened(series, opened)
    try:
        curve = mass_curve(series, cleaned(series), opened_s)
    except CalibrationError as err:
        raise (_falling(series) or err) from None
    refuse_early_onset(curve)
    if opened:
        return curve
    zero = "its first row" if series.stamped else "the zero of its clock"
    remark = f"times count from {zero}; if the funnel was opened at another time, add --start"
    return replace(curve, remarks=(*curve.remarks, remark))


def _falling(series: Series) -> CalibrationError | None:
    """Return the refusal of a log of the scale that grains leave; None where they come."""
    mass = series.values
    falls, rises = (
        float(np.sum((isotonic_regression(mass, increasing=up).x - mass) ** 2))
        for up in (False, True)
    )
    if falls >= _FALLS * rises:
        return None
    return CalibrationError(
        f"{series.path}: the mass falls from {mass[0]:.4g} to {mass[-1]:.4g} g, as on a scale that "
        "grains leave; give the log of the scale onto which they fall, or correct the head where "
        "columns are swapped"
    )


def _opened(series: Series, text: str) -> float:
    """Return when the funnel was opened, as the log counts [s]."""
    first, last = float(series.time_s[0]), float(series.time_s[-1])
    if not text:
        if not series.stamped and first > last - first:
            msg = (
                f"{series.path}: its clock shows {first:g} s in the first row, so that it does not "
                "count from the opening of the funnel; say with --start when that was"
            )
            raise CalibrationError(msg)
        return first if series.stamped else 0.0
    stamp = is_stamp(text)
    value = seconds_in(text) if stamp else number_in(text, mark_of([text]))
    if isinstance(value, str):
        msg = f"--start {text}: {value}; give what its clock showed, such as 2.5 or 12:03:04.5"
        raise CalibrationError(msg)
    if stamp != series.stamped:
        clock = "time stamps such as 12:03:04.5" if series.stamped else "seconds"
        msg = f"--start {text}: the clock of {series.path} shows {clock}; give one of them"
        raise CalibrationError(msg)
    if stamp and value + _DAY <= last:
        value += _DAY
    if value > last:
        msg = f"--start {text}: is after the end of {series.path} ({last:g} s)"
        raise CalibrationError(msg)
    return value
