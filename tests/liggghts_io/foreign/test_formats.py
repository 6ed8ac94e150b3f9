"""However grains were dumped, the same numbers come out."""

from __future__ import annotations

import gzip
import shutil
import subprocess
import tracemalloc
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from liggghts_io.errors import CaseError
from liggghts_io.foreign import facts_of, read_output, thermo_facts
from liggghts_io.measure.text_dump import blocks
from minidem import run_script
from tests.liggghts_io.foreign.grains import DATA, frame_text, known, write_frames

SHARED = ["id", "x", "y", "z", "radius"]
KINDS = ["post/f_*.dump", "many.dump", "scaled.dump"] + [
    f"post/{name}"
    for name in ("v_*.vtk", "v_*.vtp", "v_*.vtu", "av_*.vtk", "bin_*.vtk", "bin_*.vtp")
]


def grains_of(place: Path, dump: str = "", units: str = "") -> dict[int, pd.DataFrame]:
    """Return the grains of every frame by step, in the order of their ids."""
    output = read_output(place, dump, units)
    return {
        frame.step: frame.grains.sort_values("id", ignore_index=True) for frame in output.frames()
    }


@pytest.mark.parametrize("dump", KINDS)
def test_every_kind_of_dump_holds_the_same_grains(dump: str):
    truth = grains_of(DATA, "post/f_*.dump")
    found = grains_of(DATA, dump)
    assert list(found) == list(truth) == [1000, 2000]
    for step, grains in found.items():
        # Six digits in a text, single precision in VTK; the scaled ones are parts of 6 cm.
        np.testing.assert_allclose(grains[SHARED], truth[step][SHARED], rtol=2e-5, atol=1e-7)
        if "vx" in grains:
            velocity = ["vx", "vy", "vz"]
            np.testing.assert_allclose(grains[velocity], truth[step][velocity], rtol=1e-5)


def test_thermo_output_of_style_multi_is_read(tmp_path: Path):
    block = (
        "---------------- Step {0:8d} ----- CPU =      0.0206 (sec) ----------------\n"
        "Step     =       {0:8d} Atoms    =             89 KinEng   =      {1:9.2e} \n"
        "CPU      =         0.0206 \n"
    )
    log = "LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0)\nStep Atoms KinEng\n 0 89 0.5\nLoop time of 1\n"
    log += "".join(block.format(step, 1.0 / step) for step in (500, 1000)) + "Loop time of 1\n"
    (tmp_path / "log.liggghts").write_text(log)
    write_frames(tmp_path)
    found = read_output(tmp_path, "", "").thermo
    assert found["Step"].tolist() == [0, 500, 1000]
    assert found["KinEng"].tolist() == [0.5, 0.002, 0.001]
    assert found["CPU"].tolist()[1:] == [0.0206, 0.0206]


def test_scaled_coordinates_follow_the_edges_of_a_box_that_leans(tmp_path: Path):
    # Edges of 2, 3 and 4 m that lean by xy = 0.5, xz = -0.25 and yz = 0.75 m, from (1, 2, 3) on.
    bounds = f"{1 - 0.25} {3 + 0.5} 0.5\n2 {5 + 0.75} -0.25\n3 7 0.75"
    rows = "1 0 0 0 0.1\n2 1 0 0 0.1\n3 0 1 0 0.1\n4 0 0 1 0.1\n5 1 1 1 0.1"
    (tmp_path / "leaning.dump").write_text(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n5\nITEM: BOX BOUNDS xy xz yz ff ff ff\n"
        f"{bounds}\nITEM: ATOMS id xs ys zs radius\n{rows}\n"
    )
    found = grains_of(tmp_path / "leaning.dump")[0]
    wanted = [[1, 2, 3], [3, 2, 3], [1.5, 5, 3], [0.75, 2.75, 7], [3.25, 5.75, 7]]
    np.testing.assert_allclose(found[["x", "y", "z"]], wanted, rtol=1e-12)


