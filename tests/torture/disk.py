"""A disk of five megabytes that fills and is freed."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.torture.accidents import Accidents
from tests.torture.arena import Arena
from tests.torture.program import REFUSED

SIZE = 5 * 1024 * 1024
LEFT = (0, 600_000)
"""Bytes that are left free when a campaign starts: less than it needs."""
PAGE = 4096


def mountable() -> bool:
    """Return whether a small disk can be had: only the administrator of a Linux may mount one."""
    return sys.platform.startswith("linux") and os.geteuid() == 0 and bool(shutil.which("mount"))


@contextmanager
def small_disk(place: Path) -> Iterator[Path]:
    """Mount a disk of 5 MB on `place` while a ``with`` block lasts."""
    place.mkdir(parents=True)
    options = ["-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs"]
    subprocess.run(["mount", *options, str(place)], check=True, capture_output=True)
    try:
        yield place
    finally:
        subprocess.run(["umount", "--lazy", str(place)], check=True, capture_output=True)


def fill_and_free(arena: Arena, draw: random.Random, times: int) -> Accidents:
    """Start campaigns on a disk that is nearly full; each is refused, then the disk is freed."""
    done = Accidents()
    ballast = arena.out.parent / "ballast"
    for _ in range(times):
        free = shutil.disk_usage(arena.out.parent).free
        _write(ballast, max(free - draw.randrange(*LEFT), 0))
        ended = arena.finish()
        done.count += 1
        done.lost += arena.workers
        if ended.code == REFUSED and "disk is full" not in ended.said:
            done.faults.append(f"refused without the reason: {ended.said[-300:]}")
        if ended.code not in (0, REFUSED):
            done.faults.append(f"exit {ended.code}: {ended.said[-500:]}")
        left = [path.name for path in arena.out.rglob("*.tmp")]
        if left:
            done.faults.append(f"temporary files are left: {left}")
        ballast.unlink()
    return done


def _write(path: Path, size: int) -> None:
    with path.open("wb") as file:
        for _ in range(size // PAGE):
            file.write(b"\0" * PAGE)
