"""``file FILE type TYPE ...``: what a mesh takes of its file, in LIGGGHTS' first group of words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from minidem.errors import InputError
from minidem.files import append_text, nothing_is_written
from minidem.record import field, record
from minidem.script.paths import CaseFolder, inside
from minidem.words import Words, one_of
from minidem.world.mesh.edges import EQUAL
from minidem.world.mesh.quality import first_of_each, slivers
from minidem.world.mesh.stl import liggghts_stops_at, not_excluded, numbered_triangles
from minidem.world.mesh.surface import whole
from minidem.world.state import Bools, Floats, Ints

__all__ = ["WORDS", "MeshFile"]

WORDS = (
    "type", "verbose", "heal", "precision", "region", "min_feature_length",
    "element_exclusion_list",
)  # fmt: skip
"""Stand in any order between the file and what moves, turns or scales the mesh."""
_COARSEST = 0.001  # m, the largest precision that LIGGGHTS takes


@record
class MeshFile:
    """A mesh as its file has it, without the triangles that its script leaves out.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3, 3)
        Triangles in the unit of the file.
    numbers : ndarray of int64, shape (n,)
        Lines of the file at which they begin; their places in a binary file.
    kind : int
        Atom type, from 1; 0 until it is read.
    equal : float
        Nodes nearer than this are one, before the mesh is scaled and afterwards.
    heal : bool
        ``heal auto_remove_duplicates``.
    keep : list of callable
        Tell which triangles a word of the script leaves, in the unit of the file.
    bad : (Path, str) or None
        ``element_exclusion_list write``: file for the numbers of triangles to leave out, and its
        name in the script.
    odd : str
        Why LIGGGHTS cannot read the file, empty if it can.
    """

    nodes: Floats
    numbers: Ints
    kind: int = 0
    equal: float = EQUAL
    heal: bool = False
    keep: list[Callable[[Floats, Ints], Bools]] = field(default_factory=list)
    bad: tuple[Path, str] | None = None
    odd: str = ""

    @classmethod
    def read(cls, root: Path | CaseFolder, regions: Mapping[str, Any], words: Words) -> MeshFile:
        """Read the file and the words behind it.

        Parameters
        ----------
        root : Path or CaseFolder
            Folder of the case.
        regions : mapping of str to Region
            Of the script.
        words : Words
            From ``file`` on.

        Raises
        ------
        InputError
            If the atom type is missing, a word is wrong, or triangles have been listed that a
            script has to leave out.
        """
        words.expect("file")
        name = words.take("a file")
        path = inside(root, name)
        made = cls(*numbered_triangles(path, name))
        made.odd = liggghts_stops_at(path)
        while words.peek() in WORDS:
            made.word(root, regions, words)
        if not made.kind:
            words.expect("type")
        for chosen in made.keep:
            made._take(chosen(made.nodes, made.numbers))
        made._take(whole(made.nodes, made.equal))
        if made.heal:
            made._take(first_of_each(made.nodes, made.equal))
        if made.bad is not None:
            made.write(*made.bad)
        if not len(made.nodes):
            msg = "no triangle of the file is left"
            raise InputError(msg)
        return made

    def word(self, root: Path | CaseFolder, regions: Mapping[str, Any], words: Words) -> None:
        """Read one word and its value."""
        key = words.take("a keyword")
        if key == "type":
            self.kind = words.integer()
            if self.kind < 1:
                msg = f"type {self.kind} is not above 0"
                raise InputError(msg)
        elif key == "verbose":
            words.yes_no()
        elif key == "heal":
            choice = words.choice(("auto_remove_duplicates", "no"), key)
            self.heal = choice == "auto_remove_duplicates"
        elif key == "precision":
            self.precision(words.number())
        elif key == "region":
            region = regions[one_of(words.take("a region"), tuple(regions), "region")]
            self.keep.append(lambda nodes, _: region.match(nodes).reshape(-1, 3).all(axis=1))
        elif key == "min_feature_length":
            msg = "min_feature_length is not available in LIGGGHTS-PUBLIC either; leave it out"
            raise InputError(msg)
        else:
            self.exclusion(root, words)

    def precision(self, value: float) -> None:
        """Set the distance below which nodes are one; 0 leaves it as it is, as in LIGGGHTS."""
        if not 0.0 <= value <= _COARSEST:
            msg = f"precision {value:g} is not between 0 and {_COARSEST:g}"
            raise InputError(msg)
        self.equal = value or EQUAL

    def exclusion(self, root: Path | CaseFolder, words: Words) -> None:
        """Read ``read FILE``, which names triangles to leave out, or ``write FILE``."""
        key = words.choice(("read", "write"), "element_exclusion_list")
        name = words.take("a file")
        path = inside(root, name)
        if key == "write":
            self.bad = path, name
        else:
            self.keep.append(lambda _, numbers: not_excluded(path, numbers, name))

    def write(self, path: Path, name: str) -> None:
        """Write the numbers of triangles that no mesh may have, and stop if there are any.

        LIGGGHTS goes on with duplicates; a script that reads the list has none.
        """
        unfit = slivers(self.nodes) | ~first_of_each(self.nodes, self.equal)
        if nothing_is_written():  # what the list is for is seen when it is written
            self._take(~unfit)
            return
        append_text(path, "".join(f"{number}\n" for number in self.numbers[unfit]), anew=True)
        if unfit.any():
            msg = (
                f"{name} is written: {np.count_nonzero(unfit)} triangles are duplicates or "
                f"have hardly an angle; go on with 'element_exclusion_list read {name}'"
            )
            raise InputError(msg)

    def _take(self, which: Bools) -> None:
        self.nodes = np.ascontiguousarray(self.nodes[which])
        self.numbers = self.numbers[which]
