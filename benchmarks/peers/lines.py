"""JSON lines that survive a kill: a line that was cut is left out when they are read again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def append_line(file: Path, record: Mapping[str, Any]) -> None:
    """Add a record as one line, after the rest of a cut line if there is one."""
    cut = file.exists() and not _ends_whole(file)
    with file.open("a", encoding="utf-8") as stream:
        stream.write(("\n" if cut else "") + json.dumps(record) + "\n")


def read_lines(file: Path) -> list[dict[str, Any]]:
    """Return the records of a file, none where it does not exist."""
    records = []
    for text in file.read_text(encoding="utf-8").splitlines() if file.exists() else ():
        try:
            records.append(json.loads(text))
        except json.JSONDecodeError:
            continue
    return records


def _ends_whole(file: Path) -> bool:
    """Whether the last line is complete, or there is none."""
    with file.open("rb") as stream:
        if stream.seek(0, 2) == 0:
            return True
        stream.seek(-1, 2)
        return stream.read() == b"\n"
