"""Case directories: the files that describe a case, and how they are read back."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from liggghts_io.case.lock import LOCK, Tell, gone_if_full, locked, raise_if_unusable
from liggghts_io.case.mark import COMMAND, ends_with_mark, script_digest
from liggghts_io.case.sources import code_of
from liggghts_io.case.spec import (
    FORMAT,
    Case,
    CaseSpec,
    describe,
    experiment_of,
    identity_of,
    setup_of,
)
from liggghts_io.errors import CaseError
from liggghts_io.experiments import DEFINITION, Setup, own_of
from liggghts_io.files import sha256_bytes, write_bytes, write_text
from liggghts_io.materials import particle_of
from liggghts_io.measure.dumps import POST, SCRIPT

RECORD: Final = "case.json"
RESULT: Final = "result.json"
OUTPUT: Final = "output"
MESHES: Final = "meshes"

_OURS: Final = {SCRIPT: (COMMAND.encode(),), RECORD: (b'"case_id"', b'"inputs"')}
_SHORT: Final = 8  # digits of a case id in a name
_REMEDY: Final = (
    "generate the case again, or run your script yourself with 'minidem -in' or 'liggghts -in'"
)


def write_case(spec: CaseSpec, directory: Path, tell: Tell | None = None) -> Path:
    """Write `case.json`, `in.script` and `meshes/` to a directory.

    Parameters
    ----------
    spec : CaseSpec
    directory : Path
        Made if missing. A case that was never run is replaced.
    tell : callable, optional
        Receives a line while another process holds the directory.

    Returns
    -------
    Path
        The directory.

    Raises
    ------
    CaseError
        If the spec cannot be turned into a script, or the directory holds results of another
        case, or a script or mesh that is none of a case; `DiskFull` if the disk is full: a
        directory that was made for it is gone then.
    """
    case = describe(spec)
    _refuse_others(case, directory)
    with gone_if_full(directory, RECORD), locked(directory, tell):
        if _holds_other_results(directory, case.identity):
            msg = (
                f"{directory}: holds results of another case, which would be lost; choose "
                "another --out, or remove it"
            )
            raise CaseError(msg)
        write_files(case, directory)
    return directory


def free_directory(spec: CaseSpec, directory: Path) -> Path:
    """Return a directory, or one beside it named after the case where it holds other results.

    Parameters
    ----------
    spec : CaseSpec
        The case that is to be written.
    directory : Path
    """
    identity = describe(spec).identity
    if not _holds_other_results(directory, identity):
        return directory
    return directory.with_name(f"{directory.name}_{identity[:_SHORT]}")


def _holds_other_results(directory: Path, identity: str) -> bool:
    return _identity_there(directory) != identity and _was_run(directory)


def _refuse_others(case: Case, directory: Path) -> None:
    """Refuse to write over what is of no case; a script of ours is known by its mark."""
    if any(all(w in _there(directory / name) for w in words) for name, words in _OURS.items()):
        return
    files = {RECORD: b"", DEFINITION: b"", LOCK: b"", SCRIPT: case.script.encode()}
    files |= {f"{MESHES}/{name}": content for name, content in case.meshes.items()}
    for path, content in ((directory / name, one) for name, one in files.items()):
        if _there(path).strip() not in (b"", content.strip()):
            msg = f"{path}: is no file of a case, and would be lost; choose another --out"
            raise CaseError(msg)


def _there(path: Path) -> bytes:
    """Return what a file holds; a place that cannot be looked at is refused."""
    try:
        return path.read_bytes() if path.is_file() else b""
    except OSError as error:
        raise_if_unusable(error, path.parent)
        raise


def _identity_there(directory: Path) -> str:
    """Return the id of the case in a directory, empty if there is no intact one."""
    try:
        return str(load_record(directory)["case_id"])
    except CaseError:
        return ""


def _was_run(directory: Path) -> bool:
    """Return whether an engine, also one started by hand, left something in a directory."""
    return any((directory / name).exists() for name in (OUTPUT, RESULT, "log.liggghts")) or any(
        (directory / POST).glob("frame_*")
    )


def write_files(case: Case, directory: Path) -> None:
    """Write the files of a case; the lock is the caller's."""
    with suppress(CaseError):  # a case that was here before and was never run
        for name in load_record(directory)["inputs"]["meshes"]:
            if name not in case.meshes and Path(name).name == name:
                (directory / MESHES / name).unlink(missing_ok=True)
    for name, content in case.meshes.items():
        write_bytes(directory / MESHES / name, content)
    write_text(directory / SCRIPT, case.script)
    record = {"case_id": case.identity, "inputs": dict(case.inputs)}
    write_text(directory / RECORD, json.dumps(record, indent=1, sort_keys=True) + "\n")


