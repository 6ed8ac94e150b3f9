"""Read the folder of an own experiment: a definition, one script, meshes; nothing else of it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError
from liggghts_io.experiments.own.experiment import check_experiment
from liggghts_io.experiments.own.reading import read_definition
from liggghts_io.experiments.own.record import DEFINITION, TEMPLATE, OwnExperiment

MESHES: Final = "meshes"
_MOST_TEXT: Final = 1_000_000  # bytes of a definition or script
_MOST_MESH: Final = 20_000_000  # bytes of all meshes
_SCRIPTS: Final = ("*.in", "in.*", "*.lmp", "*.liggghts")


def read_experiment(folder: Path) -> OwnExperiment:
    """Read the folder of an own experiment, and check all of it.

    Parameters
    ----------
    folder : Path
        With `experiment.toml`, either `script.in.j2` or one ordinary LIGGGHTS script (`NAME.in` or
        `in.NAME`), and the meshes that the definition names.

    Raises
    ------
    CaseError
        With every mistake that was found, each with file, line, value and remedy.
    """
    if not folder.is_dir():
        msg = f"{folder}: no such folder; it holds {DEFINITION}, a script and meshes"
        raise CaseError(msg)
    definition = _text(folder, DEFINITION)
    found, mistakes = read_definition(definition, str(folder / DEFINITION))
    meshes: dict[str, bytes] = {}
    for k, mesh in enumerate(found.meshes):
        try:
            name = _mesh_name(mesh.file)
            meshes[name] = _content(folder, mesh.file, _MOST_MESH)
        except CaseError as err:
            mistakes.add(("mesh", k, "file"), str(err))
    if sum(map(len, meshes.values())) > _MOST_MESH:
        mistakes.add(("mesh",), f"the meshes have more than {_MOST_MESH // 1_000_000} MB")
    mistakes.tell()
    name = _script_name(folder)
    own = OwnExperiment(
        name=found.head.name,
        definition=definition,
        script=_text(folder, name),
        template=name == TEMPLATE,
        meshes=tuple(sorted(meshes.items())),
    )
    check_experiment(own, str(folder / DEFINITION), str(folder / name))
    return own


def experiment_files(own: OwnExperiment) -> dict[str, bytes]:
    """Return the files of a folder from which the same experiment is read.

    Parameters
    ----------
    own : OwnExperiment

    Returns
    -------
    dict of str to bytes
        By path in the folder. An ordinary script is called after the experiment.
    """
    script = TEMPLATE if own.template else f"{own.name}.in"
    meshes = {f"{MESHES}/{name}": content for name, content in own.meshes}
    return {DEFINITION: own.definition.encode(), script: own.script.encode(), **meshes}


def _mesh_name(file: str) -> str:
    """Return the name of a mesh in the folder `meshes`."""
    folder, _, name = file.rpartition("/")
    if folder != MESHES or not name.endswith(".stl"):
        msg = f"file = {file!r}: a mesh lies at {MESHES}/NAME.stl, in the folder as in the case"
        raise CaseError(msg)
    return name


def _script_name(folder: Path) -> str:
    """Return the name of the only script in a folder."""
    there = [TEMPLATE] if (folder / TEMPLATE).is_file() else []
    plain = sorted({path.name for glob in _SCRIPTS for path in folder.glob(glob)})
    found = [*there, *plain]
    if len(found) != 1:
        names = ", ".join(found) or "none"
        msg = f"{folder}: one script is needed, {TEMPLATE} or an ordinary NAME.in (there: {names})"
        raise CaseError(msg)
    return found[0]


def _content(folder: Path, name: str, most: int) -> bytes:
    """Return what is in a file of the folder; refuse a link out of it and what is no file."""
    path = folder / name
    try:
        if not path.resolve().is_relative_to(folder.resolve()):
            msg = f"{path}: leads out of the folder; put the file itself there"
            raise CaseError(msg)
        if not path.is_file():
            msg = f"{path}: missing, or not a file"
            raise CaseError(msg)
        size = path.stat().st_size
        if size > most:
            msg = f"{path}: {size} bytes; at most {most} are taken"
            raise CaseError(msg)
        return path.read_bytes()
    except OSError as err:
        msg = f"{path}: cannot be read ({err.strerror})"
        raise CaseError(msg) from err


def _text(folder: Path, name: str) -> str:
    content = _content(folder, name, _MOST_TEXT)
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as err:
        line = content[: err.start].count(b"\n") + 1
        msg = f"{folder / name}:{line}: not a text in UTF-8; save it as UTF-8"
        raise CaseError(msg) from err
    if text.startswith("\ufeff"):
        msg = f"{folder / name}:1: begins with a byte order mark; save it as UTF-8 without one"
        raise CaseError(msg)
    return text
