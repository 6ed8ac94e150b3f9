"""Files a script may touch: only those inside its root folder.

A script is data that may come from a stranger. Whatever it names for reading or writing is
resolved here, and nothing outside the root is reached: no absolute path, no way up and out, no
symbolic link out.
"""

from __future__ import annotations

from pathlib import Path, PurePosixPath, PureWindowsPath

from minidem.errors import InputError
from minidem.record import record

__all__ = ["CaseFolder", "inside"]


@record
class CaseFolder:
    """The folder of a case, and where in it the script stands after ``shell cd``.

    Attributes
    ----------
    top : Path
        Folder that the script may read and write.
    here : str
        Folder that its file names start from, relative to `top`.
    """

    top: Path
    here: str = "."


def inside(root: Path | CaseFolder, name: str) -> Path:
    """Return the full path of the file `name` of a script.

    Parameters
    ----------
    root : Path or CaseFolder
        Folder that the script may read and write.
    name : str
        Path as the script names it, relative to `root`. The file need not exist.

    Returns
    -------
    Path
        Absolute path with symbolic links followed.

    Raises
    ------
    InputError
        If `name` is empty, absolute or leads out of `root`.
    """
    shown = repr(name[:80])
    if not name.strip() or "\0" in name:
        msg = f"{shown} is not a file name"
        raise InputError(msg)
    if PurePosixPath(name).is_absolute() or PureWindowsPath(name).drive:
        msg = f"{shown} is an absolute path; name files relative to the folder of the case"
        raise InputError(msg)
    folder = root if isinstance(root, CaseFolder) else CaseFolder(root)
    try:
        base, full = folder.top.resolve(), (folder.top / folder.here / name).resolve()
    except (OSError, RuntimeError) as err:
        msg = f"{shown} cannot be resolved: {err}"
        raise InputError(msg) from err
    if not full.is_relative_to(base):
        msg = (
            f"{shown} leads out of the folder of the case; keep all files inside it, or allow a "
            "script that you trust a folder above its own: minidem -folder"
        )
        raise InputError(msg)
    return full
