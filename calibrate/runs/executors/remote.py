"""What a worker on a cluster does first: make sure that it runs the case that was meant."""

from __future__ import annotations

import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

from liggghts_io import CaseError, CaseSpec, case_id

__all__ = ["expected_case", "run_there"]


def expected_case(arguments: tuple[Any, ...]) -> str:
    """Return the id of the case that a call runs, empty for any other call."""
    return case_id(arguments[0]) if arguments and isinstance(arguments[0], CaseSpec) else ""


def run_there(expected: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function on a worker; called there.

    Parameters
    ----------
    expected : str
        As `expected_case` returned it where the call was made.
    function : callable
    *arguments : Any
        With `expected`, a case and the directory where it runs come first.

    Raises
    ------
    CaseError
        If the worker has other code, or does not see the directory: its result would be stored
        where nobody looks for it.
    """
    if expected:
        spec, root = arguments[:2]
        _check(expected, spec, Path(root))
    return function(*arguments)


def _check(expected: str, spec: CaseSpec, root: Path) -> None:
    host = socket.gethostname()
    if not root.is_dir():
        msg = (
            f"{root}: the worker on host {host} does not see this directory; choose an --out on a "
            "file system that all workers share"
        )
        raise CaseError(msg)
    if case_id(spec) != expected:
        msg = (
            f"the worker on host {host} has another version of bulkcal or of the engine; install "
            "the same one there and start its workers again"
        )
        raise CaseError(msg)
