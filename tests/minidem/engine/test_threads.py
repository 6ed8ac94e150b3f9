"""Several threads: the same bits for the same number, and nothing but rounding between numbers."""

from __future__ import annotations

import hashlib
import re
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import minidem.run.threads
from minidem import run_script
from minidem.cli import main
from minidem.run.restarts.own_file import MAGIC

GRAINS = 250
PLATE = """solid plate
facet normal 0 0 1
outer loop
vertex -0.02 -0.02 0
vertex 0.02 -0.02 0
vertex 0.02 0.02 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex -0.02 -0.02 0
vertex 0.02 0.02 0
vertex -0.02 0.02 0
endloop
endfacet
endsolid plate
"""
SCRIPT = f"""atom_style granular
boundary p f f
newton off
communicate single vel yes
units si
region domain block -0.008 0.008 -0.008 0.008 -0.002 0.04 units box
create_box 2 domain
neighbor 0.0003 bin
neigh_modify delay 0 contact_distance_factor 1.01
fix m1 all property/global youngsModulus peratomtype 5e6 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 2 .5 .5 .5 .5
fix m4 all property/global coefficientFriction peratomtypepair 2 .6 .6 .6 .6
fix m5 all property/global coefficientRollingFriction peratomtypepair 2 .1 .1 .1 .1
pair_style gran model hertz tangential history rolling_friction epsd2
pair_coeff * *
timestep 2e-5
fix g all gravity 9.81 vector 0 0 -1
fix plate all mesh/surface/stress file plate.stl type 2
fix floor all wall/gran model hertz tangential history rolling_friction epsd2 &
 mesh n_meshes 1 meshes plate
fix front all wall/gran model hertz tangential history primitive type 2 yplane -0.007
fix back all wall/gran model hertz tangential history rolling_friction epsd2 &
 primitive type 2 yplane 0.007
fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 3500 &
 radius constant 0.0008
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region fill block -0.007 0.007 -0.006 0.006 0.001 0.02 units box
fix ins all insert/pack seed 86028121 distributiontemplate pdd maxattempt 100 insert_every once &
 overlapcheck yes all_in no vel constant 0 0 -0.4 region fill particles_in_region {GRAINS}
fix integr all nve/sphere
thermo_style custom step atoms ke f_plate[3]
thermo 300
thermo_modify lost error norm no
dump d all custom 600 out.dump id x y z vx vy vz omegax omegay omegaz
dump_modify d sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run 1200
"""


def simulate(folder: Path, threads: int) -> str:
    """Return dump and thermo lines of the pile."""
    folder.mkdir()
    (folder / "plate.stl").write_text(PLATE)
    (folder / "in.script").write_text(SCRIPT)
    run_script(folder / "in.script", root=folder, threads=threads)
    thermo = re.findall(r"(?m)^ *\d+ +250 .*$", (folder / "log.liggghts").read_text())
    assert len(thermo) == 4
    return "\n".join([(folder / "out.dump").read_text(), *thermo])


def rows(text: str) -> np.ndarray:
    """Return the last frame of a dump, shape (grains, 10)."""
    frame = text.rsplit("ITEM: ATOMS", 1)[1].splitlines()[1 : GRAINS + 1]
    return np.array([[float(word) for word in line.split()] for line in frame])


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> str:
    return simulate(tmp_path_factory.mktemp("threads") / "one", 1)


@pytest.mark.parametrize("threads", [2, 3])
def test_same_number_of_threads_gives_the_same_bits(tmp_path, threads):
    assert simulate(tmp_path / "a", threads) == simulate(tmp_path / "b", threads)


def test_result_does_not_depend_on_who_does_the_work(tmp_path, monkeypatch):
    shared = simulate(tmp_path / "helped", 2)
    monkeypatch.setattr(minidem.run.threads, "FREE", False)
    assert simulate(tmp_path / "unhelped", 2) == shared


@pytest.mark.parametrize("threads", [2, 5])
def test_number_of_threads_changes_nothing_but_rounding(tmp_path, alone, threads):
    here, there = rows(simulate(tmp_path / "many", threads)), rows(alone)
    # a rounding of 1e-16 of the force grows with every collision; 1200 steps of a pile that
    # falls and settles make 1e-12 of it, and a wrong or missing contact a hundredth of a radius
    np.testing.assert_allclose(here[:, 1:4], there[:, 1:4], rtol=0, atol=1e-8)


def pair_arrays(path: Path) -> dict[str, np.ndarray]:
    """Return the pair list in a restart file."""
    with path.open("rb") as file:
        file.seek(len(MAGIC) + hashlib.sha256().digest_size)
        with np.load(file, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files if name.startswith("pairs_")}


@pytest.fixture(scope="module")
def pile(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder with a restart file of a pile whose contacts have histories."""
    folder = tmp_path_factory.mktemp("lists")
    (folder / "plate.stl").write_text(PLATE)
    (folder / "in.script").write_text(SCRIPT + "write_restart pile.npz\n")
    run_script(folder / "in.script", root=folder)
    return folder


@pytest.mark.parametrize("skin", [0.00006, 0.004])  # with the second parts outgrow their memory
@pytest.mark.parametrize("threads", [2, 7])
def test_pair_lists_are_those_of_one_thread(pile, skin, threads):
    """Lists are made in parts that are moved together, histories and all."""
    again = re.sub(r"(?s)region domain.*?create_box 2 domain", "read_restart pile.npz", SCRIPT)
    again = re.sub(r"(?s)fix pts all.*?(?=fix integr)", "", again)
    again = again[: again.index("dump d all")].replace("neighbor 0.0003", f"neighbor {skin}")
    lists = []
    for number in (1, threads):
        (pile / "in.again").write_text(again + "run 0\nwrite_restart lists.npz\n")
        run_script(pile / "in.again", root=pile, threads=number)
        lists.append(pair_arrays(pile / "lists.npz"))
    one, several = lists
    at_first = 6 * GRAINS + 256  # what `Lists.make_room` gives a list
    assert (len(one["pairs_other"]) > at_first) == (skin > 0.001)
    assert (one["pairs_hist"] != 0.0).any()
    for name, values in one.items():
        np.testing.assert_array_equal(several[name], values)


def test_threads_end_with_the_script(tmp_path):
    before = threading.active_count()
    simulate(tmp_path / "run", 3)
    for _ in range(100):
        if threading.active_count() <= before:
            break
        time.sleep(0.05)
    assert threading.active_count() <= before  # those of the test before may have ended


@pytest.mark.parametrize("word", ["0", "-1", "65", "two", "1.5", ""])
def test_impossible_number_on_the_command_line(capsys, word):
    with pytest.raises(SystemExit) as caught:
        main(["-in", "in.script", f"-threads={word}"])
    assert caught.value.code == 2
    assert "expected a whole number from 1 to 64" in capsys.readouterr().err


@pytest.mark.parametrize("number", [0, 65])
def test_impossible_number_in_the_call(tmp_path, number):
    with pytest.raises(ValueError, match="expected a number from 1 to 64"):
        run_script(tmp_path / "in.script", root=tmp_path, threads=number)
