"""Lines of thermodynamic output in screen and log."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from minidem.errors import InputError
from minidem.output.text.formats import read_format
from minidem.record import field, record

__all__ = ["LABELS", "ThermoFormat", "label_of", "loop_line"]

LABELS: Final = {
    "step": "Step",
    "elapsed": "Elapsed",
    "elaplong": "Elaplong",
    "dt": "Dt",
    "time": "Time",
    "cpu": "CPU",
    "tpcpu": "T/CPU",
    "spcpu": "S/CPU",
    "cpuremain": "CPULeft",
    "ke": "KinEng",
    "erotate": "RotEng",
    "vol": "Volume",
    "cellalpha": "CellAlpha",
    "cellbeta": "CellBeta",
    "cellgamma": "CellGamma",
}
"""Column titles of the thermo keywords that are not the keyword with a capital."""

_INTEGERS: Final = frozenset(["step", "elapsed", "elaplong", "part", "atoms"])
_TITLE: Final = 8  # characters of an ID that a title shows
_PER_LINE: Final = 3  # values in a line of several


def label_of(keyword: str) -> str:
    """Return the title of a column; of computes, fixes and variables the beginning of the ID.

    Examples
    --------
    >>> label_of("ke"), label_of("f_ts[1]"), label_of("v_energy_all")
    ('KinEng', 'ts[1]', 'energy_a')
    """
    if keyword[:2] in ("c_", "f_", "v_"):
        return keyword[2:][:_TITLE]
    return LABELS.get(keyword, keyword.capitalize())


@record
class ThermoFormat:
    """Titles and formats of the thermo columns.

    Attributes
    ----------
    keywords : tuple of str
        Columns of ``thermo_style custom``.
    several : bool
        Whether a snapshot takes several lines, without a line of titles.
    integer, number : str
        Formats of whole numbers and of others; empty for the default.
    own : dict
        Formats of single columns, from 0.
    """

    keywords: tuple[str, ...]
    several: bool = False
    integer: str = ""
    number: str = ""
    own: dict[int, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Choose the default formats."""
        self.integer = self.integer or ("%14d" if self.several else "%8d")
        self.number = self.number or ("%14.4f" if self.several else "%14.8g")

    def set_format(self, which: str, text: str) -> None:
        """Carry out ``thermo_modify format``.

        Parameters
        ----------
        which : str
            ``int``, ``float`` or the number of a column, from 1.
        text : str
            A C format.

        Raises
        ------
        InputError
            For another word, or a format that does not fit.
        """
        if which == "int":
            self.integer = read_format(text, integer=True)
        elif which == "float":
            self.number = read_format(text, integer=False)
        elif which.isascii() and which.isdigit() and 1 <= int(which) <= len(self.keywords):
            at = int(which) - 1
            self.own[at] = read_format(text, integer=self.keywords[at] in _INTEGERS)
        else:
            columns = len(self.keywords)
            msg = f"thermo_modify format needs int, float or 1 to {columns}, got '{which[:40]}'"
            raise InputError(msg)

    def header(self) -> str:
        """Return the line of titles, empty if there is none."""
        if self.several:
            return ""
        titles = (
            f"{label_of(word):>8} " if word in _INTEGERS else f"{label_of(word):>14} "
            for word in self.keywords
        )
        return "".join(titles)

    def row(self, values: Sequence[float], step: int = 0, clock: float = 0.0) -> str:
        """Return a snapshot.

        Parameters
        ----------
        values : sequence of float
            One per keyword.
        step : int
            Time step; stands above several lines.
        clock : float
            Wall time since the start of the run, s; stands beside it.
        """
        cells = []
        for at, (word, value) in enumerate(zip(self.keywords, values, strict=True)):
            integer = word in _INTEGERS
            form = self.own.get(at, self.integer if integer else self.number)
            cell = form % (int(value) if integer else value) + " "
            if self.several:
                cell = ("" if at % _PER_LINE else "\n") + f"{label_of(word):<8} = {cell}"
            cells.append(cell)
        if not self.several:
            return "".join(cells)
        head = f"---------------- Step {step:8d} ----- CPU = {clock:11.4f} (sec) " + "-" * 16
        return head + "".join(cells)


def loop_line(seconds: float, steps: int, atoms: int, finished: str) -> str:
    """Return the line that ends a run.

    Parameters
    ----------
    seconds : float
        Wall time of the run.
    steps, atoms : int
        Steps done and particles at the end.
    finished : str
        Date and time, as ``Sat Nov 21 03:28:18 2026``.
    """
    return (
        f"Loop time of {seconds:g} on 1 procs for {steps} steps with {atoms} atoms, "
        f"finish time {finished}"
    )
