"""Reading of STL files, good and bad."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from minidem.errors import DemError
from minidem.world.mesh.stl import numbered_triangles

TRIANGLES = np.arange(18, dtype=np.float64).reshape(2, 3, 3) / 8.0


def ascii_stl(triangles) -> bytes:
    lines = ["solid thing"]
    for corners in triangles:
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += ["  vertex " + " ".join(f"{x:.17g}" for x in corner) for corner in corners]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, "endsolid thing", ""]).encode()


def binary_stl(triangles, count=None, header=b"solid but binary") -> bytes:
    data = header.ljust(80, b"\0") + struct.pack("<I", len(triangles) if count is None else count)
    for corners in triangles:
        data += struct.pack("<12fH", 0, 0, 1, *np.ravel(corners), 0)
    return data


@pytest.mark.parametrize("encode", [ascii_stl, binary_stl])
def test_triangles_come_back_in_file_order(tmp_path, encode):
    path = tmp_path / "a.stl"
    path.write_bytes(encode(TRIANGLES))
    np.testing.assert_array_equal(numbered_triangles(path)[0], TRIANGLES)


def test_ascii_keeps_double_precision(tmp_path, rng):
    triangles = rng.normal(size=(5, 3, 3))
    path = tmp_path / "a.stl"
    path.write_bytes(ascii_stl(triangles).replace(b"\n", b"\r\n"))
    np.testing.assert_array_equal(numbered_triangles(path)[0], triangles)


def test_comments_of_an_ascii_file_are_no_part_of_it(tmp_path):
    path = tmp_path / "a.stl"
    text = ascii_stl(TRIANGLES).replace(b"endloop", b"endloop # of the wall")
    path.write_bytes(b"# ======\n#wall.stl:\n\n" + text + b"#=====\n")
    triangles, lines = numbered_triangles(path)
    np.testing.assert_array_equal(triangles, TRIANGLES)
    assert list(lines) == [5, 12]


def test_lines_between_facets_that_it_does_not_know_are_passed_over_as_in_liggghts(tmp_path):
    path = tmp_path / "a.stl"
    text = ascii_stl(TRIANGLES).replace(b"endfacet\n", b"endfacet\ncolor 1 0 0\n", 1)
    path.write_bytes(text + b"\n -0.4 0.4 -1.0 1.0 -0.5 1.5")
    triangles, lines = numbered_triangles(path)
    np.testing.assert_array_equal(triangles, TRIANGLES)
    assert list(lines) == [2, 10]


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("empty", b"", "the file is empty"),
        ("short", b"hello", "not an STL file"),
        ("VTK", b"# vtk DataFile Version 2.0\n" + bytes(80), "LIGGGHTS 3.8.0 stops as well"),
        ("nothing", b"solid a\nendsolid a\n", "holds no triangle"),
        ("truncated", ascii_stl(TRIANGLES)[:150], "truncated"),
        ("cut_binary", binary_stl(TRIANGLES)[:-3], "announces 2 triangles"),
        ("huge_count", binary_stl(TRIANGLES, count=2**32 - 1), "needs 214748364834 bytes"),
        ("word", ascii_stl(TRIANGLES).replace(b"endloop", b"endlop", 1), "expected 'endloop'"),
        ("facet", ascii_stl(TRIANGLES).replace(b"facet", b"face", 1), "expected 'facet', found 'o"),
        ("letter", ascii_stl(TRIANGLES).replace(b"0.125", b"0.x25"), "expected 'vertex X Y Z'"),
        ("infinite", ascii_stl(TRIANGLES).replace(b"0.125", b"inf"), "triangle 1 has"),
        ("four", ascii_stl(TRIANGLES).replace(b"0.125", b"0.125 1"), "expected 'vertex X Y Z'"),
    ],
)
def test_bad_file_is_named_with_the_reason(tmp_path, name, data, message):
    path = tmp_path / f"{name}.stl"
    path.write_bytes(data)
    with pytest.raises(DemError, match=rf"^{name}\.stl:") as error:
        numbered_triangles(path)[0]
    assert message in str(error.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(DemError, match="cannot read STL file: No such file"):
        numbered_triangles(tmp_path / "none.stl")[0]


@given(
    st.one_of(
        st.binary(max_size=400),
        st.binary(max_size=200).map(lambda tail: b"solid x\nfacet normal 0 0 1\n" + tail),
        st.tuples(st.integers(0, 400), st.integers(0, 255)).map(
            lambda change: _changed(ascii_stl(TRIANGLES), *change)
        ),
        st.tuples(st.integers(0, 183), st.integers(0, 255)).map(
            lambda change: _changed(binary_stl(TRIANGLES), *change)
        ),
    )
)
def test_any_bytes_give_triangles_or_a_clear_error(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("fuzz") / "a.stl"
    path.write_bytes(data)
    try:
        triangles, message = numbered_triangles(path)[0], "a.stl:"
    except DemError as error:
        triangles, message = TRIANGLES, str(error)
    assert message.startswith("a.stl:")
    assert triangles.shape[1:] == (3, 3)
    assert np.isfinite(triangles).all()


def _changed(data: bytes, place: int, value: int) -> bytes:
    place %= len(data)
    return data[:place] + bytes([value]) + data[place + 1 :]
