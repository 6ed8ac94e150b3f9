"""A user's own experiment as plain data: the texts of its folder, which travel with a case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from liggghts_io.files import canonical_json, sha256_bytes, sha256_text

DEFINITION: Final = "experiment.toml"
TEMPLATE: Final = "script.in.j2"
"""Files of the folder of an own experiment."""


@dataclass(frozen=True, repr=False)
class OwnExperiment:
    """What the folder of an own experiment holds.

    It can be pickled and hashed, and two folders with the same contents are equal.

    Attributes
    ----------
    name : str
        As the definition says.
    definition : str
        Text of `experiment.toml`.
    script : str
        Text of the script.
    template : bool
        Whether the script is a template (`script.in.j2`), else an ordinary LIGGGHTS script.
    meshes : tuple of (str, bytes)
        STL files by file name, in the order of the names.
    """

    name: str
    definition: str
    script: str
    template: bool
    meshes: tuple[tuple[str, bytes], ...] = ()

    def __repr__(self) -> str:
        """Return name and digest: a mesh may be long."""
        return f"OwnExperiment({self.name!r}, sha256={self.digest})"

    @property
    def digest(self) -> str:
        """Sha256 of all that it holds."""
        return sha256_text(canonical_json(plain_own(self)))


def plain_own(own: OwnExperiment) -> dict[str, Any]:
    """Return an own experiment as JSON holds it; of the meshes, the digests."""
    return {
        "name": own.name,
        "definition": own.definition,
        "script": own.script,
        "template": own.template,
        "meshes": {name: sha256_bytes(content) for name, content in own.meshes},
    }


def own_of(plain: Mapping[str, Any], meshes: Mapping[str, bytes]) -> OwnExperiment:
    """Return the own experiment that `plain_own` described.

    Parameters
    ----------
    plain : Mapping[str, Any]
    meshes : Mapping[str, bytes]
        STL files by file name.

    Raises
    ------
    TypeError, KeyError, ValueError
        If it described none, or a mesh is not the one that it names.
    """
    found = []
    for name, digest in sorted(plain["meshes"].items()):
        if sha256_bytes(meshes[name]) != digest:
            msg = f"the mesh {name} was changed"
            raise ValueError(msg)
        found.append((name, meshes[name]))
    texts = {key: plain[key] for key in ("name", "definition", "script", "template")}
    return OwnExperiment(**texts, meshes=tuple(found))
