"""How much memory a simulation needs, and how much there is."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from minidem.errors import ResourceError

__all__ = ["BYTES_PER_PARTICLE", "available_bytes", "check_room", "shortage"]

BYTES_PER_PARTICLE: Final = 1280
"""In a settled heap (``benchmarks/engine/engine_scaling.py``), neighbour lists included."""
_ALWAYS_ENOUGH = 100_000  # particles; so few need no look at the machine
_KIB, _MIB, _GIB = 1024, 1024**2, 1024**3
_CONTROL_GROUPS: Final = (
    ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
    (
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
        "/sys/fs/cgroup/memory/memory.usage_in_bytes",
    ),
)
"""Limit and use of the container that this process is in, by version of the kernel's interface."""


def available_bytes() -> int | None:
    """Return how much memory this process may still take; None where nothing tells."""
    return min(_offers(), default=None)


def _offers() -> Iterator[int]:
    """Yield what the machine, the container and the user's limits leave."""
    for line in _read("/proc/meminfo").splitlines():
        if line.startswith("MemAvailable:"):
            yield int(line.split()[1]) * _KIB
    for limit, used in _CONTROL_GROUPS:
        words = _read(limit).split(), _read(used).split()
        if all(word and word[0].isdigit() for word in words):
            yield max(int(words[0][0]) - int(words[1][0]), 0)
    if sys.platform != "win32":
        import resource

        limit_of_user = resource.getrlimit(resource.RLIMIT_AS)[0]
        pages = _read("/proc/self/statm").split()
        if limit_of_user != resource.RLIM_INFINITY and pages:
            used_now = int(pages[0]) * os.sysconf("SC_PAGE_SIZE")
            yield max(limit_of_user - used_now, 0)


def _read(name: str) -> str:
    try:
        return Path(name).read_text(encoding="ascii")
    except OSError:
        return ""


def shown(count: int) -> str:
    """Return a number of bytes for people.

    Examples
    --------
    >>> shown(128_000_000_000)
    '119 GiB'
    """
    return f"{count / _GIB:.3g} GiB" if count >= _GIB else f"{count / _MIB:.3g} MiB"


def check_room(particles: int, present: int, what: str) -> None:
    """Refuse particles for which there is no memory.

    Parameters
    ----------
    particles, present : int
        Particles to be added, and those that are there.
    what : str
        Who adds them, for the message.

    Raises
    ------
    ResourceError
        With how much memory they need and how much there is.
    """
    if particles <= _ALWAYS_ENOUGH:
        return
    free = available_bytes()
    needed = particles * BYTES_PER_PARTICLE
    if free is not None and needed > free:
        most = free // BYTES_PER_PARTICLE + present
        msg = (
            f"{what}: {particles} more particles need about {shown(needed)} of memory "
            f"({BYTES_PER_PARTICLE} bytes each), {shown(free)} are free; insert fewer, at most "
            f"{most} in all, or use a larger machine"
        )
        raise ResourceError(msg)


def shortage(step: int, particles: int) -> ResourceError:
    """Return the error for an allocation that has failed."""
    free = available_bytes()
    left = "" if free is None else f", {shown(free)} are free"
    msg = (
        f"step {step}: the machine has not enough memory; {particles} particles are there, which "
        f"take about {shown(particles * BYTES_PER_PARTICLE)}{left}; use fewer particles or a "
        "larger machine"
    )
    return ResourceError(msg)