@pytest.mark.liggghts
def test_the_stored_files_are_what_liggghts_writes(tmp_path: Path):
    shutil.copyfile(DATA / "in.make", tmp_path / "in.make")
    with (tmp_path / "screen").open("w") as screen:
        subprocess.run(["liggghts", "-in", "in.make"], cwd=tmp_path, stdout=screen, check=True)
    for dump in KINDS:
        stored = grains_of(DATA, dump)
        for step, grains in grains_of(tmp_path, dump).items():
            pd.testing.assert_frame_equal(grains, stored[step], rtol=1e-6)


def test_an_overview_tells_dumps_columns_and_log():
    output = read_output(DATA)
    assert {one.name for one in output.series} == set(KINDS)  # no boxes, no script, no log
    assert output.series[0].name == "post/f_*.dump"
    facts = facts_of(output.series[0], output.units)
    assert (facts.files, facts.frames, facts.steps, facts.grains) == (2, 2, (1000, 2000), (12, 12))
    assert facts.columns.loc["radius"].tolist() == ["m", 0.003, 0.003]
    assert facts.columns.loc["id"].tolist() == ["-", 1.0, 12.0]
    thermo = thermo_facts(output)
    assert list(thermo.index) == ["Step", "Atoms", "KinEng"]
    assert thermo.loc["Step", "last"] == 2001
    assert (output.units, output.dt, output.remarks) == ("si", 1e-5, ())


@pytest.mark.parametrize(("behind", "between"), [(" ", " "), ("", " "), ("  ", "   "), ("", "\t")])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_columns_in_any_order_and_any_space(tmp_path: Path, behind: str, between: str, end: str):
    columns = known(7)
    names = ["radius", "vz", "z", "id", "y", "vx", "x", "type", "vy"]
    text = frame_text(3, columns, names, behind=behind, between=between)
    (tmp_path / "run.dump").write_bytes(text.replace("\n", end).encode())
    (grains,) = grains_of(tmp_path).values()
    for name in names:
        assert grains[name].tolist() == columns[name].tolist()


def test_many_frames_in_one_file_a_file_for_each_and_gzip(tmp_path: Path):
    paths = write_frames(tmp_path / "each", (5, 0, 9, 2))
    joined = b"".join(path.read_bytes() for path in paths)
    (tmp_path / "one.dump").write_bytes(joined)
    (tmp_path / "one.gz").write_bytes(gzip.compress(joined))
    truth = grains_of(tmp_path / "each")
    assert [len(grains) for grains in truth.values()] == [5, 0, 9, 2]
    for name in ("one.dump", "one.gz"):
        found = grains_of(tmp_path / name)
        assert list(found) == list(truth)
        for step, grains in found.items():
            pd.testing.assert_frame_equal(grains, truth[step])


@pytest.mark.parametrize(
    ("units", "length", "speed", "force", "seconds"),
    [("micro", 1e-6, 1.0, 1e-9, 1e-6), ("nano", 1e-9, 1.0, 1e-12, 1e-9), ("lj", 1, 1, 1, 1)],
)
def test_time_has_a_unit_too(tmp_path: Path, units, length, speed, force, seconds):
    columns = known(4) | {"fx": np.ones(4)}
    (tmp_path / "a.dump").write_text(frame_text(7, columns))
    log = f"LIGGGHTS (Version 3.8.0)\nunits {units}\ntimestep 2e-5\n    Step    Atoms\n 0 4\n"
    (tmp_path / "log.run").write_text(log)
    (grains,) = grains_of(tmp_path).values()
    assert read_output(tmp_path).time_of(7) == pytest.approx(1.4e-4 * seconds)
    assert read_output(tmp_path, dt=2e-5).time_of(7) == pytest.approx(1.4e-4)
    assert grains["x"].tolist() == pytest.approx((columns["x"] * length).tolist())
    assert grains["vx"].tolist() == pytest.approx((columns["vx"] * speed).tolist())
    assert grains["fx"].tolist() == pytest.approx([force] * 4)


