"""``fix print``: a line of text every so many steps."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from minidem.world.fix import Fix
from minidem.world.world import World

__all__ = ["PrintFix"]


@dataclass
class PrintFix(Fix):
    """Prints a text with the values variables have at that step.

    Attributes
    ----------
    every : int
        Interval in steps.
    text : str
        The text, variables not yet substituted.
    screen : bool
        Whether it goes to screen and log.
    path : Path or None
        File that receives it too.
    append : bool
        Whether that file goes on.
    title : str
        First line of the file.
    """

    every: int
    text: str
    screen: bool = True
    path: Path | None = None
    append: bool = False
    title: str = ""

    def open_file(self) -> None:
        """Begin the file with its title.

        Raises
        ------
        ValueError
            If it cannot be written.
        """
        if self.path is None:
            return
        try:
            with self.path.open("a" if self.append else "w", encoding="utf-8") as file:
                file.write(self.title + "\n")
        except OSError as err:
            msg = f"fix print cannot write '{self.path.name}': {err.strerror}"
            raise ValueError(msg) from err

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return (step // self.every + 1) * self.every

    def act(self, world: World, step: int) -> None:
        """Print the line."""
        del step
        line = world.interpreter.substitute(self.text)
        if self.screen:
            world.log(line)
        if self.path is not None:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(line + "\n")
