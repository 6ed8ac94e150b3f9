"""VTK files of other programs and other kinds, cut ones, and ones that announce too much."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from liggghts_io.errors import CaseError
from liggghts_io.foreign import read_output, vtk_files
from tests.liggghts_io.foreign.grains import frame_text, known

LEGACY = "# vtk DataFile Version 3.0\nby hand\nASCII\n"
POINTS = "POINTS 3 float\n0 0 0\n1 0 0\n0 1 0\n"
RADII = "SCALARS radius float 1\nLOOKUP_TABLE default\n0.25\n0.5\n0.75\n"
GRAINS = f"{LEGACY}DATASET POLYDATA\n{POINTS}VERTICES 3 6\n1 0\n1 1\n1 2\nPOINT_DATA 3\n{RADII}"
MESH = f"{LEGACY}DATASET UNSTRUCTURED_GRID\n{POINTS}CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n"
MEANS = GRAINS + "SCALARS volumefraction float 1\nLOOKUP_TABLE default\n0.5\n0.5\n0.5\n"


def xml(kind: str, arrays: str, head: str = "", cells: str = "") -> str:
    """Return a file as VTK's XML has it, with two grains."""
    counts = 'NumberOfCells="0"' if kind == "UnstructuredGrid" else 'NumberOfVerts="0"'
    if kind == "UnstructuredGrid":
        words = cells.split("|") if cells else ["", "", ""]
        counts = 'NumberOfCells="1"' if cells else counts
        array = '<DataArray type="Int32" Name="{}" format="ascii">{}</DataArray>'
        names = ("connectivity", "offsets", "types")
        every = zip(names, words, strict=True)
        cells = f"<Cells>{''.join(array.format(name, word) for name, word in every)}</Cells>"
    point = (
        '<DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 2 3</DataArray>'
    )
    return (
        f'<?xml version="1.0"?>\n{head}<VTKFile type="{kind}" version="0.1" '
        f'byte_order="LittleEndian">\n<{kind}><Piece NumberOfPoints="2" {counts}>'
        f"<Points>{point}</Points><PointData>{arrays}</PointData>{cells}</Piece></{kind}></VTKFile>\n"
    )


def scalars(name: str, words: str, size: int = 1) -> str:
    return (
        f'<DataArray type="Float32" Name="{name}" NumberOfComponents="{size}" format="ascii">'
        f"{words}</DataArray>"
    )


MERCURY = xml(
    "UnstructuredGrid",
    scalars("Radius", "0.25 0.5") + scalars("Velocity", "0 0 0 0 0 1", 3)
    + scalars("AngularVelocity", "0 0 0 0 2 0", 3),
)  # fmt: skip
YADE = xml(
    "UnstructuredGrid",
    scalars("radii", "0.25 0.5") + scalars("linVelVec", "0 0 0 0 0 1", 3)
    + scalars("angVelVec", "0 0 0 0 2 0", 3),
)  # fmt: skip


def binary(order: str) -> bytes:
    """Return a cloud as foamToVTK of OpenFOAM writes it, in an order of bytes."""
    head = "# vtk DataFile Version 2.0\ncloud\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n"
    fields = {"d 1": [0.25, 0.5, 0.75], "rho 1": [2500.0] * 3, "U 3": [0.0] * 6 + [1.0, 2.0, 3.0]}
    content = head.encode() + np.array([0, 0, 0, 0.01, 0, 0, 0, 0.02, 0.03], f"{order}f4").tobytes()
    content += b"\nVERTICES 3 6\n" + np.array([1, 0, 1, 1, 1, 2], f"{order}i4").tobytes()
    content += b"\nPOINT_DATA 3\nFIELD attributes 3\n"
    for name, values in fields.items():
        content += f"{name} 3 float\n".encode() + np.array(values, f"{order}f4").tobytes() + b"\n"
    return content


def test_a_cloud_of_openfoam_is_read(tmp_path: Path):
    (tmp_path / "cloud_7.vtk").write_bytes(binary(">"))
    output = read_output(tmp_path)
    (frame,) = output.frames()
    last = frame.grains.iloc[-1]
    assert [last[name] for name in ("diameter", "density", "vx", "vz")] == [0.75, 2500.0, 1.0, 3.0]
    assert last["z"] == pytest.approx(0.03, rel=1e-7)  # single precision


def test_bytes_in_the_other_order_are_told(tmp_path: Path):
    turned = binary("<")  # without the cells, which VTK itself finds wrong
    start, end = turned.index(b"\nVERTICES"), turned.index(b"\nPOINT_DATA")
    (tmp_path / "cloud_7.vtk").write_bytes(turned[:start] + turned[end:])
    with pytest.raises(CaseError, match=r"cloud_7.vtk: most places .* bytes .* in the other order"):
        list(read_output(tmp_path).frames())


def test_the_step_is_the_number_that_differs(tmp_path: Path):
    for step in (500, 1000, 10000):
        (tmp_path / f"run_{step}_part2.vtk").write_text(GRAINS)
    output = read_output(tmp_path)
    assert [one.name for one in output.series] == ["run_*_part2.vtk"]
    assert [frame.step for frame in output.frames()] == [500, 1000, 10000]
    (tmp_path / "run_500_part2.vtk").unlink()
    assert len(read_output(tmp_path).series) == 2  # which may be two runs


