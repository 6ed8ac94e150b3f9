"""Errors of the case layer."""


class CaseError(RuntimeError):
    """Raised when a case cannot be described, written, run or read.

    The message names the place, the value and a remedy; the command line shows it without a
    traceback and ends with exit code 2.
    """