def is_written(case: Case, directory: Path) -> bool:
    """Return whether a directory holds the files of a case as they were written."""
    try:
        record = load_record(directory)
        checked_files(directory, record)
    except CaseError:
        return False
    return bool(record["case_id"] == case.identity)


def load_record(directory: Path) -> dict[str, Any]:
    """Read `case.json` and check it against its own hash.

    Raises
    ------
    CaseError
        If the file is missing, broken, was changed after it was written, or has the form of
        another version.
    """
    path = directory / RECORD
    try:
        record = json.loads(path.read_bytes().decode("utf-8"))
        hashed, stored = record["inputs"], record["case_id"]
        actual = identity_of(hashed)
    except FileNotFoundError as err:
        msg = f"{path}: missing; make the case with 'bulkcal generate'"
        raise CaseError(msg) from err
    except OSError as err:
        raise_if_unusable(err, directory)
        raise
    except (ValueError, KeyError, TypeError, RecursionError) as err:
        msg = f"{path}: not a case record ({err}); generate the case again"
        raise CaseError(msg) from err
    if actual != stored:
        msg = f"{path}: the inputs do not match the case id; the file was changed, generate again"
        raise CaseError(msg)
    if not isinstance(hashed, dict) or hashed.get("format") != FORMAT:
        msg = f"{path}: written by another version of bulkcal; generate the case again"
        raise CaseError(msg)
    return dict(record)


def load_spec(directory: Path) -> CaseSpec:
    """Return the spec of a case directory.

    Raises
    ------
    CaseError
        As `load_record`.
    """
    return spec_of(load_record(directory), directory)


def spec_of(record: Mapping[str, Any], directory: Path) -> CaseSpec:
    """Return the spec in a record.

    Raises
    ------
    CaseError
        If it has the form of another version.
    """
    try:
        plain = record["inputs"]["spec"]
        own = plain["own"]
        kept = None if own is None else own_of(own, _meshes(record, directory))
        return CaseSpec(**(plain | {"particle": particle_of(plain["particle"]), "own": kept}))
    except (TypeError, KeyError, ValueError) as err:
        msg = f"{directory / RECORD}: written by another version ({err}); generate the case again"
        raise CaseError(msg) from err


def _meshes(record: Mapping[str, Any], directory: Path) -> dict[str, bytes]:
    return {name: _content(directory / MESHES / name) for name in record["inputs"]["meshes"]}


def load_setup(directory: Path) -> Setup:
    """Return the setup a case was written with, also where defaults have changed since.

    Raises
    ------
    CaseError
        As `load_spec`.
    """
    record = load_record(directory)
    resolved = record["inputs"]["resolved_apparatus"]
    return setup_of(replace(spec_of(record, directory), apparatus=resolved))


def code_today(record: Mapping[str, Any], directory: Path) -> dict[str, str]:
    """Return what identifies the code that would run the case of a record today.

    Raises
    ------
    CaseError
        As `spec_of`, and where the experiment is not known any more.
    """
    spec = spec_of(record, directory)
    return code_of(spec.engine, experiment_of(spec))


def other_parts(record: Mapping[str, Any], today: Mapping[str, str]) -> tuple[str, ...]:
    """Return which parts of today's code are not those of a record: "engine", "observables"."""
    stored = record["inputs"]["code"]
    return tuple(part for part, code in today.items() if stored.get(part) != code)


def checked_files(directory: Path, record: Mapping[str, Any]) -> dict[str, bytes]:
    """Read script and meshes of a case and compare them with its record.

    Parameters
    ----------
    directory : Path
    record : Mapping[str, Any]
        As `load_record` returns it.

    Returns
    -------
    dict of str to bytes
        Contents by path in the directory: what an engine may be given.

    Raises
    ------
    CaseError
        Naming the file that is missing, empty or was changed.
    """
    return dict(_checked(directory, record))


def _checked(directory: Path, record: Mapping[str, Any]) -> Iterator[tuple[str, bytes]]:
    content = _content(directory / SCRIPT)
    script = content.decode("utf-8", errors="replace")
    same = script_digest(script) == record["inputs"]["script"]
    if not same or not ends_with_mark(script, record["case_id"]):
        msg = f"{directory / SCRIPT}: was changed by hand since it was generated; {_REMEDY}"
        raise CaseError(msg)
    yield SCRIPT, content
    for name, digest in record["inputs"]["meshes"].items():
        content = _content(directory / MESHES / name)
        if sha256_bytes(content) != digest:
            msg = f"{directory / MESHES / name}: was changed since it was generated; {_REMEDY}"
            raise CaseError(msg)
        yield f"{MESHES}/{name}", content


def _content(path: Path) -> bytes:
    """Return what is in a file of a case; refuse a missing and an empty one."""
    try:
        content = path.read_bytes()
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror}); {_REMEDY}"
        raise CaseError(msg) from err
    if not content.strip():
        msg = f"{path}: is empty; {_REMEDY}"
        raise CaseError(msg)
    return content
