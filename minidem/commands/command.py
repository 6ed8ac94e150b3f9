"""The table of commands."""

from __future__ import annotations

from collections.abc import Callable

from minidem.registry import Registry
from minidem.run.engine import Engine
from minidem.words import Words

__all__ = ["COMMANDS", "Handler"]

Handler = Callable[[Engine, Words], None]
"""Carries out a command, given the words after its own."""

COMMANDS: Registry[Handler] = Registry("command")
"""Command word to its handler; those of the interpreter itself are in `minidem.script`."""
