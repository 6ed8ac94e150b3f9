"""The ``shell`` command: five words that the engine does itself; nothing is ever executed.

As in LIGGGHTS, what the operating system refuses (a folder that is there already, a file that is
not) is no error, ``rm`` deletes single files and ``rmdir`` empty folders, and no word is a pattern.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from minidem.errors import InputError
from minidem.record import field, record
from minidem.script.paths import CaseFolder, inside

__all__ = ["BUILT_IN", "Shell"]

BUILT_IN = ("cd", "mkdir", "mv", "rm", "rmdir")
"""What is done; every other word would start a program."""
_SHOWN = 120  # characters of a line that a message shows


@record
class Shell:
    """Carries out ``shell`` lines inside the folder of a case.

    Attributes
    ----------
    folder : CaseFolder
        The folder; ``cd`` changes where it stands.
    warn : callable
        Takes a warning.
    strict : bool
        Refuse lines that would be skipped.
    idle : bool
        Change nothing, in a rehearsal.
    said : set of str
        Lines that were warned of; each is warned of once.
    """

    folder: CaseFolder
    warn: Callable[[str], None]
    strict: bool = False
    idle: bool = False
    said: set[str] = field(default_factory=set)

    def run(self, words: tuple[str, ...]) -> None:
        """Carry out one line, given the words after ``shell``.

        Raises
        ------
        InputError
            For a missing word, ``cd`` out of the case, and with `strict` for a line that would be
            skipped.
        """
        if not words:
            msg = f"shell needs a command: {', '.join(BUILT_IN)}"
            raise InputError(msg)
        if words[0] not in BUILT_IN:
            self._skip(words, "a script is data and runs no program")
            return
        _check_count(words)
        if words[0] == "cd":
            self._enter(words[1])
            return
        try:
            paths = [self._place(word) for word in words[1:] if not word.startswith("-")]
        except InputError as err:
            self._skip(words, str(err))
            return
        if not self.idle:
            with suppress(OSError):
                _act(words[0], paths)

    def _enter(self, name: str) -> None:
        target = inside(self.folder, name)
        if target.is_dir() or self.idle:
            self.folder.here = str(target.relative_to(self.folder.top.resolve()))
        else:
            self._skip(("cd", name), "there is no such folder")

    def _place(self, name: str) -> Path:
        """Return the path of a file or folder; if it is a link, that of the link itself."""
        if Path(name).name in ("", "..") or not Path(name).name.strip():
            return inside(self.folder, name)
        return inside(self.folder, str(Path(name).parent)) / Path(name).name

    def _skip(self, words: tuple[str, ...], why: str) -> None:
        """Warn of a line that is not carried out, or refuse it."""
        line = f"shell {' '.join(words)}"[:_SHOWN]
        if self.strict:
            msg = f"'{line}' is refused by --strict: {why}"
            raise InputError(msg)
        if line not in self.said:
            self.said.add(line)
            self.warn(f"'{line}' is skipped: {why}")


def _check_count(words: tuple[str, ...]) -> None:
    exact = {"cd": 2, "mv": 3}.get(words[0])
    if len(words) < 2 or len(words) != (exact or len(words)):
        what = {"cd": "one folder", "mv": "two names"}.get(words[0], "at least one name")
        msg = f"shell {words[0]} needs {what}, found {len(words) - 1} words"
        raise InputError(msg)


def _act(word: str, paths: list[Path]) -> None:
    """Change the folder of the case; OSError for what cannot be done."""
    if word == "mv":
        if len(paths) == 2:
            paths[0].replace(paths[1])
        return
    for path in paths:
        with suppress(OSError):
            if word == "mkdir":
                path.mkdir(parents=True, exist_ok=True)
            elif word == "rm":
                path.unlink()
            else:
                path.rmdir()
