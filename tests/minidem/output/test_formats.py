"""Output byte for byte as LIGGGHTS-PUBLIC 3.8.0 wrote it for the same numbers.

``precise.dump`` holds the numbers with 17 digits; the other files of the folder were written in
the same run in LIGGGHTS' default formats.
"""

from __future__ import annotations

import numpy as np
import pytest
import pyvista
from hypothesis import given
from hypothesis import strategies as st

from minidem.fixes.flow.massflow import flow_header, flow_row
from minidem.output.text.custom import custom_frame, frame_name
from minidem.output.text.formats import column_formats
from minidem.output.text.stl import stl_file
from minidem.output.text.thermo import ThermoFormat, label_of, loop_line
from minidem.output.text.vtk import bounding_box_file, bounding_box_name, particle_file, vtk_fields
from minidem.world.mesh.stl import numbered_triangles
from tests.paths import DATA

STORED = DATA / "minidem" / "output"
INTEGERS = ("id", "type", "ix", "iy", "iz")
FIXED = ("f", "f", "f")


def frame():
    """Return step, box and columns of the reference run."""
    lines = (STORED / "precise.dump").read_text().splitlines()
    names = lines[8].split()[2:]
    box = np.array([[float(word) for word in line.split()] for line in lines[5:8]]).T
    words = [line.split() for line in lines[9:]]
    columns = []
    for i, name in enumerate(names):
        kind = np.int64 if name in INTEGERS else np.float64
        columns.append((name, np.array([row[i] for row in words], dtype=kind)))
    return int(lines[1]), box, columns


def test_dump_custom_in_default_format():
    step, box, columns = frame()
    integers = [name in INTEGERS for name, _ in columns]
    text = custom_frame(step, box, FIXED, columns, column_formats(None, integers))
    assert text == (STORED / "plain.dump").read_text()


def test_dump_custom_with_one_format_per_column():
    step, box, columns = frame()
    integers = [name in INTEGERS for name, _ in columns]
    words = " ".join("%d" if integer else "%.17lg" for integer in integers)
    text = custom_frame(step, box, ("ff", "ff", "ff"), columns, column_formats(words, integers))
    assert text == (STORED / "precise.dump").read_text()


def test_vtk_file_and_bounding_box():
    _, box, columns = frame()
    assert particle_file(columns) == (STORED / "particles_1.vtk").read_text()
    assert bounding_box_file(box) == (STORED / "particles_boundingBox_1.vtk").read_text()


def test_vtk_file_without_particles():
    empty = [(name, values[:0]) for name, values in frame()[2]]
    assert particle_file(empty) == (STORED / "empty.vtk").read_text()


def test_vtk_opens_in_pyvista(tmp_path):
    _, box, columns = frame()
    values = dict(columns)
    (tmp_path / "p.vtk").write_text(particle_file(columns))
    (tmp_path / "b.vtk").write_text(bounding_box_file(box))
    cloud = pyvista.read(tmp_path / "p.vtk")
    assert cloud.n_points == cloud.n_verts == len(values["x"])
    np.testing.assert_array_equal(cloud["id"], values["id"])
    # Eleven digits are written.
    np.testing.assert_allclose(cloud["v"][:, 1], values["vy"], rtol=1e-10)
    np.testing.assert_allclose(cloud["radius"], values["radius"], rtol=1e-10)
    assert pyvista.read(tmp_path / "b.vtk").bounds == pytest.approx(box.T.ravel())


def test_nine_values_leave_an_empty_line():
    """VTK breaks the line after nine values and once more at the end."""
    three = [(name, np.arange(3.0)) for name in "xyz"]
    assert "POINTS 3 float\n0 0 0 1 1 1 2 2 2 \n\nVERTICES" in particle_file(three)


