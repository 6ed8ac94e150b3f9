"""Files that are photographs, of every kind, and files that are none."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from liggghts_io import CaseError
from liggghts_io.photo import reading
from liggghts_io.photo.reading import read_photo


@pytest.fixture
def pixels() -> np.ndarray:
    """Return a picture whose corners differ."""
    x, y = np.meshgrid(np.arange(60), np.arange(40))
    return np.stack([4 * x, 6 * y, np.full_like(x, 90)], axis=-1).astype(np.uint8)


@pytest.mark.parametrize(
    ("name", "within"),
    [("a.png", 0), ("a.jpg", 12), ("a.JPEG", 12), ("a.tif", 0), ("a.bmp", 0), ("a.ppm", 0),
     ("a.webp", 12)],
)  # fmt: skip
def test_every_kind_of_file(name: str, within: int, pixels: np.ndarray, tmp_path: Path):
    Image.fromarray(pixels).save(tmp_path / name, quality=95)
    found = read_photo(tmp_path / name)
    assert found.shape == pixels.shape
    assert np.median(np.abs(found.astype(int) - pixels)) <= within


def test_the_ending_of_a_name_tells_nothing(pixels: np.ndarray, tmp_path: Path):
    Image.fromarray(pixels).save(tmp_path / "a.png")
    (tmp_path / "a.png").rename(tmp_path / "a.jpg")
    assert np.array_equal(read_photo(tmp_path / "a.jpg"), pixels)


def test_a_camera_held_upright(pixels: np.ndarray, tmp_path: Path):
    tags = Image.Exif()
    tags[0x0112] = 6  # turn by 90 degrees to see it upright
    Image.fromarray(pixels).save(tmp_path / "a.png", exif=tags)
    assert np.array_equal(read_photo(tmp_path / "a.png"), np.rot90(pixels, -1))


def test_grey_deep_and_transparent_pictures(pixels: np.ndarray, tmp_path: Path):
    Image.fromarray(pixels[:, :, 0]).save(tmp_path / "grey.png")
    assert np.array_equal(read_photo(tmp_path / "grey.png")[:, :, 2], pixels[:, :, 0])
    deep = pixels[:, :, 0].astype(np.uint16) * 40 + 1000
    Image.fromarray(deep).save(tmp_path / "deep.png")
    found = read_photo(tmp_path / "deep.png")
    assert (found.min(), found.max()) == (0, 255)
    clear = np.dstack([pixels // 4, np.where(pixels[:, :, 0] > 100, 255, 0)])
    Image.fromarray(clear.astype(np.uint8)).save(tmp_path / "clear.png")
    assert read_photo(tmp_path / "clear.png")[0, 0].tolist() == [255, 255, 255]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is empty"),
        (b"hello, this is a text\n", "is no picture that can be read"),
        (b"\x89PNG\r\n\x1a\n" + bytes(40), "no picture|cut or damaged"),
        (b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 50 50\n", "is no picture"),
    ],
)
def test_what_is_no_photo_is_refused(content: bytes, said: str, tmp_path: Path):
    path = tmp_path / "photo.png"
    path.write_bytes(content)
    with pytest.raises(CaseError, match=said) as told:
        read_photo(path)
    assert str(told.value).startswith(str(path))


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("ending", ["png", "jpg", "tif"])
def test_a_cut_file_is_refused(part: float, ending: str, tmp_path: Path, rng: np.random.Generator):
    path = tmp_path / f"a.{ending}"
    Image.fromarray(rng.integers(0, 255, (80, 90, 3)).astype(np.uint8)).save(path)
    path.write_bytes(path.read_bytes()[: round(part * path.stat().st_size)])
    with pytest.raises(CaseError, match=r"cut or damaged|no picture"):
        read_photo(path)


def test_other_things_than_files(tmp_path: Path):
    with pytest.raises(CaseError, match="no such file"):
        read_photo(tmp_path / "none.png")
    with pytest.raises(CaseError, match="is no file"):
        read_photo(tmp_path)
    os.mkfifo(tmp_path / "pipe.png")
    with pytest.raises(CaseError, match="is no file"):
        read_photo(tmp_path / "pipe.png")
    for name in ("phone.heic", "renamed.jpg"):
        (tmp_path / name).write_bytes(b"\0\0\0\x18ftypheic" + bytes(100))
        with pytest.raises(CaseError, match="set the phone to JPEG"):
            read_photo(tmp_path / name)


def test_too_small_and_too_large(tmp_path: Path, monkeypatch):
    Image.new("RGB", (1, 1)).save(tmp_path / "one.png")
    with pytest.raises(CaseError, match="1 x 1 pixels, too few"):
        read_photo(tmp_path / "one.png")
    Image.new("L", (10_000, 10_000)).save(tmp_path / "large.png")
    with pytest.raises(CaseError, match="10000 x 10000 pixels, at most 80 million"):
        read_photo(tmp_path / "large.png")
    monkeypatch.setattr(reading, "MOST_BYTES", 100)
    with pytest.raises(CaseError, match="GB can be read"):
        read_photo(tmp_path / "large.png")
