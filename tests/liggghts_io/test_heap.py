"""The heap as photographed: a free cone, at rest, seen from several sides; and its nuisances."""

import math
import shutil
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from liggghts_io import CaseError, CaseSpec, execute
from liggghts_io.case.liggghts import find_liggghts
from liggghts_io.case.output import check_complete
from liggghts_io.case.spec import build_case, case_id, script_of, setup_of
from liggghts_io.errors import DamagedFile
from liggghts_io.experiments.heap.observing import (
    azimuths,
    mean_of_flanks,
    measure,
    motion,
)
from liggghts_io.measure.dumps import Frame, all_frames, read_frame
from liggghts_io.measure.schedule import load_of, schedule_of
from tests.liggghts_io.conftest import ONE_DIAMETER, PARAMETERS

SMALL = {
    "side_walls": 0.0, "cone_mass_kg": 0.003, "outlet_height_m": 0.035, "frames": 5.0,
    "plate_half_length_m": 0.03,
}  # fmt: skip
CONE = CaseSpec(
    "heap", ONE_DIAMETER, "glued", "quick",
    PARAMETERS | {"mu_pp": 0.8, "mu_roll_pp": 0.4}, SMALL,
)  # fmt: skip
SETUP = setup_of(CONE)
# A grain is drawn with 16 pixels: an edge that moves by half a pixel on a flank of 10 diameters.
DRAWN_DEG = 0.3


def stacked(angle_deg=33.0, radius_d=18.0, seed=5):
    """Grains at random in a cone, as a dump gives them; three to a cube of a diameter."""
    rng, d = np.random.default_rng(seed), SETUP.particle.d32_m
    slope = math.tan(math.radians(angle_deg))
    count = int(3.0 * (2.0 * radius_d) ** 2 * radius_d * slope)
    x, y = rng.uniform(-radius_d, radius_d, (2, count))
    z = rng.uniform(0.0, radius_d * slope, count)
    inside = z < (radius_d - np.hypot(x, y)) * slope
    still = np.zeros(inside.sum())
    places = {"x": x[inside] * d, "y": y[inside] * d, "z": z[inside] * d}
    speeds = {"vx": still, "vy": still, "vz": still}
    radius = np.full_like(still, d / 2)
    return Frame(0, {"id": np.arange(len(still)) + 1.0, **places, **speeds, "radius": radius})


HEAP = stacked()


def turned(frame, by_deg):
    """Return the grains turned about the vertical, counterclockwise from above."""
    turn = math.radians(by_deg)
    x, y = frame.columns["x"], frame.columns["y"]
    across = x * math.cos(turn) - y * math.sin(turn)
    return replace(
        frame,
        columns=frame.columns | {"x": across, "y": x * math.sin(turn) + y * math.cos(turn)},
    )


def seen(frame, setup=SETUP):
    return [measure(frame, setup, one) for one in azimuths(setup)]


def run_small(tmp_path, **changes):
    """Run the small cone; return its result and the folder of its output."""
    result = execute(replace(CONE, apparatus=SMALL | changes), tmp_path)
    return result, result.path / "output"


def test_a_cone_of_known_angle_is_measured_from_all_sides():
    angle, error = mean_of_flanks(seen(HEAP))
    assert angle == pytest.approx(33.0, abs=1.0)  # the outline lies half a grain outside
    assert 0.0 < error < 0.5


@given(turn=st.floats(-360.0, 360.0), azimuth=st.floats(0.0, 180.0))
@settings(max_examples=12, deadline=None)
def test_a_heap_and_its_camera_turned_together_give_the_same(turn, azimuth):
    one, other = measure(HEAP, SETUP, azimuth), measure(turned(HEAP, turn), SETUP, azimuth + turn)
    assert other.left_deg == pytest.approx(one.left_deg, abs=DRAWN_DEG)
    assert other.right_deg == pytest.approx(one.right_deg, abs=DRAWN_DEG)


@given(turn=st.floats(-180.0, 180.0))
@settings(max_examples=8, deadline=None)
def test_the_mean_all_round_does_not_depend_on_where_the_first_view_is(turn):
    (one, error), (other, _) = mean_of_flanks(seen(HEAP)), mean_of_flanks(seen(turned(HEAP, turn)))
    assert abs(one - other) < 4.0 * error


@given(azimuth=st.floats(0.0, 180.0))
@settings(max_examples=8, deadline=None)
def test_mirror_images_have_the_same_flanks(azimuth):
    mirror = replace(HEAP, columns=HEAP.columns | {"y": -HEAP.columns["y"]})
    one, other = measure(HEAP, SETUP, azimuth), measure(mirror, SETUP, -azimuth)
    assert other.left_deg == pytest.approx(one.left_deg, abs=DRAWN_DEG)
    behind = measure(HEAP, SETUP, azimuth + 180.0)
    assert behind.right_deg == pytest.approx(one.left_deg, abs=DRAWN_DEG)
    assert behind.angle_deg == pytest.approx(one.angle_deg, abs=DRAWN_DEG)


