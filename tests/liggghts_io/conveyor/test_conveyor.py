"""The conveyor: what may be off in it acts, residents are poured first, a slice is periodic."""

from __future__ import annotations

import math
import re
import shutil
import subprocess

import numpy as np
import pytest

from liggghts_io import CaseError, Particle, execute, write_case
from liggghts_io.case.spec import build_case, script_of, setup_of
from liggghts_io.errors import DamagedFile
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.conveyor import arrivals, curve, falls, gravity, head_start
from liggghts_io.measure.counts import Count, read_count
from liggghts_io.measure.dumps import frame_paths, read_frame
from tests.liggghts_io.conftest import SMALL, TIMED

NEUTRAL = {
    "tilt_deg": 0.0, "cross_tilt_deg": 0.0, "pour_offset_m": 0.0, "mass_flow_factor": 1.0,
    "amplitude_factor": 1.0, "period_factor": 1.0, "pour_speed_m_s": 0.1,
}  # fmt: skip
RESIDENTS = {"resident_mass_kg": 0.1, "resident_duration_s": 45.0}


def variables(make_spec, surface="steel", **apparatus):
    return build_case(make_spec("conveyor", surface=surface, apparatus=apparatus)).variables


@pytest.mark.parametrize("scale", ["quick", "lab", "paper"])
def test_deviations_are_none_by_default(make_spec, scale):
    plain = make_spec("conveyor", scale=scale)
    assert EXPERIMENTS["conveyor"].apparatus(scale, {}).items() >= NEUTRAL.items()
    assert script_of(make_spec("conveyor", scale=scale, apparatus=NEUTRAL)) == script_of(plain)


def test_finer_grains_need_no_wider_slice_than_coarse_ones(make_spec):
    """At lab it is 6.5 diameters wide, or 10 mm; the funnel's flow shrinks with it."""
    for d, wide in ((1.6e-3, 0.01), (0.6e-3, 6.5 * 0.6e-3)):
        grain = Particle("a", d, 3560.0, flow_flat_kg_s=0.02)
        found = build_case(make_spec("conveyor", scale="lab", particle=grain))
        low, high = found.variables["slice"]
        assert high - low == pytest.approx(wide)
        assert found.variables["grain_rate"] * grain.mass_kg == pytest.approx(0.02 * wide / 0.08)


def test_a_tilt_along_and_across_leans_gravity_and_keeps_its_size():
    for along, across in ((3.0, 0.0), (0.0, -2.0), (4.0, 5.0)):
        found = gravity({"tilt_deg": along, "cross_tilt_deg": across})
        assert math.hypot(*found) == pytest.approx(1.0)
        assert found[0] == pytest.approx(math.sin(math.radians(along)))
        assert found[1] / -found[2] == pytest.approx(math.tan(math.radians(across)))


def test_an_effect_tilts_on_from_the_tilt_of_the_apparatus(make_spec):
    both = make_spec("conveyor", apparatus={"tilt_deg": 2.0}, effects={"plate_tilt_deg": 1.5})
    whole = make_spec("conveyor", apparatus={"tilt_deg": 3.5})
    gravities = [build_case(spec).variables["gravity"] for spec in (both, whole)]
    assert gravities[0] == pytest.approx(gravities[1])


def test_each_deviation_changes_its_variables_and_no_other(make_spec):
    plain = variables(make_spec)
    acts = {
        "tilt_deg": (1.0, {"gravity"}),
        "cross_tilt_deg": (1.0, {"gravity"}),
        "pour_offset_m": (0.01, {"pour_position", "spout"}),
        "mass_flow_factor": (1.1, {"grain_rate"}),
        "amplitude_factor": (1.1, {"amplitudes", "domain"}),
        "period_factor": (1.1, {"periods"}),
        "pour_speed_m_s": (0.2, {"pour_speed", "duration"}),
    }
    assert acts.keys() == NEUTRAL.keys()
    for name, (value, changed) in acts.items():
        found = variables(make_spec, **{name: value})
        assert {key for key in found if found[key] != plain[key]} == changed, name
    late = variables(make_spec, period_factor=1.1)
    assert late["periods"] == pytest.approx([1.1 * one for one in plain["periods"]])
    wide = variables(make_spec, amplitude_factor=1.1)
    assert wide["amplitudes"] == pytest.approx([1.1 * one for one in plain["amplitudes"]])
    moved = variables(make_spec, pour_offset_m=0.01, length_fraction=0.5)
    still = variables(make_spec, length_fraction=0.5)
    assert moved["spout"][0] - still["spout"][0] == pytest.approx(0.005)


