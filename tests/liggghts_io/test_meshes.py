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


def test_a_file_that_is_no_stl_is_refused(tmp_path):
    path = tmp_path / "a.stl"
    for content, message in [
        (b"solid\n vertex 0 0 0\n", "three for each triangle"),
        (b"\xff\x00garbage", "three for each triangle"),
        (b"vertex 0 0 0\n" * 2 + b"vertex 0 x 0\n", "not three numbers"),
        (b"vertex 0 0 0\n" * 2 + b"vertex 0 0\n", "not three numbers"),
        (b"vertex 0 0 0\n" * 2 + b"vertex 0 nan 0\n", "not finite"),
    ]:
        path.write_bytes(content)
        with pytest.raises(CaseError, match=message):
            read_stl(path)