@pytest.fixture
def make_spec(make_spec):
    """Make a spec with grains of one diameter: what is told here is told for them."""

    def make(*words, **changes):
        return make_spec(*words, **({"particle": ONE_DIAMETER} | changes))

    return make


def test_the_paper_scale_is_the_cone_and_the_small_ones_are_slices(make_spec):
    for scale, walls in (("quick", 1), ("lab", 1), ("paper", 0)):
        script = script_of(make_spec(scale=scale))
        assert script.count("yplane") == 2 * walls
        assert ("cylinder z 0 0 0.00375" in script) == (not walls)


def test_a_cone_comes_to_rest_and_its_frames_follow_from_its_end(tmp_path):
    result, folder = run_small(tmp_path)
    assert result.status == "ok", result.reason
    assert 5.0 < result.observables["angle_deg"] < 45.0
    paths = all_frames(folder)
    last = read_frame(paths[-1])
    assert motion(last, SETUP) < SETUP.apparatus["rest_energy"]
    assert motion(read_frame(paths[-2]), SETUP) > SETUP.apparatus["rest_energy"]
    views = pd.read_csv(result.path / "views.csv")
    flanks = views[["left_deg", "right_deg"]].to_numpy()
    assert len(views) == 6
    assert flanks.mean() == pytest.approx(result.observables["angle_deg"], abs=1e-4)
    mass = last.count * SETUP.particle.mass_kg  # to the last grain: none left the plate
    assert mass == pytest.approx(SETUP.apparatus["cone_mass_kg"], abs=SETUP.particle.mass_kg)


def test_a_frame_that_is_lost_or_too_much_is_found_where_only_the_run_knows_its_end(tmp_path):
    result, folder = run_small(tmp_path)
    steps = sorted(int(path.stem.partition("_")[2]) for path in (folder / "post").iterdir())
    every, last = steps[1], steps[-1]
    assert check_complete(folder, result.case_id) == last
    for step, message in (
        (last, f"frame_{last}.dump: missing; the run has {len(steps)} frames from step 0"),
        (every, f"frame_{every}.dump: missing"),
    ):
        kept = tmp_path / "kept"
        shutil.move(folder / "post" / f"frame_{step}.dump", kept)
        with pytest.raises(DamagedFile, match=message):
            check_complete(folder, result.case_id)
        shutil.move(kept, folder / "post" / f"frame_{step}.dump")
    shutil.copy(folder / "post" / f"frame_{last}.dump", folder / f"post/frame_{last + every}.dump")
    with pytest.raises(DamagedFile, match=f"frame_{last + every}.dump: no frame of this run"):
        check_complete(folder, result.case_id)


def test_a_heap_that_moves_still_is_a_reason_not_an_angle(tmp_path):
    result, _ = run_small(tmp_path, rest_limit_tau=2.0)
    assert result.status == "failed"
    assert "the heap moves still 2 falls over a diameter after the pour" in result.reason
    assert "at rest below 1e-05" in result.reason


@pytest.mark.skipif(find_liggghts() is None, reason="needs LIGGGHTS")
def test_both_engines_end_at_rest(tmp_path):
    result = execute(replace(CONE, engine="liggghts"), tmp_path)
    assert result.status == "ok", result.reason
    assert motion(read_frame(all_frames(result.path / "output")[-1]), SETUP) < 1e-5


def test_a_loop_that_may_end_early_tells_the_most_steps_and_how_frames_follow():
    script = script_of(CONE)
    found = schedule_of(script)
    assert found.steps is None
    every, pour = found.dumps[0].every, int(script.partition("\nrun ")[2].split()[0])
    turns = int(script.partition("piece loop ")[2].split()[0])
    assert found.most == load_of(script).steps == pour + turns * every
    assert found.dumps[0].due(pour + every) == tuple(range(0, pour + every + 1, every))


