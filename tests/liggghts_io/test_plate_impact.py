"""Plate impact: every grain has one fate, landings tell what other boxes would hold, nuisances."""

import numpy as np
import pytest

from liggghts_io import CaseError, execute, read_curve
from liggghts_io.case.spec import build_case, setup_of
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.common import leaning
from liggghts_io.experiments.plate_impact import masses_with
from liggghts_io.experiments.plate_impact.observing import fate_of, landings
from liggghts_io.measure.counts import Count, read_count
from liggghts_io.measure.dumps import all_frames, read_frame
from liggghts_io.measure.landings import Opening, landing_x, masses_in
from liggghts_io.measure.schedule import load_of
from tests.liggghts_io.conftest import ONE_DIAMETER

SMALL = {"mass_fraction": 0.05}
IMPACT = EXPERIMENTS["plate_impact"]
WALLS = IMPACT.apparatus("quick", {})
HEIGHT = 0.003


@pytest.fixture
def make_spec(make_spec):
    """Make a spec with grains of one diameter: what is told here is told for them."""

    def make(*words, **changes):
        return make_spec(*words, **({"particle": ONE_DIAMETER} | changes))

    return make


@pytest.fixture
def impact(make_spec, tmp_path):
    """Run a plate impact of some 450 grains into boxes with rims; return result, output, setup."""

    def run(**apparatus):
        spec = make_spec("plate_impact", apparatus=SMALL | {"box_rims": 1.0} | apparatus)
        result = execute(spec, tmp_path)
        assert result.status == "ok", result.reason
        return result, result.path / "output", setup_of(spec)

    return run


def test_every_grain_is_in_one_place(make_spec, tmp_path):
    """By hand: grain 1 in box 1 and still falling below its mouth, 2 in box 4, 3 lost, 4 in air."""
    setup = setup_of(make_spec("plate_impact", apparatus={"box_rims": 1.0}))
    d = setup.particle.d32_m

    def count(name, *grains):
        rows = [f"{one} 0.1 {d:.9g} 0 0 {HEIGHT} 0 0 -1\n" for one in grains]
        (tmp_path / f"{name}.txt").write_text("# ID\n" + "".join(rows))

    count("poured", 1, 2, 3, 4)
    count("landing", 1, 2, 3)
    for box, grains in ((1, [1]), (2, []), (3, []), (4, [2])):
        count(f"box{box}", *grains)
    (tmp_path / "in.script").write_text(
        "fix pour all insert/rate/region nparticles 5\n"
        "dump frames all custom 1 post/frame_*.dump id type x y z vx vy vz radius\nrun 0\n"
    )
    (tmp_path / "post").mkdir()
    rows = "".join(f"{one} 1 0 0 0.1 0 0 -1 {d / 2:.9g}\n" for one in (1, 4, 5))
    (tmp_path / "post" / "frame_0.dump").write_text(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
        f"ITEM: ATOMS id type x y z vx vy vz radius \n{rows}"
    )
    assert fate_of(tmp_path, setup).counted() == {
        "poured": 5, "box_1": 1, "box_2": 0, "box_3": 0, "box_4": 1, "beside": 1, "in_air": 2,
    }  # fmt: skip
    found = IMPACT.observe(tmp_path, setup)
    assert found.values["m1_g"] == pytest.approx(68.73 / 5)
    assert found.values["beside_g"] == pytest.approx(68.73 / 5)
    assert found.tables["balance.csv"]["in_air"].tolist() == [2.0]
    script = (tmp_path / "in.script").read_text()
    (tmp_path / "in.script").write_text(script.replace("nparticles 5", "nparticles 6"))
    with pytest.raises(CaseError, match=r"5 of 6 grains were poured: .* raise pour_depth_m"):
        IMPACT.observe(tmp_path, setup)


