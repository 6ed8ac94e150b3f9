"""What a script asks an engine for: its steps, and the steps at which frames are written.

A script is read from top to bottom. Where its text does not tell a number of steps (a condition,
a variable that only the run knows), nothing is said about it.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError
from liggghts_io.measure.arithmetic import evaluate
from liggghts_io.measure.script_text import logical_lines, words_of

FRAMES: Final = "frames"
"""Name of the dump in the scripts of this package."""
_MOST_FRAMES: Final = 100_000
_COUNTED: Final = ("nparticles", "particles_in_region")
"""Words of insertions behind which a number of grains stands."""
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
    """

    name: str
    pattern: str
    frames: tuple[int, ...] | None


@dataclass(frozen=True)
class Schedule:
    """Steps of a run.

    Attributes
    ----------
    steps : int, optional
        Step at which it ends; None where the script does not tell.
    dumps : tuple of Dump
    """

    steps: int | None
    dumps: tuple[Dump, ...]

    @property
    def frames(self) -> tuple[int, ...]:
        """Steps at which the first dump writes a frame, empty where that is not known."""
        return self.dumps[0].frames or () if self.dumps else ()

    def dump(self, name: str = "") -> Dump:
        """Return a dump by name; without one that of this package's scripts, else the first.

        Raises
        ------
        CaseError
            If there is none.
        """
        known = {one.name: one for one in self.dumps}
        found = known.get(name or FRAMES) or (None if name or not self.dumps else self.dumps[0])
        if found is None:
            names = ", ".join(known) or "none"
            msg = (
                f"no dump {name or 'custom'!r} that writes one file for each frame, such as 'dump "
                f"{name or FRAMES} all custom 1000 post/frame_*.dump id x y z radius' (there: "
                f"{names}); generate the case again, or mend the script"
            )
            raise CaseError(msg)
        return found


def read_schedule(script: Path) -> Schedule:
    """Read from a script how long it runs and when it writes frames.

    Raises
    ------
    CaseError
        If the script is missing or asks for no run.
    """
    try:
        text = script.read_bytes().decode("utf-8")
    except FileNotFoundError as err:
        msg = f"{script}: missing; generate the case again"
        raise CaseError(msg) from err
    except UnicodeDecodeError as err:
        msg = f"{script}: not a text in UTF-8; generate the case again"
        raise CaseError(msg) from err
    try:
        return schedule_of(text)
    except CaseError as err:
        msg = f"{script}: {err}"
        raise CaseError(msg) from err


@dataclass(frozen=True)
class Load:
    """How large a run is, as far as its script tells.

    Attributes
    ----------
    steps : float
        0 where the script does not tell.
    grains : float
        That insertions ask for by number; 0 where the script does not tell.
    """

    steps: float
    grains: float


def load_of(text: str) -> Load:
    """Return how large the run of a script is."""
    reader = _read(text)
    return Load(float(reader.step or 0), reader.grains)


@lru_cache(maxsize=16)  # a run asks for the schedule of its script five times
def schedule_of(text: str) -> Schedule:
    """Return the schedule of a script.

    Raises
    ------
    CaseError
        If it asks for no run.
    """
    return _read(text).schedule()


def _read(text: str) -> ScriptReader:
    reader = ScriptReader()
    for _, line in logical_lines(text):
        reader.read(words_of(line))
    if not reader.runs:
        msg = "no 'run N'; generate the case again, or mend the script"
        raise CaseError(msg)
    return reader


@dataclass
class _Open:
    """A dump while the script is read: from where it writes, and what it has written."""

    dump: Dump
    every: int | None
    steps: set[int] = field(default_factory=set)


@dataclass
class ScriptReader:
    """Reads a script command by command; what its text does not tell stays unknown.

    Attributes
    ----------
    step : int, optional
    runs : int
        How many runs there were.
    values : dict of str to float
        Variables whose value the text tells.
    dumps : dict of str to object
        Dumps that are open, by name.
    closed : list of object
        Dumps that were open before.
    grains : float
        Grains that insertions ask for.
    """

    step: int | None = 0
    runs: int = 0
    values: dict[str, float] = field(default_factory=dict)
    dumps: dict[str, _Open] = field(default_factory=dict)
    closed: list[_Open] = field(default_factory=list)
    grains: float = 0.0

    def read(self, words: list[str]) -> None:
        """Read the words of one command."""
        act = _ACTS.get(words[0]) if words else None
        if act is not None:
            act(self, words)

    def schedule(self) -> Schedule:
        """Return what was read."""
        found = [*self.closed, *self.dumps.values()]
        known = self.step is not None
        return Schedule(
            self.step,
            tuple(
                replace(one.dump, frames=tuple(sorted(one.steps)) if known and one.every else None)
                for one in found
            ),
        )

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
        if count is None or self.step is None:
            self.step = None
            return
        start = self.step
        self.step = max(start, count) if "upto" in words[2:] else start + count
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
        every = self.number(words[4])
        name = words[1]
        self.dumps[name] = _Open(Dump(name, words[5], None), every if every and every > 0 else None)

    def close(self, words: list[str]) -> None:
        """Read `undump`."""
        if len(words) > 1 and words[1] in self.dumps:
            self.closed.append(self.dumps.pop(words[1]))

    def modify(self, words: list[str]) -> None:
        """Read `dump_modify`."""
        if len(words) > 1 and words[1] in self.dumps and {"every", "first"} & {*words[2:]}:
            self.dumps[words[1]].every = None

    def lose(self, words: list[str]) -> None:
        """Forget the step at a condition that may run steps, and at a new step number."""
        if words[0] != "if" or any("run" in word.split()[:1] for word in words[1:]):
            self.runs += any("run" in word.split()[:1] for word in words[1:])
            self.step = None


_ACTS: Final[dict[str, Callable[[ScriptReader, list[str]], None]]] = {
    "variable": ScriptReader.variable,
    "fix": ScriptReader.fix,
    "run": ScriptReader.run,
    "dump": ScriptReader.open,
    "undump": ScriptReader.close,
    "dump_modify": ScriptReader.modify,
    "reset_timestep": ScriptReader.lose,
    "if": ScriptReader.lose,
}
