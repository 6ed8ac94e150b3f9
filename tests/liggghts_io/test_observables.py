"""Observables on files made by hand."""

import numpy as np
import pytest

from liggghts_io import CaseError
from liggghts_io.case.spec import setup_of
from liggghts_io.errors import DamagedFile
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.conveyor import falls
from liggghts_io.experiments.heap.observing import measured_frames
from liggghts_io.measure.counts import read_count
from liggghts_io.measure.dumps import all_frames, frame_paths, read_frame
from liggghts_io.measure.mass_time import mass_time, time_to_reach

HEAD = "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{n}\nITEM: BOX BOUNDS ff ff ff\n"
BOX = "0 1\n0 1\n0 1\nITEM: ATOMS id type x y z vx vy vz radius \n"


def write_script(folder, last, every=1):
    """Write the part of a script that says which frames there must be."""
    columns = "id type x y z vx vy vz radius"
    text = f"dump frames all custom {every} post/frame_*.dump {columns}\nrun {last}\n"
    (folder / "in.script").write_text(text)


def write_dump(path, rows, step=0):
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = "".join(" ".join(f"{v:.8g}" for v in row) + " \n" for row in rows)
    path.write_text(HEAD.format(step=step, n=len(rows)) + BOX + lines)


def test_frame_is_read_in_the_order_of_ids(tmp_path):
    path = tmp_path / "post" / "frame_7.dump"
    write_dump(path, [(2, 1, 0, 0, 2, 3, 0, 4, 0.1), (1, 1, 0, 0, 1, 0, 0, 0, 0.1)], step=7)
    frame = read_frame(path)
    assert frame.step == 7
    assert frame.positions[:, 2].tolist() == [1.0, 2.0]
    assert frame.speeds.tolist() == [0.0, 5.0]


def test_frames_are_in_the_order_of_steps(tmp_path):
    for step in (1000, 200, 30):
        write_dump(tmp_path / "post" / f"frame_{step}.dump", [], step)
    assert [path.stem for path in frame_paths(tmp_path)] == ["frame_30", "frame_200", "frame_1000"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text[:60], "_1.dump:6: the file ends in the head"),
        (lambda text: text.rsplit("\n", 2)[0] + "\n", "announces 2 grains"),
        (lambda text: text.replace("0.1 ", "nan ", 1), ":10: column radius: 'nan' is not a number"),
        (lambda text: text.replace("0.1 ", "", 1), ":10: expected the 9 columns .* got 8"),
        (lambda text: text + text, ":12: a second time step"),
        (lambda text: text.replace(" radius", " width"), "no column radius in the dump"),
        (lambda text: text.replace("1 1 0 0 1", "1 1 1e+30 0 1"), r"grain 1 at \(1e\+30, 0, 1\)"),
        (lambda text: text.replace("2 1 0 0 2", "1 1 0 0 2"), "two grains have one id"),
        (lambda text: text.replace("0.1 ", "-0.1 ", 1), "a radius is not positive"),
        (lambda text: text.replace("0 1\n", "0 x\n", 1), ":6: expected two bounds of .* '0 x'"),
        (lambda text: text.replace("\n2\n", "\n-2\n"), ":4: expected a whole .* got '-2'"),
        (lambda text: "", ":1: expected 'ITEM: TIMESTEP'"),
        (lambda text: text.replace("0.1", "0.\xb5"), ":10: column radius: .* is not a number"),
    ],
)
def test_a_damaged_dump_is_named(tmp_path, change, message):
    path = tmp_path / "frame_1.dump"
    write_dump(path, [(1, 1, 0, 0, 1, 0, 0, 0, 0.1), (2, 1, 0, 0, 2, 0, 0, 0, 0.1)])
    path.write_bytes(change(path.read_text()).encode("latin-1"))
    with pytest.raises(DamagedFile, match=message):
        read_frame(path)
    path.write_bytes(bytes(range(256)) * 20)  # what 'dump ... binary' might leave
    with pytest.raises(DamagedFile, match=":1: expected 'ITEM: TIMESTEP' of a dump of grains, got"):
        read_frame(path)