def test_the_log_of_minidem_is_one(tmp_path: Path):
    lines = ["atom_style granular", "boundary f f f", "newton off", "communicate single vel yes"]
    lines += ["units cgs", "region r block -4 4 -4 4 -4 4 units box", "create_box 1 r"]
    lines += ["fix a all property/global youngsModulus peratomtype 5e7"]
    lines += ["fix b all property/global poissonsRatio peratomtype 0.3"]
    lines += ["fix c all property/global coefficientRestitution peratomtypepair 1 0.5"]
    lines += ["fix d all property/global coefficientFriction peratomtypepair 1 0.5"]
    lines += ["pair_style gran model hertz tangential history", "pair_coeff * *"]
    lines += ["timestep 1e-5", "neigh_modify delay 0", "create_atoms 1 single 1 0 0"]
    lines += ["set group all diameter 0.2 density 2.5", "fix i all nve/sphere"]
    lines += ["dump d all custom 10 d_*.dump id type x y z radius", "run 10", ""]
    (tmp_path / "in.s").write_text("\n".join(lines))
    run_script(tmp_path / "in.s", root=tmp_path)
    output = read_output(tmp_path)
    assert (output.units, output.dt) == ("cgs", 1e-5)
    assert output.log is not None
    assert output.log.thermo["Step"].tolist() == [0, 10]


def test_numbers_are_those_that_python_reads(tmp_path: Path, rng: np.random.Generator):
    values = rng.normal(size=(200, 3)) * 10.0 ** rng.integers(-300, 300, (200, 1))
    words = [[repr(float(value)) for value in row] for row in values]
    columns = dict(zip("xyz", np.zeros((3, 200)), strict=True))
    head, _, _ = frame_text(0, columns).partition("ITEM: ATOMS")
    rows = "\n".join(" ".join(row) for row in words)
    (tmp_path / "a.dump").write_text(f"{head}ITEM: ATOMS x y z\n{rows}\n")
    (frame,) = read_output(tmp_path).frames()
    assert frame.grains[["x", "y", "z"]].to_numpy().tolist() == values.tolist()


def test_cgs_becomes_si_by_the_word_in_the_log(tmp_path: Path):
    columns = known(4) | {"fx": np.ones(4), "mass": np.ones(4), "c_1": np.ones(4)}
    (tmp_path / "a.dump").write_text(frame_text(7, columns))
    log = "LIGGGHTS (Version 3.8.0)\nunits cgs\ntimestep 2e-5\n    Step    Atoms\n       0      4\n"
    (tmp_path / "log.run").write_text(log)
    (grains,) = grains_of(tmp_path).values()
    output = read_output(tmp_path)
    assert output.units == "cgs"
    assert output.time_of(7) == pytest.approx(1.4e-4)
    assert grains["x"].tolist() == pytest.approx((columns["x"] / 100).tolist())
    assert grains["fx"].tolist() == pytest.approx([1e-5] * 4)
    assert grains["mass"].tolist() == pytest.approx([1e-3] * 4)
    assert grains["c_1"].tolist() == [1.0] * 4
    (as_si,) = grains_of(tmp_path, units="si").values()
    assert as_si["x"].tolist() == columns["x"].tolist()
    with pytest.raises(CaseError, match="units 'cgz': cannot be converted; did you mean 'cgs'"):
        read_output(tmp_path, units="cgz")


def test_a_mesh_is_no_dump_of_grains(tmp_path: Path):
    head = "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
    (tmp_path / "mesh_1.vtk").write_text(f"{head}0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n")
    (tmp_path / "reader.py").write_text("WORDS = 'DATASET POLYDATA'\n")
    with pytest.raises(CaseError, match="no dump of grains"):
        read_output(tmp_path).first()


def test_the_memory_is_that_of_one_frame(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(blocks, "_PIECE", 1 << 14)
    # Small frames are read together, up to 1 MB.
    monkeypatch.setattr("liggghts_io.foreign.dump._BATCH", 1 << 14)
    path = tmp_path / "long.dump"
    frame = frame_text(0, known(500))

    def peak(frames: int) -> int:
        path.write_text(frame * frames)
        output = read_output(path)
        assert len(output.dump.steps) == frames
        tracemalloc.start()
        assert sum(len(one.grains) for one in output.frames()) == 500 * frames
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return most

    peak(2)  # imports
    assert peak(60) < 1.5 * peak(3)  # all at once would be twenty times as much
