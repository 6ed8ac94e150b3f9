"""Case directories: the files that describe a case, and how they are read back."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from liggghts_io.case.spec import CaseSpec, build_case, inputs, particle_of, setup_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments import Setup, experiment_named
from liggghts_io.files import canonical_json, sha256_text, write_text
from liggghts_io.scripts.templating import render
from liggghts_io.stl import write_stl

SCRIPT: Final = "in.script"
RECORD: Final = "case.json"


def write_case(spec: CaseSpec, directory: Path) -> Path:
    """Write `case.json`, `in.script` and `meshes/` to a directory.

    Parameters
    ----------
    spec : CaseSpec
    directory : Path
        Created if missing; existing files of the case are replaced, nothing is deleted.

    Returns
    -------
    Path
        The directory.

    Raises
    ------
    CaseError
        If the spec cannot be turned into a script.
    """
    build = build_case(spec)
    text = render(experiment_named(spec.experiment).template, build.variables)
    for name, triangles in build.meshes.items():
        write_stl(directory / "meshes" / f"{name}.stl", triangles)
    (directory / "post").mkdir(parents=True, exist_ok=True)
    write_text(directory / SCRIPT, text)
    hashed = inputs(spec)
    record = {
        "case_id": sha256_text(canonical_json(hashed)),
        "inputs": hashed,
        "script_sha256": sha256_text(text),
    }
    write_text(directory / RECORD, json.dumps(record, indent=1, sort_keys=True) + "\n")
    return directory


def load_record(directory: Path) -> dict[str, Any]:
    """Read `case.json` and check it against its own hash.

    Raises
    ------
    CaseError
        If the file is missing, broken or was changed after it was written.
    """
    path = directory / RECORD
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        hashed, stored = record["inputs"], record["case_id"]
    except FileNotFoundError as err:
        msg = f"{path}: missing; make the case with 'bulkcal generate'"
        raise CaseError(msg) from err
    except (json.JSONDecodeError, KeyError, TypeError, UnicodeDecodeError) as err:
        msg = f"{path}: not a case record ({err}); generate the case again"
        raise CaseError(msg) from err
    if sha256_text(canonical_json(hashed)) != stored:
        msg = f"{path}: the inputs do not match the case id; the file was changed, generate again"
        raise CaseError(msg)
    return dict(record)


def load_spec(directory: Path) -> CaseSpec:
    """Return the spec of a case directory.

    Raises
    ------
    CaseError
        As `load_record`.
    """
    record = load_record(directory)
    try:
        plain = record["inputs"]["spec"]
        return CaseSpec(**(plain | {"particle": particle_of(plain["particle"])}))
    except (TypeError, KeyError, ValueError) as err:
        msg = f"{directory / RECORD}: written by another version ({err}); generate the case again"
        raise CaseError(msg) from err


def load_setup(directory: Path) -> Setup:
    """Return the setup a case was written with, also where defaults have changed since.

    Raises
    ------
    CaseError
        As `load_spec`.
    """
    resolved = load_record(directory)["inputs"]["resolved_apparatus"]
    spec = load_spec(directory)
    return setup_of(replace(spec, apparatus=resolved))
