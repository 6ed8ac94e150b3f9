"""Progress of a single run on stderr."""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar

__all__ = ["StepBar", "clock"]


def clock(seconds: float | None) -> str:
    """Return the time left as text."""
    if seconds is None:
        return "time left: after the first run"
    minutes, rest = divmod(round(seconds), 60)
    return f"time left {minutes}:{rest:02d}"


class StepBar:
    """Progress of one run, in time steps; an instance is what the engine's `progress` wants."""

    def __init__(self, label: str, console: Console) -> None:
        self._started = time.monotonic()
        self._bar = Bar(
            TextColumn("{task.description}"),
            BarColumn(bar_width=24),
            TextColumn("{task.percentage:.0f} %"),
            TextColumn("{task.fields[left]}"),
            console=console,
        )
        self._task = self._bar.add_task(label, total=None, left="")

    def __enter__(self) -> StepBar:
        """Show the bar."""
        self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the bar as it stands."""
        self._bar.stop()

    def __call__(self, done: int, total: int) -> None:
        """Draw the steps done."""
        elapsed = time.monotonic() - self._started
        left = elapsed / done * (total - done) if done else None
        self._bar.update(self._task, completed=done, total=max(total, 1), left=clock(left))