def test_count_reads_time_and_diameter(tmp_path):
    path = tmp_path / "scale.txt"
    path.write_text(
        "# ID time  diameter x y z u v w  (ex ey ez, color)\n"
        "7  0.5  0.002 0 0 0 0 0 -1\n3 [  0.25 0.001 0 0 0 0 0 -1 ] \n"
    )
    count = read_count(path, 1000.0)
    assert count.time_s.tolist() == [0.25, 0.5]
    assert count.mass_kg == pytest.approx(1000 * np.pi / 6 * np.array([1e-9, 8e-9]))


def test_count_names_file_and_line_of_a_broken_row(tmp_path):
    path = tmp_path / "scale.txt"
    row = "7 [ 0.5 0.002 0 0 0 0 0 -1 ]\n"
    for rows in ("7 0.5\n", row + row, row.replace("0.5", "nan"), row.replace("0.5", "-1")):
        path.write_text("# ID\n" + rows)
        with pytest.raises(DamagedFile, match=r"scale.txt:[23]: expected 'id \[ time"):
            read_count(path, 1000.0)
    for text in ("", "# ID\n" + row.rstrip()):
        path.write_text(text)
        with pytest.raises(DamagedFile, match=r"scale.txt: empty or cut short"):
            read_count(path, 1000.0)
    with pytest.raises(CaseError, match="missing"):
        read_count(tmp_path / "none.txt", 1000.0)


def test_mass_time_is_exact_for_a_steady_flow():
    times = np.arange(2.0, 20.0, 0.01)
    curve = mass_time(times, np.full_like(times, 1e-4), window=0.8)
    # 10 g/s from 2 s on: 100 g after 12 s; one grain of 0.1 g is 0.01 s.
    assert time_to_reach(curve, 0.1) == pytest.approx(12.0, abs=0.02)


def test_strokes_are_averaged_out():
    period = 0.8
    strokes = np.repeat(2.0 + period * np.arange(25), 80)
    curve = mass_time(strokes, np.full_like(strokes, 1e-4), window=period)
    steps = np.diff(curve.mass_kg[curve.time_s > 3.0])
    assert steps.min() > 0.9 * steps.mean()  # without the average most steps would be zero
    assert time_to_reach(curve, 0.1) == pytest.approx(2.0 + period * 12.0, abs=0.5 * period)


def test_t100_is_a_smooth_function_of_the_arrivals():
    base = np.arange(2.0, 20.0, 0.01)
    times = [
        time_to_reach(mass_time(base * scale, np.full_like(base, 1e-4), 0.8), 0.1)
        for scale in np.linspace(1.0, 1.001, 6)
    ]
    assert np.ptp(np.diff(times)) < 1e-3


def test_a_target_beyond_the_run_is_extrapolated_from_the_steady_slope():
    times = np.arange(2.0, 9.0, 0.01)
    curve = mass_time(times, np.full_like(times, 1e-4), 0.8)
    assert time_to_reach(curve, 0.1) == pytest.approx(12.0, abs=0.1)


def test_too_little_mass_is_a_reason_not_a_number():
    times = np.arange(2.0, 3.0, 0.01)
    with pytest.raises(CaseError, match="simulate longer"):
        time_to_reach(mass_time(times, np.full_like(times, 1e-4), 0.8), 0.1)


def test_conveyor_scales_times_and_masses_back(make_spec, tmp_path):
    setup = setup_of(make_spec("conveyor"))
    part = setup.apparatus["length_fraction"] * setup.apparatus["width_fraction"]
    grain = setup.particle.mass_kg
    # 20 g/s of the whole apparatus from 3 s on, in the time of the slice.
    real = 3.0 + np.arange(0.0, 9.0, grain / part / 0.02)
    slice_times = (real - falls(setup)) * setup.apparatus["length_fraction"] + falls(setup)
    d = setup.particle.d32_m
    rows = [f"{k} {t:.9g} {d:.9g} 0 0 0 0 0 0" for k, t in enumerate(slice_times)]
    (tmp_path / "scale.txt").write_text("\n".join(rows) + "\n")
    write_script(tmp_path, 0)
    write_dump(tmp_path / "post" / "frame_0.dump", [])
    found = EXPERIMENTS["conveyor"].observe(tmp_path, setup)
    # One grain of the slice stands for 0.6 g, that is 0.03 s.
    assert found.values["t100_s"] == pytest.approx(8.0, abs=0.04)
    table = found.tables["mass_time.csv"]
    assert np.interp(8.0, table["time_s"], table["mass_g"]) == pytest.approx(100.0, abs=1.0)
    assert (np.diff(table["mass_g"]) >= 0).all()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.script", "post", "scale.txt"]


