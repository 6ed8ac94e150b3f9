"""Put the pictures of the README together from the report of a finished demo.

    python docs/draw_demo.py demo/report.html      # writes demo.png and joint.png in docs/images

demo.png: above the figure of stage 1, below the pictures of heap, conveyor and plate impact.
joint.png: the corner plot of the joint calibration. A report holds them as they are.
"""

from __future__ import annotations

import argparse
import base64
import re
from pathlib import Path
from typing import Final

import cv2
import numpy as np
import numpy.typing as npt

IMAGES: Final = Path(__file__).resolve().parent / "images"
JOINT: Final = "Probability of every unknown and of every pair"
WIDTH: Final = 1800
GAP: Final = 30
STAGE: Final = "Stage 1"
PLACES: Final = ("Heap for the angle of repose, steel", "Oscillating conveyor plate, steel",
                 "Impact on an inclined plate, steel")  # fmt: skip
_IMAGE: Final = re.compile(r'<img alt="([^"]*)" src="data:image/png;base64,([^"]*)"')

Image = npt.NDArray[np.uint8]


def pictures(report: Path) -> dict[str, Image]:
    """Return the pictures of a report by their words, on white."""
    return {
        words: _on_white(base64.b64decode(data))
        for words, data in _IMAGE.findall(report.read_text(encoding="utf-8"))
    }


def _on_white(png: bytes) -> Image:
    image = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_UNCHANGED)
    if image.shape[2] == 4:
        share = image[:, :, 3:] / 255.0
        image = np.round(image[:, :, :3] * share + 255.0 * (1.0 - share)).astype(np.uint8)
    return np.asarray(image, dtype=np.uint8)


def _scaled(image: Image, width: int) -> Image:
    height = round(image.shape[0] * width / image.shape[1])
    return np.asarray(cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA), np.uint8)


def page(found: dict[str, Image]) -> Image:
    """Return the figure of the stage above the pictures of the experiments, side by side."""
    above = next(image for words, image in found.items() if STAGE in words)
    places = [
        next(image for words, image in found.items() if words.startswith(place)) for place in PLACES
    ]
    top = _scaled(above, WIDTH)
    cell = (WIDTH - (len(places) - 1) * GAP) // len(places)
    cells = [_scaled(image, cell) for image in places]
    sheet = np.full(
        (top.shape[0] + GAP + max(one.shape[0] for one in cells), WIDTH, 3), 255, np.uint8
    )
    sheet[: top.shape[0]] = top
    for number, image in enumerate(cells):
        left = number * (cell + GAP)
        low = top.shape[0] + GAP
        sheet[low : low + image.shape[0], left : left + cell] = image
    return sheet


def main() -> None:
    """Read the report that the command line names and write the pictures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("report", type=Path)
    report = parser.parse_args().report
    found = pictures(report)
    for name, image in (("demo.png", page(found)), ("joint.png", found[JOINT])):
        cv2.imwrite(str(IMAGES / name), image, [cv2.IMWRITE_PNG_COMPRESSION, 9])


if __name__ == "__main__":
    main()
