"""What `photo angle` finds: heaps of one or several photos, their mean, files and words."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from calibrate.cli.laboratory.options import CHECK
from calibrate.cli.laboratory.photo_output import distinct, names_of_pictures
from calibrate.cli.show.output import Screen, table
from liggghts_io.errors import CaseError
from liggghts_io.photo.above import Above, seen_from_above
from liggghts_io.photo.drawing import heap_picture
from liggghts_io.photo.heap import Heap, Line, measure_heap
from liggghts_io.photo.plate import BORDER
from liggghts_io.photo.reading import read_photo
from liggghts_io.photo.scale import points_of

__all__ = [
    "MeasuredHeaps",
    "angle_files",
    "angles_data",
    "measured_heaps",
    "names_of_files",
    "show_angles",
    "tell_doubts",
]


_UNEQUAL = 4.0
"""Degrees between both flanks from which it is told. Those of one pour may differ by two or three:
a small heap as a whole scatters by 0.6 to 1.4 degrees from pour to pour."""

_ROUGH = 0.4
"""Standard error of the outline [deg] from which it is told; a heap that stands out clearly, 20
grains high, has half of that."""

_FLATTER = 1.0
"""Degrees from which a camera that looked down is told; a level one seems to by 0.3."""


@dataclass(frozen=True)
class MeasuredHeaps:
    """Photos of heaps, each poured anew, and what is on them.

    Attributes
    ----------
    photos : sequence of Path
    heaps : sequence of Heap
    pictures : sequence of bytes
        PNG of each photo with its flanks; empty where none was asked for.
    surface : str
        Wall under the heaps; empty if it was not said.
    above : sequence of Above or None
        How far from above each heap was photographed, where that is seen.
    """

    photos: Sequence[Path]
    heaps: Sequence[Heap]
    pictures: Sequence[bytes]
    surface: str
    above: Sequence[Above | None]

    @property
    def angle_deg(self) -> float:
        """Mean of all photos [deg]."""
        return float(np.mean([heap.repose.angle_deg for heap in self.heaps]))

    @property
    def se_deg(self) -> float:
        """Standard error of the mean; of one photo `error_of` it [deg]."""
        if len(self.heaps) == 1:
            return error_of(self.heaps[0])
        angles = [heap.repose.angle_deg for heap in self.heaps]
        return float(np.std(angles, ddof=1) / np.sqrt(len(angles)))


def measured_heaps(
    photos: Sequence[Path], level: str, surface: str, *, draw: bool
) -> MeasuredHeaps:
    """Measure the heaps of photos.

    Parameters
    ----------
    photos : sequence of Path
    level : str
        What --level says; empty where the plate is looked for.
    surface : str
    draw : bool
        Whether pictures are wanted.

    Raises
    ------
    CalibrationError, CaseError
        For a photo that cannot be measured or a level line that cannot be.
    """
    line: Line | None = None
    if level:
        x1, y1, x2, y2 = points_of(level, "--level")
        line = (x1, y1), (x2, y2)
    heaps, pictures, above = list[Heap](), list[bytes](), list[Above | None]()
    for path in distinct(photos):
        colour = read_photo(path)
        try:
            heap = measure_heap(colour, line)
        except CaseError as err:
            msg = f"{path}: {err}"
            raise CaseError(msg) from err
        heaps.append(heap)
        above.append(seen_from_above(colour, heap.lines, heap.plate.slope))
        if draw:
            title = f"{path.name}: {heap.repose.angle_deg:.2f} ± {error_of(heap):.2f}°"
            pictures.append(heap_picture(colour, heap, title))
    return MeasuredHeaps(photos, heaps, pictures, surface, above)


def error_of(heap: Heap) -> float:
    """Return the standard error of one heap: of its outline, or of two flanks that differ [deg]."""
    between = 0.5 * abs(heap.repose.left_deg - heap.repose.right_deg)
    return float(np.fmax(heap.repose.se_deg, between))


def angles_data(found: MeasuredHeaps) -> dict[str, Any]:
    """Return the numbers as JSON shows them; those of each photo where there are several."""
    if len(found.heaps) == 1:
        return _numbers(found.heaps[0])
    each = [_numbers(heap) for heap in found.heaps]
    return {
        "left_deg": _mean([one["left_deg"] for one in each]),
        "right_deg": _mean([one["right_deg"] for one in each]),
        "angle_deg": found.angle_deg,
        "se_deg": found.se_deg,
        "repeats": len(found.heaps),
        "photos": [
            {"photo": str(path), **one} for path, one in zip(found.photos, each, strict=True)
        ],
        "study": _study_lines(found),
    }


def _numbers(heap: Heap) -> dict[str, Any]:
    repose = heap.repose
    return {
        "left_deg": _known(repose.left_deg),
        "right_deg": _known(repose.right_deg),
        "angle_deg": repose.angle_deg,
        "se_deg": error_of(heap),
    }


def _known(value: float) -> float | None:
    """Return a number, None for a flank that is not in the photo; JSON knows no NaN."""
    return value if math.isfinite(value) else None


def _mean(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else None


def angle_files(found: MeasuredHeaps) -> dict[str, bytes]:
    """Return what goes into --out: numbers, a row per photo, photos with their flanks."""
    record = {
        **angles_data(found),
        "plates": [
            {"photo": path.name, "tilt_deg": heap.plate.tilt_deg, "found_from": heap.plate.source}
            for path, heap in zip(found.photos, found.heaps, strict=True)
        ],
    }
    target = io.StringIO()
    rows = csv.writer(target, lineterminator="\n")
    rows.writerow(["photo", "left_deg", "right_deg", "angle_deg", "se_deg", "tilt_deg"])
    for path, heap in zip(found.photos, found.heaps, strict=True):
        numbers = [*_numbers(heap).values(), heap.plate.tilt_deg]
        rows.writerow([path.name, *("" if one is None else f"{one:.4f}" for one in numbers)])
    contents = (
        (json.dumps(record, indent=1) + "\n").encode(),
        target.getvalue().encode(),
        *found.pictures,
    )
    return dict(zip(names_of_files(found.photos), contents, strict=True))


def names_of_files(photos: Sequence[Path]) -> list[str]:
    """Return the names of what goes into --out."""
    return ["angles.json", "angles.csv", *names_of_pictures(photos, "angle")]


def show_angles(screen: Screen, found: MeasuredHeaps) -> None:
    """Print the table of angles, and of several photos the target for a study."""
    headings = ["photo", "left (deg)", "right (deg)", "mean (deg)", "± (deg)", "plate (deg)",
                "plate found from"]  # fmt: skip
    shown = table(headings, headings[1:6], "Angle of repose")
    for path, heap in zip(found.photos, found.heaps, strict=True):
        numbers = _numbers(heap).values()
        cells = ("-" if one is None else f"{one:.2f}" for one in numbers)
        shown.add_row(path.name, *cells, f"{heap.plate.tilt_deg:+.2f}", heap.plate.source)
    screen.table(shown)
    tell_doubts(screen, found)
    if any(heap.plate.source == BORDER for heap in found.heaps):
        screen.hint(
            "no plate was seen where its border is taken: let the picture end at the plate, or "
            "give --level"
        )
    if len(found.heaps) == 1:
        screen.hint(
            "± is the scatter of the outline, or half of what the flanks differ by; several heaps "
            "tell that of pouring"
        )
        return
    screen.result(f"{found.angle_deg:.2f} ± {found.se_deg:.2g} deg, {len(found.heaps)} repeats")
    screen.hint(f"into the study, and then '{CHECK}':\n")
    screen.hint(_study_lines(found))


def tell_doubts(screen: Screen, found: MeasuredHeaps) -> None:
    """Say on stderr what about a photo makes its angle doubtful."""
    for k, (path, heap) in enumerate(zip(found.photos, found.heaps, strict=True)):
        if len(heap.lines) == 1:
            screen.remark(f"{path}: shows one flank only; both are better than one")
        unequal = abs(heap.repose.left_deg - heap.repose.right_deg)
        if unequal > _UNEQUAL:
            screen.remark(
                f"{path}: its flanks differ by {unequal:.1f} deg; look whether one is the edge of "
                "a shadow, and whether the plate is level (--level)"
            )
        if heap.repose.se_deg > _ROUGH:
            screen.remark(
                f"{path}: its outline scatters by {heap.repose.se_deg:.1f} deg about the flanks; "
                "look whether it is followed in the picture of --out; light the heap, or take "
                "another wall, so that it differs from that"
            )
        above = found.above[k]
        if above is not None and above.flatter_deg > _FLATTER:
            screen.remark(
                f"{path}: the round foot of the heap is seen, from about "
                f"{above.elevation_deg:.0f} deg above, which makes its angle too small by up to "
                f"{above.flatter_deg:.1f} deg; hold the camera as low as the foot"
            )


def _study_lines(found: MeasuredHeaps) -> str:
    """Return the lines of a target in a study file."""
    # A wall may have any words for a name, a target letters, digits and _ only.
    words = re.findall(r"[A-Za-z0-9_]+", found.surface)
    name = "_".join(["angle", *words])
    surface = [f"surface = {json.dumps(found.surface)}"] if found.surface else []
    return "\n".join(
        [
            "[[target]]",
            f"name = {json.dumps(name)}",
            'experiment = "heap"',
            *surface,
            'observable = "angle_deg"',
            'unit = "deg"',
            f"value = {found.angle_deg:.2f}",
            f"se = {found.se_deg:.2g}",
            f"repeats = {len(found.heaps)}",
        ]
    )
