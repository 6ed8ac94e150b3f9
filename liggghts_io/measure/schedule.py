"""What a script asks an engine for: its steps, and the steps at which frames are written."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError
from liggghts_io.measure.script_reader import Dump, ScriptReader
from liggghts_io.measure.script_text import logical_lines, words_of

FRAMES: Final = "frames"
"""Name of the dump in the scripts of this package."""


@dataclass(frozen=True)
class Schedule:
    """Steps of a run.

    Attributes
    ----------
    steps : int, optional
        Step at which it ends; None where the script does not tell.
    most : int, optional
        Step that it does not pass; None where the script does not tell that either.
    dumps : tuple of Dump
    """

    steps: int | None
    most: int | None
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
        The most there can be; 0 where the script does not tell.
    grains : float
        That insertions ask for by number; 0 where the script does not tell.
    """

    steps: float
    grains: float


def load_of(text: str) -> Load:
    """Return how large the run of a script is."""
    reader = _read(text)
    return Load(float(reader.most or 0), reader.grains)


@lru_cache(maxsize=16)  # a run asks for the schedule of its script five times
def schedule_of(text: str) -> Schedule:
    """Return the schedule of a script.

    Raises
    ------
    CaseError
        If it asks for no run.
    """
    reader = _read(text)
    return Schedule(reader.step, reader.most, reader.written())


def _read(text: str) -> ScriptReader:
    reader = ScriptReader()
    for _, line in logical_lines(text):
        reader.read(words_of(line))
    if not reader.runs:
        msg = "no 'run N'; generate the case again, or mend the script"
        raise CaseError(msg)
    return reader
