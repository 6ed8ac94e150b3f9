"""What commands print on stdout."""

from __future__ import annotations

import json
import sys
from typing import Any

from rich.console import Console

__all__ = ["say", "say_json", "stdout"]

PIPE_WIDTH = 110
"""Columns of a file or pipe: wide enough for every table."""


def stdout() -> Console:
    """Return where results go."""
    width = None if sys.stdout.isatty() else PIPE_WIDTH
    return Console(file=sys.stdout, width=width)


def say(text: str) -> None:
    """Print a plain line on stdout."""
    stdout().print(text, highlight=False, markup=False, soft_wrap=True)


def say_json(value: Any) -> None:
    """Print a value as JSON on stdout."""
    say(json.dumps(value, indent=1))
