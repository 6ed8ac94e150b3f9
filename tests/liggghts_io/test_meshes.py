"""STL files and mesh shapes."""

import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.stl import disc, open_box, quad, read_stl, rectangle, stl_text, tube


def area(triangles):
    sides = triangles[:, 1:] - triangles[:, :1]
    return 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum()


def test_stl_round_trip(rng, tmp_path):
    triangles = rng.normal(size=(7, 3, 3))
    (tmp_path / "a.stl").write_text(stl_text("a", triangles))
    assert read_stl(tmp_path / "a.stl") == pytest.approx(triangles, rel=1e-8)  # nine digits


def test_shapes_have_the_area_of_their_closed_form():
    assert area(rectangle((0.0, 2.0), (1.0, 4.0), 0.5)) == pytest.approx(6.0)
    assert area(quad((0, 0, 0), (1, 0, 1), (1, 1, 1), (0, 1, 0))) == pytest.approx(np.sqrt(2))
    # Inscribed polygons: n/2 sin(2 pi/n) r^2, and 2 n sin(pi/n) r h for the tube.
    assert area(disc(2.0, 0.0, 48)) == pytest.approx(24 * np.sin(2 * np.pi / 48) * 4)
    assert area(tube((1.0, 1.0), (0.0, 3.0), 24)) == pytest.approx(48 * np.sin(np.pi / 24) * 3)
    assert area(open_box((0, 1), (0, 2), (0, 3), floor=True)) == pytest.approx(18 + 2)
    assert area(open_box((0, 1), (0, 2), (0, 3), floor=False)) == pytest.approx(18)


@pytest.mark.parametrize(
    "triangles",
    [np.zeros((1, 3, 3)), np.full((1, 3, 3), np.nan), np.zeros((3, 3))],
)
def test_broken_meshes_are_refused(triangles):
    with pytest.raises(CaseError, match=r"a\.stl"):
        stl_text("a", triangles)


CORNER = b"vertex 0 0 0\n"
FACET = b"outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "holds no triangle"),
        (b"# vtk DataFile Version 3.0\n", "holds no triangle; name an STL file, text or binary"),
        (b"solid\n vertex 0 0 0\n", "the last line is not 'endsolid'"),
        (b"solid\n vertex 0 0 0\nendsolid\n", "the last line is not 'endsolid'"),
        (b"\xff\x00garbage", "cut short, or is no STL file"),
        (CORNER * 2 + b"vertex 0 x 0\n", ":3: a corner is not three finite numbers: '0 x 0'"),
        (CORNER * 2 + b"vertex 0 0\n", ":3: a corner is not three finite numbers: '0 0'"),
        (CORNER * 2 + b"vertex 0 nan 0\n", ":3: a corner is not three finite numbers"),
        (CORNER * 2 + b"vertex 0 1_0 0\n", ":3: a corner is not three finite numbers"),
        # Three facets that lost a corner each have as many as two whole ones.
        (b"solid\n" + FACET.replace(b"vertex 1 0 0\n", b"") * 3 + b"endsolid\n", ":5: a facet"),
    ],
)
def test_a_file_that_is_no_stl_is_refused(tmp_path, content, message):
    path = tmp_path / "a.stl"
    path.write_bytes(content)
    with pytest.raises(CaseError, match=rf"a\.stl.*{message}"):
        read_stl(path)


def test_missing_files_and_directories_are_no_stl(tmp_path):
    with pytest.raises(CaseError, match=r"b\.stl: no such file"):
        read_stl(tmp_path / "b.stl")
    with pytest.raises(CaseError, match=r"Is a directory.*name an STL file"):
        read_stl(tmp_path)


def test_a_binary_stl_is_read_whatever_its_head_says(rng, tmp_path):
    triangles = rng.normal(size=(7, 3, 3)).astype("<f4")
    facets = np.zeros(7, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    facets["corners"] = triangles
    content = b"solid box".ljust(80, b"\0") + (7).to_bytes(4, "little") + facets.tobytes()
    path = tmp_path / "a.stl"
    path.write_bytes(content)
    assert read_stl(path).tolist() == triangles.astype(float).tolist()
    path.write_bytes(content[:-5])
    with pytest.raises(CaseError, match="7 triangles has 434 bytes, this one 429; it was cut"):
        read_stl(path)
    path.write_bytes(content[:80] + (4 * 10**9).to_bytes(4, "little") + content[84:])
    with pytest.raises(CaseError, match="4000000000 triangles"):
        read_stl(path)
    facets["corners"][3, 1, 2] = np.inf
    path.write_bytes(content[:84] + facets.tobytes())
    with pytest.raises(CaseError, match="triangle 3 is not finite"):
        read_stl(path)


def test_a_text_stl_may_have_several_solids_and_large_letters(tmp_path):
    solid = b"solid a\nfacet normal 0 0 1\n" + FACET + b"endfacet\nendsolid a\n"
    for content in (solid * 2, solid.upper() * 2, solid.replace(b"\n", b"\r\n") * 2):
        (tmp_path / "a.stl").write_bytes(content)
        assert read_stl(tmp_path / "a.stl").tolist() == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]] * 2
