"""Errors of `bulkcal photo` over drawn photographs whose truth is known.

    python benchmarks/laboratory/photos.py [--photos 40] [--seed 1]

Everything about a photograph is drawn at random: count, size in pixels, shape and contact of
grains; angle, height, place and plate of a heap; colours, light, blur, noise, texture, JPEG.
Printed is a table of errors for docs/how-to/measure-with-a-camera.md.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from liggghts_io import CaseError
from liggghts_io.photo.grains.sizes import measure_sizes
from liggghts_io.photo.heap import measure_heap
from tests.liggghts_io.photo import heaps, scene

ColourImage = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class Errors:
    """Errors of one photograph; None where it was refused.

    Attributes
    ----------
    kind : str
        Row of the table.
    values : sequence of float or None
        In the order of the columns.
    """

    kind: str
    values: Sequence[float] | None


def random_scene(rng: np.random.Generator, diameter: float, seed: int) -> scene.Scene:
    """Return grains of a mean diameter [px], everything else at random."""
    dark = rng.random() < 0.6
    high, low = rng.uniform(150.0, 240.0), rng.uniform(20.0, 90.0)
    return scene.Scene(
        count=round(np.exp(rng.uniform(np.log(20), np.log(250)))),
        diameter=diameter,
        spread=rng.uniform(0.03, 0.25),
        aspect=rng.uniform(1.0, 1.6),
        touching=rng.uniform(0.0, 0.6),
        cover=rng.uniform(0.08, 0.22),
        ground=high if dark else low,
        grain=low if dark else high,
        highlight=rng.choice([0.0, 0.4]),
        blur=min(rng.uniform(0.4, 2.5), 0.1 * diameter),
        noise=rng.uniform(0.5, 8.0),
        slope=rng.uniform(0.0, 0.4),
        vignette=rng.uniform(0.0, 0.3),
        texture=rng.choice([0.0, 4.0]),
        tracer=rng.random() < 0.3,
        ruler=rng.random() < 0.3,
        dust=int(rng.choice([0, 10])),
        seed=seed,
    )


def random_pile(rng: np.random.Generator, grains: float, seed: int) -> heaps.Pile:
    """Return a heap of grains of a diameter [px], everything else at random."""
    left = rng.uniform(22.0, 46.0)
    dark = rng.random() < 0.6
    bright, dim = rng.uniform(150.0, 230.0, 3), rng.uniform(20.0, 90.0, 3)
    height = rng.uniform(110.0, 190.0)
    return heaps.Pile(
        left=left,
        right=left + rng.uniform(-3.0, 3.0),
        height=height,
        middle=rng.uniform(0.45, 0.55),
        plate=rng.uniform(40.0, 90.0),
        plate_width=rng.choice([1e6, 2.4 * height / np.tan(np.radians(left))]),
        ground=tuple(bright if dark else dim),
        grain=tuple(dim if dark else bright),
        table=tuple(rng.uniform(20.0, 230.0, 3)),
        tilt=rng.uniform(-4.0, 4.0),
        grains=grains,
        rounded=rng.uniform(0.0, 0.05),
        shadow=rng.choice([0.0, 0.25]) if dark else 0.0,
        slope=rng.uniform(0.0, 0.4),
        blur=rng.uniform(0.5, 2.5),
        noise=rng.uniform(0.5, 8.0),
        texture=rng.choice([0.0, 6.0]),
        funnel=rng.random() < 0.4,
        jpeg=int(rng.choice([0, 60, 85])),
        seed=seed,
    )


def size_errors(one: scene.Scene, kind: str, rng: np.random.Generator) -> Errors:
    """Return errors of d32 and d10 to d90 [%], of circularity, and the share not counted [%]."""
    grey, truth = scene.photograph(one)
    colour = np.repeat(grey[:, :, None], 3, axis=2)
    if rng.random() < 0.5:
        colour = heaps.through_jpeg(colour, int(rng.uniform(60, 95)))
    try:
        found = measure_sizes(colour, 1.0)
    except CaseError:
        return Errors(kind, None)
    quantiles = [
        100.0 * abs(value / truth.quantile(part) - 1.0)
        for value, part in zip(found.quantiles_m(), (0.1, 0.5, 0.9), strict=True)
    ]
    return Errors(
        kind,
        (
            100.0 * abs(found.d32_m / truth.d32 - 1.0),
            max(quantiles),
            abs(found.circularity - truth.circularity),
            100.0 * abs(found.count / len(truth.diameters) - 1.0),
        ),
    )


def angle_errors(pile: heaps.Pile, kind: str) -> Errors:
    """Return errors of the mean angle, the worse flank and the plate's tilt [deg]."""
    try:
        heap = measure_heap(heaps.photograph(pile))
    except CaseError:
        return Errors(kind, None)
    flanks = (abs(heap.repose.left_deg - pile.left), abs(heap.repose.right_deg - pile.right))
    mean = abs(heap.repose.angle_deg - 0.5 * (pile.left + pile.right))
    return Errors(kind, (mean, max(flanks), abs(heap.plate.tilt_deg - pile.tilt)))


def table(errors: Sequence[Errors], title: str, columns: Sequence[str], digits: int) -> str:
    """Return a table: median, 95 % and largest error for each kind and column."""
    lines = [
        f"| {title} | photos | refused | {' | '.join(columns)} |",
        f"|---|---|---|{'---|' * len(columns)}",
    ]
    for kind in dict.fromkeys(one.kind for one in errors):
        mine = [one for one in errors if one.kind == kind]
        values = np.array([one.values for one in mine if one.values is not None])
        cells = [
            " / ".join(
                f"{part:.{digits}f}" for part in (*np.quantile(column, (0.5, 0.95)), max(column))
            )
            for column in values.T
        ]
        lines.append(f"| {kind} | {len(mine)} | {len(mine) - len(values)} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main() -> None:
    """Draw, measure, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--photos", type=int, default=40, help="of each row")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    rng = np.random.default_rng(asked.seed)
    sizes, angles = [], []
    for low, high in ((8.0, 15.0), (15.0, 30.0), (30.0, 80.0)):
        for k in range(asked.photos):
            one = random_scene(rng, float(np.exp(rng.uniform(np.log(low), np.log(high)))), k)
            sizes.append(size_errors(one, f"{low:.0f} to {high:.0f} px", rng))
    for grains, kind in ((0.0, "smooth"), (4.0, "4 px"), (8.0, "8 px")):
        for k in range(asked.photos):
            angles.append(angle_errors(random_pile(rng, grains, k), kind))
    print("Median / 95 % / largest error.\n")
    print(table(sizes, "grains", ["d32 (%)", "d10, d50, d90 (%)", "circularity", "count (%)"], 3))
    print()
    print(table(angles, "heap of grains", ["mean (deg)", "flank (deg)", "plate (deg)"], 2))


if __name__ == "__main__":
    main()
