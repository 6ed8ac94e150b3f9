"""Find dumps and logs among the files of a folder by what they begin with, not by their names."""

from __future__ import annotations

import codecs
import os
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.files import UTF_16_MARKS
from liggghts_io.foreign.binary_dump import begin_of
from liggghts_io.foreign.dump import TEXT, VTK, Series, number_of
from liggghts_io.measure.text_dump.blocks import BEGINS

LOG: Final = "log"
_OTHER: Final = ""
_HEAD: Final = 4000  # bytes by which a file is known
_MOST_VTK: Final = 1 << 26  # bytes in which surfaces are looked for
_SHOWN: Final = 60  # characters of a first line in a message
_MOST_FILES: Final = 200_000
_FEWEST: Final = 3  # files by which a number in the midst of their names is taken for the step
_DEEPEST: Final = 3  # folders below the one that is named
_NUMBER: Final = re.compile(r"\d+")
_LAST_NUMBER: Final = re.compile(r"\d+(?=\D*$)")
_LOG_WORDS: Final = (b"LIGGGHTS (Version", b"LAMMPS (")
_COMMANDS: Final = re.compile(rb"^(atom_style|boundary|units|read_restart)\s", re.MULTILINE)
"""Some of the commands with which a script begins, and the log of minidem, which repeats them."""
_ROWS: Final = b"ITEM: ATOMS"
_SIZES: Final = (b"radi", b"diameter")
_VTK_HEAD: Final = b"# vtk DataFile"
_LEGACY_GRAINS: Final = re.compile(rb"^DATASET\s+(POLYDATA|UNSTRUCTURED_GRID)", re.I | re.M)
_XML: Final = re.compile(rb"(\xef\xbb\xbf)?\s*(<\?xml[^>]*>\s*)?(<!--.*?-->\s*)*<VTKFile ", re.S)
_XML_GRAINS: Final = re.compile(rb"""type=["'](PolyData|UnstructuredGrid)["']""")
_NO_GRAINS: Final = (
    re.compile(rb"\nPOLYGONS\s+[1-9]"),
    re.compile(rb"\nLINES\s+[1-9]"),
    re.compile(rb"\nTRIANGLE_STRIPS\s+[1-9]"),
    re.compile(rb"\nCELL_TYPES\s+\d+\s+([3-9]|1\d)\s"),  # 1 and 2 are points
    re.compile(rb"\nSCALARS volumefraction\s"),
    re.compile(rb"""NumberOf(Polys|Lines|Strips)=["'][1-9]"""),
)
"""What surfaces, lines and volumes of a VTK file are known by, and the means in the cells of a
grid that LIGGGHTS' `dump euler/vtk` writes at points."""
_POST: Final = "post"
"""Folder into which scripts write dumps; the log lies beside it."""
_UNITS: Final = re.compile(rb"ITEM: UNITS\s*\n\s*(\w+)\s*\nITEM: TIME")


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
    beside : tuple of Path
        Logs that lie beside a file that is named, or a folder `post`, where there are no others.
    """

    root: Path
    series: tuple[Series, ...]
    logs: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    beside: tuple[Path, ...] = ()


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
    series = tuple(_series_in(_joined(groups), root))
    logs = sorted(path for group in groups.values() for path, kind in group if kind == LOG)
    known = {one.name for one in series}
    notes = [f"{path}: a directory, not a dump; passed over" for path, n in folders if n in known]
    notes += _parts_in(series)
    beside = () if logs else _logs_beside(place)
    return Files(root, series, tuple(logs), tuple(sorted(notes)), beside)


def _joined(groups: Mapping[str, list[tuple[Path, str]]]) -> dict[str, list[tuple[Path, str]]]:
    """Join VTK files whose names differ in one number that is not the last: that is their step.

    The files themselves do not tell a step. Two alone may be of two runs.
    """
    alike: dict[str, list[str]] = defaultdict(list)
    for name, group in groups.items():
        if len(group) == 1 and group[0][1] == VTK:
            alike[_in_file_name(group[0][0], name)].append(name)
    found = dict(groups)
    for names in alike.values():
        numbers = [_NUMBER.findall(groups[name][0][0].name) for name in names]
        varied = [len(set(column)) for column in zip(*numbers, strict=True)]
        if len(names) < _FEWEST or sorted(varied)[:-1] != [1] * (len(varied) - 1):
            continue
        at, path = varied.index(max(varied)), groups[names[0]][0][0]
        parts = list(_NUMBER.finditer(path.name))[at]
        name = f"{path.name[: parts.start()]}*{path.name[parts.end() :]}"
        folder = names[0].rpartition("/")[0]
        found[f"{folder}/{name}" if folder else name] = [
            one for old in names for one in found.pop(old)
        ]
    return found


def _in_file_name(path: Path, name: str) -> str:
    """Return the name within the folder that is searched, without the numbers of the file."""
    return f"{name.rpartition('/')[0]}/{_NUMBER.sub('*', path.name)}"


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


def _parts_in(series: Sequence[Series]) -> Iterator[str]:
    """Yield what to say of dumps that may be the parts of one, a part for each processor.

    Their names differ by one more number (`%` of LAMMPS), and they have the same steps.
    """
    alike: dict[tuple[str, tuple[int, ...]], list[str]] = defaultdict(list)
    for one in series:
        if one.kind == TEXT:
            steps = tuple(number_of(path, one.name) for path in one.files)
            alike[_NUMBER.sub("#", one.name.replace("*", "#")), steps].append(one.name)
    for names in alike.values():
        if len(names) > 1:
            yield (
                f"{', '.join(names[:3])}{' ...' * (len(names) > 3)}: {len(names)} dumps of the "
                "same steps, one is measured; if each has a part of the grains, join their files"
            )


def _logs_beside(place: Path) -> tuple[Path, ...]:
    """Return the logs of the run that a file or a folder of dumps is a part of."""
    folder = place.absolute() if place.is_dir() else place.absolute().parent
    folders = [] if place.is_dir() else [folder]
    if folder.name == _POST:
        folders.append(folder.parent)
    for one in folders:
        files = sorted(path for path in one.glob("log.*") if path.is_file())
        logs = tuple(path for path in files if _kind(path) == LOG)
        if logs:
            return logs
    return ()


def _head(path: Path, size: int = _HEAD) -> bytes:
    """Return the first bytes of a file, none where it cannot be read."""
    try:
        return begin_of(path, size)
    except (DamagedFile, OSError):
        return b""


def units_said(series: Series) -> str:
    """Return the word for units in a dump that LAMMPS was asked to write it into, else ''."""
    found = _UNITS.match(_head(series.files[0]))
    return found[1].decode() if found else ""


def described(path: Path) -> str:
    """Return what a file begins with, for the message that it is no dump."""
    head = _head(path)
    if not head:
        return "it is empty or cannot be read"
    if head.startswith((codecs.BOM_UTF8, *UTF_16_MARKS)):
        return "it begins with a byte order mark, as editors write; save it as plain ASCII"
    first = head.decode("utf-8", errors="replace").strip().partition("\n")[0]
    return f"it begins with {first[:_SHOWN]!r}"


def _kind(path: Path) -> str:
    """Return what a file is, by its first bytes."""
    head = _head(path)
    if head.startswith(BEGINS):
        return TEXT
    if head.startswith(_LOG_WORDS):
        return LOG
    if path.name.startswith("log.") and _COMMANDS.search(head):
        return LOG
    is_legacy = head.startswith(_VTK_HEAD) and _LEGACY_GRAINS.search(head)
    return VTK if is_legacy or (_XML.match(head) and _XML_GRAINS.search(head)) else _OTHER


def _has_cells(path: Path) -> bool:
    """Whether a VTK file holds surfaces, lines or the cells of a grid."""
    content = _head(path, _MOST_VTK)
    return any(one.search(content) for one in _NO_GRAINS)


def _series_in(groups: dict[str, list[tuple[Path, str]]], root: Path) -> Iterator[Series]:
    """Yield the dumps; a file of another kind among those of a dump is a damaged one of it."""
    found = []
    for name, group in groups.items():
        kinds = [kind for _, kind in group if kind in (TEXT, VTK)]
        if not kinds:
            continue
        kind = max(sorted(set(kinds)), key=kinds.count)
        files = sorted((path for path, _ in group), key=lambda path: (number_of(path, name), path))
        if kind == VTK and any(_has_cells(one) for one in {files[0], files[-1]}):
            continue  # a first one may be empty
        shown = name if len(files) > 1 else files[0].relative_to(root).as_posix()
        found.append(Series(shown, kind, tuple(files)))
    yield from sorted(found, key=_rank)


def _rank(series: Series) -> tuple[bool, bool, int, bool, str]:
    """Return what comes first, by the head of the first file."""
    head = _head(series.files[0], _MOST_VTK if series.kind == VTK else _HEAD)
    titles = [line for line in head.splitlines() if line.startswith(_ROWS)]
    words = set(titles[0].split()) if titles else set()
    placed = series.kind == VTK or words >= {b"x", b"y", b"z"}
    sized = any(word in head.lower() for word in _SIZES)
    return not placed, not sized, -len(series.files), series.kind != TEXT, series.name
