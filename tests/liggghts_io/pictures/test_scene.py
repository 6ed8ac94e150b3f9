"""The scene of a page: what stands in it, and what a browser makes of it."""

from __future__ import annotations

import base64
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from liggghts_io.errors import CaseError
from liggghts_io.pictures.camera import SIDE, VIEWS
from liggghts_io.pictures.compose import composed
from liggghts_io.pictures.page import page_of, scene_of
from tests.browser import DESKTOP, PHONE, opened
from tests.liggghts_io.pictures.shots import PLATE, frame_of, pile, shot_of

STILL = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg=="
)
"""A PNG picture of one pixel."""


def data_of(page: str) -> dict:
    found = re.search(r'<script type="application/json" id="scene-data">(.*?)</script>', page)
    assert found is not None
    return json.loads(found[1])


def numbers(text: str, kind: str = "<f4") -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), kind)


@pytest.fixture(scope="module")
def page(tmp_path_factory) -> Path:
    shot = shot_of(pile())
    still = io.BytesIO()
    composed(shot, VIEWS[SIDE], None).savefig(still)
    path = tmp_path_factory.mktemp("page") / "pile.html"
    path.write_text(page_of(shot, still.getvalue()), encoding="utf-8")
    return path


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("distance", [2.0, 1e3, 1e300])
def test_a_lost_grain_makes_the_others_no_smaller(view: str, distance: float):
    places = pile(60).positions
    alone = shot_of(frame_of(*places))
    lost = shot_of(frame_of(*places, (0.0, distance, 0.0)))
    assert lost.window_of(VIEWS[view]) == pytest.approx(alone.window_of(VIEWS[view]))
    words = composed(lost, VIEWS[view], None).get_suptitle()
    assert "not in sight: 1 of 61 grains" in words
    assert "not in sight" not in composed(alone, VIEWS[view], None).get_suptitle()


def test_a_scene_holds_every_grain_and_triangle_in_mm():
    shot = shot_of(pile(50))
    data = data_of(scene_of(shot))
    centres = numbers(data["grains"]["centres"]).reshape(-1, 3)
    assert centres == pytest.approx(1e3 * shot.frame.positions, rel=1e-6)
    assert numbers(data["grains"]["radii"]) == pytest.approx(np.ones(50))
    colours = numbers(data["grains"]["colours"], "u1").reshape(-1, 3)
    assert np.array_equal(colours, shot.colouring.of(shot.frame))
    (mesh,) = data["meshes"]
    assert numbers(mesh["corners"]).reshape(-1, 3, 3) == pytest.approx(1e3 * PLATE)
    assert mesh["opacity"] < 0.5


def test_words_of_a_run_are_not_taken_for_html():
    page = page_of(shot_of(pile(5), title="<script>alert(1)</script>"), STILL)
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert(1)" in page


def test_the_license_of_vtk_js_goes_with_every_page():
    page = page_of(shot_of(pile(5)), STILL)
    assert "Copyright (c) 2016, Kitware Inc." in page
    assert "Redistributions in binary form must reproduce" in page


def test_a_scene_of_a_hundred_thousand_grains_is_below_5_mb_and_a_larger_one_refused():
    assert len(scene_of(shot_of(pile(100_000)))) < 5e6
    with pytest.raises(CaseError, match=r"300000 grains and 2 triangles .* 5 at most; draw a"):
        scene_of(shot_of(pile(300_000)))


def seen(shown) -> np.ndarray:
    """Return the picture of the scene's place, (rows, columns, 3) from 0 to 1."""
    content = shown.page.locator(".scene-place").screenshot()
    return imread(io.BytesIO(content), format="png")[:, :, :3]


@pytest.mark.parametrize("size", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_a_browser_shows_the_scene_and_asks_nobody(page: Path, size: tuple[int, int]):
    with opened(page, size) as shown:
        shown.page.locator("#scene canvas").wait_for()
        shown.page.wait_for_timeout(1000)
        assert shown.errors == []
        assert shown.requests == []
        assert shown.page.locator(".until-scene").is_hidden()
        assert shown.page.evaluate("document.documentElement.scrollWidth") <= size[0]
        picture = seen(shown)
    coloured = np.ptp(picture, axis=2) > 0.1
    assert 0.02 < coloured.mean() < 0.7
    # All of the pile is in the picture: nothing touches its edges.
    edges = (coloured[0], coloured[-1], coloured[:, 0], coloured[:, -1])
    assert not np.concatenate(edges).any()


def test_the_mouse_turns_the_scene_and_a_button_turns_it_back(page: Path):
    with opened(page) as shown:
        shown.page.locator("#scene canvas").wait_for()
        shown.page.locator("button[data-view=iso]").click()
        shown.page.wait_for_timeout(500)
        first = seen(shown)
        box = shown.page.locator(".scene-place").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        shown.page.mouse.move(x, y)
        shown.page.mouse.down()
        shown.page.mouse.move(x + 150, y - 60, steps=5)
        shown.page.mouse.up()
        shown.page.wait_for_timeout(500)
        turned = seen(shown)
        shown.page.locator("button[data-view=iso]").click()
        shown.page.wait_for_timeout(500)
        back = seen(shown)
        assert shown.errors == []
    assert np.abs(turned - first).mean() > 0.01
    assert np.abs(back - first).mean() < 0.001


def test_without_webgl_the_still_picture_stays(page: Path):
    with opened(page, webgl=False) as shown:
        assert shown.page.locator(".until-scene").is_visible()
        assert shown.page.locator("#scene").is_hidden()
        assert shown.errors == []


def test_one_grain_without_a_mesh_is_a_scene(tmp_path: Path):
    path = tmp_path / "one.html"
    shot = shot_of(frame_of((0.0, 0.0, 0.0)))
    path.write_text(page_of(shot, STILL), encoding="utf-8")
    with opened(path) as shown:
        shown.page.locator("#scene canvas").wait_for()
        assert shown.errors == []
