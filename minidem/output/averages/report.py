"""The file that an averaging fix writes, and the options that all of them have."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from minidem.errors import InputError
from minidem.files import append_text
from minidem.output.dump import write_whole
from minidem.record import record
from minidem.script.paths import inside
from minidem.words import Words
from minidem.world.world import World

__all__ = ["REPORT_OPTIONS", "Report"]

REPORT_OPTIONS: Final = ("file", "ave", "overwrite", "title1", "title2", "title3")


@record
class Report:
    """Where results go, and which of them count.

    Attributes
    ----------
    titles : list of str
        First lines of the file.
    path : Path or None
        File that receives the results.
    mode : str
        ``one``, ``running`` or ``window``: which averages are put together.
    window : int
        How many of them.
    overwrite : bool
        Whether the file has the latest only.
    """

    titles: list[str]
    path: Path | None = None
    mode: str = "one"
    window: int = 1
    overwrite: bool = False

    def read_option(
        self,
        world: World,
        key: str,
        words: Words,
        modes: tuple[str, ...] = ("one", "running", "window"),
    ) -> None:
        """Read what follows one of `REPORT_OPTIONS`."""
        if key == "file":
            self.path = inside(world.root, words.take("a file"))
        elif key == "ave":
            self.mode = words.choice(modes, key)
            self.window = words.interval() if self.mode == "window" else 1
        elif key == "overwrite":
            self.overwrite = True
        else:
            title, line = words.take("a title"), int(key[-1]) - 1
            if line < len(self.titles):
                self.titles[line] = title

    def begin(self, style: str) -> None:
        """Write the titles.

        Raises
        ------
        InputError
            If options do not go together.
        """
        if self.overwrite and self.mode != "running":
            msg = f"fix {style}: 'overwrite' needs 'ave running'"
            raise InputError(msg)
        if self.path is not None:
            append_text(self.path, self._heading(), anew=True)

    def write(self, lines: list[str]) -> None:
        """Write lines, after those before them or instead of them."""
        if self.path is None:
            return
        text = "\n".join([*lines, ""])
        if self.overwrite:
            write_whole(self.path, self._heading() + text)
        else:
            append_text(self.path, text)

    def _heading(self) -> str:
        return "\n".join([*self.titles, ""])
