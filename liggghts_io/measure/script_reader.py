"""Reads a script for its steps and frames, from top to bottom.

Where its text does not tell a number of steps (a condition, a loop that may end early, a variable
that only the run knows), that number stays unknown; a loop that counts tells the most there can be.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

from liggghts_io.errors import CaseError
from liggghts_io.measure.arithmetic import evaluate

_MOST_FRAMES: Final = 100_000
_COUNTED: Final = ("nparticles", "particles_in_region")
"""Words of insertions behind which a number of grains stands."""
_CONTROLLED: Final = ("run", "jump", "dump", "undump", "dump_modify", "reset_timestep")
"""Commands behind an `if` that decide about steps and frames."""
_REFERENCE: Final = re.compile(r"\$\{(\w+)\}|\$(\w)|\$\(([^()]*(?:\([^()]*\)[^()]*)*)\)|\bv_(\w+)")


@dataclass(frozen=True)
class Dump:
    """A dump of grains that writes one file for every frame.

    Attributes
    ----------
    name : str
    pattern : str
        File name with ``*`` for the step, relative to the folder of the script.
    frames : tuple of int, optional
        Steps at which a frame is written; None where the script does not tell.
    every, since : int, optional
        Steps between two frames, and the first step at which one could be written, of a dump that
        stays as it is until the run ends; None where the script does not tell.
    """

    name: str
    pattern: str
    frames: tuple[int, ...] | None
    every: int | None = None
    since: int | None = None

    def due(self, last: int) -> tuple[int, ...] | None:
        """Return the steps of all frames of a run that ended at step `last`, None if not known."""
        if self.frames is not None or self.every is None or self.since is None:
            return self.frames
        return tuple(range(-(-self.since // self.every) * self.every, last + 1, self.every))


@dataclass
class _Open:
    """A dump while the script is read: from where it writes, and what it has written."""

    dump: Dump
    every: int | None
    since: int | None
    steps: set[int] = field(default_factory=set)

    def told(self, *, known: bool, closed: bool) -> Dump:
        """Return the dump with its frames where all steps are known, else how they follow."""
        if known and self.every:
            return replace(self.dump, frames=tuple(sorted(self.steps)))
        return self.dump if closed else replace(self.dump, every=self.every, since=self.since)


@dataclass
class ScriptReader:
    """Reads a script command by command; what its text does not tell stays unknown.

    Attributes
    ----------
    step : int, optional
    most : int, optional
        Step that is not passed, also where the step itself is unknown.
    runs : int
        How many runs there were.
    values : dict of str to float
        Variables whose value the text tells.
    turns : dict of str to int
        Loop variables and how often they are taken.
    labels : dict of str to int
        Labels and the step that is not passed before them.
    turning : str
        Loop variable that the last command counted on, empty if it did not.
    dumps : dict of str to object
        Dumps that are open, by name.
    closed : list of object
        Dumps that were open before.
    grains : float
        Grains that insertions ask for.
    """

    step: int | None = 0
    most: int | None = 0
    runs: int = 0
    values: dict[str, float] = field(default_factory=dict)
    turns: dict[str, int] = field(default_factory=dict)
    labels: dict[str, int | None] = field(default_factory=dict)
    turning: str = ""
    dumps: dict[str, _Open] = field(default_factory=dict)
    closed: list[_Open] = field(default_factory=list)
    grains: float = 0.0

    def read(self, words: list[str]) -> None:
        """Read the words of one command."""
        act = _ACTS.get(words[0]) if words else None
        if act is not None:
            act(self, words)
        self.turning = words[1] if len(words) > 1 and words[0] == "next" else ""

    def written(self) -> tuple[Dump, ...]:
        """Return the dumps that were read."""
        known = self.step is not None
        before = [one.told(known=known, closed=True) for one in self.closed]
        return (*before, *(one.told(known=known, closed=False) for one in self.dumps.values()))

    def number(self, word: str) -> int | None:
        """Return a whole number that the text tells, else None."""
        value = self.value(word)
        return None if value is None else int(value)

    def value(self, text: str) -> float | None:
        """Return the value of a number, a variable or a formula, None where it is not told."""

        def told(found: re.Match[str]) -> str:
            return f"({found[1] or found[2] or found[4] or found[3]})"

        try:
            opened = _REFERENCE.sub(told, text)  # a formula in $() may name variables itself
            return evaluate(_REFERENCE.sub(told, opened), self.values)
        except CaseError:
            return None

    def variable(self, words: list[str]) -> None:
        """Read `variable`."""
        if len(words) == 4 and words[2] == "loop":
            self.turns[words[1]] = self.number(words[3]) or 0
        if len(words) < 4 or words[2] not in ("equal", "index"):
            return
        value = self.value(" ".join(words[3:]) if words[2] == "equal" else words[3])
        if value is None:
            self.values.pop(words[1], None)
        else:
            self.values[words[1]] = value

    def fix(self, words: list[str]) -> None:
        """Read how many grains a `fix insert` asks for."""
        for key, count in itertools.pairwise(words):
            if key in _COUNTED:
                self.grains += max(self.value(count) or 0.0, 0.0)

    def run(self, words: list[str]) -> None:
        """Read `run`."""
        self.runs += 1
        count = self.number(words[1]) if len(words) > 1 else None
        upto = "upto" in words[2:]
        self.most = _later(self.most, count, upto=upto)
        start, self.step = self.step, _later(self.step, count, upto=upto)
        if start is None or self.step is None:
            return
        for one in self.dumps.values():
            if one.every:
                first = -(-start // one.every) * one.every
                due = range(first, self.step + 1, one.every)
                if len(due) > _MOST_FRAMES:
                    msg = f"dump {one.dump.name}: more than {_MOST_FRAMES} frames; raise its N"
                    raise CaseError(msg)
                one.steps.update(due)

    def open(self, words: list[str]) -> None:
        """Read `dump`."""
        if len(words) < 6 or words[3] != "custom" or "*" not in words[5]:
            return
        every, name = self.number(words[4]), words[1]
        dump = Dump(name, words[5], None)
        self.dumps[name] = _Open(dump, every if every and every > 0 else None, self.step)

    def close(self, words: list[str]) -> None:
        """Read `undump`."""
        if len(words) > 1 and words[1] in self.dumps:
            self.closed.append(self.dumps.pop(words[1]))

    def modify(self, words: list[str]) -> None:
        """Read `dump_modify`."""
        if len(words) > 1 and words[1] in self.dumps and {"every", "first"} & {*words[2:]}:
            self.dumps[words[1]].every = None

    def label(self, words: list[str]) -> None:
        """Read `label`: from here the script may be run again."""
        if len(words) > 1:
            self.labels[words[1]] = self.most

    def jump(self, words: list[str]) -> None:
        """Read `jump`: back along a loop that counts, or to a place that only the run knows."""
        self.step = None
        start = self.labels.get(words[2]) if len(words) > 2 and words[1] == "SELF" else None
        turns = self.turns.get(self.turning)
        if start is None or self.most is None or turns is None:
            self.most = None
        else:
            self.most = start + turns * (self.most - start)

    def condition(self, words: list[str]) -> None:
        """Forget at an `if` what the commands behind it may change."""
        behind = [word.split() for word in words[1:]]
        named = {parts[0] for parts in behind if parts} & {*_CONTROLLED}
        if not named:
            return
        self.runs += "run" in named
        self.step = None
        targets = [parts[-1] for parts in behind if parts[:1] == ["jump"]]
        if named != {"jump"} or any(target in self.labels for target in targets):
            self.most = None
        if named - {"run", "jump"}:
            self._forget_frames()

    def renumber(self, _words: list[str]) -> None:
        """Forget the step at `reset_timestep`."""
        self.step = self.most = None
        self._forget_frames()

    def _forget_frames(self) -> None:
        for one in self.dumps.values():
            one.every = None


def _later(step: int | None, count: int | None, *, upto: bool) -> int | None:
    """Return the step after a run of `count` steps, or up to that step; None if not told."""
    if step is None or count is None:
        return None
    return max(step, count) if upto else step + count


_ACTS: Final[dict[str, Callable[[ScriptReader, list[str]], None]]] = {
    "variable": ScriptReader.variable,
    "fix": ScriptReader.fix,
    "run": ScriptReader.run,
    "dump": ScriptReader.open,
    "undump": ScriptReader.close,
    "dump_modify": ScriptReader.modify,
    "label": ScriptReader.label,
    "jump": ScriptReader.jump,
    "reset_timestep": ScriptReader.renumber,
    "if": ScriptReader.condition,
}
