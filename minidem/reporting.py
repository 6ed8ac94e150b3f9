"""Log file and screen."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from minidem.quantities import THERMO_INTEGERS

__all__ = ["Report"]


class Report:
    """Writes what LIGGGHTS writes to its log and screen.

    Parameters
    ----------
    log : Path or None
        Log file.
    screen : text file or None
        Screen.
    echo : bool
        Show commands on the screen too.
    """

    def __init__(self, log: Path | None, screen: TextIO | None, *, echo: bool) -> None:
        self._log = None
        if log is not None:
            log.parent.mkdir(parents=True, exist_ok=True)
            self._log = log.open("w", buffering=1)
        self._screen = screen
        self._echo = echo

    def line(self, text: str) -> None:
        """Write a line to log and screen."""
        self._both(text + "\n")

    def screen(self, text: str) -> None:
        """Write a line to the screen only."""
        if self._screen is not None:
            self._screen.write(text + "\n")

    def echo(self, text: str) -> None:
        """Write a command to the log, and to the screen if asked for."""
        if self._log is not None:
            self._log.write(text + "\n")
        if self._echo:
            self.screen(text)

    def warning(self, text: str) -> None:
        """Write a warning."""
        self.line("WARNING: " + text)

    def setup(self) -> None:
        """Announce a run."""
        self._both("Setting up run ...\n\n")

    def thermo_header(self, columns: Sequence[str]) -> None:
        """Write the column names."""
        names = {"step": "Step", "atoms": "Atoms", "ke": "KinEng", "vol": "Volume"}
        shown = []
        for name in columns:
            text = name[2:] if name[:2] in ("c_", "f_", "v_") else names.get(name, name.capitalize())
            shown.append(f"{text:>8s} " if name in THERMO_INTEGERS else f"{text:>14s} ")
        self._both("".join(shown) + "\n")

    def thermo(self, columns: Sequence[str], values: Sequence[float]) -> None:
        """Write one line of values."""
        shown = [
            f"{int(value):8d} " if name in THERMO_INTEGERS else f"{value:14.8g} "
            for name, value in zip(columns, values, strict=True)
        ]
        self._both("".join(shown) + "\n")

    def loop(self, seconds: float, steps: int, atoms: int) -> None:
        """Write the loop time."""
        self._both(
            f"Loop time of {seconds:g} on 1 procs for {steps} steps with {atoms} atoms\n\n"
        )

    def close(self) -> None:
        """Close the log."""
        if self._log is not None:
            self._log.close()
            self._log = None

    def _both(self, text: str) -> None:
        if self._log is not None:
            self._log.write(text)
        if self._screen is not None:
            self._screen.write(text)
