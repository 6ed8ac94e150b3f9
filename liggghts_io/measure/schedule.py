"""What a script asks an engine for: its steps, and the steps at which frames are written."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from liggghts_io.errors import CaseError

_RUN: Final = re.compile(r"^run (\d+)$", re.MULTILINE)
_DUMP: Final = re.compile(r"^dump frames all custom (\d+) post/frame_\*\.dump ", re.MULTILINE)


@dataclass(frozen=True)
class Schedule:
    """Steps of a run.

    Attributes
    ----------
    steps : int
        Steps in all.
    every : int
        Steps between two frames.
    """

    steps: int
    every: int

    @property
    def frames(self) -> tuple[int, ...]:
        """Steps at which a frame is written, the first and the last included."""
        return tuple(range(0, self.steps + 1, self.every))


def read_schedule(script: Path) -> Schedule:
    """Read from a rendered script how long it runs and when it writes frames.

    Raises
    ------
    CaseError
        If the script is missing or has no `run` or no `dump frames` of the form that the
        templates give it.
    """
    try:
        text = script.read_bytes().decode("utf-8")
    except FileNotFoundError as err:
        msg = f"{script}: missing; generate the case again"
        raise CaseError(msg) from err
    except UnicodeDecodeError as err:
        msg = f"{script}: not a text in UTF-8; generate the case again"
        raise CaseError(msg) from err
    runs, dumps = _RUN.findall(text), _DUMP.findall(text)
    if not runs or len(dumps) != 1 or int(dumps[0]) < 1:
        msg = (
            f"{script}: expected 'run N' and one 'dump frames all custom N post/frame_*.dump', "
            f"found {len(runs)} and {len(dumps)}; generate the case again"
        )
        raise CaseError(msg)
    return Schedule(sum(int(steps) for steps in runs), int(dumps[0]))
