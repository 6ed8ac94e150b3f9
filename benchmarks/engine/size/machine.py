"""What a table of times says of the machine."""

from __future__ import annotations

import os
import re
from pathlib import Path

__all__ = ["described"]


def described() -> str:
    """Return what the processor calls itself, and how busy the machine is."""
    found = re.search(r"(?m)^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text())
    name = found[1] if found else "unknown processor"
    return f"{name}; load at the start {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