@pytest.mark.parametrize("flight_s", [0.05, 0.1, 0.35])
def test_grains_in_boxes_beside_and_in_the_air_are_those_poured(impact, flight_s):
    """To the last grain, also where the run ends with grains in the boxes, beside and in the air.

    Three countings that know nothing of each other: what the script asked for, the grains that
    crossed the planes, those left at the end.
    """
    result, folder, setup = impact(flight_s=flight_s)
    fate = fate_of(folder, setup)
    counted = fate.counted()
    asked = load_of((result.path / "in.script").read_text()).grains
    assert counted["poured"] == asked
    assert sum(counted.values()) == 2 * counted["poured"]
    left = set(read_frame(all_frames(folder)[-1]).columns["id"].astype(int).tolist())
    boxes = [set(read_count(folder / f"box{box}.txt", 1.0).grain.tolist()) for box in (1, 2, 3, 4)]
    assert [counted[f"box_{box}"] for box in (1, 2, 3, 4)] == [len(one) for one in boxes]
    assert counted["in_air"] == len(left - set().union(*boxes))
    landed = set(landings(folder, setup).grain.tolist())
    assert set().union(*boxes) <= landed
    # Who neither landed nor flies has left through a side of the domain, and is beside.
    beside = set(fate.grain[fate.box == 0].tolist())
    assert landed - set().union(*boxes) - left <= beside
    grams = 68.73 * (1.0 - counted["in_air"] / counted["poured"])
    assert sum(result.observables.values()) == pytest.approx(grams)


def test_landings_tell_what_the_boxes_hold(impact):
    """Box positions are post-processing: only what bounces off a rim differs."""
    result, folder, setup = impact(mass_fraction=0.1)
    measured = [result.observables[f"m{box}_g"] for box in (1, 2, 3, 4)]
    boxes = [
        Opening(WALLS[f"box_{box}_near_m"], WALLS[f"box_{box}_far_m"], WALLS["box_width_m"])
        for box in (1, 2, 3, 4)
    ]
    found = masses_with(folder, setup, boxes)
    # What differs bounced off a rim: grains that came down within a diameter of one.
    x, y = landing_x(landings(folder, setup), 0.0)
    d = setup.particle.d32_m
    walls = np.array([wall for box in boxes for wall in (box.near_m, box.far_m)])
    at_a_rim = (np.abs(x[:, None] - walls) < d).any(axis=1) | (np.abs(np.abs(y) - 0.03) < d)
    grain_g = 68.73 / len(fate_of(folder, setup).grain)
    assert np.abs(np.subtract(found, measured)).sum() <= 2.0 * grain_g * at_a_rim.sum()
    assert found == pytest.approx(measured, abs=2.0)
    curve = read_curve(result, IMPACT.curves[0])
    levels = list(IMPACT.curves[0].levels)
    assert (np.diff(curve) >= 0.0).all()
    wide = Opening(0.040, 0.120, WALLS["box_width_m"])
    assert curve[levels.index(120.0)] - curve[levels.index(40.0)] == pytest.approx(
        masses_with(folder, setup, [wide])[0], rel=1e-5
    )


def test_shifted_boxes_in_a_run_and_in_post_processing_agree(impact):
    """The boxes stand elsewhere, the grains fly as before."""
    base, folder, setup = impact()
    shifted, _, _ = impact(box_shift_x_m=0.004)
    openings = [
        Opening(
            WALLS[f"box_{box}_near_m"] + 0.004, WALLS[f"box_{box}_far_m"] + 0.004,
            WALLS["box_width_m"],
        )
        for box in (1, 2, 3, 4)
    ]  # fmt: skip
    expected = masses_with(folder, setup, openings)
    found = [shifted.observables[f"m{box}_g"] for box in (1, 2, 3, 4)]
    # A grain is 0.15 g of the full apparatus; rims of 450 grains as above.
    assert found == pytest.approx(expected, abs=2.5)
    assert max(abs(one - base.observables[f"m{k}_g"]) for k, one in enumerate(found, 1)) > 1.0


def test_boxes_without_rims_hold_what_lands_in_them(impact):
    """The same flights; the masses are those of the landings, and every grain is somewhere."""
    result, folder, setup = impact(box_rims=0.0)
    boxes = [
        Opening(WALLS[f"box_{box}_near_m"], WALLS[f"box_{box}_far_m"], WALLS["box_width_m"])
        for box in (1, 2, 3, 4)
    ]
    found = [result.observables[f"m{box}_g"] for box in (1, 2, 3, 4)]
    assert found == pytest.approx(masses_with(folder, setup, boxes))
    counted = fate_of(folder, setup).counted()
    assert sum(counted.values()) == 2 * counted["poured"]
    down = landings(folder, setup)
    landed = set(down.grain.tolist())
    in_air = set(fate_of(folder, setup).grain[fate_of(folder, setup).box == -1].tolist())
    left = set(read_frame(all_frames(folder)[-1]).columns["id"].astype(int).tolist())
    assert in_air == left - landed


