"""Results: the numbers of a run or the reason why there are none, stored in the case directory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from liggghts_io.case.directory import RECORD, RESULT, load_record
from liggghts_io.case.failure import Failure
from liggghts_io.errors import CaseError
from liggghts_io.experiments import Curve
from liggghts_io.files import read_signed_json, sha256_bytes, sha256_text, signed_json, write_text
from liggghts_io.measure.levels import at_levels


@dataclass(frozen=True)
class CaseResult:
    """Outcome of a case.

    Attributes
    ----------
    case_id : str
    path : Path
    status : str
        "ok" or "failed"; a failed run is data.
    reason : str
        Why it failed, empty when it did not.
    observables : Mapping[str, float]
        Empty when failed.
    wall_s : float
        Duration of the run [s].
    failure : str
        Class of the failure, a value of `Failure`; empty when there was none.
    log_tail : str
        Last lines of the engine's log when failed.
    tables : Mapping[str, str]
        Sha256 by file name of the tables in the case directory that belong to the result.
    output : str
        Sha256 that names the output it was computed from; empty for a run by hand and where a run
        left none.
    """

    case_id: str
    path: Path
    status: str
    reason: str
    observables: Mapping[str, float]
    wall_s: float
    failure: str = ""
    log_tail: str = ""
    tables: Mapping[str, str] = field(default_factory=dict)
    output: str = ""


def is_final(result: CaseResult) -> bool:
    """Return whether a result stands: numbers, or a failure that would come again."""
    return result.status == "ok" or result.failure == Failure.PHYSICS


def store_tables(
    directory: Path, tables: Mapping[str, Mapping[str, npt.NDArray[Any]]]
) -> dict[str, str]:
    """Write tables as CSV files with six significant digits; return their digests by name."""
    found = {}
    for name, columns in tables.items():
        rows = zip(*columns.values(), strict=True)
        lines = [",".join(columns), *(",".join(f"{one:.6g}" for one in row) for row in rows)]
        text = "\n".join(lines) + "\n"
        write_text(directory / name, text)
        found[name] = sha256_text(text)
    return found


def store_result(result: CaseResult) -> CaseResult:
    """Write a result to its case directory, with its hash."""
    plain = asdict(result)
    del plain["path"]
    write_text(result.path / RESULT, signed_json("result", plain))
    return result


def load_result(directory: Path) -> CaseResult:
    """Read the stored result of a case and check it against its hash, its case and its tables.

    Raises
    ------
    CaseError
        If there is none, or it or a table of it is broken, changed or of another case.
    """
    path = directory / RESULT
    try:
        result = CaseResult(path=directory, **read_signed_json(path, "result"))
    except FileNotFoundError as err:
        msg = f"{path}: missing; run the case with 'bulkcal run'"
        raise CaseError(msg) from err
    except (OSError, TypeError, ValueError) as err:
        msg = f"{path}: not a result ({err}); run the case again"
        raise CaseError(msg) from err
    if result.case_id != load_record(directory)["case_id"]:
        msg = f"{path}: belongs to another case than {RECORD}; run the case again"
        raise CaseError(msg)
    for name in result.tables:
        read_table(result, name)
    return result


def read_table(result: CaseResult, name: str) -> str:
    """Return the text of a table that belongs to a result.

    Raises
    ------
    CaseError
        If it is missing or was changed since the run.
    """
    path = result.path / name
    try:
        content = path.read_bytes()
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror}); run the case again"
        raise CaseError(msg) from err
    if sha256_bytes(content) != result.tables.get(name):
        msg = f"{path}: was changed since the run; run the case again"
        raise CaseError(msg)
    return content.decode("utf-8")


def read_curve(result: CaseResult, curve: Curve) -> npt.NDArray[np.float64]:
    """Return a curve of a result at its levels.

    Parameters
    ----------
    result : CaseResult
    curve : Curve
        Of the experiment of the case; `dataclasses.replace` gives it other levels.

    Returns
    -------
    (L,) float64
        In the unit of the curve; nan at levels that the run did not reach, everywhere if it failed.

    Raises
    ------
    CaseError
        If the table of the curve is missing or was changed since the run.
    """
    if result.status != "ok":
        return np.full(len(curve.levels), np.nan)
    head, *rows = read_table(result, curve.file).splitlines()
    names = head.split(",")
    table = np.array([row.split(",") for row in rows], dtype=np.float64).reshape(-1, len(names))
    x, y = (table[:, names.index(name)] for name in (curve.x_column, curve.y_column))
    return at_levels(x, y, np.array(curve.levels))


def stored_result(root: Path, identity: str) -> CaseResult | None:
    """Return the final result of the case `identity` under `root`, or None when it has to run.

    None too where the result, the record or a table is damaged: running the case mends it.
    """
    return final_result(root / identity, identity)


def final_result(directory: Path, identity: str) -> CaseResult | None:
    """Return the final result in a directory if it is that of a case, else None."""
    try:
        result = load_result(directory)
    except CaseError:
        return None
    return result if result.case_id == identity and is_final(result) else None
