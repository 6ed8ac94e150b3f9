"""Films: as many pictures as frames, all alike in size and colours, and nothing half-written."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from importlib import import_module
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.measure.dumps import Frame
from liggghts_io.pictures import child, film
from liggghts_io.pictures.reel import Reel
from liggghts_io.pictures.render import Look
from tests.liggghts_io.pictures.shots import PLATE, frame_of

FALLING = [
    frame_of((0.0, 0.0, 0.01 * (5 - k)), (0.005, 0.0, 0.002), step=100 * k) for k in range(5)
]


@pytest.fixture(autouse=True)
def discs(monkeypatch):
    """Draw discs, which is quicker, and a turn of few pictures."""
    monkeypatch.setattr(child, "_started", lambda: None)
    monkeypatch.setattr(film, "_TURN_S", 0.5)


def reel_of(frames: list[Frame], damaged: int | None = None, *, plate: bool = True) -> Reel:
    def read(wanted: Collection[int] | None) -> Iterator[Frame]:
        for k in range(len(frames)) if wanted is None else sorted(wanted):
            if k == damaged:
                msg = "run.dump:7: 'x' is not a number"
                raise DamagedFile(msg)
            yield frames[k]

    meshes = {"plate": PLATE} if plate else {}
    return Reel(len(frames) - 1, read, 0, "Falling", meshes, dict.fromkeys(meshes, 0.3))


def pictures_in(path: Path) -> list[np.ndarray]:
    if path.suffix == ".gif":
        with Image.open(path) as opened:
            count = opened.n_frames
            found = []
            for k in range(count):
                opened.seek(k)
                found.append(np.asarray(opened.convert("RGB")))
            return found
    film_read = cv2.VideoCapture(str(path))
    found = []
    while (one := film_read.read())[0]:
        found.append(one[1])
    film_read.release()
    return found


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_a_time_lapse_has_a_picture_for_each_frame(tmp_path: Path, suffix: str):
    if suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg")
    told = []
    path = film.time_lapse(
        reel_of(FALLING), tmp_path / f"fall{suffix}", Look(colour="height"),
        lambda done, count: told.append((done, count)),
    )  # fmt: skip
    pictures = pictures_in(path)
    assert len(pictures) == len(FALLING)
    assert {one.shape for one in pictures} == {pictures[0].shape}
    assert told == [(k, 5) for k in range(1, 6)]
    # The upper grain falls, in one window: what is coloured ends lower in each picture.
    tops = [np.flatnonzero(shadow(one).any(axis=1))[0] for one in pictures]
    assert tops == sorted(tops)
    assert tops[-1] > tops[0] + 50
    assert list(tmp_path.iterdir()) == [path]


def shadow(picture: np.ndarray) -> np.ndarray:
    """Return where a picture is coloured, between its words and the bar."""
    rows = len(picture)
    return (np.ptp(picture.astype(int), axis=2) > 60)[rows // 20 : 3 * rows // 4]


def test_a_turntable_goes_once_around(tmp_path: Path):
    beside = frame_of((0.01, 0.0, 0.005), (0.0, 0.0, 0.005))
    path = film.turntable(reel_of([beside]), tmp_path / "turn.gif", Look(colour="height"))
    pictures = pictures_in(path)
    assert len(pictures) == 6
    assert len({one.shape for one in pictures}) == 1
    assert len({one.tobytes() for one in pictures}) == 6


@pytest.mark.parametrize("plate", [True, False])
def test_frames_without_grains_before_the_pour_are_no_mistake(tmp_path: Path, plate: bool):
    frames = [frame_of(step=0), *FALLING[:2]]
    reel = reel_of(frames, plate=plate)
    assert len(pictures_in(film.time_lapse(reel, tmp_path / "a.gif"))) == 3
    with pytest.raises(CaseError, match="no frame holds a grain"):
        film.time_lapse(reel_of([frame_of()]), tmp_path / "b.gif")


def test_a_film_of_a_damaged_run_leaves_nothing(tmp_path: Path):
    with pytest.raises(CaseError, match=r"run\.dump:7"):
        film.time_lapse(reel_of(FALLING, damaged=3), tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_is_full_leaves_nothing(tmp_path: Path, monkeypatch):
    def full(target: Path, images: Iterator[np.ndarray], rate: float) -> None:
        target.write_bytes(next(images).tobytes())
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(film, "_write_gif", full)
    with pytest.raises(OSError, match="No space"):
        film.time_lapse(reel_of(FALLING), tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


def test_other_names_and_mp4_without_its_library_are_refused(tmp_path: Path, monkeypatch):
    with pytest.raises(CaseError, match=r"a\.avi: name a film that ends in \.mp4 or \.gif"):
        film.time_lapse(reel_of(FALLING), tmp_path / "a.avi")

    def missing(name: str):
        if name == "imageio_ffmpeg":
            raise ImportError(name)
        return import_module(name)

    monkeypatch.setattr(film, "import_module", missing)
    with pytest.raises(CaseError, match=r"pip install bulkcal\[film\]"):
        film.time_lapse(reel_of(FALLING), tmp_path / "a.mp4")
