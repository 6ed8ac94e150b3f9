"""``fix ID GROUP print N "TEXT" [file NAME] [append NAME] [screen yes|no] [title TEXT]``."""

from __future__ import annotations

from pathlib import Path

from minidem.files import append_text
from minidem.record import record
from minidem.registry import Head
from minidem.script.paths import inside
from minidem.words import Words
from minidem.world.event import next_multiple
from minidem.world.fix import FIXES, Fix
from minidem.world.world import World

__all__ = ["PrintFix"]

_NO_TITLE = "none"


@FIXES.register("print")
@record
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
        First line of the file; with ``none`` it has no such line.
    """

    every: int
    text: str
    screen: bool = True
    path: Path | None = None
    append: bool = False
    title: str = ""

    @classmethod
    def read(cls, world: World, head: Head, words: Words) -> PrintFix:
        """Read interval, text and options, and begin the file."""
        words.need(2, 'fix ID GROUP print N "TEXT" [file NAME] [append NAME] [screen yes|no]')
        made = cls(*head, words.interval(), words.take("a text"))
        made.title = f"# Fix print output for fix {head.name}"
        while not words.done():
            key = words.choice(("file", "append", "screen", "title"))
            words.need(1, f"fix print {key} VALUE")
            if key == "screen":
                made.screen = words.yes_no()
            elif key == "title":
                made.title = words.take("a title")
            else:
                made.path = inside(world.root, words.take("a file"))
                made.append = key == "append"
        made.open_file()
        return made

    def open_file(self) -> None:
        """Begin the file with its title, if it has one; OutputError if it cannot be written."""
        if self.path is not None:
            first = "" if self.title == _NO_TITLE else self.title + "\n"
            append_text(self.path, first, anew=not self.append)

    def next_step(self, step: int) -> int:
        """Return the next multiple of the interval."""
        return next_multiple(step, self.every)

    def act(self, world: World) -> None:
        """Print the line."""
        line = world.interpreter.substitute(self.text)
        if self.screen:
            world.log(line)
        if self.path is not None:
            append_text(self.path, line + "\n")
