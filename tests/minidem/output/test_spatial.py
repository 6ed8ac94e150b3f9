"""Means in bins of space, held against what LIGGGHTS writes."""

from __future__ import annotations

import pytest

from minidem import run_script
from minidem.errors import ScriptError
from tests.minidem.output import scenes

HEAD = scenes.HEAD.replace("boundary f f m", "boundary f f f")
LINES = """group odd type 1
compute ka all ke/atom
region rr block -0.02 0.05 -0.2 0.2 -0.1 0.1 units box
fix a1 all ave/spatial 2 5 20 z lower 0.01 vx density/number density/mass c_ka &
 file a1.txt
fix a2 odd ave/spatial 10 2 20 x center 0.05 y 0.013 0.07 vz density/mass &
 norm sample file a2.txt
fix a3 all ave/spatial 10 1 20 x 0.5 0.25 y lower 0.5 z upper 0.3 &
 fz units reduced ave running overwrite file a3.txt
fix a4 all ave/spatial 10 1 20 x lower 0.04 c_ka density/number ave window 3 &
 region rr file a4.txt write_ts no title1 "# hi"
fix a5 all ave/spatial 10 2 20 z 0.3 0.04 vx ave running file a5.txt
fix a6 all ave/spatial 10 2 20 z -0.3 0.04 vx norm sample ave running file a6.txt
run 200
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files that minidem writes."""
    return scenes.run_minidem(tmp_path_factory.mktemp("mine"), scenes.scene(LINES, HEAD))


def test_bins_are_those_of_liggghts(files):
    for name in ("a4.txt", "a5.txt"):
        stored = (scenes.STORED / f"spatial_{name}").read_text()
        assert scenes.alike(files[name], stored, rtol=2e-5), name  # six digits are in the files


@pytest.mark.liggghts
def test_all_bins_are_those_of_liggghts(files, tmp_path):
    theirs = scenes.run_liggghts(tmp_path, scenes.scene(LINES, HEAD))
    assert len(theirs) == 6
    assert scenes.different(files, theirs) == []


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("z lower 1e-9 vx", "more than 1000000"),
        ("z lower 0.1 z lower 0.1 vx", "direction z comes twice"),
        ("z lower 0.1 density/mas", "did you mean 'density/mass'?"),
        ("z middle 0.1 vx", "expected a number"),
        ("z lower 0 vx", "above zero"),
        ("z lower 0.1 vx region r", "unknown region 'r'"),
        ("z lower 0.1 vx overwrite", "needs 'ave running'"),
    ],
)
def test_mistake_names_file_and_line(tmp_path, line, message):
    text = scenes.scene(f"fix a all ave/spatial 1 1 10 {line}\n")
    with pytest.raises(ScriptError) as error:
        run_script(scenes.write(tmp_path, text), root=tmp_path)
    assert message in str(error.value)