@pytest.mark.parametrize(
    ("offset", "words"), [(-0.07, "in front of the back stop"), (0.4, "must lie on the plate")]
)
def test_a_funnel_beside_the_plate_is_refused(make_spec, offset, words):
    with pytest.raises(CaseError, match=words):
        script_of(make_spec("conveyor", apparatus={"pour_offset_m": offset}))


def counted(times):
    """Return grains of 10 mg that fell through the scale at these times."""
    nowhere = np.zeros((len(times), 3))
    return Count(np.arange(len(times)), times, np.full(len(times), 1e-5), nowhere, nowhere)


def test_the_curve_is_averaged_over_the_period_that_the_plate_has(make_spec):
    """Grains of one stroke come at once: only an average over its period makes a straight line."""
    stroke = 0.08 * 1.25
    times = np.repeat(0.2 + stroke * np.arange(20), 30)
    count = counted(times)
    for factor, straight in ((1.25, True), (1.0, False)):
        setup = setup_of(make_spec("conveyor", apparatus={"period_factor": factor}))
        line = curve(count, setup)
        inner = (line.mass_kg > 0.2 * line.mass_kg[-1]) & (line.mass_kg < 0.8 * line.mass_kg[-1])
        fit = np.polyfit(line.time_s[inner], line.mass_kg[inner], 1)
        off = np.abs(line.mass_kg[inner] - np.polyval(fit, line.time_s[inner])).max()
        assert (off < 1e-3 * line.mass_kg[-1]) == straight


def test_residents_are_poured_first_on_a_glued_plate_only(make_spec):
    glued = make_spec("conveyor", surface="glued", apparatus=RESIDENTS)
    pours = re.findall(r"^fix (\w+) all insert.* seed (\d+) .* nparticles (\d+) .* start (\d+)",
                       script_of(glued), re.M)  # fmt: skip
    assert [name for name, *_ in pours] == ["before", "pour1"]
    assert len({seed for _, seed, *_ in pours}) == 2
    assert int(pours[0][2]) == round(int(pours[1][2]) / 3.0)  # 100 g before 300 g
    build, setup = build_case(glued), setup_of(glued)
    begin = head_start(setup)
    assert int(pours[1][3]) == round(begin / build.variables["dt"])
    assert begin >= 4.5  # 45 s at a tenth of the length, in whole periods
    assert begin / 0.08 == pytest.approx(round(begin / 0.08))
    assert build.variables["duration"] == pytest.approx(begin + 2.4 + falls(setup))
    steel = make_spec("conveyor", apparatus=RESIDENTS)
    assert head_start(setup_of(steel)) == 0.0
    assert script_of(steel) == script_of(make_spec("conveyor"))


def test_the_clock_starts_with_the_measured_pour(make_spec):
    """The same grains, that much later: one curve."""
    bare = setup_of(make_spec("conveyor", surface="glued"))
    full = setup_of(make_spec("conveyor", surface="glued", apparatus=RESIDENTS))
    times = np.arange(0.3, 2.4, 0.01)
    plain = curve(counted(times), bare)
    found = curve(counted(times + head_start(full)), full)
    assert found.time_s == pytest.approx(plain.time_s)
    assert found.mass_kg == pytest.approx(plain.mass_kg)


def test_a_grain_may_have_the_id_of_one_that_was_lost_before_the_test(tmp_path):
    """As LIGGGHTS gives them: grain 159 of the first pour fell off, and the next one was 159."""
    path = tmp_path / "scale.txt"
    row = "159  {} 0.001595 0.04 0 -0.0032 0 0 -0.3\n"
    path.write_text("# ID\n" + row.format(1.817) + row.format(5.789))
    assert read_count(path, 1000.0, since=4.5).time_s.tolist() == [5.789]
    for since in (0.0, 1.0):
        with pytest.raises(DamagedFile, match=r"scale.txt:3: .* each grain once"):
            read_count(path, 1000.0, since=since)


