"""Options of `bulkcal post` for output without our records, and what their words mean."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

import typer
from pydantic import ValidationError

from calibrate.errors import CalibrationError, unknown_name
from liggghts_io.foreign import Grains
from liggghts_io.measure.extract import EXTRACTORS, Extractor

__all__ = [
    "AngleFlag",
    "BoxWords",
    "ColumnWords",
    "CountFlag",
    "Density",
    "Diameter",
    "DumpName",
    "FramesWord",
    "MassFlag",
    "MeasuredFolder",
    "OutFile",
    "PlaneName",
    "Request",
    "SlopeFlag",
    "SlowerThan",
    "ThermoFlag",
    "TimeStep",
    "UnitsName",
    "box_of",
    "extractors_of",
    "part_of",
]

ALL: Final = "all"
LAST: Final = "last"
PLANES: Final = ("xz", "yz")
_AXES: Final = "xyz"
_MEANS: Final = {"least": 0.0, "median": 50.0, "largest": 100.0}
"""What is told of a column beside its mean, as percentiles."""

AngleFlag = Annotated[
    bool, typer.Option("--angle", help="Angle of repose of a heap [deg], mean of both flanks.")
]
SlopeFlag = Annotated[
    bool, typer.Option("--slope", help="Angle of one line through the upper outline [deg].")
]
PlaneName = Annotated[
    str,
    typer.Option("--plane", metavar="xz|yz", help="Plane in which angles are seen."),
]
ColumnWords = Annotated[
    list[str],
    typer.Option(
        "--column", metavar="NAME",
        help="Mean, least, median and largest value of a column, or of speed; repeatable.",
    ),
]  # fmt: skip
CountFlag = Annotated[bool, typer.Option("--count", help="Number of grains.")]
MassFlag = Annotated[bool, typer.Option("--mass", help="Mass of the grains [kg].")]
BoxWords = Annotated[
    list[str],
    typer.Option(
        "--box", metavar="AXIS=FROM:TO",
        help="Only grains with their middle there [m], for example z=0:0.02; repeatable.",
    ),
]  # fmt: skip
SlowerThan = Annotated[
    float | None,
    typer.Option("--slower-than", metavar="M/S", min=0.0, help="Only grains below this speed."),
]
FramesWord = Annotated[
    str,
    typer.Option(
        "--frames", metavar="all|last|FROM:TO",
        help="Frames that are measured; FROM:TO are parts of the run, 0.5:1 the second half.",
    ),
]  # fmt: skip
DumpName = Annotated[
    str, typer.Option("--dump", metavar="NAME", help="Dump that is measured, as it is listed.")
]
ThermoFlag = Annotated[bool, typer.Option("--thermo", help="The thermo table of the log.")]
MeasuredFolder = Annotated[
    str,
    typer.Option(
        "--experiment", metavar="DIR",
        help="Folder with an experiment.toml, whose observables are measured.",
    ),
]  # fmt: skip
UnitsName = Annotated[
    str,
    typer.Option(
        "--units",
        metavar="si|cgs|lj|micro|nano",
        help="Units of the run; default: those of its log, or si.",
    ),
]
TimeStep = Annotated[
    float | None,
    typer.Option(
        "--timestep", metavar="S", min=1e-15, max=1e3, help="Time step; default: that of the log."
    ),
]
Density = Annotated[
    float | None,
    typer.Option(
        "--density", metavar="KG_M3", min=1e-3, max=1e6, help="Density of the grains, for masses."
    ),
]
Diameter = Annotated[
    float | None,
    typer.Option(
        "--diameter",
        metavar="M",
        min=1e-9,
        max=1e3,
        help="Diameter of all grains, for dumps without sizes.",
    ),
]
OutFile = Annotated[
    Path | None, typer.Option("--out", metavar="FILE.csv", help="Write the table there.")
]


@dataclass(frozen=True)
class Request:
    """What is to be measured.

    Attributes
    ----------
    angle, slope, count, mass, thermo : bool
    columns, box : sequence of str
    plane, frames, dump, folder, units : str
    slower_than, timestep : float, optional
    grains : Grains
    apparatus : Mapping[str, float]
        Parameters of the experiment in `folder`.
    out : Path, optional
    """

    angle: bool
    slope: bool
    count: bool
    mass: bool
    thermo: bool
    columns: Sequence[str]
    box: Sequence[str]
    plane: str
    frames: str
    dump: str
    folder: str
    units: str
    slower_than: float | None
    timestep: float | None
    grains: Grains
    apparatus: Mapping[str, float]
    out: Path | None

    @property
    def measures(self) -> bool:
        """Whether a number of the grains is asked for."""
        return bool(self.angle or self.slope or self.count or self.mass or self.columns)

    @property
    def asks(self) -> bool:
        """Whether anything is asked for that a case of our own does not tell of itself."""
        words = (self.folder, self.dump, self.units, self.thermo, self.out, self.box)
        return self.measures or any(words)


def extractors_of(request: Request) -> dict[str, Extractor]:
    """Return what finds each number, by its name in the table.

    Raises
    ------
    CalibrationError
        For words that mean nothing.
    """
    if request.plane not in PLANES:
        msg = f"--plane {request.plane}: {unknown_name(request.plane, PLANES)}"
        raise CalibrationError(msg)
    common = {"box": box_of(request.box), "slower_than": request.slower_than}
    seen = common | {"plane": request.plane}
    found: dict[str, Extractor] = {}

    def add(name: str, kind: str, **options: object) -> None:
        try:
            found[name] = EXTRACTORS[kind].model_validate(options)
        except ValidationError as err:
            first = err.errors()[0]
            key = ".".join(str(one) for one in first["loc"]).replace("_", "-")
            msg = f"--{key} {first['input']!r}: {first['msg'].lower()}"
            raise CalibrationError(msg) from None

    if request.angle:
        add("angle_deg", "angle", **seen)
    if request.slope:
        add("slope_deg", "angle", **seen, shape="slope", signed=True)
    if request.count:
        add("grains", "count", **common)
    if request.mass:
        add("mass_kg", "mass", **common)
    for column in request.columns:
        add(f"{column}_mean", "grain_mean", **common, column=column)
        for word, percent in _MEANS.items():
            add(f"{column}_{word}", "grain_percentile", **common, column=column, percent=percent)
    return found


def box_of(words: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Return the sides of a box from words such as ``z=0:0.02``.

    Raises
    ------
    CalibrationError
        With the word, and what would be right.

    Examples
    --------
    >>> box_of(["z=0:0.02", "x=:0.1"])
    {'z': (0.0, 0.02), 'x': (-1e+300, 0.1)}
    """
    sides: dict[str, tuple[float, float]] = {}
    for word in (one for words_ in words for one in words_.split(",")):
        axis, _, limits = word.strip().partition("=")
        pair = _pair(limits, (-_FAR, _FAR))
        if axis not in tuple(_AXES) or axis in sides or pair is None:
            msg = (
                f"--box {word}: write AXIS=FROM:TO in metres, each axis once, for example z=0:0.02 "
                "(a side that is left out is open: z=0:)"
            )
            raise CalibrationError(msg)
        sides[axis] = pair
    return sides


_FAR: Final = 1e300


def part_of(word: str) -> tuple[float, float] | None:
    """Return the part of the frames that is asked for, None for the last one.

    Raises
    ------
    CalibrationError
        With the word, and what would be right.

    Examples
    --------
    >>> part_of("0.5:1"), part_of("all"), part_of("last")
    ((0.5, 1.0), (0.0, 1.0), None)
    """
    if word == LAST:
        return None
    pair = (0.0, 1.0) if word == ALL else _pair(word, (0.0, 1.0))
    if pair is None or not 0.0 <= pair[0] <= pair[1] <= 1.0:
        msg = f"--frames {word}: write all, last or FROM:TO, parts of the run such as 0.5:1"
        raise CalibrationError(msg)
    return pair


def _pair(text: str, open_: tuple[float, float]) -> tuple[float, float] | None:
    """Return two rising numbers from ``FROM:TO``; a side without a number is open."""
    low, colon, high = text.partition(":")
    try:
        pair = (float(low) if low else open_[0], float(high) if high else open_[1])
    except ValueError:
        return None
    finite = colon and all(map(math.isfinite, pair))
    return pair if finite and pair[0] <= pair[1] else None
