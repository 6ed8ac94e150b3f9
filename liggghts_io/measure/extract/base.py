"""What an extractor is: options that a definition gives, and how a number follows from a run."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Annotated, Final

import numpy as np
import numpy.typing as npt
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from liggghts_io.measure.extract.run import Run

FloatArray = npt.NDArray[np.float64]
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Amount = Number | Annotated[str, Field(max_length=200)]
"""A number, or a formula of the parameters and `d32_m`."""
Word = Annotated[str, Field(min_length=1, max_length=200)]

_FILE_CHARACTERS: Final = frozenset(
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./"
)


def inside(name: str) -> str:
    """Return a file name that stays in the folder of a run.

    Raises
    ------
    ValueError
        If it may lead out of it, or holds other characters than letters, digits and ``_-./``.
    """
    if not name or name.startswith("/") or ".." in name or not _FILE_CHARACTERS.issuperset(name):
        msg = "name a file inside the folder of the run, with letters, digits and _-./ only"
        raise ValueError(msg)
    return name


FileName = Annotated[str, Field(max_length=200), AfterValidator(inside)]


def rising(pair: tuple[float, float]) -> tuple[float, float]:
    """Return a pair of parts of a run, from the earlier to the later one.

    Raises
    ------
    ValueError
        If they are not between 0 and 1, or do not rise.
    """
    if not 0.0 <= pair[0] < pair[1] <= 1.0:
        msg = "give two parts of the run from 0 to 1, the earlier one first, such as [0.5, 1.0]"
        raise ValueError(msg)
    return pair


Part = Annotated[tuple[Number, Number], AfterValidator(rising)]


class Options(BaseModel):
    """Options that a definition gives to an extractor; an unknown one is refused.

    Attributes
    ----------
    factor : float
        The value is multiplied by it: 1000 turns kilograms into grams.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    factor: Number = 1.0

    def formulas(self) -> tuple[str, ...]:
        """Return the formulas among the options, to be tried before a run."""
        return ()


class Extractor(Options, ABC):
    """Options of what finds one number in a finished run."""

    @abstractmethod
    def read(self, run: Run) -> float:
        """Return the number, before it is multiplied by `factor`.

        Raises
        ------
        CaseError
            If the run does not determine it; DamagedFile if a file is not as the script says.
        """


class CurveExtractor(Options, ABC):
    """Options of what finds a curve in a finished run.

    Attributes
    ----------
    x_factor : float
        What the levels are levels of is multiplied by it.
    """

    x_factor: Number = 1.0

    @abstractmethod
    def read(self, run: Run) -> tuple[FloatArray, FloatArray]:
        """Return the points of the curve, x and y, before they are multiplied by the factors.

        Raises
        ------
        CaseError
            As `Extractor.read`.
        """
