"""Never silent: what a command shows on stderr while something takes time.

On a terminal a bar moves. In a notebook one line is kept up to date. In a file or pipe lines
appear, every second and a half at first and then ever less often, so that the log of a night stays
short.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Final, Self

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, SpinnerColumn, TextColumn

__all__ = ["Shown", "StepBar", "Waiting", "clock"]

FIRST_S: Final = 1.5
"""Longest silence at the beginning."""
_PART: Final = 0.05  # later silences as a part of the time that has passed
_MOST_S: Final = 60.0


def clock(seconds: float) -> str:
    """Return a duration as a person reads it.

    Examples
    --------
    >>> clock(75), clock(7380.0)
    ('1:15', '2:03:00')
    """
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


class _Lines:
    """Shows a line now and then, in a thread of its own.

    Parameters
    ----------
    line : callable
        Returns what to show.
    show : callable
        Shows it.
    last : bool
        Whether the line is shown once more when it all ends, and as often at all times.
    """

    def __init__(
        self, line: Callable[[], str], show: Callable[[str], None], *, last: bool = False
    ) -> None:
        self._line = line
        self._show = show
        self._last = last
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End; no line comes after this."""
        self._ended.set()
        self._thread.join()
        if self._last:
            self._show(self._line())

    def _run(self) -> None:
        started, pause = time.monotonic(), FIRST_S
        while not self._ended.wait(pause):
            self._show(self._line())
            if not self._last:
                pause = min(max(FIRST_S, _PART * (time.monotonic() - started)), _MOST_S)


class _Place:
    """One place of a notebook; the newest of the texts that it is called with stands there."""

    def __init__(self) -> None:
        from IPython.display import DisplayHandle  # there is none outside a notebook

        make: Any = DisplayHandle  # IPython's annotations are not whole
        handle = make()
        self._show, self._again = handle.display, handle.update

    def __call__(self, text: str) -> None:
        """Show a text."""
        self._show({"text/plain": text}, raw=True)
        self._show = self._again


class Shown:
    """What is on the screen while a ``with`` block lasts.

    Parameters
    ----------
    console : Console
        Where to draw, normally stderr.
    label : str
        What is being done.
    columns : ProgressColumn
        What stands between the label and the time left.
    """

    def __init__(self, console: Console, label: str, *columns: ProgressColumn) -> None:
        self.console = console
        self.started = time.monotonic()
        moving = console.is_terminal and not console.quiet
        self.bar = Progress(
            SpinnerColumn(),
            TextColumn("{task.description}", markup=False),
            *columns,
            TextColumn("{task.fields[left]}", markup=False),
            console=console,
            disable=not moving,
        )
        self.task = self.bar.add_task(label, total=None, left="")
        self._lines = None if moving or console.quiet else self._written()

    def _written(self) -> _Lines:
        """Return what tells the state where no bar can move."""
        if self.console.is_jupyter:
            return _Lines(self.line, _Place(), last=True)
        return _Lines(self.line, self.say)

    def __enter__(self) -> Self:
        """Show it."""
        self.bar.start()
        if self._lines is not None:
            self._lines.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the bar as it stands."""
        if self._lines is not None:
            self._lines.stop()
        self.bar.stop()

    @property
    def elapsed_s(self) -> float:
        """Time since it was made [s]."""
        return time.monotonic() - self.started

    def line(self) -> str:
        """Return the state in words."""
        task = self.bar.tasks[0]
        share = f": {task.percentage:.0f} %" if task.total else ""
        left = f", {task.fields['left']}" if task.fields["left"] else ""
        return f"{task.description}{share} after {clock(self.elapsed_s)}{left}"

    def say(self, line: str) -> None:
        """Print a line above the bar."""
        self.console.print(line, highlight=False, markup=False, soft_wrap=True)


class Waiting(Shown):
    """Shows that something of unknown length goes on; `tell` changes the words."""

    def tell(self, label: str) -> None:
        """Say what is being done now."""
        self.bar.update(self.task, description=label)


class StepBar(Shown):
    """Progress of one run, in time steps; an instance is what the engine's `progress` wants."""

    def __init__(self, label: str, console: Console) -> None:
        columns = BarColumn(bar_width=24), TextColumn("{task.percentage:.0f} %")
        super().__init__(console, label, *columns)

    def __call__(self, done: int, total: int) -> None:
        """Draw the steps done."""
        left = ""
        if done:
            left = f"time left {clock(self.elapsed_s / done * (total - done))}"
        self.bar.update(self.task, completed=done, total=max(total, 1), left=left)