@pytest.mark.parametrize("content", [MERCURY, YADE], ids=["MercuryDPM", "YADE"])
def test_the_names_of_other_programs_are_known(tmp_path: Path, content: str):
    (tmp_path / "grains_7.vtu").write_text(content)
    (frame,) = read_output(tmp_path).frames()
    last = frame.grains.iloc[-1]
    named = ("x", "y", "z", "radius", "vz", "omegay")
    assert [last[name] for name in named] == [1.0, 2.0, 3.0, 0.5, 1.0, 2.0]


def test_comments_quotes_and_small_letters_are_no_hindrance(tmp_path: Path):
    openfoam = xml("PolyData", scalars("radius", "0.25 0.5"), "<!-- case='x' time='1' -->\n")
    files = {
        "a.vtp": openfoam.replace('type="PolyData"', "type='PolyData'"),
        "b.vtp": "\ufeff" + xml("PolyData", scalars("radius", "0.25 0.5")),
        "c.vtk": GRAINS.replace("DATASET POLYDATA", "dataset polydata"),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
        (frame,) = read_output(tmp_path / name).frames()
        assert frame.grains["radius"].tolist()[:2] == [0.25, 0.5]


@pytest.mark.parametrize("content", [MESH, MEANS], ids=["mesh/vtk", "euler/vtk"])
def test_what_is_no_grain_is_passed_over(tmp_path: Path, content: str):
    (tmp_path / "other_1.vtk").write_text(content)
    with pytest.raises(CaseError, match="no dump of grains"):
        read_output(tmp_path).first()
    (tmp_path / "run.dump").write_text(frame_text(0, known(3)))
    assert [one.name for one in read_output(tmp_path).series] == ["run.dump"]


def test_a_mesh_that_only_vtk_knows_is_refused(tmp_path: Path):
    (tmp_path / "mesh_1.vtu").write_text(xml("UnstructuredGrid", "", cells="0 1|2|3"))
    with pytest.raises(CaseError, match=r"mesh_1.vtu: holds surfaces or lines, not grains"):
        list(read_output(tmp_path).frames())


def test_arrays_may_have_any_name(tmp_path: Path):
    names = ("file", "points", "error", "names")
    arrays = "".join(RADII.replace("radius", name) for name in (*names, "radius"))
    (tmp_path / "a_1.vtk").write_text(GRAINS.replace(RADII, arrays))
    (frame,) = read_output(tmp_path).frames()
    for name in (*names, "radius"):
        assert frame.grains[name].tolist() == [0.25, 0.5, 0.75]


def test_every_array_is_read_of_whatever_kind(tmp_path: Path):
    """By itself VTK reads the first of several SCALARS and VECTORS."""
    vectors = "VECTORS {} float\n1 0 0\n2 0 0\n3 0 0\n"
    arrays = RADII.replace("radius", "density") + RADII
    arrays += vectors.format("v") + vectors.format("omega") + vectors.format("Velocity")
    (tmp_path / "a_1.vtk").write_text(GRAINS.replace(RADII, arrays))
    (frame,) = read_output(tmp_path).frames()
    for name in ("density", "radius"):
        assert frame.grains[name].tolist() == [0.25, 0.5, 0.75]
    for name in ("vx", "omegax", "Velocity_x"):
        assert frame.grains[name].tolist() == [1.0, 2.0, 3.0]


def test_a_text_is_used_only_as_a_whole(tmp_path: Path):
    """VTK itself gives what lies in memory for numbers that are missing behind a cut line."""
    start = GRAINS.index("SCALARS")
    with vtk_files.VtkReader() as reader:
        for kept in range(start + 1, len(GRAINS) + 1):
            path = tmp_path / "a_1.vtk"
            path.write_text(GRAINS[:kept])
            if kept == len(GRAINS):
                assert reader.read(path)["radius"].tolist() == [0.25, 0.5, 0.75]
                continue
            with pytest.raises(CaseError, match=r"a_1.vtk: .*; take it out"):
                reader.read(path)


def test_a_last_file_that_ends_before_its_columns_is_left_out(tmp_path: Path):
    for step in (1, 2):
        (tmp_path / f"a_{step}.vtk").write_text(GRAINS)
    (tmp_path / "a_3.vtk").write_text(GRAINS[: GRAINS.index("POINT_DATA")])
    output = read_output(tmp_path)
    assert [frame.step for frame in output.frames()] == [1, 2]
    assert output.notes == (f"{tmp_path / 'a_3.vtk'}: ends before radius; this frame is left out",)


def test_a_number_of_points_that_lies_takes_no_memory(tmp_path: Path):
    """7 GB are announced for 100 bytes; VTK fills them before it looks at the file."""
    head = b"# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\nPOINTS 300000000 double\n"
    (tmp_path / "a_1.vtk").write_bytes(head + b"\0" * 100)
    script = (
        "import resource, sys; from pathlib import Path\n"
        "from liggghts_io.foreign import read_output\n"
        "try:\n    read_output(Path(sys.argv[1])).dump\n"
        "except Exception as err:\n    print(err)\n"
        "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)\n"
    )
    start = time.monotonic()
    found = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True, check=True
    )
    told, kilobytes = found.stdout.strip().rsplit("\n", 1)
    assert "a_1.vtk: VTK cannot read it: Unable to allocate" in told
    assert int(kilobytes) < 1 << 20  # 1 GB; VTK alone takes a tenth of it
    assert time.monotonic() - start < 60.0  # half a minute went into filling the memory


def test_a_name_that_is_no_text_is_read(tmp_path: Path):
    (tmp_path / os.fsdecode(b"a\xff_1.vtk")).write_text(GRAINS)
    (frame,) = read_output(tmp_path).frames()
    assert frame.grains["radius"].tolist() == [0.25, 0.5, 0.75]
