"""What people type wrongly at the bench: one message with a remedy, exit code 2, nothing written.

And what was taken although it was wrong, or refused without saying what would have been right.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.liggghts_io.foreign.grains import frame_text, known
from tests.liggghts_io.photo.heaps import Pile
from tests.liggghts_io.photo.heaps import photograph as photograph_of_heap

CONTACT = (
    "-p", "mu_pp=0.4", "-p", "mu_roll_pp=0.1", "-p", "mu_pw=0.3", "-p", "mu_roll_pw=0.1",
    "-p", "e_pp=0.8", "-p", "e_pw=0.6",
)  # fmt: skip
INTO = ("--out", "m.csv", "--name", "a")
HEAP = (*INTO, "--experiment", "heap", "--observable", "angle_deg")
OUT = ("--out", "out")

WRONG = [
    # photographs
    ("photo size note.png --ruler 1mm", OUT, "note.png: is no picture"),
    ("photo size cut.png --ruler 1mm", OUT, "cut.png: is cut or damaged"),
    ("photo size gains.png --ruler 1mm", OUT, "did you mean 'grains.png'?"),
    ("photo size white.png --scale 20px/mm", OUT, "no grains in the picture"),
    ("photo size tiny.png --scale 20px/mm", OUT, "at least 32 on each side"),
    ("photo size white.png", OUT, "--scale 22.7px/mm"),
    ("photo size white.png --scale 20", OUT, "write it as 22.7px/mm"),
    ("photo size white.png --scale 20px/parsec", OUT, "known: mm, cm, m, um, in"),
    ("photo size white.png --scale 1e9px/mm", OUT, "check number and unit"),
    ("photo size white.png --ruler 1kg", OUT, "unknown unit of length 'kg'"),
    ("photo size white.png --ruler 1mm --grains darc", OUT, "did you mean 'dark'?"),
    ("photo angle white.png", OUT, "no heap in the picture"),
    ("photo angle white.png --level 1,2,3", OUT, "are no two points"),
    ("photo sizes white.png", (), "Did you mean 'size'?"),
    # logs of a scale
    ("measured scale empty.csv", INTO, "export the log as CSV"),
    ("measured scale rum.csv", INTO, "did you mean 'run.csv'?"),
    ("measured scale km.csv", INTO, "does not say its unit; give it with --mass-unit"),
    ("measured scale run.csv --mass 100mm", INTO, "such as 100g or 0.1kg"),
    ("measured scale run.csv --mass 100kg", INTO, "100"),
    ("measured scale run.csv --quantity plateu", INTO, "did you mean 'plateau'?"),
    ("measured scale run.csv --mass-column masse", INTO, "did you mean 'mass [g]'?"),
    ("measured scale run.csv --experiment conveyer", INTO, "did you mean 'conveyor'?"),
    ("measured scale huge.csv", INTO, "huge.csv:3: mass [g] = '1e250' is 1e+250 g"),
    ("measured scale short.csv", INTO, "short.csv: lasts 1.2e-08 s from first to last row"),
    ("measured scale run.csv --start 5s", INTO, "--start 5s: is not a number"),
    ("measured scale run.csv --out m.csv --name t-100", (), "letters, digits and _ only"),
    ("measured scal run.csv", INTO, "(see: bulkcal measured --help)"),
    # numbers from a notebook
    ("measured add -3 -4 --unit deg", (), "write -- before numbers"),
    ("measured add 34 35 --unit deg", INTO, "--experiment: give a name"),
    ("measured add 34.2 abc --unit deg", HEAP, "'abc' is not a number"),
    ("measured add 34.2 33 --unit g", HEAP, "give deg or rad"),
    ("measured add 134 133 --unit deg", HEAP, "0 to 90 deg"),
    ("measured add 34 95 35 --unit deg", HEAP, "95 deg is not a possible value of angle_deg"),
    ("measured add angles.csv --column angel_deg", HEAP, "did you mean 'angle_deg'?"),
    ("measured add angels.csv --column angle_deg", HEAP, "did you mean 'angles.csv'?"),
    # the motion of a plate
    ("motion empty.csv", (), "export the log as CSV"),
    ("motion plate.csv --period 80", (), "such as 80ms"),
    ("motion plate.csv --period 50s", (), "--period 50s: the record holds"),
    ("motion plate.csv --unit parsec", (), "known names: m/s2"),
    ("motion plate.csv --harmonics 31", (), "'--harmonics': must be at most 30"),
    ("motion plate.csv --harmonics two", (), "'--harmonics': must be a whole number"),
    # somebody's output
    ("post run.csv", (), "run.csv: no dump of grains"),
    ("post a.dump --count --out run.csv", (), "--out run.csv: exists already"),
    ("post a.dump --mass --density 0", (), "'--density': must be at least 0.001"),
    ("post a.dump --box z=5: --column z", (), "bulkcal: step 5: z_mean: no grain in the box"),
    ("post a.dump --experiment run.csv", (), "cannot be read (Not a directory)"),
    ("render a.dump --out white.png", (), "--out white.png: exists already"),
    # cases
    ("generate heap --particle Carbo_HPS13", (*CONTACT, *OUT), "did you mean 'Carbo HSP13'?"),
    ("generate heap --particles run.csv", (*CONTACT, *OUT), "no column 'particle'"),
    ("generate heep", (*CONTACT, *OUT), "did you mean 'heap'?"),
    ("generate heap --surface stele", (*CONTACT, *OUT), "did you mean 'steel'?"),
    ("generate heap --sizes measure", (*CONTACT, *OUT), "must be 'one' or 'measured'\n"),
    ("generate heap --coarse-graining 50", (*CONTACT, *OUT), "must be at most 10\n"),
    ("generate heap -a slice_width=3", (*CONTACT, *OUT), "did you mean 'slice_width_d'?"),
    ("generate heap -a slice_width_d=3e9", (*CONTACT, *OUT), "from 1.5 to 1000 d"),
]


@pytest.fixture
def bench(tmp_path: Path, monkeypatch) -> Path:
    """Go to a folder with files of every kind, few of them right."""
    monkeypatch.chdir(tmp_path)
    noise = np.random.default_rng(3).integers(0, 255, (200, 300), dtype=np.uint8)
    Image.fromarray(noise).save("grains.png")
    Path("cut.png").write_bytes(Path("grains.png").read_bytes()[:3000])
    Image.fromarray(np.full((200, 300), 255, np.uint8)).save("white.png")
    Image.fromarray(np.full((4, 4), 100, np.uint8)).save("tiny.png")
    Path("note.png").write_text("hello\n")
    Path("empty.csv").write_text("")
    times = np.arange(0.0, 30.0, 0.5)
    masses = np.clip(20.0 * (times - 4.0), 0.0, 300.0)
    rows = "".join(f"{t},{m:.2f}\n" for t, m in zip(times, masses, strict=True))
    Path("run.csv").write_text("time [s],mass [g]\n" + rows)
    Path("huge.csv").write_text("time [s],mass [g]\n0,1\n1,1e250\n" + rows)
    tiny = "".join(f"{k}e-9,{20 * k}\n" for k in range(13))
    Path("short.csv").write_text("time [s],mass [g]\n" + tiny)
    Path("a.dump").write_text(frame_text(5, known(20)))
    Path("km.csv").write_text("time [s],mass [km]\n" + rows)
    Path("angles.csv").write_text("angle_deg\n34\n35\n36\n")
    moved = np.arange(0.0, 0.5, 0.002)
    rows = "".join(f"{t:.3f},{20.0 * np.sin(78.5 * t):.2f}\n" for t in moved)
    Path("plate.csv").write_text("t [s],a [m/s2]\n" + rows)
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize(("words", "more", "told"), WRONG, ids=[one[0] for one in WRONG])
def test_a_mistake_has_one_message_and_writes_nothing(bench, bulkcal, words, more, told):
    before = contents(bench)
    code, out, err = bulkcal(*words.split(), *more)
    assert (code, out) == (2, "")
    messages = [line for line in err.splitlines() if line.startswith("bulkcal: ")]
    assert len(messages) == 1
    assert told in f"{messages[0]}\n"
    assert "Traceback" not in err
    assert contents(bench) == before
    assert not (bench / "out").exists()


def test_the_same_commands_work_without_the_mistake(bench, bulkcal):
    for words in (
        ("measured", "scale", "run.csv", *INTO),
        ("measured", "add", "angles.csv", "--column", "angle_deg", "--unit", "deg",
         "--out", "n.csv", "--name", "b", "--experiment", "heap", "--observable", "angle_deg"),
        ("motion", "plate.csv"),
    ):  # fmt: skip
        code, _, err = bulkcal(*words)
        assert code == 0, err


def photos_of(folder: Path, **changed) -> list[str]:
    """Draw two heaps of 32 and 34 degrees."""
    paths = []
    for angle in (32.0, 34.0):
        pile = Pile(left=angle, right=angle, size=(600, 300), height=130.0, **changed)
        paths.append(str(folder / f"heap{angle:.0f}.png"))
        Image.fromarray(photograph_of_heap(pile)).save(paths[-1])
    return paths


def test_a_wall_with_words_gives_a_target_that_a_study_takes(tmp_path, bulkcal):
    photos = photos_of(tmp_path, plate=50.0)
    code, out, _ = bulkcal("photo", "angle", *photos, "--surface", "steel, brushed", "--json")
    assert code == 0
    lines = json.loads(out)["study"]
    assert 'name = "angle_steel_brushed"' in lines
    assert 'surface = "steel, brushed"' in lines


def test_a_plate_that_was_not_seen_is_told(tmp_path, bulkcal):
    """The picture's border is taken for it, which is wrong where the plate is in the picture."""
    code, out, err = bulkcal("photo", "angle", *photos_of(tmp_path, plate=0.0))
    assert code == 0
    assert "the picture's border" in out
    assert "let the picture end at the plate" in out + err
    code, out, err = bulkcal("photo", "angle", *photos_of(tmp_path, plate=50.0))
    assert code == 0
    assert "let the picture end at the plate" not in out + err


def test_the_next_command_can_be_typed_when_names_have_spaces(bench, bulkcal):
    code, out, _ = bulkcal("generate", "heap", *CONTACT, "--out", "my heap")
    assert (code, out.splitlines()[-1]) == (0, 'next: bulkcal run "my heap"')
    _, _, err = bulkcal("post", "my heap")
    assert """run it with 'bulkcal run "my heap"'""" in err
