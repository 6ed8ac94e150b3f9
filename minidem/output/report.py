"""Log file and screen."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from minidem.files import open_text, writing
from minidem.output.text.thermo import ThermoFormat, loop_line

__all__ = ["Report"]

_SCREEN = "screen"  # name of the screen in messages


class Report:
    """Writes what LIGGGHTS writes to its log and screen.

    Parameters
    ----------
    log : Path or None
        Log file.
    screen : text file or None
        Screen.
    echo : str
        Where commands are shown: none, screen, log or both.
    """

    def __init__(self, log: Path | None, screen: TextIO | None, *, echo: str) -> None:
        self._log: TextIO | None = None
        self._name = ""
        self._values: TextIO | None = None
        self._values_name = ""
        self.open_log(log, append=False)
        self._screen = screen
        self._echo = echo
        self._formats: list[tuple[str, str]] = []
        self._table = ThermoFormat(())

    def open_log(self, path: Path | None, *, append: bool) -> None:
        """Go on in another log file, or in none; OutputError if it cannot be written."""
        self._close_log()
        if path is not None:
            self._name = path.name
            self._log = open_text(path, append=append)

    def open_thermo_log(self, path: Path | None, *, append: bool) -> None:
        """Write the thermo table into a file of its own too, or no more."""
        self._close_values()
        if path is not None:
            self._values_name = path.name
            self._values = open_text(path, append=append)

    def echo_to(self, where: str) -> None:
        """Choose where commands are shown: none, screen, log or both."""
        self._echo = where

    def line(self, text: str) -> None:
        """Write a line to log and screen."""
        self._both(text + "\n")

    def screen(self, text: str) -> None:
        """Write a line to the screen only."""
        if self._screen is not None:
            with writing(_SCREEN):
                self._screen.write(text + "\n")

    def echo(self, text: str) -> None:
        """Write a command to the log, and to the screen if asked for."""
        if self._log is not None and self._echo in ("log", "both"):
            with writing(self._name):
                self._log.write(text + "\n")
        if self._echo in ("screen", "both"):
            self.screen(text)

    def warning(self, text: str) -> None:
        """Write a warning."""
        self.line("WARNING: " + text)

    def setup(self) -> None:
        """Announce a run."""
        self._both(f"Setting up run at {time.ctime()}\n\n")

    def thermo_format(self, columns: Sequence[str], which: str, text: str) -> None:
        """Apply ``thermo_modify format`` to the columns there are.

        Raises
        ------
        InputError
            If the format does not fit.
        """
        ThermoFormat(tuple(columns)).set_format(which, text)
        self._formats.append((which, text))

    def reset_formats(self) -> None:
        """Forget all formats, as a new ``thermo_style`` does."""
        self._formats = []

    def thermo_header(self, columns: Sequence[str], *, several: bool = False) -> None:
        """Write the column names; with `several` none, but each value behind its name later."""
        self._table = ThermoFormat(tuple(columns), several)
        for which, text in self._formats:
            self._table.set_format(which, text)
        if not several:
            self._table_line(self._table.header() + "\n")

    def thermo(self, values: Sequence[float], step: int, clock: float) -> None:
        """Write values of the columns of the last header, the step and the clock, s."""
        self._table_line(self._table.row(values, step, clock) + "\n")

    def _table_line(self, text: str) -> None:
        self._both(text)
        if self._values is not None:
            with writing(self._values_name):
                self._values.write(text)

    def loop(self, seconds: float, steps: int, atoms: int) -> None:
        """Write the loop time."""
        self._both(loop_line(seconds, steps, atoms, time.ctime()) + "\n\n")

    def close(self) -> None:
        """Close the log and the file of the thermo table."""
        self._close_values()
        self._close_log()

    def _close_values(self) -> None:
        values, self._values = self._values, None
        if values is not None:
            with writing(self._values_name):
                values.close()

    def _close_log(self) -> None:
        log, self._log = self._log, None
        if log is not None:
            with writing(self._name):
                log.close()

    def _both(self, text: str) -> None:
        if self._log is not None:
            with writing(self._name):
                self._log.write(text)
        if self._screen is not None:
            with writing(_SCREEN):
                self._screen.write(text)
