"""What both photo commands do with files: distinct photos in, a directory of results out."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from calibrate.cli.arguments import named_directory
from calibrate.errors import CalibrationError
from liggghts_io.files import sha256_file, write_bytes

__all__ = ["distinct", "names_of_pictures", "out_directory", "write_all"]


def distinct(photos: Sequence[Path]) -> Sequence[Path]:
    """Return the photos, or refuse one that is named twice or a copy: it would count twice.

    Raises
    ------
    CalibrationError
    """
    seen: dict[Path | str, Path] = {}
    for path in photos:
        real = path.resolve()
        if real in seen:
            msg = f"{path}: is named twice; name every photo once"
            raise CalibrationError(msg)
        seen[real] = path
        try:
            digest = sha256_file(path)
        except OSError:
            continue  # told when it is read
        if digest in seen:
            msg = f"{path}: is a copy of {seen[digest]}; a repeat counts once, leave one out"
            raise CalibrationError(msg)
        seen[digest] = path
    return photos


def names_of_pictures(photos: Sequence[Path], kind: str) -> list[str]:
    """Return a name for the picture of each photo; a number where there are several.

    Examples
    --------
    >>> names_of_pictures([Path("a/heap.jpg")], "angle")
    ['heap.angle.png']
    """
    if len(photos) == 1:
        return [f"{photos[0].stem}.{kind}.png"]
    return [f"{k:02d}_{path.stem}.{kind}.png" for k, path in enumerate(photos, start=1)]


def out_directory(option: str | None, names: Iterable[str]) -> Path | None:
    """Return the directory that --out names, None where it was left out.

    Raises
    ------
    CalibrationError
        If it holds a file of one of these names: nothing is written over.
    """
    if option is None:
        return None
    directory = named_directory("--out", option)
    for name in names:
        if (directory / name).exists():
            msg = f"--out {directory}: holds {name} already; name another directory"
            raise CalibrationError(msg)
    return directory


def write_all(directory: Path, files: Mapping[str, bytes]) -> None:
    """Write all files into a directory, or none of them."""
    new = not directory.exists()
    written: list[Path] = []
    try:
        for name, content in files.items():
            write_bytes(directory / name, content)
            written.append(directory / name)
    except BaseException:
        for path in written:
            path.unlink(missing_ok=True)
        if new and directory.is_dir():
            shutil.rmtree(directory, ignore_errors=True)
        raise
