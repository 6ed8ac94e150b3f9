"""`bulkcal photo size` and `photo angle`: numbers, files, lines of a study, and mistakes."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from calibrate.cli.laboratory import photo_output
from calibrate.study.load import load_study
from tests.liggghts_io.photo.heaps import Pile
from tests.liggghts_io.photo.heaps import photograph as photograph_of_heap
from tests.liggghts_io.photo.scene import Scene, grains_in_rows
from tests.liggghts_io.photo.scene import photograph as photograph_of_grains

GRAINS = Scene(count=40, ruler=True, tracer=True)
SMALL = Pile(size=(600, 300), height=130.0, plate=50.0)
SIZE_KEYS = ["d32_um", "d10_um", "d50_um", "d90_um", "circularity", "count"]
ANGLE_KEYS = ["left_deg", "right_deg", "angle_deg", "se_deg"]


@pytest.fixture
def grains(tmp_path: Path) -> Path:
    """Return a photo of 39 grains and a tracer, 30 px across, with a tick each 30 px."""
    path = tmp_path / "grains.png"
    Image.fromarray(photograph_of_grains(GRAINS)[0]).save(path)
    return path


@pytest.fixture
def heaps(tmp_path: Path) -> list[str]:
    """Return photos of three heaps with angles of 33, 34 and 36 degrees."""
    paths = [tmp_path / f"heap{k}.jpg" for k in range(3)]
    for path, angle in zip(paths, (33.0, 34.0, 36.0), strict=True):
        pile = Pile(left=angle, right=angle, size=SMALL.size, height=SMALL.height, plate=50.0)
        Image.fromarray(photograph_of_heap(pile)).save(path, quality=92)
    return [str(path) for path in paths]


@pytest.mark.parametrize(
    "scale", [("--scale", "30px/mm"), ("--ruler", "1mm"), ("--points", "10,10,310,10,10mm")]
)
def test_sizes_as_json(grains: Path, bulkcal, scale: tuple[str, str]):
    code, out, _ = bulkcal("photo", "size", str(grains), *scale, "--json")
    assert code == 0
    found = json.loads(out)
    assert list(found) == SIZE_KEYS
    truth = photograph_of_grains(GRAINS)[1]
    assert found["count"] == 39
    assert found["d32_um"] == pytest.approx(truth.d32 / 30 * 1000, rel=0.02)
    assert found["d90_um"] == pytest.approx(truth.quantile(0.9) / 30 * 1000, rel=0.02)
    assert found["circularity"] == pytest.approx(truth.circularity, abs=0.02)


def test_a_ruler_of_grains_in_rows_is_refused(bulkcal, tmp_path: Path):
    path = tmp_path / "rows.png"
    Image.fromarray(grains_in_rows()).save(path)
    code, out, err = bulkcal("photo", "size", str(path), "--ruler", "10mm")
    assert (code, out) == (2, "")
    assert "rows.png: no ruler in the picture" in " ".join(err.split())


def test_sizes_into_a_directory(grains: Path, bulkcal, tmp_path: Path):
    out = tmp_path / "sizes"
    words = ("photo", "size", str(grains), "--scale", "30px/mm", "--out", str(out))
    code, said, _ = bulkcal(*words)
    assert code == 0
    names = ["grains.csv", "grains.grains.png", "sizes.json", "sizes.png"]
    assert sorted(path.name for path in out.iterdir()) == names
    assert "1 of other brightness (tracer)" in said
    assert "d32_um = " in said
    rows = list(csv.DictReader((out / "grains.csv").read_text(encoding="utf-8").splitlines()))
    counted = [float(row["diameter_um"]) for row in rows if not row["left_out"]]
    record = json.loads((out / "sizes.json").read_text(encoding="utf-8"))
    assert len(counted) == record["count"] == 39
    cubes, squares = np.sum(np.power(counted, 3)), np.sum(np.power(counted, 2))
    assert cubes / squares == pytest.approx(record["d32_um"], rel=1e-4)
    with Image.open(out / "grains.grains.png") as drawn:
        green = (np.asarray(drawn) == (30, 200, 60)).all(axis=2).sum()
        red = (np.asarray(drawn) == (235, 40, 60)).all(axis=2).sum()
    assert green > 39 * 60
    assert red > 60
    code, _, err = bulkcal(*words)
    assert (code, "holds sizes.json already" in err) == (2, True)


def test_several_photos_of_grains_are_counted_together(grains: Path, bulkcal, tmp_path: Path):
    other = tmp_path / "other.png"
    Image.fromarray(photograph_of_grains(Scene(count=30, seed=4))[0]).save(other)
    words = ("photo", "size", str(grains), str(other), "--scale", "30px/mm", "--json")
    found = json.loads(bulkcal(*words)[1])
    assert list(found) == [*SIZE_KEYS, "photos"]
    assert [one["count"] for one in found["photos"]] == [39, 30]
    assert found["count"] == 69


def test_unequal_flanks_are_told_and_make_the_error(bulkcal, tmp_path: Path):
    path = tmp_path / "unequal.png"
    pile = Pile(left=36.0, right=28.0, size=SMALL.size, height=90.0, plate=50.0)
    Image.fromarray(photograph_of_heap(pile)).save(path)
    found = json.loads(bulkcal("photo", "angle", str(path), "--json")[1])
    assert found["angle_deg"] == pytest.approx(32.0, abs=0.3)
    assert found["se_deg"] == pytest.approx(4.0, abs=0.3)
    assert "its flanks differ by" in bulkcal("photo", "angle", str(path))[2]


def test_angle_as_json(heaps: list[str], bulkcal):
    code, out, _ = bulkcal("photo", "angle", heaps[1], "--json")
    assert code == 0
    found = json.loads(out)
    assert list(found) == ANGLE_KEYS
    assert found["angle_deg"] == pytest.approx(34.0, abs=0.3)
    assert found["angle_deg"] == pytest.approx(0.5 * (found["left_deg"] + found["right_deg"]))
    assert 0.0 < found["se_deg"] < 0.2


def test_a_flank_that_is_not_in_the_photo_is_null(bulkcal, tmp_path: Path):
    path = tmp_path / "half.png"
    Image.fromarray(photograph_of_heap(SMALL)[:, :300]).save(path)
    code, out, _ = bulkcal("photo", "angle", str(path), "--json", "--out", str(tmp_path / "out"))
    assert code == 0
    assert json.loads(out)["right_deg"] is None
    assert "one flank only" in bulkcal("photo", "angle", str(path))[2]


def test_repeats_make_a_target_of_a_study(heaps: list[str], bulkcal, tmp_path: Path, small_study):
    out = tmp_path / "angle"
    code, said, _ = bulkcal("photo", "angle", *heaps, "--surface", "glued", "--out", str(out))
    assert code == 0
    found = json.loads((out / "angles.json").read_text(encoding="utf-8"))
    assert found["repeats"] == 3
    assert found["angle_deg"] == pytest.approx(np.mean([33, 34, 36]), abs=0.2)
    assert found["se_deg"] == pytest.approx(np.std([33, 34, 36], ddof=1) / 3**0.5, abs=0.1)
    assert found["study"] in said
    assert len(list(out.glob("*.angle.png"))) == 3
    study = tmp_path / "with_angle.toml"
    text = small_study.read_text(encoding="utf-8")
    lines = found["study"].replace("angle_glued", "angle_of_photos")
    study = small_study.with_name("with_photos.toml")
    study.write_text(f"{text}\n{lines}\n", encoding="utf-8")
    targets = {target.name: target for target in load_study(study).targets}
    assert targets["angle_of_photos"].repeats == 3
    assert targets["angle_of_photos"].value == pytest.approx(found["angle_deg"], abs=0.01)


def test_a_level_line(bulkcal, tmp_path: Path):
    path = tmp_path / "tilted.png"
    tilted = Pile(tilt=3.0, size=SMALL.size, height=SMALL.height, plate=50.0)
    Image.fromarray(photograph_of_heap(tilted)).save(path)
    fall = 500.0 * np.tan(np.radians(3.0))
    level = f"50,20,550,{20 + fall:.2f}"
    found = json.loads(bulkcal("photo", "angle", str(path), "--level", level, "--json")[1])
    assert found["angle_deg"] == pytest.approx(34.0, abs=0.3)
    assert found["left_deg"] == pytest.approx(found["right_deg"], abs=0.4)


BAD_SCALES = {
    "none": ((), "none was given"),
    "two": (("--scale", "30px/mm", "--ruler", "1mm"), "--scale and --ruler were given"),
    "no unit": (("--scale", "22.7"), "write it as 22.7px/mm"),
    "wrong unit": (("--scale", "22.7px/kg"), "unknown unit of length 'kg'"),
    "absurd": (("--scale", "22.7px/m"), "check number and unit"),
    "absurd sizes": (("--scale", "9mm/px"), "check the scale"),
    "one point": (("--points", "1,2,3"), "has 3 parts"),
    "ruler without unit": (("--ruler", "1"), "no length with a unit"),
    "colour": (("--scale", "30px/mm", "--grains", "drak"), "did you mean 'dark'"),
}


@pytest.mark.parametrize("name", BAD_SCALES)
def test_a_bad_scale_is_refused_and_nothing_written(name, grains: Path, bulkcal, tmp_path: Path):
    words, said = BAD_SCALES[name]
    out = tmp_path / "out"
    code, printed, err = bulkcal("photo", "size", str(grains), *words, "--out", str(out), "-q")
    assert (code, printed) == (2, "")
    assert said in err
    assert err.count("\n") == 1
    assert not out.exists()


def _bad_photo(kind: str, folder: Path) -> Path:
    path = folder / f"{kind}.png"
    if kind == "grey":
        Image.new("L", (300, 200), 128).save(path)
    elif kind == "point":
        Image.new("L", (1, 1)).save(path)
    elif kind == "text":
        path.write_text("hello", encoding="utf-8")
    elif kind == "empty":
        path.touch()
    return path


@pytest.mark.parametrize("verb", ["size", "angle"])
@pytest.mark.parametrize("kind", ["grey", "point", "text", "empty", "missing"])
def test_a_bad_photo_is_refused_and_nothing_written(verb, kind, grains, heaps, bulkcal, tmp_path):
    """Also behind a good one, of which nothing is left then."""
    bad = _bad_photo(kind, tmp_path)
    good = str(grains) if verb == "size" else heaps[0]
    scale = ("--scale", "30px/mm") if verb == "size" else ()
    out = tmp_path / "out"
    for photos in ((str(bad),), (good, str(bad))):
        words = ("photo", verb, *photos, *scale, "--json", "--out", str(out), "-q")
        code, printed, err = bulkcal(*words)
        assert (code, printed) == (2, "")
        assert err.startswith(f"bulkcal: {bad}: ")
        assert err.count("\n") == 1
        assert not out.exists()


def test_a_photo_named_twice_counts_once(heaps: list[str], bulkcal):
    code, _, err = bulkcal("photo", "angle", heaps[0], heaps[0])
    assert (code, "is named twice" in err) == (2, True)


def test_files_that_cannot_be_written_leave_nothing(tmp_path: Path, monkeypatch):
    def full(path: Path, content: bytes) -> None:
        if path.name == "b":
            raise OSError(28, "No space left on device")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)

    monkeypatch.setattr(photo_output, "write_bytes", full)
    with pytest.raises(OSError, match="No space"):
        photo_output.write_all(tmp_path / "new", {"a": b"1", "b": b"2"})
    assert not (tmp_path / "new").exists()


def test_help_has_examples(bulkcal):
    for verb in ("size", "angle"):
        assert f"Example: bulkcal photo {verb}" in bulkcal("photo", verb, "--help")[1]
    assert "size" in bulkcal("photo")[1]


def test_one_grain_tells_a_size_and_no_spread(bulkcal, tmp_path: Path):
    """Three equal quantiles are no distribution: a study refuses them."""
    path = tmp_path / "one.png"
    Image.fromarray(photograph_of_grains(Scene(count=1))[0]).save(path)
    out = tmp_path / "out"
    words = ("photo", "size", str(path), "--scale", "30px/mm")
    code, said, _ = bulkcal(*words, "--out", str(out))
    assert code == 0
    assert "um, of one grain" in said
    assert "and then 'bulkcal check STUDY.toml'" in said
    assert said.splitlines()[-1].startswith("d32_um = ") or "wrote" in said.splitlines()[-1]
    assert "d10_um" not in said
    assert json.loads((out / "sizes.json").read_text())["d32_se_um"] is None


def _of_two_kinds() -> np.ndarray:
    """Return radius and grey level of 39 grains, nine of them bright."""
    other = (np.arange(39) % 4 == 2) & (np.arange(39) < 36)
    return np.column_stack([np.full(39, 20.0), np.where(other, 235.0, 40.0)])


def _of_all_sizes() -> np.ndarray:
    """Return radius and grey level of 39 grains from 4 to 36 px, each size as often."""
    radii = np.random.default_rng(1).permutation(np.geomspace(4.0, 36.0, 39))
    return np.column_stack([radii, np.full(39, 40.0)])


@pytest.mark.parametrize(
    ("grains", "said"),
    [
        (_of_all_sizes(), "5 things are so small that they were taken for dust"),
        (_of_two_kinds(), "9 grains are of other brightness or colour than the 30 that count"),
    ],
)
def test_what_may_be_grains_and_does_not_count_is_told(
    bulkcal, tmp_path: Path, grains: np.ndarray, said: str
):
    """d10 and d50 hang on whether they are grains. For programs, too, it is on stderr."""
    y, x = np.mgrid[:520, :1100]
    grey = np.full(x.shape, 140.0)
    for k, (radius, ink) in enumerate(grains):
        away = np.hypot(x - 70 - 80 * (k % 13), y - 90 - 160 * (k // 13))
        grey = grey + (ink - grey) * np.clip(radius + 0.5 - away, 0.0, 1.0)
    path = tmp_path / "two.png"
    Image.fromarray(grey.astype(np.uint8)).save(path)
    for words in ((), ("--json",)):
        code, _, err = bulkcal("photo", "size", str(path), "--scale", "30px/mm", *words)
        assert code == 0
        assert said in " ".join(err.split())