def test_fields_merge_only_whole_triples():
    names = ["x", "y", "z", "vy", "vz", "c_a[1]", "c_a[2]", "c_a[3]", "v_q", "radius", "type"]
    assert vtk_fields(names) == [
        ("type", ("type",)),
        ("vy", ("vy",)),
        ("vz", ("vz",)),
        ("radius", ("radius",)),
        ("c_a[1-3]", ("c_a[1]", "c_a[2]", "c_a[3]")),
        ("q", ("v_q",)),
    ]


def test_mesh_is_written_and_read_back(tmp_path):
    reference = STORED / "mesh_1.stl"
    triangles, _ = numbered_triangles(reference)
    text = stl_file(triangles)
    # The normals come from vertices of 6 digits here, from exact ones in the reference.
    body = [line for line in text.splitlines() if "normal" not in line]
    assert body == [line for line in reference.read_text().splitlines() if "normal" not in line]
    (tmp_path / "a.stl").write_text(text)
    np.testing.assert_array_equal(numbered_triangles(tmp_path / "a.stl")[0], triangles)


def test_normal_of_a_flat_facet_keeps_its_negative_zero():
    corners = np.array([[[-0.03, -0.03, 0.05], [0.03, 0.03, 0.05], [-0.03, 0.03, 0.05]]])
    assert "facet normal 0 -0 1\n" in stl_file(corners)


def test_thermo_lines():
    table = ThermoFormat(("step", "atoms", "ke", "c_er", "vol", "dt", "time", "f_mf[1]"))
    assert table.header() == (
        "    Step    Atoms         KinEng             er         Volume             Dt"
        "           Time          mf[1] "
    )
    values = [3000, 10, 0.0029049375123, 7.9641395e-07, 0.048, 1e-5, 0.03, 0.0065449847]
    assert table.row(values) == (
        "    3000       10   0.0029049375  7.9641395e-07          0.048          1e-05"
        "           0.03   0.0065449847 "
    )
    table.set_format("float", "%.17g")
    table.set_format("2", "%4d")
    assert table.row(values).startswith("    3000   10 0.0029049375123 ")
    for which, text in [("9", "%g"), ("1", "%g"), ("float", "%s"), ("int", "%n"), ("x", "%g")]:
        with pytest.raises(ValueError, match="format"):
            table.set_format(which, text)


def test_massflow_lines():
    assert flow_header(write_time=True) == "# ID time  diameter x y z u v w  (ex ey ez, color)\n"
    assert flow_header(write_time=False) == "# ID diameter x y z u v w  (ex ey ez, color)\n"
    values = (0.01, 0.01, 0.01, 0.05, 0.0, 0.0, -0.58)
    assert flow_row(6, 0.02345, values) == "6  0.02345  0.01 0.01 0.01 0.05    0    0 -0.58\n"
    assert flow_row(6, None, values) == "6 0.01 0.01 0.01 0.05    0    0 -0.58\n"


def test_names_of_files():
    assert frame_name("post/a_*.dump", 800, pad=6) == "post/a_000800.dump"
    assert bounding_box_name("post/b*c.vtk") == "post/bboundingBox_*c.vtk"
    assert bounding_box_name("single.vtk") == "single_boundingBox.vtk"
    assert label_of("atoms") == "Atoms"
    assert loop_line(0.0519334, 4000, 10, "Sat Nov 21 03:28:18 2026") == (
        "Loop time of 0.0519334 on 1 procs for 4000 steps with 10 atoms, "
        "finish time Sat Nov 21 03:28:18 2026"
    )


@pytest.mark.parametrize(
    "word", ["%s", "%n", "%d %d", "%", "abc", "%1000000000d", "%*d", "%.9999g"]
)
def test_dangerous_format_is_refused(word):
    with pytest.raises(ValueError, match="format"):
        column_formats(word, [False])


@given(st.lists(st.floats(allow_nan=False), min_size=1, max_size=30))
def test_numbers_are_those_of_the_default_c_format(numbers):
    values = np.array(numbers)
    text = custom_frame(0, np.zeros((2, 3)), FIXED, [("x", values)], ["%g"])
    assert text.splitlines()[9:] == ["%g " % number for number in numbers]  # noqa: UP031