def test_a_periodic_slice_has_no_side_walls_and_fills_its_box(make_spec):
    spec = make_spec("conveyor", apparatus={"periodic_slice": 1.0})
    script, build = script_of(spec), build_case(spec)
    assert "boundary f p f" in script
    assert "yplane" not in script
    low, high = build.variables["slice"]
    assert build.variables["domain"][2:4] == (low, high)
    for mesh in build.meshes.values():
        assert (mesh[:, :, 1].min(), mesh[:, :, 1].max()) == (low, high)
        longest = np.ptp(mesh[:, :, 0], axis=1).max()
        assert longest <= (high - low) * (1.0 + 1e-12)  # LIGGGHTS loses longer ones
        area = 0.5 * np.linalg.norm(np.cross(mesh[:, 1] - mesh[:, 0], mesh[:, 2] - mesh[:, 0]))
        assert area > 0.0
    walls = build_case(make_spec("conveyor"))
    for name, mesh in build.meshes.items():
        assert np.ptp(mesh[:, :, 0]) == pytest.approx(np.ptp(walls.meshes[name][:, :, 0]))


@pytest.mark.liggghts
@pytest.mark.parametrize("scale", ["quick", "lab", "paper"])
@pytest.mark.parametrize("periodic", [0.0, 1.0])
def test_liggghts_takes_residents_and_periodic_slices(make_spec, tmp_path, scale, periodic):
    """A few steps with grains from both pours, each with a tilt across."""
    apparatus = RESIDENTS | {
        "periodic_slice": periodic, "cross_tilt_deg": 1.0, "resident_duration_s": 0.1
    }  # fmt: skip
    spec = make_spec("conveyor", surface="glued", scale=scale, apparatus=apparatus)
    write_case(spec, tmp_path)
    script = tmp_path / "in.script"
    steps = round(head_start(setup_of(spec)) / build_case(spec).variables["dt"]) + 400
    script.write_text(re.sub(r"^run \d+", f"run {steps}", script.read_text(), flags=re.M))
    program = shutil.which("liggghts")
    assert program, "LIGGGHTS is required here (BULKCAL_REQUIRE_LIGGGHTS=1) but not installed"
    done = subprocess.run(
        ["stdbuf", "-oL", program, "-in", "in.script"],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    assert "ERROR" not in done.stdout, done.stdout[-2000:]
    assert done.returncode == 0


@pytest.fixture(scope="module")
def timed_runs(tmp_path_factory):
    """Return the time of a short conveyor, by what deviates."""
    return tmp_path_factory.mktemp("conveyor"), {}


@pytest.mark.parametrize(
    ("name", "value", "faster"),
    [
        ("tilt_deg", 6.0, True), ("tilt_deg", -4.0, False),
        ("pour_offset_m", 0.03, True), ("pour_offset_m", -0.06, False),
        ("mass_flow_factor", 1.3, True), ("amplitude_factor", 1.7, True),
        ("amplitude_factor", 0.6, False),
        ("period_factor", 1.5, False),
    ],
)  # fmt: skip
def test_each_deviation_moves_the_time_where_it_has_to(make_spec, timed_runs, name, value, faster):
    """By more than a seed does: a tenth of a second for this small plate.

    An amplitude of 1.3 took 0.15 s off the mean of nine seeds, and of 1.7 0.34 s.
    """
    folder, known = timed_runs
    for key, change in (("plain", {}), (name, {name: value})):
        if key == name or key not in known:
            result = execute(make_spec("conveyor", apparatus=TIMED | change), folder)
            assert result.status == "ok", result.reason
            known[key] = result.observables["t100_s"]
    change = known[name] - known["plain"]
    assert change < -0.1 if faster else change > 0.1


def test_grains_drift_to_the_low_side_of_a_plate(make_spec, tmp_path):
    spec = make_spec("conveyor", apparatus=SMALL["conveyor"] | {"cross_tilt_deg": 8.0})
    result = execute(spec, tmp_path)
    frame = read_frame(frame_paths(result.path / "output")[-1])
    assert frame.positions[:, 1].mean() > 0.0


@pytest.mark.slow
def test_residents_stay_and_shorten_the_time(make_spec, tmp_path):
    """A layer that is there needs no grains of the test: t100 falls by seconds."""
    small = {"width_fraction": 0.09, "poured_mass_kg": 0.2, "target_mass_kg": 0.05,
             "duration_glued_s": 20.0}  # fmt: skip
    times = []
    for more in ({}, {"resident_mass_kg": 0.1, "resident_duration_s": 30.0}):
        spec = make_spec("conveyor", surface="glued", apparatus=small | more)
        result = execute(spec, tmp_path)
        assert result.status == "ok", result.reason
        times.append(result.observables["t100_s"])
        first = arrivals(result.path / "output", setup_of(spec))
        assert first.mass_kg[0] < 0.02
    assert times[1] < times[0] - 1.5
