"""Which code makes a run: digests that stand in the case id, so that other code has other cases."""

from __future__ import annotations

import functools
import hashlib
import inspect
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

from liggghts_io.case.liggghts import find_liggghts, liggghts_version
from liggghts_io.errors import CaseError
from liggghts_io.experiments import Experiment
from liggghts_io.files import sha256_text


def code_of(engine: str, experiment: Experiment) -> dict[str, str]:
    """Return what identifies the code of a run, by the name of the part.

    Script and meshes are no part of it: they are covered by what they hold, and so are the
    effects and the geometry that made them.

    Parameters
    ----------
    engine : str
    experiment : Experiment

    Returns
    -------
    dict of str to str
        "engine" and "observables".
    """
    return {"engine": engine_code(engine), "observables": observables_code(experiment)}


def engine_code(engine: str) -> str:
    """Return the digest of minidem's sources, or the version of LIGGGHTS."""
    if engine == "liggghts":
        return liggghts_version(find_liggghts())
    return f"minidem {_minidem_digest()}"


@functools.cache
def _minidem_digest() -> str:
    """Digest of all sources of the bundled engine; read once, since the process runs those."""
    found = find_spec("minidem")
    if found is None or not found.submodule_search_locations:
        msg = "the engine minidem is not installed; reinstall bulkcal"
        raise CaseError(msg)
    folder = Path(found.submodule_search_locations[0])
    return _digest(folder, folder.rglob("*.py"))


def observables_code(experiment: Experiment) -> str:
    """Return the digest of what turns dumps into the numbers of an experiment.

    That is code and, for an experiment that a folder describes, its definition.
    """
    code = _observables_digest(Path(inspect.getfile(experiment.observe)).resolve())
    return (
        sha256_text(code + experiment.definition_digest) if experiment.definition_digest else code
    )


@functools.cache
def _observables_digest(own: Path) -> str:
    """Digest of the file of an experiment and of what all of them measure with."""
    package = Path(__file__).resolve().parents[1]
    return _digest(package, [*(package / "measure").rglob("*.py"), own])


def _digest(folder: Path, paths: Iterable[Path]) -> str:
    """Digest of the names below a folder (or alone, elsewhere) and the contents of files."""
    named = {
        path.relative_to(folder).as_posix() if path.is_relative_to(folder) else path.name: path
        for path in paths
    }
    digest = hashlib.sha256()
    for name, path in sorted(named.items()):
        digest.update(f"{name}\0{path.stat().st_size}\0".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