def test_heap_is_averaged_over_the_later_part_of_the_pour(make_spec, tmp_path):
    spec = make_spec(apparatus={"frames": 8.0, "pour_tau": 80.0, "settle_tau": 0.0})
    setup = setup_of(spec)
    d = setup.particle.d32_m

    def wedge(angle):
        x, z = np.meshgrid(np.arange(-12, 12.25, 0.25) * d, np.arange(0.5, 14, 0.25) * d)
        keep = z <= (12 * d - np.abs(x)) * np.tan(np.radians(angle))
        return [
            (k, 1, a, 0, b, 0, 0, 0, d / 2)
            for k, (a, b) in enumerate(zip(x[keep], z[keep], strict=True), 1)
        ]

    for step in range(9):
        rows = wedge(30.0 if step < 4 else 40.0)
        rows.append((len(rows) + 1, 1, 0.0, 0.0, 20 * d, 0, 0, -1.0, d / 2))  # a grain in the air
        write_dump(tmp_path / "post" / f"frame_{step}.dump", rows, step)
    write_script(tmp_path, 8)
    assert [frame.step for frame in measured_frames(tmp_path, setup)] == [4, 5, 6, 7, 8]
    found = EXPERIMENTS["heap"].observe(tmp_path, setup).values["angle_deg"]
    # Grains on a lattice of a quarter diameter; the grain in the air must not make a summit.
    assert found == pytest.approx(40.0, abs=1.0)


def remove(post):
    (post / "frame_20.dump").unlink()


def cut(post):
    path = post / "frame_10.dump"
    path.write_bytes(path.read_bytes()[:-9])


def add(post):
    write_dump(post / "frame_15.dump", [], 15)


def rename(post):
    write_dump(post / "frame_10.dump", [], 20)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (remove, "frame_20.dump: missing; the run has 3 frames from step 0 to 20, 2 are there"),
        (cut, "frame_10.dump: the head announces 1 grains, the file holds 0 whole lines"),
        (add, "frame_15.dump: no frame of this run, which has one every 10 steps"),
        (rename, "frame_10.dump: the file says step 20"),
    ],
)
@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_every_experiment_refuses_frames_that_are_not_those_of_its_run(
    make_spec, tmp_path, experiment, damage, message
):
    write_script(tmp_path, 20, every=10)
    for step in (0, 10, 20):
        rows = [(1, 1, 0, 0, 0.5, 0, 0, 0, 1e-3)]
        write_dump(tmp_path / "post" / f"frame_{step}.dump", rows, step)
    for name in ("scale", "poured", "landing", "box1", "box2", "box3", "box4"):
        (tmp_path / f"{name}.txt").write_text("# ID\n")
    damage(tmp_path / "post")
    (frames,) = (one for one in EXPERIMENTS[experiment].parameters if one.name == "frames")
    spec = make_spec(experiment, apparatus={"frames": max(5.0, frames.limits[0])})
    with pytest.raises(DamagedFile, match=message):
        EXPERIMENTS[experiment].observe(tmp_path, setup_of(spec))


def test_a_heap_without_a_measured_frame_is_a_reason(make_spec, tmp_path):
    brief = {"frames": 5.0, "pour_tau": 1.0, "settle_tau": 1e5}
    with pytest.raises(CaseError, match="frames = 5: none falls into the measured part"):
        EXPERIMENTS["heap"].observe(tmp_path, setup_of(make_spec(apparatus=brief)))


@pytest.mark.parametrize(
    "text", ["", "run 10\n", "run 10\ndump frames all custom 1 post/f id", "\xff"]
)
def test_a_script_without_frames_is_refused(tmp_path, text):
    (tmp_path / "in.script").write_bytes(text.encode("latin-1"))
    with pytest.raises(CaseError, match="generate the case again"):
        all_frames(tmp_path)
