"""`photo size --ruler`: what lies on the ruler, and ticks of which finer ones may be blurred."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import pytest
from PIL import Image

from tests.liggghts_io.photo import rulers

TOLD = "no longer ticks at each fifth or tenth"


def test_numbers_of_a_ruler_count_as_no_grains(bulkcal, tmp_path: Path):
    path = tmp_path / "ruler.png"
    Image.fromarray(rulers.photograph(rulers.close_up(10.3, (240, 210, 60)))).save(path)
    code, out, _ = bulkcal("photo", "size", str(path), "--ruler", "1mm", "--json")
    assert code == 0
    assert json.loads(out)["count"] == rulers.GRAINS


@pytest.mark.parametrize(("tick", "blur"), [(6.6, 2.3), (5.6, 1.4), (10.3, 1.5)])
def test_ticks_that_may_be_those_left_by_blur_are_told(bulkcal, tmp_path: Path, tick, blur):
    """Of blurred ticks each fifth was taken for a millimetre without a word."""
    picture = rulers.photograph(rulers.close_up(tick, (240, 238, 230)))
    path = tmp_path / "blurred.png"
    Image.fromarray(cv2.GaussianBlur(picture, (0, 0), blur)).save(path)
    code, out, err = bulkcal("photo", "size", str(path), "--ruler", "1mm", "--json")
    assert code == 0, err
    right = 2e3 * rulers.RADIUS / tick  # um
    taken = json.loads(out)["d32_um"] == pytest.approx(right, rel=0.1)
    assert taken == (tick > 10.0), "so much blur takes the ticks of the others"
    assert (TOLD in " ".join(err.split())) == (not taken)
