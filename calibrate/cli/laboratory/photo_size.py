"""What `photo size` finds: grains of one or several photos, their table, files and words."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, cast

import numpy as np
import numpy.typing as npt

from calibrate.cli.laboratory.options import CHECK
from calibrate.cli.laboratory.photo_output import distinct, names_of_pictures
from calibrate.cli.laboratory.photo_size_doubts import size_doubts
from calibrate.cli.show.output import Screen, table
from liggghts_io.errors import CaseError
from liggghts_io.photo.colour import grey_of
from liggghts_io.photo.corners import without_corners
from liggghts_io.photo.drawing import grains_picture, sizes_chart
from liggghts_io.photo.grains.on_ruler import without_ruler
from liggghts_io.photo.grains.result import GrainSizes, pooled
from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.light import Polarity
from liggghts_io.photo.reading import read_photo
from liggghts_io.photo.ruler import check_ruler, find_ruler
from liggghts_io.photo.scale import checked_scale, length_of, scale_between, scale_of
from liggghts_io.photo.tick_lengths import are_finest
from liggghts_io.photo.ticks import Ruler

__all__ = [
    "MeasuredPhotos",
    "measured_photos",
    "names_of_files",
    "show_sizes",
    "size_files",
    "sizes_data",
    "tell_doubts",
]

UM: Final = 1e6
_LEAST_M: Final = 1e-6
_MOST_M: Final = 0.2


@dataclass(frozen=True)
class MeasuredPhotos:
    """Photos of one bulk and what is on them.

    Attributes
    ----------
    photos : sequence of Path
    each : sequence of GrainSizes
    total : GrainSizes
        Of all photos together.
    pictures : sequence of bytes
        PNG of each photo with its outlines; empty where none was asked for.
    rulers : sequence of Ruler
        What was followed in each photo; empty where the scale was told.
    coarse : sequence of Path
        Photos whose ruler may have finer ticks that blur has taken.
    """

    photos: Sequence[Path]
    each: Sequence[GrainSizes]
    total: GrainSizes
    pictures: Sequence[bytes]
    rulers: Sequence[Ruler] = ()
    coarse: Sequence[Path] = ()


def measured_photos(
    photos: Sequence[Path], words: tuple[str, str, str], grains: str, *, draw: bool
) -> MeasuredPhotos:
    """Measure the grains of photos.

    Parameters
    ----------
    photos : sequence of Path
    words : (str, str, str)
        What --scale, --ruler and --points say; two of them are empty.
    grains : str
        "dark", "bright" or empty.
    draw : bool
        Whether pictures are wanted.

    Raises
    ------
    CalibrationError, CaseError
        For a photo or a scale that cannot be.
    """
    fixed = _fixed_scale(words)
    each, pictures, rulers = list[GrainSizes](), list[bytes](), list[Ruler]()
    coarse = list[Path]()
    for path in distinct(photos):
        colour = read_photo(path)
        try:
            ruler = None if fixed else _ruler(colour)
            scale = fixed if ruler is None else _scale_by(ruler, words[1])
            found = measure_sizes(colour, scale, cast("Polarity | None", grains or None))
            if ruler is not None:
                check_ruler(ruler, found.outlines)
                found = without_ruler(found, colour, ruler)
                rulers.append(ruler)
                if not are_finest(grey_of(colour), ruler):
                    coarse.append(path)
        except CaseError as err:
            msg = f"{path}: {err}"
            raise CaseError(msg) from err
        _check(found, path)
        each.append(found)
        if draw:
            pictures.append(grains_picture(colour, found, ruler))
    return MeasuredPhotos(photos, each, pooled(each), pictures, rulers, coarse)


def _fixed_scale(words: tuple[str, str, str]) -> float:
    """Return the size of a pixel [m], 0 where each photo has its ruler."""
    scale, ruler, points = words
    if ruler:
        length_of(ruler, "--ruler")
        return 0.0
    return scale_of(scale) if scale else scale_between(points)


def _ruler(colour: npt.NDArray[np.uint8]) -> Ruler:
    """Return the ruler in a photo, looked for where the camera saw something."""
    colour, missing = without_corners(colour)
    return find_ruler(grey_of(colour), missing)


def _scale_by(ruler: Ruler, word: str) -> float:
    """Return the size of a pixel [m], with a ruler whose ticks are as far apart as --ruler says."""
    return checked_scale(length_of(word, "--ruler") / ruler.pixels, f"--ruler {word}")


def _check(found: GrainSizes, path: Path) -> None:
    """Refuse grains of a size that none have: the scale is wrong then."""
    if not _LEAST_M <= found.d32_m <= _MOST_M:
        msg = (
            f"{path}: grains of {found.d32_m * UM:.3g} um at {found.metres_per_pixel * UM:.3g} um "
            f"a pixel; sizes from {_LEAST_M * UM:g} um to {_MOST_M * 1e3:g} mm can be, so check "
            "the scale"
        )
        raise CaseError(msg)


def sizes_data(found: MeasuredPhotos) -> dict[str, Any]:
    """Return the numbers as JSON shows them; those of each photo where there are several."""
    data = _numbers(found.total)
    if len(found.each) > 1:
        data["photos"] = [
            {"photo": str(path), **_numbers(one)}
            for path, one in zip(found.photos, found.each, strict=True)
        ]
    return data


def _numbers(one: GrainSizes) -> dict[str, Any]:
    d10, d50, d90 = (value * UM for value in one.quantiles_m())
    return {
        "d32_um": one.d32_m * UM,
        "d10_um": d10,
        "d50_um": d50,
        "d90_um": d90,
        "circularity": one.circularity,
        "count": one.count,
    }


def size_files(found: MeasuredPhotos) -> dict[str, bytes]:
    """Return what goes into --out: numbers, a row per grain, distribution, annotated photos."""
    se = found.total.d32_se_m * UM
    record = {
        **_numbers(found.total),
        "d32_se_um": se if np.isfinite(se) else None,
        "photos": [
            {
                "photo": path.name,
                **_numbers(one),
                "um_per_pixel": one.metres_per_pixel * UM,
                "grains": one.polarity,
                "left_out": dict(one.rejected()),
            }
            for path, one in zip(found.photos, found.each, strict=True)
        ],
    }
    total = found.total
    contents = (
        (json.dumps(record, indent=1) + "\n").encode(),
        _rows(found).encode(),
        sizes_chart(total.diameters_m, total.d32_m, total.quantiles_m()),
        *found.pictures,
    )
    return dict(zip(names_of_files(found.photos), contents, strict=True))


def names_of_files(photos: Sequence[Path]) -> list[str]:
    """Return the names of what goes into --out."""
    return ["sizes.json", "grains.csv", "sizes.png", *names_of_pictures(photos, "grains")]


def _rows(found: MeasuredPhotos) -> str:
    """Return a row for each grain, and for each thing that was left out, with the reason."""
    target = io.StringIO()
    rows = csv.writer(target, lineterminator="\n")
    rows.writerow(["photo", "x_px", "y_px", "diameter_um", "circularity", "left_out"])
    for path, one in zip(found.photos, found.each, strict=True):
        sizes = zip(one.outlines.mean(axis=1), one.diameters_m, one.circularities, strict=True)
        for (x, y), diameter, round_ in sizes:
            rows.writerow(
                [path.name, f"{x:.1f}", f"{y:.1f}", f"{diameter * UM:.2f}", f"{round_:.4f}", ""]
            )
        for (x, y), reason in zip(one.left_out.mean(axis=1), one.reasons, strict=True):
            rows.writerow([path.name, f"{x:.1f}", f"{y:.1f}", "", "", reason])
    return target.getvalue()


def show_sizes(screen: Screen, found: MeasuredPhotos) -> None:
    """Print the table of sizes, what was left out, and the lines of a study."""
    headings = ["photo", "d32 (µm)", "d10,0 (µm)", "d50,0 (µm)", "d90,0 (µm)", "circularity",
                "grains", "px across"]  # fmt: skip
    shown = table(headings, headings[1:], "Sizes")
    for path, one in zip(found.photos, found.each, strict=True):
        shown.add_row(path.name, *_cells(one))
    if len(found.each) > 1:
        shown.add_row("together", *_cells(found.total))
    screen.table(shown)
    size, se = (value * UM for value in (found.total.d32_m, found.total.d32_se_m))
    if np.isfinite(se):
        screen.result(
            f"d32 = {size:.5g} ± {se:.2g} um: standard error from {found.total.count} grains, "
            "without that of the scale"
        )
    else:
        screen.result(f"d32 = {size:.5g} um, of one grain")
    if found.rulers:
        each = ", ".join(f"{one.pixels:.2f}" for one in found.rulers)
        screen.hint(f"ticks of the ruler are {each} px apart; blue in the pictures of --out")
    left = _left_out(found)
    if left:
        screen.hint("left out: " + ", ".join(f"{count} {reason}" for reason, count in left.items()))
    tell_doubts(screen, found)
    screen.hint(f"into the study, under [[material]], and then '{CHECK}':\n")
    screen.hint("\n".join(_study_lines(found.total)))


def _study_lines(one: GrainSizes) -> list[str]:
    """Return the lines of a material; quantiles where the grains tell any."""
    lines = [f"{key} = {value:.5g}" for key, value in _numbers(one).items() if key.endswith("_um")]
    d10, d50, d90 = (line.partition("=")[2] for line in lines[1:])
    return lines if d10 != d50 != d90 else lines[:1]


def _cells(one: GrainSizes) -> list[str]:
    sizes = (one.d32_m, *one.quantiles_m())
    return [
        *(f"{value * UM:.1f}" for value in sizes),
        f"{one.circularity:.3f}",
        f"{one.count}",
        f"{one.pixels_across:.1f}",
    ]


def _left_out(found: MeasuredPhotos) -> Counter[str]:
    left: Counter[str] = Counter()
    for one in found.each:
        left.update(one.rejected())
    return left


def tell_doubts(screen: Screen, found: MeasuredPhotos) -> None:
    """Say on stderr what about the photos makes their sizes doubtful."""
    for doubt in size_doubts(found.each, found.total, _left_out(found)):
        screen.remark(doubt)
    if found.coarse:
        screen.remark(
            f"{', '.join(path.name for path in found.coarse)}: no longer ticks at each fifth or "
            "tenth show which ticks of the ruler these are; where blur has taken finer ones, sizes "
            "are 5 or 10 times too small. See in the pictures of --out whether what is --ruler "
            "apart is as far apart as the px above"
        )
