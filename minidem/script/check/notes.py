"""What a rehearsal notices on its way through a script."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from minidem.errors import ScriptError
from minidem.script.check.finding import Finding

__all__ = ["BOX", "Notes"]

BOX = ("create_box", "read_data", "read_restart")
"""Commands without which nothing else can be judged."""
_DEFINING = ("fix", "compute", "dump", "region", "group", "variable")
_UNDOING = ("unfix", "uncompute", "undump", "lattice")
_WRITING = ("dump", "restart", "write_restart", "write_data", "write_dump", "shell", "log")
_NAME = re.compile(r"\w+")


@dataclass
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
    writes : bool
        Whether the script writes files, which it may read later.
    texts : set of str
        Files that the script prints into.
    jumps : dict
        How often each line has jumped.
    """

    findings: list[Finding] = field(default_factory=list)
    broken: set[str] = field(default_factory=set)
    blind: bool = False
    doubt: int = 0
    doubtful: bool = False
    ahead: set[str] = field(default_factory=set)
    steps_known: bool = True
    writes: bool = False
    texts: set[str] = field(default_factory=set)
    jumps: dict[tuple[str, int], int] = field(default_factory=dict)

    @property
    def certain(self) -> bool:
        """Whether the present line will be executed if the script gets this far."""
        return not self.doubt and not self.ahead

    def follow(self, words: Sequence[str]) -> None:
        """Take notice of a command that is gone through, whether it fails or not."""
        command = words[0] if words else ""
        self.writes = self.writes or command in _WRITING
        reading = command == "fix" and "".join(words[3:4]).startswith("mesh/")
        if command in ("print", "fix") and not reading:
            named = [b for a, b in pairwise(words) if a in ("file", "append")]
            self.texts.update(named)
            self.writes = self.writes or bool(named)
        if self.certain:
            return
        if command in (*_DEFINING, *_UNDOING):
            self.broken.update(words[1:2])
        if command == "run":
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
        found = Finding.of(error, text, certain=self.certain)
        if found.missing_file and self.writes:
            found = Finding.of(error, text, certain=False)
        words = text.split()
        late = found.command == "run" and not self.steps_known
        named = set(_NAME.findall(" ".join(words[1:])))
        # a mistake that follows from another one, or from a guess, is not told
        follows = self.blind or guessed or late or not found.certain or bool(named & self.broken)
        place = (error.file, error.line)
        told = any((one.error.file, one.error.line) == place for one in self.findings)
        if not told and (found.unknown_word or not follows):
            self.findings.append(found)
        self.blind = self.blind or found.command in BOX or found.missing_file
        if found.command not in _DEFINING or len(words) < 2 or words[1].isdigit():
            return ""
        self.broken.add(words[1])
        return words[1] if found.command == "variable" else ""
