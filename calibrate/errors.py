"""Errors of the calibration layer."""


class CalibrationError(RuntimeError):
    """Raised when a study, its data or a calibration step cannot be used as given.

    The message names the place, the value and a remedy; the command line shows it without a
    traceback and ends with exit code 2.
    """
