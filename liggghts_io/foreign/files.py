"""Find dumps and logs among the files of a folder by what they begin with, not by their names."""

from __future__ import annotations

import os
import re
import zlib
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.foreign.dump import TEXT, VTK, Series, number_of
from liggghts_io.measure.dump_text import MARK, open_dump

LOG: Final = "log"
_OTHER: Final = ""
_HEAD: Final = 4000  # bytes by which a file is known
_MOST_VTK: Final = 1 << 26  # bytes in which surfaces are looked for
_MOST_FILES: Final = 200_000
_DEEPEST: Final = 3  # folders below the one that is named
_LAST_NUMBER: Final = re.compile(r"\d+(?=\D*$)")
_LOG_WORDS: Final = (b"LIGGGHTS (Version", b"LAMMPS (")
_COMMANDS: Final = re.compile(rb"^(atom_style|boundary|units|read_restart)\s", re.MULTILINE)
"""Some of the commands with which a script begins, and the log of minidem, which repeats them."""
_ROWS: Final = b"ITEM: ATOMS"
_SIZES: Final = (b"radi", b"diameter")
_VTK_GRAINS: Final = (
    b"DATASET POLYDATA", b"DATASET UNSTRUCTURED_GRID", b'type="PolyData"',
    b'type="UnstructuredGrid"',
)  # fmt: skip
_XML: Final = re.compile(rb"\s*(<\?xml[^>]*>\s*)?<VTKFile ")
_VTK_CELLS: Final = (b"\nPOLYGONS", b"\nLINES", b"\nTRIANGLE_STRIPS")
_CELLS_OF_XML: Final = re.compile(rb'NumberOf(?:Polys|Lines|Strips)="[1-9]')


@dataclass(frozen=True)
class Files:
    """What is in a folder.

    Attributes
    ----------
    root : Path
    series : tuple of Series
        Dumps of grains, the one that can tell most first: places, sizes, many files, text.
    logs : tuple of Path
    notes : tuple of str
        What was passed over.
    """

    root: Path
    series: tuple[Series, ...]
    logs: tuple[Path, ...]
    notes: tuple[str, ...] = ()


def find_files(place: Path) -> Files:
    """Look for dumps and logs in a folder and the folders in it, or at one file.

    Parameters
    ----------
    place : Path

    Raises
    ------
    CaseError
        If there is no such folder or file, or there are too many files.
    """
    if not place.exists():
        msg = f"{place}: no such file or directory"
        raise CaseError(msg)
    root = place if place.is_dir() else place.parent
    groups: dict[str, list[tuple[Path, str]]] = defaultdict(list)
    folders = []
    for path in _below(place):
        name = _LAST_NUMBER.sub("*", path.relative_to(root).as_posix())
        if path.is_dir():
            folders.append((path, name))
        elif path.is_file():  # a pipe or a device would never end
            groups[name].append((path, _kind(path)))
    series = tuple(_series_in(groups, root))
    logs = sorted(path for group in groups.values() for path, kind in group if kind == LOG)
    known = {one.name for one in series}
    notes = [f"{path}: a directory, not a dump; passed over" for path, n in folders if n in known]
    return Files(root, series, tuple(logs), tuple(sorted(notes)))


def _below(place: Path) -> Iterator[Path]:
    """Yield what is in a folder and, a few folders deep, in those in it, never behind links."""
    if not place.is_dir():
        yield place
        return
    count = 0
    for folder, folders, files in os.walk(place):
        depth = len(Path(folder).relative_to(place).parts)
        folders[:] = sorted(one for one in folders if depth < _DEEPEST and one[0] != ".")
        for name in (*folders, *sorted(files)):
            count += 1
            if count > _MOST_FILES:
                msg = f"{place}: more than {_MOST_FILES} files; name the folder with the dumps"
                raise CaseError(msg)
            yield Path(folder, name)


def _kind(path: Path) -> str:
    """Return what a file is, by its first bytes."""
    try:
        with open_dump(path) as opened:
            head = opened.read(_HEAD)
    except (DamagedFile, OSError, EOFError, zlib.error):
        return _OTHER
    if head.startswith(MARK):
        return TEXT
    if head.startswith(_LOG_WORDS):
        return LOG
    if path.name.startswith("log.") and _COMMANDS.search(head):
        return LOG
    is_vtk = head.startswith(b"# vtk DataFile") or _XML.match(head) is not None
    return VTK if is_vtk and any(word in head for word in _VTK_GRAINS) else _OTHER


def _has_cells(path: Path) -> bool:
    """Whether a VTK file holds surfaces or lines: a mesh, or contacts."""
    try:
        with open_dump(path) as opened:
            content = opened.read(_MOST_VTK)
    except (DamagedFile, OSError, EOFError, zlib.error):
        return False
    return any(word in content for word in _VTK_CELLS) or bool(_CELLS_OF_XML.search(content))


def _series_in(groups: dict[str, list[tuple[Path, str]]], root: Path) -> Iterator[Series]:
    """Yield the dumps; a file of another kind among those of a dump is a damaged one of it."""
    found = []
    for name, group in groups.items():
        kinds = [kind for _, kind in group if kind in (TEXT, VTK)]
        if not kinds:
            continue
        kind = max(sorted(set(kinds)), key=kinds.count)
        files = sorted((path for path, _ in group), key=lambda path: (number_of(path), path))
        if kind == VTK and any(_has_cells(one) for one in {files[0], files[-1]}):
            continue  # a first one may be empty
        shown = name if len(files) > 1 else files[0].relative_to(root).as_posix()
        found.append(Series(shown, kind, tuple(files)))
    yield from sorted(found, key=_rank)


def _rank(series: Series) -> tuple[bool, bool, int, bool, str]:
    """Return what comes first, by the head of the first file."""
    try:
        with open_dump(series.files[0]) as opened:
            head = opened.read(_MOST_VTK if series.kind == VTK else _HEAD)
    except (DamagedFile, OSError, EOFError, zlib.error):
        head = b""
    titles = [line for line in head.splitlines() if line.startswith(_ROWS)]
    words = set(titles[0].split()) if titles else set()
    placed = series.kind == VTK or words >= {b"x", b"y", b"z"}
    sized = any(word in head for word in _SIZES)
    return not placed, not sized, -len(series.files), series.kind != TEXT, series.name
