"""What commands say: results on stdout, everything else on stderr."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from rich.console import Console, JustifyMethod
from rich.table import Table

from calibrate.cli.show.streams import Terminal

__all__ = ["Screen", "printable", "stdout", "table"]

PIPE_WIDTH: Final = 10_000
"""Columns of a file or pipe: no table is cut there."""


def stdout() -> Console:
    """Return where results go."""
    width = None if sys.stdout.isatty() else PIPE_WIDTH
    return Terminal(file=sys.stdout, width=width, markup=False, emoji=False)


def printable(text: str) -> str:
    r"""Return text that every terminal shows: lines stay, other control characters are written out.

    Words of the command line may hold bytes that are no text, and names of files may hold codes
    that would change the colours or the title of a terminal.

    Examples
    --------
    >>> printable("a\x1b[31m")
    'a\\x1b[31m'
    """
    whole = text.encode("utf-8", "backslashreplace").decode("utf-8")
    return "".join(
        one if one == "\n" or one.isprintable() else one.encode("unicode_escape").decode("ascii")
        for one in whole
    )


class _Words(Table):
    """A table of words as they are: names of files and columns may look like codes of styles."""

    def add_row(self, *cells: Any, **options: Any) -> None:
        """Add a row; what a terminal would take for a command is written out."""
        super().add_row(*(printable(c) if isinstance(c, str) else c for c in cells), **options)


def table(headings: Sequence[str], numbers: Sequence[str] = (), title: str = "") -> Table:
    """Return an empty table whose words are never cut.

    Parameters
    ----------
    headings : sequence of str
    numbers : sequence of str
        Headings of the columns that are set to the right.
    title : str
    """
    empty = _Words(title=printable(title) or None, title_justify="left")
    for heading in headings:
        side: JustifyMethod = "right" if heading in numbers else "left"
        empty.add_column(printable(heading), justify=side, overflow="fold")
    return empty


@dataclass(frozen=True)
class Screen:
    """How much a command says, and where.

    Attributes
    ----------
    quiet : bool
        Only results: no progress, no remarks.
    verbose : bool
        Details as well.
    """

    quiet: bool = False
    verbose: bool = False

    @property
    def console(self) -> Console:
        """Where progress and remarks go."""
        return Terminal(stderr=True, quiet=self.quiet, markup=False, emoji=False)

    def result(self, text: str) -> None:
        """Print a line of the result."""
        stdout().print(printable(text), highlight=False, markup=False, soft_wrap=True)

    def json(self, value: Any) -> None:
        """Print a value as JSON, the whole result."""
        self.result(json.dumps(value, indent=1))

    def table(self, shown: Table) -> None:
        """Print a table of the result."""
        stdout().print(shown)

    def hint(self, text: str) -> None:
        """Print what surrounds a result: what it is of, and what comes next."""
        if not self.quiet:
            self.result(text)

    def remark(self, text: str) -> None:
        """Print a line on stderr."""
        self.console.print(printable(text), highlight=False, markup=False, soft_wrap=True)

    def detail(self, text: str) -> None:
        """Print a line on stderr that only -v asks for."""
        if self.verbose:
            self.remark(text)

    def details(self, facts: Mapping[str, Any]) -> None:
        """Print facts on stderr, one line each."""
        for name, value in facts.items():
            self.remark(f"{name}: {_in_words(value)}")

    def plan(self, facts: Mapping[str, Any], as_json: bool) -> None:
        """Print what would be done, the result of a dry run."""
        if as_json:
            self.json(facts)
            return
        for name, value in facts.items():
            self.result(f"{name}: {_in_words(value)}")


def _in_words(value: Any) -> str:
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
