"""What a rehearsal notices on its way through a script."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fnmatch import fnmatchcase
from itertools import pairwise

from minidem.errors import ScriptError
from minidem.record import field, record
from minidem.script.check.finding import Finding

__all__ = ["BOX", "Notes"]

BOX = ("create_box", "read_data", "read_restart")
"""Commands without which nothing else can be judged."""
_DEFINING = ("fix", "compute", "dump", "region", "group", "variable")
_UNDOING = ("unfix", "uncompute", "undump", "lattice")
_WRITING = {
    "dump": 5, "write_dump": 3, "restart": 2, "write_restart": 1, "write_data": 1, "log": 1,
    "thermo_log": 1,
}  # fmt: skip
"""Commands that write files, and at which of their words the names of these begin."""
_MAKING = ("rmdir", "mkdir", "rm")  # words of `shell` after which no file is new
_WALL = "wall/gran"
_CONTACTS = "wall/gran/local"  # a compute that needs such a wall
_MODELS = ("property/global", "custom_property/global", _WALL)
"""Fixes that decide which values of the material there are and which are needed."""
_RUNS = {"run", "run_time"}
_NAME = re.compile(r"\w+")


@record
class Notes:
    """What has been noticed so far.

    Attributes
    ----------
    findings : list of Finding
        In the order of the rehearsal.
    broken : set of str
        Names of fixes, computes and so on that may not be as the script says.
    blind : bool
        Whether so much is missing that only unknown words are judged.
    doubt : int
        How many branches deep that may not be taken.
    doubtful : bool
        Whether a condition of the present ``if`` is unknown.
    ahead : set of str
        Labels to which a jump may have gone, over the present line.
    steps_known : bool
        Whether it is known how many steps have been made.
    written : set of str
        Names of files that the script writes, which it may read later.
    unseen : bool
        Whether files may come that nobody can know of.
    models_known : bool
        Whether it is known which contact models and which of their values are there.
    walls_known : bool
        Whether it is known which walls there are.
    texts : set of str
        Files that the script prints into.
    jumps : dict
        How often each line has jumped.
    moved : bool
        Whether a run has made steps for certain.
    units_known : bool
        Whether numbers are in units that minidem has.
    words : sequence of str
        Of the command of the present line, with the values of its variables.
    """

    findings: list[Finding] = field(default_factory=list)
    broken: set[str] = field(default_factory=set)
    blind: bool = False
    doubt: int = 0
    doubtful: bool = False
    ahead: set[str] = field(default_factory=set)
    steps_known: bool = True
    written: set[str] = field(default_factory=set)
    unseen: bool = False
    models_known: bool = True
    walls_known: bool = True
    texts: set[str] = field(default_factory=set)
    jumps: dict[tuple[str, int], int] = field(default_factory=dict)
    moved: bool = False
    units_known: bool = True
    words: Sequence[str] = ()

    @property
    def certain(self) -> bool:
        """Whether the present line will be executed if the script gets this far."""
        return not self.doubt and not self.ahead

    def follow(self, words: Sequence[str]) -> None:
        """Take notice of a command that is gone through, whether it fails or not."""
        self.words = words
        command = words[0] if words else ""
        if command in _WRITING:
            at = _WRITING[command]
            self.written.update(f"{word}*" for word in words[at : at + (2 if at == 2 else 1)])
        self.unseen = self.unseen or (command == "shell" and "".join(words[1:2]) not in _MAKING)
        reading = command == "fix" and "".join(words[3:4]).startswith("mesh/")
        if command in ("print", "fix") and not reading:
            named = [b for a, b in pairwise(words) if a in ("file", "append")]
            self.texts.update(named)
            self.written.update(named)
        if self.certain:
            self.moved = self.moved or (command in _RUNS and "".join(words[1:2]) != "0")
            return
        if command in ("pair_style", "unfix") or "".join(words[3:4]).startswith(_MODELS):
            self.models_known = False
        if command == "unfix" or "".join(words[3:4]).startswith(_WALL):
            self.walls_known = False
        if command in (*_DEFINING, *_UNDOING):
            self.broken.update(words[1:2])
        if command in _RUNS:
            self.steps_known = False
        self.blind = self.blind or command in (*BOX, "clear")

    def add(self, error: ScriptError, text: str, *, guessed: bool) -> str:
        """Take notice of a mistake; return the name of a variable that has no value now.

        Parameters
        ----------
        error : ScriptError
            The mistake.
        text : str
            The line.
        guessed : bool
            Whether the line has values that are guessed.
        """
        found = Finding.of(
            error,
            text,
            certain=self.certain,
            late=self.moved and not text.lstrip().startswith("run"),
        )
        if found.no_particles and (self.moved or not self.steps_known):
            return ""  # steps that insert some are not made here
        words = text.split()
        if found.missing_file:
            if not guessed and self._made_by_script((*words[1:], *self.words[1:])):
                self.blind = self.blind or found.command in (*BOX, "include")
                return self._lose(found, words)
            found = Finding.of(error, text, certain=self.certain and not self.unseen)
        late = found.command in _RUNS and not (self.steps_known and self.units_known)
        named = set(_NAME.findall(" ".join(words[1:])))
        # a mistake that follows from another one, or from a guess, is not told
        follows = self.blind or guessed or late or not found.certain or bool(named & self.broken)
        follows = follows or (found.command == "pair_coeff" and not self.models_known)
        follows = follows or (found.style == _CONTACTS and not self.walls_known)
        place = (error.file, error.line)
        told = any(
            (one.error.file, one.error.line) == place
            or ({one.command, found.command} <= _RUNS and one.error.message == error.message)
            for one in self.findings
        )
        if found.missing_value:  # whatever else is wrong with its line, and once only
            follows = self.blind or not found.certain or not self.models_known
            self.models_known = False
        if found.missing_file:
            follows = guessed
        if not told and (found.unknown_word or not follows):
            self.findings.append(found)
        self.blind = self.blind or found.command in (*BOX, "include")
        return self._lose(found, words)

    def _made_by_script(self, names: Sequence[str]) -> bool:
        """Tell whether a file of one of these names may have been written by the script."""
        return any(
            fnmatchcase(name, pattern.replace("%", "*"))
            for name in names
            for pattern in self.written
        )

    def _lose(self, found: Finding, words: Sequence[str]) -> str:
        """Take notice of what a failed line does not define; return the name of a variable."""
        self.units_known = self.units_known and found.command != "units"
        if found.command == "pair_style" or found.style.startswith(_MODELS[:2]):
            self.models_known = False
        self.walls_known = self.walls_known and not (
            found.command == "fix" and found.style.startswith(_WALL)
        )
        if found.command not in _DEFINING or len(words) < 2 or words[1].isdigit():
            return ""
        self.broken.add(words[1])
        return words[1] if found.command == "variable" else ""
