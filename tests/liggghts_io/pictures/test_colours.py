"""What colours say of grains, with known answers."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from liggghts_io.errors import CaseError
from liggghts_io.measure.dumps import Frame
from liggghts_io.pictures.camera import SIDE, VIEWS, camera_named
from liggghts_io.pictures.colouring import COLOURS, checked_colour, colouring_of
from liggghts_io.pictures.compose import composed
from tests.liggghts_io.pictures.shots import frame_of, pile, shot_of

FRAME = frame_of(
    (0.0, 0.0, 0.010), (0.0, 0.0, 0.020), (0.0, 0.0, 0.050), vx=[3.0, 0.0, 0.6], vz=[4.0, 0.0, 0.8],
    radius=[1e-3, 2e-3, 4e-3], type=[2.0, 1.0, 2.0],
)  # fmt: skip


@pytest.mark.parametrize(
    ("by", "low", "high", "part"),
    [
        ("speed", 0.0, 5.0, [1.0, 0.0, 0.2]),
        ("height", 10.0, 50.0, [0.0, 0.25, 1.0]),
        ("size", 2.0, 8.0, [0.0, 1 / 3, 1.0]),
    ],
)
def test_a_bar_runs_from_the_least_to_the_largest(by, low, high, part):
    colouring = colouring_of([FRAME], by)
    assert colouring.is_bar
    assert (colouring.low, colouring.high) == pytest.approx((low, high))
    expected = np.array([colouring.scale(one)[:3] for one in part])
    assert colouring.of(FRAME) / 255.0 == pytest.approx(expected, abs=1 / 255)


def test_grains_at_rest_are_all_pale_and_not_coloured_by_rounding():
    still = frame_of((0.0, 0.0, 0.0), (0.0, 0.0, 0.01), vx=[1e-9, 3e-9])
    colours = colouring_of([still], "speed").of(still)
    assert np.ptp(colours, axis=0).max() == 0


def test_each_type_has_its_own_colour_and_word():
    colouring = colouring_of([FRAME], "type")
    colours = colouring.of(FRAME)
    assert np.array_equal(colours[0], colours[2])
    assert not np.array_equal(colours[0], colours[1])
    assert [words for _, words in colouring.patches] == ["type 1", "type 2"]


def test_one_size_is_said_in_words():
    one = frame_of((0.0, 0.0, 0.0), (0.0, 0.0, 0.01))
    assert [words for _, words in colouring_of([one], "size").patches] == ["diameter 2 mm"]


def test_all_frames_of_a_film_have_the_same_colours():
    later = frame_of((0.0, 0.0, 0.100), step=1)
    assert colouring_of([FRAME, later], "height").high == pytest.approx(100.0)


def test_a_column_that_is_not_there_is_told_with_what_is():
    bare = Frame(0, {name: FRAME.columns[name] for name in ("id", "x", "y", "z", "radius")})
    with pytest.raises(CaseError, match="colour speed: the dump has no column vx; choose height"):
        colouring_of([bare], "speed")


def test_numbers_at_the_bar_of_a_flat_picture_do_not_touch():
    """Grains at rest have the longest numbers, a layer the shortest bar."""
    layer = frame_of(*((0.003 * k, 0.0, 0.0) for k in range(25)))
    for frame in (layer, pile()):
        figure = composed(shot_of(frame), VIEWS[SIDE], None)
        figure.draw_without_rendering()
        bar = figure.axes[-1]
        boxes = [one.get_window_extent() for one in bar.get_xticklabels() if one.get_text()]
        assert len(boxes) > 1
        assert all(left.x1 < right.x0 for left, right in itertools.pairwise(boxes))


def test_unknown_words_are_refused_with_the_nearest():
    with pytest.raises(CaseError, match=r"colour 'sped'.*did you mean 'speed'"):
        checked_colour("sped")
    with pytest.raises(CaseError, match=r"view 'tpo'.*did you mean 'top'"):
        camera_named("tpo")
    assert [checked_colour(one) for one in COLOURS] == list(COLOURS)
