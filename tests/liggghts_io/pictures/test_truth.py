"""What stands in a picture is true: lengths, angles, flanks, boxes, and the frame asked for."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from matplotlib.image import imread

from liggghts_io import CaseError, execute
from liggghts_io.case.directory import OUTPUT, load_setup
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.heap.observing import measure
from liggghts_io.measure.dumps import Frame, frame_paths, read_frame
from liggghts_io.measure.silhouette import draw_silhouette
from liggghts_io.pictures import render
from liggghts_io.pictures.camera import SIDE, VIEWS
from liggghts_io.pictures.child import Studio
from liggghts_io.pictures.colouring import Colouring
from liggghts_io.pictures.compose import composed
from liggghts_io.pictures.reel import Reel
from liggghts_io.pictures.reels import reel_of_case
from liggghts_io.pictures.shot import Shot


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("cases")


@pytest.fixture
def case_of(small_spec, root):
    """Return a function from experiment to the directory of a small case."""
    return lambda experiment="heap": execute(small_spec(experiment), root).path


@pytest.fixture
def reel_in(case_of):
    """Return a function from experiment and what was measured to the frames of a small case."""

    def reel(experiment="heap", observables=None) -> Reel:
        path = case_of(experiment)
        return reel_of_case(path, path / OUTPUT, observables or {})

    return reel


def frame_of(*grains: tuple[float, float, float]) -> Frame:
    """Return a frame with grains of radius 1 mm at rest."""
    x, y, z = np.array(grains, dtype=float).T
    columns = dict(zip(("vx", "vy", "vz"), np.zeros((3, len(x))), strict=True))
    columns |= {"id": np.arange(len(x)) + 1.0, "x": x, "y": y, "z": z}
    return Frame(0, columns | {"radius": np.full(len(x), 1e-3)})


AT_REST = Colouring("speed", 0.0, 1.0)


def drawn(shot: Shot, view: str) -> np.ndarray:
    """Return what VTK draws, (rows, columns, 3) from 0 to 1."""
    with Studio() as studio:
        picture = studio.picture(shot, VIEWS[view])
        if picture is None:
            pytest.skip("VTK cannot draw here")
        return imread(picture)[:, :, :3]


@pytest.mark.parametrize("y", [-0.02, 0.0, 0.02])
def test_a_grain_is_drawn_where_it_is_however_near(y):
    """The projection is parallel: a grain in front is as large, and in the same place."""
    shot = Shot(frame_of((0.012, y, 0.005)), AT_REST, window=(0.0, 0.02, 0.0, 0.01))
    image = drawn(shot, SIDE)
    dark = image.min(axis=2) < 0.9
    rows, columns = np.nonzero(dark)
    pixel = 0.02 / image.shape[1]
    assert (columns.mean() + 0.5) * pixel == pytest.approx(0.012, abs=pixel)
    assert 0.01 - (rows.mean() + 0.5) * pixel == pytest.approx(0.005, abs=pixel)
    assert dark.sum() * pixel**2 == pytest.approx(np.pi * 1e-6, rel=0.01)


@pytest.mark.parametrize("view", sorted(VIEWS))
def test_no_grain_of_a_long_row_is_behind_the_camera(view):
    """However deep a scene is in a view, the nearest and the farthest grain are drawn."""
    row = frame_of(*((x, x / 9.0, x / 7.0) for x in np.linspace(-0.5, 0.5, 21)))
    camera = VIEWS[view]
    found = drawn(Shot(row, AT_REST), view).min(axis=2) < 0.9
    left, right, low, _ = camera.window(row.positions, row.columns["radius"], np.empty((0, 3)))
    pixel = (right - left) / found.shape[1]
    places = ((camera.seen(row.positions) - [left, low]) / pixel).astype(int)
    assert found[found.shape[0] - 1 - places[:, 1], places[:, 0]].all()


def test_the_flanks_drawn_are_those_of_the_observable(case_of, reel_in):
    """One routine: mean angle of the lines in the measured frames = observable."""
    shot = reel_in("heap", {"angle_deg": 33.3}).shot("best", "speed")
    repose = measure(shot.frame, load_setup(case_of()))
    notes = shot.notes
    assert np.array_equal(notes.lines, repose.lines)
    slopes = [np.degrees(np.arctan2(*abs(np.diff(line, axis=0)[0])[::-1])) for line in notes.lines]
    assert slopes == pytest.approx([repose.left_deg, repose.right_deg], abs=1e-3)
    assert [text for _, _, text in notes.labels] == [
        f"{repose.left_deg:.1f}°", f"{repose.right_deg:.1f}°",
    ]  # fmt: skip
    assert f"{repose.angle_deg:.1f}°" in notes.title
    assert "33.3°" in notes.title


def test_the_flanks_lie_on_the_heap():
    """A wedge of grains whose flanks are known: the lines touch them in its own coordinates."""
    d, slope = 0.002, np.radians(35.0)
    x, z = np.meshgrid(np.arange(-40, 41) * d / 2 + 0.1, (np.arange(40) + 1) * d / 2)
    inside = z <= (20 * d - np.abs(x - 0.1)) * np.tan(slope)
    x, z = x[inside], z[inside]
    shadow = draw_silhouette(x, z, np.full_like(x, d / 2), d / 16)
    left = x.min() - 2.0 * d
    assert shadow.left_m == pytest.approx(left)
    dark = np.flatnonzero((shadow.image == 0).any(axis=0))
    middle = shadow.left_m + (dark.mean() + 0.5) * shadow.metres_per_pixel
    assert middle == pytest.approx(0.1, abs=d / 16)


def test_lines_begin_and_end_on_the_upper_edge_of_the_grains(case_of, reel_in):
    shot = reel_in().shot("best", "speed")
    setup = load_setup(case_of())
    repose = measure(shot.frame, setup)
    grains, radius = shot.frame.positions[:, [0, 2]], setup.particle.d32_m / 2
    for line in repose.lines:
        for end in line:
            assert np.linalg.norm(grains - end, axis=1).min() < 4.0 * radius


def test_every_box_has_its_number_and_mass(case_of, reel_in):
    masses = {f"m{box}_g": 10.0 * box for box in (1, 2, 3, 4)} | {"beside_g": 7.5}
    notes = reel_in("plate_impact", masses).shot("best", "speed").notes
    a = load_setup(case_of("plate_impact")).apparatus
    for box, (x, z, text) in enumerate(notes.labels, start=1):
        assert text == f"box {box}\n{10.0 * box:.2f} g"
        assert a[f"box_{box}_near_m"] < x < a[f"box_{box}_far_m"]
        assert z < -a["box_depth_m"]
    assert "7.50 g" in notes.title


@pytest.mark.parametrize("view", ["side", "iso"])
@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_no_words_or_ticks_lie_over_each_other(reel_in, experiment, view):
    known = {one.name: 12.345 for one in EXPERIMENTS[experiment].observables}
    figure = composed(reel_in(experiment, known).shot("best", "speed"), VIEWS[view], None)
    figure.draw_without_rendering()
    axes, bar = figure.axes
    texts = [
        axes.xaxis.label, axes.yaxis.label, bar.xaxis.label, *axes.texts, figure._suptitle,
        *axes.get_xticklabels(), *axes.get_yticklabels(), *bar.get_xticklabels(),
    ]  # fmt: skip
    texts = [one for one in texts if one.get_text() and shown(one, axes, bar)]
    boxes = [(one.get_text(), one.get_window_extent()) for one in texts]
    width, height = figure.canvas.get_width_height()
    for number, (text, box) in enumerate(boxes):
        assert -1 <= box.x0 < box.x1 <= width + 1, text
        assert -1 <= box.y0 < box.y1 <= height + 1, text
        for other, beside in boxes[number + 1 :]:
            assert not box.shrunk(0.95, 0.95).overlaps(beside), (text, other)


@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_numbers_beside_the_colours_are_read_in_a_report(reel_in, experiment):
    """A report shows a picture half as large at the least; letters stay 9 pixels high there."""
    figure = composed(reel_in(experiment).shot("best", "speed"), VIEWS[SIDE], None)
    _, bar = figure.axes
    labels = [one for one in bar.get_xticklabels() if one.get_text() and shown(one, bar)]
    assert len(labels) >= 3
    for text in (*labels, bar.xaxis.label):
        assert 0.5 * text.get_fontsize() / 72.0 * figure.dpi >= 9.0


def shown(text, *panels) -> bool:
    """Whether a tick label belongs to a tick within the limits."""
    for panel in panels:
        if text in panel.get_xticklabels():
            return panel.get_xlim()[0] <= text.get_position()[0] <= panel.get_xlim()[1]
        if text in panel.get_yticklabels():
            return panel.get_ylim()[0] <= text.get_position()[1] <= panel.get_ylim()[1]
    return True


@pytest.mark.parametrize(("word", "number"), [("first", 0), ("last", -1), ("3", 3)])
def test_the_frame_asked_for_is_drawn(case_of, reel_in, word, number):
    frames = [read_frame(one) for one in frame_paths(case_of() / OUTPUT)]
    if not frames[number].count:
        with pytest.raises(CaseError, match="no grain in this frame"):
            reel_in().shot(word, "speed")
        return
    assert reel_in().shot(word, "speed").frame.step == frames[number].step


def test_best_is_the_end_of_the_pour_for_a_heap(case_of, reel_in):
    shot = reel_in().shot("best", "speed")
    a = load_setup(case_of()).apparatus
    pour = a["pour_tau"] / (a["pour_tau"] + a["settle_tau"])
    assert shot.number <= pour * shot.last < shot.number + 1


@pytest.mark.parametrize("word", ["", "lst", "-1", "99", "9" * 30, "1.5", "²"])
def test_a_frame_that_is_not_there_is_refused(reel_in, word):
    with pytest.raises(CaseError, match="frame"):
        reel_in().shot(word, "speed")


def test_a_level_plate_is_seen_as_a_line_and_level(reel_in):
    figure = composed(reel_in().shot("best", "speed"), VIEWS[SIDE], None)
    lines = [one for one in figure.axes[0].collections if type(one).__name__ == "LineCollection"]
    heights = np.concatenate([path.vertices[:, 1] for path in lines[0].get_paths()])
    assert heights == pytest.approx(0.0, abs=1e-9)
    assert figure.axes[0].get_aspect() == 1.0


def test_a_picture_says_what_it_shows(small_spec, root, monkeypatch):
    result = execute(small_spec(), root)
    titles = []
    save = render._save
    monkeypatch.setattr(render, "_save", lambda f, t: titles.append(f.get_suptitle()) or save(f, t))
    picture = render.render_case(result.path, render.Look("last"))
    last = len(frame_paths(result.path / OUTPUT)) - 1
    assert titles[0].startswith(
        f"Angle of repose: Carbo HSP13 on a flat wall, frame {last} of {last}\nin this picture "
    )
    assert f"{result.observables['angle_deg']:.1f}°" in titles[0]
    assert cv2.imread(str(picture)).shape[1] == 1050
    assert load_setup(result.path).kind == "flat"
    assert not [one for one in Path(result.path).iterdir() if one.name.startswith(".")]


def test_grains_too_far_for_any_picture_are_refused():
    far = np.array([0.0, 1e30])
    with pytest.raises(CaseError, match="too far for a picture"):
        draw_silhouette(far, np.ones(2), np.ones(2), 0.1)
