"""What happens to stored files: cut, emptied, flipped, edited, deleted, moved in time, littered."""

from __future__ import annotations

import os
import random
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

STORED = (
    "case.json", "in.script", "meshes/*.stl", "result.json", "mass_time.csv", "lock",
    "output/end.json", "output/in.script", "output/meshes/*.stl", "output/post/*.dump",
    "output/log.liggghts", "output/screen.txt", "output/box*.txt", "output/scale.txt",
)  # fmt: skip
"""Every kind of file that a case directory holds."""
RESULT = "result.json"
YEAR_S = 365 * 86400.0


def cut(path: Path, draw: random.Random) -> None:
    """Cut a file somewhere."""
    size = path.stat().st_size
    os.truncate(path, draw.randrange(size) if size else 0)


def empty(path: Path, draw: random.Random) -> None:
    """Leave nothing in a file."""
    del draw
    os.truncate(path, 0)


def flip(path: Path, draw: random.Random) -> None:
    """Flip one bit."""
    content = bytearray(path.read_bytes())
    if content:
        content[draw.randrange(len(content))] ^= 1 << draw.randrange(8)
        path.write_bytes(content)


def delete(path: Path, draw: random.Random) -> None:
    """Remove a file."""
    del draw
    path.unlink()


def edit(path: Path, draw: random.Random) -> None:
    """Change the last digit of one number, as somebody with an editor would."""
    text = path.read_text(encoding="utf-8")
    numbers = list(re.finditer(r"\d", text))
    if numbers:
        at = draw.choice(numbers).start()
        path.write_text(f"{text[:at]}{(int(text[at]) + 5) % 10}{text[at + 1 :]}", encoding="utf-8")


def date_back(path: Path, draw: random.Random) -> None:
    """Give a file a date in the past, as with a clock that was wrong."""
    _date(path, -draw.uniform(0.0, 30.0) * YEAR_S)


def date_ahead(path: Path, draw: random.Random) -> None:
    """Give a file a date in the future."""
    _date(path, draw.uniform(0.0, 10.0) * YEAR_S)


def _date(path: Path, shift_s: float) -> None:
    moment = path.stat().st_mtime + shift_s
    os.utime(path, (moment, moment))


HARMS: Mapping[str, Callable[[Path, random.Random], None]] = {
    "cut": cut, "emptied": empty, "bit flipped": flip, "deleted": delete, "edited": edit,
    "dated back": date_back, "dated ahead": date_ahead,
}  # fmt: skip


@dataclass(frozen=True)
class Harm:
    """One file that was harmed.

    Attributes
    ----------
    path : Path
    how : str
        A key of `HARMS`.
    """

    path: Path
    how: str


def harm(case: Path, kind: str, how: str, draw: random.Random) -> Harm | None:
    """Harm one file of a case; None when the case has no such file.

    Parameters
    ----------
    case : Path
        Case directory.
    kind : str
        Pattern of `STORED`.
    how : str
        A key of `HARMS`.
    draw : Random
    """
    paths = sorted(case.glob(kind))
    if not paths:
        return None
    path = draw.choice(paths)
    HARMS[how](path, draw)
    return Harm(path, how)


def litter(case: Path, draw: random.Random) -> Harm:
    """Leave something in a case directory that a dead process might have left."""
    name = draw.choice(["attempt-0123456789ab", ".result.json.0123.tmp", "lock.holder"])
    path = case / name
    if name.startswith("attempt"):
        (path / "post").mkdir(parents=True, exist_ok=True)
        (path / "post" / "frame_0.dump").write_text("ITEM: TIMESTEP\n0\n", encoding="utf-8")
    else:
        path.write_text('{"pid": 1, "host": "elsewhere", "since": "00:00"}', encoding="utf-8")
    return Harm(path, "littered")