@pytest.mark.parametrize(
    ("text", "most"),
    [
        ("variable a loop 4\nlabel l\nrun 10\nnext a\njump SELF l\nrun 5", 45),
        ("variable a loop 4\nlabel l\nrun 10\njump SELF l", None),
        ("label l\nrun 10\nnext a\njump SELF l", None),
        ("variable a loop 4\nlabel l\nrun 10\nnext a\njump other.in l", None),
        ('run 10\nif "${x} > 1" then "jump SELF end"\nrun 10\nlabel end', 20),
        ('label l\nrun 10\nif "${x} > 1" then "jump SELF l"', None),
        ('run 10\nif "${x} > 1" then "run 10"', None),
        ('run 10\nif "${x} > 1" then "print here"', 10),
        ("run 10\nreset_timestep 0\nrun 10", None),
    ],
)
def test_what_loops_tell_of_the_most_steps(text, most):
    found = schedule_of(f"dump d all custom 5 p/a_*.d id\n{text}")
    assert found.most == most
    assert found.steps == (most if "jump" not in text else None)
    after = found.dumps[0].due(12)
    assert after == (None if "reset" in text else found.dumps[0].frames or (0, 5, 10))


def test_nuisances_of_zero_change_nothing(make_spec):
    zero = dict.fromkeys(
        ("tilt_x_deg", "tilt_y_deg", "pour_offset_x_d", "pour_offset_y_d", "pour_speed_error_m_s"),
        0.0,
    )
    for scale in ("quick", "paper"):
        spec = make_spec(scale=scale)
        assert script_of(replace(spec, apparatus=zero)) == script_of(spec)
        for name in zero.keys() - ({"pour_offset_y_d"} if scale == "quick" else set()):
            other = replace(spec, apparatus={name: 0.4})
            assert script_of(other) != script_of(spec), name
            assert case_id(other) != case_id(spec), name


@pytest.mark.parametrize("scale", ["quick", "paper"])
def test_a_tilt_turns_gravity_towards_the_lower_side(make_spec, scale):
    both = {"tilt_x_deg": 3.0, "tilt_y_deg": -2.0}
    down = np.array(build_case(make_spec(scale=scale, apparatus=both)).variables["gravity"])
    assert np.linalg.norm(down) == pytest.approx(1.0)
    slopes = np.degrees(np.arctan2(down[:2], -down[2]))
    assert slopes == pytest.approx([3.0, -2.0])


def test_on_a_tilted_plate_the_downhill_flank_is_the_flat_one(tmp_path):
    result, _ = run_small(tmp_path, tilt_x_deg=8.0)
    views = pd.read_csv(result.path / "views.csv").set_index("azimuth_deg")
    along, across = views.loc[0.0], views.loc[90.0]
    assert along["left_deg"] - along["right_deg"] > 8.0  # twice the tilt, less what slid
    assert abs(across["left_deg"] - across["right_deg"]) < 6.0  # scatter of two single flanks


REFUSED = {
    "off the plate": ({"side_walls": 0.0, "pour_offset_x_d": 40.0}, "pour_offset_x_d = 40 shifts"),
    "into a wall": ({"pour_offset_y_d": 1.0}, "pour_offset_y_d = 1 shifts the pour"),
    "upwards": ({"pour_speed_error_m_s": -0.1}, "pour_speed_error_m_s = -0.1 turns the speed"),
    "outlet too low": ({"side_walls": 0.0, "outlet_height_m": 0.03}, "raise the outlet or pour"),
    "too much": ({"side_walls": 0.0, "cone_mass_kg": 1.0}, "outlet_height_m = 0.06: the stream"),
    "outlet too narrow": ({"side_walls": 0.0, "outlet_m": 0.004}, "outlet_m = 0.004 is less than"),
}


@pytest.mark.parametrize(("override", "message"), REFUSED.values(), ids=REFUSED)
def test_a_pour_that_misses_is_refused_with_the_number(make_spec, override, message):
    with pytest.raises(CaseError, match=message):
        script_of(make_spec(apparatus=override))


def test_the_flow_is_that_of_the_particle_or_is_asked_for(make_spec):
    paper = make_spec(scale="paper")
    grain = paper.particle
    for surface, flow in (("steel", grain.flow_flat_kg_s), ("glued", grain.flow_glued_kg_s)):
        rate = build_case(replace(paper, surface=surface)).variables["grain_rate"]
        assert rate == pytest.approx(flow / grain.mass_kg)
    unknown = replace(paper, particle=replace(grain, flow_flat_kg_s=None))
    with pytest.raises(CaseError, match="give pour_flow_kg_s of the apparatus, or measure"):
        script_of(unknown)
    given_here = replace(unknown, apparatus={"pour_flow_kg_s": 0.02})
    rate = build_case(given_here).variables["grain_rate"]
    assert rate == pytest.approx(0.02 / grain.mass_kg)


def test_the_early_frames_of_a_slice_are_not_measured(make_spec):
    slice_ = setup_of(make_spec())
    assert azimuths(slice_) == [0.0]
    assert azimuths(SETUP) == [0.0, 30.0, 60.0, 90.0, 120.0, 150.0]
