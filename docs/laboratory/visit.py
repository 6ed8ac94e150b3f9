"""What comes back from a laboratory that the invented bulk solid was measured in.

`python docs/laboratory/visit.py beads` makes the folder `beads`: photographs, drawn from the tables
beside this file, and the logs of the scale and of the sensor on the plate.
"""

from __future__ import annotations

import shutil
import sys
import tomllib
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

HERE = Path(__file__).resolve().parent
Image = npt.NDArray[np.float32]

FINER = 4
"""Pixels of the drawing, along each side, to one of the photograph."""
NOISE = 2.0
"""Of the camera, in grey levels."""
GRAIN_PX_MM = 20.0
GRAINS_MM = (64.0, 48.0)
"""Picture of the spread grains, with 8 mm of ruler below."""
GRAINS = 320
SPREAD = 2.563
"""Width between the 10 and 90 % quantiles of the unit normal."""
HEAP_PX_MM = 16.0
HEAP_MM = (76.0, 34.0)
PLATE_MM = 28.4
"""Half the length of the plate under the heaps: 16 Sauter diameters."""
BELOW_MM = 4.0
TILT_DEG = 0.8
"""Of the camera before the heaps."""


def main() -> None:
    """Fill the folder that is named on the command line."""
    folder = Path(sys.argv[1])
    (folder / "photos").mkdir(parents=True)
    rng = np.random.default_rng(1)
    _photograph(folder / "photos" / "grains.png", _spread_grains(rng), rng)
    for table in sorted(HERE.glob("heap_*.csv")):
        _photograph(folder / "photos" / f"{table.stem}.png", _heap(table), rng)
    for log in sorted([*HERE.glob("log_*.csv"), HERE / "plate.csv"]):
        shutil.copyfile(log, folder / log.name.removeprefix("log_"))
    print(f"{folder}: {', '.join(sorted(one.name for one in folder.iterdir()))}")


def _spread_grains(rng: np.random.Generator) -> Image:
    """Draw grains of the true sizes in one layer, and a ruler: some touch, none lie on others."""
    sizes = tomllib.loads((HERE / "truth.toml").read_text(encoding="utf-8"))["material"]
    width = np.log(sizes["d90_um"] / sizes["d10_um"]) / SPREAD
    radii = 0.5e-3 * sizes["d50_um"] * np.exp(width * rng.standard_normal(GRAINS))
    scale = GRAIN_PX_MM * FINER
    picture = _ground((GRAINS_MM[0] * scale, (GRAINS_MM[1] + 8.0) * scale), 205.0)
    placed: list[tuple[float, float, float]] = []
    for radius in sorted(radii, reverse=True):
        while True:
            x, y = rng.uniform(1.5, np.array(GRAINS_MM) - 1.5)
            if all(np.hypot(x - a, y - b) >= radius + r for a, b, r in placed):
                break
        placed.append((x, y, radius))
        _bead(picture, (x, y), radius, scale)
    picture[round(GRAINS_MM[1] * scale) :] = 240.0
    for tick in range(int(GRAINS_MM[0]) - 2):
        long = 4.0 if tick % 5 == 0 else 2.5
        corner = np.array([1.0 + tick, GRAINS_MM[1] + 1.0]) * scale
        ends = np.array([corner, corner + np.array([0.15, long]) * scale])
        cv2.rectangle(picture, *np.int32(ends).tolist(), 20.0, -1)
    return picture


def _heap(table: Path) -> Image:
    """Draw a heap between two panes of glass on its plate, as a camera sees it from the side."""
    scale = HEAP_PX_MM * FINER
    picture = _ground((HEAP_MM[0] * scale, HEAP_MM[1] * scale), 190.0)
    middle, base = 0.5 * HEAP_MM[0], HEAP_MM[1] - BELOW_MM
    for x, z, diameter in np.loadtxt(table, delimiter=",", skiprows=1):
        _bead(picture, (middle + x, base - z), 0.5 * diameter, scale)
    corners = np.array([[middle - PLATE_MM, base], [middle + PLATE_MM, HEAP_MM[1]]]) * scale
    cv2.rectangle(picture, *np.int32(corners).tolist(), 250.0, -1)
    rows, columns = picture.shape
    turn = cv2.getRotationMatrix2D((0.5 * columns, 0.5 * rows), TILT_DEG, 1.0)
    return cv2.warpAffine(picture, turn, (columns, rows), borderMode=cv2.BORDER_REPLICATE)


def _ground(size: tuple[float, float], grey: float) -> Image:
    return np.full((round(size[1]), round(size[0])), grey, np.float32)


def _bead(picture: Image, place_mm: tuple[float, float], radius: float, scale: float) -> None:
    """Draw a ball that is lit from the upper left."""
    for share, grey in ((1.0, 45.0), (0.85, 70.0), (0.65, 90.0), (0.4, 110.0), (0.15, 135.0)):
        shift = 0.25 * (1.0 - share) * radius
        centre = np.int32(np.round((np.array(place_mm) - shift) * scale)).tolist()
        cv2.circle(picture, centre, round(share * radius * scale), grey, cv2.FILLED)


def _photograph(path: Path, scene: Image, rng: np.random.Generator) -> None:
    """Write a scene as a camera records it: uneven light, blur, noise, pixels."""
    size = (scene.shape[1] // FINER, scene.shape[0] // FINER)
    light = cv2.resize(scene, size, interpolation=cv2.INTER_AREA)
    light = cv2.GaussianBlur(light, (0, 0), 0.8) * np.linspace(1.0, 0.85, size[0])[None, :]
    light += NOISE * rng.standard_normal(light.shape)
    cv2.imwrite(str(path), np.clip(light, 0.0, 255.0).astype(np.uint8))


if __name__ == "__main__":
    main()
