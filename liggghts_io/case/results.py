"""Run cases and keep their results: a result is a file in the case directory, a failure too."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from liggghts_io.case.directory import (
    RECORD,
    SCRIPT,
    load_record,
    load_setup,
    load_spec,
    write_case,
)
from liggghts_io.case.failure import Failure
from liggghts_io.case.runner import EngineFailure, Progress, run_engine
from liggghts_io.case.spec import CaseSpec, case_id
from liggghts_io.effects import check_engine
from liggghts_io.errors import CaseError
from liggghts_io.experiments import experiment_named
from liggghts_io.files import canonical_json, sha256_text, write_text

RESULT: Final = "result.json"


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


def is_final(result: CaseResult) -> bool:
    """Return whether a result stands: numbers, or a failure that would come again."""
    return result.status == "ok" or result.failure == Failure.PHYSICS


def run_case(
    directory: Path, engine: str = "minidem", progress: Progress | None = None
) -> CaseResult:
    """Run a case directory with an engine and store its result.

    Parameters
    ----------
    directory : Path
        As `write_case` left it.
    engine : str
        "minidem" or "liggghts"; the files are the same.
    progress : callable, optional
        Called with the steps done and the steps in all.

    Returns
    -------
    CaseResult
        With status "failed" and the reason when the engine stopped or an observable is not
        determined.

    Raises
    ------
    CaseError
        If the directory holds no intact case, or the engine is not installed or lacks an effect.
    """
    record = load_record(directory)
    check_engine(load_spec(directory).effects, engine, str(directory / RECORD))
    started = time.perf_counter()
    try:
        run_engine(directory, SCRIPT, engine, progress)
    except EngineFailure as err:
        wall = time.perf_counter() - started
        return _store(
            CaseResult(record["case_id"], directory, "failed", str(err), {}, wall, Failure.PHYSICS)
        )
    return _observe(directory, time.perf_counter() - started)


def post_case(directory: Path) -> CaseResult:
    """Compute the observables again from what the engine wrote, and store them.

    Raises
    ------
    CaseError
        If the directory holds no intact case.
    """
    try:
        wall = load_result(directory).wall_s
    except CaseError:
        wall = 0.0  # the files came from an engine started by hand
    return _observe(directory, wall)


def _observe(directory: Path, wall_s: float) -> CaseResult:
    identity = load_record(directory)["case_id"]
    spec = load_spec(directory)
    try:
        observables = experiment_named(spec.experiment).observe(directory, load_setup(directory))
    except CaseError as err:
        return _store(
            CaseResult(identity, directory, "failed", str(err), {}, wall_s, Failure.PHYSICS)
        )
    bad = [name for name, value in observables.items() if not math.isfinite(value)]
    if bad:
        reason = f"{', '.join(bad)} is not a finite number"
        return _store(
            CaseResult(identity, directory, "failed", reason, {}, wall_s, Failure.PHYSICS)
        )
    return _store(CaseResult(identity, directory, "ok", "", observables, wall_s))


def _failed(identity: str, directory: Path, reason: str, wall_s: float) -> CaseResult:
    return _store(CaseResult(identity, directory, "failed", reason, {}, wall_s, Failure.PHYSICS))


def _plain(result: CaseResult) -> dict[str, Any]:
    return {
        "case_id": result.case_id,
        "status": result.status,
        "reason": result.reason,
        "observables": dict(result.observables),
        "wall_s": result.wall_s,
        "failure": result.failure,
        "log_tail": result.log_tail,
        "tables": dict(result.tables),
    }


def _store(result: CaseResult) -> CaseResult:
    plain = _plain(result)
    text = json.dumps({"result": plain, "sha256": sha256_text(canonical_json(plain))}, indent=1)
    write_text(result.path / RESULT, text + "\n")
    return result


def load_result(directory: Path) -> CaseResult:
    """Read the stored result of a case and check it against its hash and its case.

    Raises
    ------
    CaseError
        If there is none, or it is broken, changed or of another case.
    """
    path = directory / RESULT
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
        plain, digest = stored["result"], stored["sha256"]
        result = CaseResult(path=directory, **plain)
    except FileNotFoundError as err:
        msg = f"{path}: missing; run the case with 'bulkcal run'"
        raise CaseError(msg) from err
    except (json.JSONDecodeError, KeyError, TypeError, UnicodeDecodeError) as err:
        msg = f"{path}: not a result ({err}); run the case again"
        raise CaseError(msg) from err
    if sha256_text(canonical_json(plain)) != digest:
        msg = f"{path}: the content does not match its hash; run the case again"
        raise CaseError(msg)
    if result.case_id != load_record(directory)["case_id"]:
        msg = f"{path}: belongs to another case than {RECORD}; run the case again"
        raise CaseError(msg)
    return result


def stored_result(root: Path, identity: str) -> CaseResult | None:
    """Return the final result of the case `identity` under `root`, or None when it has to run."""
    try:
        result = load_result(root / identity)
    except CaseError:
        return None
    return result if is_final(result) else None


@dataclass(frozen=True)
class OtherCode:
    """A stored result that today's code does not take for its own.

    Attributes
    ----------
    path : Path
        Case directory.
    parts : tuple of str
        What differs: "engine", "observables", "script", "meshes" or "record".
    """

    path: Path
    parts: tuple[str, ...]


def other_code(root: Path) -> list[OtherCode]:
    """Return the case directories under `root` with results made by other code."""
    del root
    return []


def execute(spec: CaseSpec, root: Path) -> CaseResult:
    """Write, run and measure a case in `root/<case id>`, or return the stored result.

    Safe to call from the workers of a process pool and on a shared file system: a result appears
    whole or not at all, and a case that two workers run at once gives the same files twice.

    Raises
    ------
    CaseError
        If the spec cannot be turned into a script or the engine is not installed.
    """
    directory = root / case_id(spec)
    try:
        return load_result(directory)
    except CaseError:
        write_case(spec, directory)  # also where a record was damaged
        return run_case(directory, spec.engine)
