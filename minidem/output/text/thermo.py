"""Lines of thermodynamic output in screen and log."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from minidem.errors import InputError
from minidem.output.text.formats import read_format

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
    "atoms": "Atoms",
    "ke": "KinEng",
    "erotate": "RotKinEng",
    "vol": "Volume",
    "density": "Density",
    "lx": "Lx",
    "ly": "Ly",
    "lz": "Lz",
    "xlo": "Xlo",
    "xhi": "Xhi",
    "ylo": "Ylo",
    "yhi": "Yhi",
    "zlo": "Zlo",
    "zhi": "Zhi",
}
"""Column titles of the thermo keywords."""

_INTEGERS: Final = frozenset(["step", "elapsed", "elaplong", "atoms"])


def label_of(keyword: str) -> str:
    """Return the title of a column; computes, fixes and variables lose their prefix.

    Examples
    --------
    >>> label_of("ke"), label_of("f_ts[1]")
    ('KinEng', 'ts[1]')
    """
    if keyword[:2] in ("c_", "f_", "v_"):
        return keyword[2:]
    return LABELS.get(keyword, keyword)


@dataclass
class ThermoFormat:
    """Titles and formats of the thermo columns.

    Attributes
    ----------
    keywords : tuple of str
        Columns of ``thermo_style custom``.
    integer, number : str
        Formats of whole numbers and of others.
    """

    keywords: tuple[str, ...]
    integer: str = "%8d"
    number: str = "%14.8g"

    def __post_init__(self) -> None:
        """Choose the default format of each column."""
        self._own: dict[int, str] = {}

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
            self._own[at] = read_format(text, integer=self.keywords[at] in _INTEGERS)
        else:
            columns = len(self.keywords)
            msg = f"thermo_modify format needs int, float or 1 to {columns}, got '{which[:40]}'"
            raise InputError(msg)

    def header(self) -> str:
        """Return the line of titles."""
        return "".join(
            f"{label_of(word):>8} " if word in _INTEGERS else f"{label_of(word):>14} "
            for word in self.keywords
        )

    def row(self, values: Sequence[float]) -> str:
        """Return a line of values, one per keyword."""
        cells = []
        for at, (word, value) in enumerate(zip(self.keywords, values, strict=True)):
            integer = word in _INTEGERS
            form = self._own.get(at, self.integer if integer else self.number)
            cells.append(form % (int(value) if integer else value) + " ")
        return "".join(cells)


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
