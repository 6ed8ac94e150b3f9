"""What generate and run would do: the facts of a dry run, and of -v."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from calibrate.cli.show.about import engine_in_words
from liggghts_io import CaseError, CaseSpec, case_id, load_result
from liggghts_io.case.directory import RECORD, load_record
from liggghts_io.case.spec import describe, script_of
from liggghts_io.measure.dumps import SCRIPT
from liggghts_io.measure.schedule import load_of

__all__ = ["plan_of_case", "plan_of_run"]


def plan_of_case(spec: CaseSpec, directory: Path) -> dict[str, Any]:
    """Return what `generate` would write.

    Raises
    ------
    CaseError
        If the specification cannot be turned into a script.
    """
    meshes = [f"meshes/{name}" for name in describe(spec).meshes]
    facts: dict[str, Any] = {
        "directory": f"{directory} ({_state(directory)})",
        "would write": [RECORD, SCRIPT, *meshes],
        "case id": case_id(spec),
        "engine": engine_in_words(spec.engine),
    }
    return facts | {"time steps": _steps(script_of(spec))}


def plan_of_run(directory: Path, engine: str) -> dict[str, Any]:
    """Return what `run` would do.

    Raises
    ------
    CaseError
        If the directory holds no intact case.
    """
    record = load_record(directory)
    script = directory / SCRIPT
    try:
        text = script.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as err:
        msg = f"{script}: cannot be read ({err}); generate the case again"
        raise CaseError(msg) from err
    return {
        "directory": str(directory),
        "case id": record["case_id"],
        "engine": engine_in_words(engine),
        "time steps": _steps(text),
        "stored result": stored_result_in_words(directory),
    }


def stored_result_in_words(directory: Path) -> str:
    """Return what the directory holds already."""
    try:
        result = load_result(directory)
    except CaseError:
        return "none"
    numbers = ", ".join(f"{name} = {value:.6g}" for name, value in result.observables.items())
    return numbers or f"{result.status}: {result.reason}"


def _state(directory: Path) -> str:
    if not directory.is_dir():
        return "new"
    if not any(directory.iterdir()):
        return "empty"
    try:
        return f"holds the case {load_record(directory)['case_id']}"
    except CaseError:
        return "holds other files, which stay"


def _steps(script: str) -> int:
    return int(load_of(script).steps)