def test_landings_follow_a_parabola():
    """A grain that was thrown from (0, 0, 0.1) with 1 m/s along x, counted at 3 mm."""
    time = np.sqrt(2.0 * (0.1 - HEIGHT) / 9.81)
    count = Count(
        np.array([1]), np.array([time]), np.array([2.0]),
        np.array([[time, 0.0, HEIGHT]]), np.array([[1.0, 0.0, -9.81 * time]]),
    )  # fmt: skip
    for height in (-0.5, 0.0, HEIGHT, 0.05, 0.099):
        x, y = landing_x(count, height)
        assert x[0] == pytest.approx(np.sqrt(2.0 * (0.1 - height) / 9.81))
        assert y[0] == 0.0
    assert np.isnan(landing_x(count, 0.11)[0][0])
    near, far = Opening(0.10, 0.12, 0.06, 0.05), Opening(0.13, 0.15, 0.06, 0.0)
    assert masses_in(count, [near, far, Opening(0.10, 0.12, 0.06, 0.0)]) == [2.0, 2.0, 0.0]


def test_nuisances_are_zero_unless_said_and_move_what_they_name(make_spec):
    def variables(**apparatus):
        return build_case(make_spec("plate_impact", apparatus=apparatus))

    base = variables()
    zeros = ("tilt_x_deg", "tilt_y_deg", "pour_offset_x_m", "pour_offset_y_m",
             "plate_angle_error_deg", "box_shift_x_m", "box_shift_z_m")  # fmt: skip
    assert all(WALLS[name] == 0.0 for name in zeros)
    assert variables(pour_offset_x_m=0.002).variables["spout_axis"] == (0.002, 0.0)
    steep = variables(plate_angle_error_deg=3.0).meshes["plate"][0]
    rise = (steep[0] - steep[1])[[0, 2]]
    assert np.degrees(np.arctan2(rise[1], -rise[0])) == pytest.approx(48.0)
    assert np.linalg.norm(rise) == pytest.approx(WALLS["plate_up_m"] + WALLS["plate_down_m"])
    moved = variables(box_shift_x_m=0.003, box_shift_z_m=0.002)
    shift = moved.meshes["boxes"] - base.meshes["boxes"]
    assert shift == pytest.approx(np.broadcast_to([0.003, 0.0, 0.002], shift.shape))
    for name in ("mouth1", "mouth4", "boxes"):
        assert moved.meshes[name][..., 2].max() == pytest.approx(
            base.meshes[name][..., 2].max() + 0.002
        )
    assert variables(tilt_x_deg=1.0).variables["gravity"] == pytest.approx(leaning(1.0, 0.0))


def test_an_apparatus_that_leans_has_its_low_side_there():
    assert leaning(0.0, 0.0) == (0.0, 0.0, -1.0)
    assert leaning(2.0, 0.0) == pytest.approx((0.0348995, 0.0, -0.9993908), abs=1e-7)
    x, y, z = leaning(3.0, -4.0)
    assert np.degrees(np.arctan2(x, -z)) == pytest.approx(3.0)
    assert np.degrees(np.arctan2(y, -z)) == pytest.approx(-4.0)
    assert np.hypot(np.hypot(x, y), z) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"pour_offset_x_m": 0.005}, "funnel outlet reaches 0.00875 m .* inside the wall"),
        ({"box_shift_z_m": 0.05, "plate_down_m": 0.02}, "lower edge of the plate, 0.04586 m"),
        ({"plate_angle_error_deg": 30.0}, "give a number from -20 to 20"),
    ],
)
def test_parts_that_do_not_fit_are_refused(make_spec, changes, words):
    with pytest.raises(CaseError, match=words):
        build_case(make_spec("plate_impact", apparatus=changes))
