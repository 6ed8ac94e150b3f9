"""Every extractor against numbers that are known."""

import numpy as np
import pytest

from liggghts_io.errors import CaseError, DamagedFile
from liggghts_io.measure.arithmetic import evaluate
from liggghts_io.measure.extract import CURVE_EXTRACTORS, EXTRACTORS, Run
from liggghts_io.measure.schedule import schedule_of

DENSITY = 2500.0
SCRIPT = "dump d all custom 10 post/g_*.dump id x y z vx vy vz radius\nrun 20\n"


def dump(path, step, rows, names="id x y z vx vy vz radius"):
    """Write a frame in the form of both engines."""
    path.parent.mkdir(exist_ok=True)
    head = ["ITEM: TIMESTEP", str(step), "ITEM: NUMBER OF ATOMS", str(len(rows))]
    head += ["ITEM: BOX BOUNDS ff ff ff", *["-1 1"] * 3, f"ITEM: ATOMS {names} "]
    lines = [" ".join(f"{v:g}" for v in row) for row in rows]
    path.write_text("\n".join([*head, *lines]) + "\n")


@pytest.fixture
def run(tmp_path):
    """Make a run of 20 steps with three frames, a printed table, counted grains and a log."""
    (tmp_path / "in.script").write_text(SCRIPT)
    for step, shift in ((0, 0.0), (10, 0.1), (20, 0.2)):
        rows = [(k, 0.1 * k, 0, shift + 0.01 * k, 0, 0, 0.1 * k, 0.005) for k in range(1, 5)]
        dump(tmp_path / "post" / f"g_{step}.dump", step, rows)
    (tmp_path / "level.txt").write_text("# time_s z_m\n0 10\n1 6\n2 2\n3 2\n")
    (tmp_path / "flow.txt").write_text(
        "# ID time  diameter x y z u v w  (ex ey ez, color)\n"
        "7  0.5  0.002 0 0 0 0 0 0\n3  0.25  0.002 0 0 0 0 0 0\n"
    )
    (tmp_path / "log.liggghts").write_text(
        "run 20\nStep Atoms KinEng\n 0 4 1.5 \n 10 4 0.5 \nLoop time of 1 on 1 procs\n"
        "run 0\nStep Atoms KinEng\n 10 4 0.5 \n 20 4 0.25 \nLoop time\nprint 3 4 5\n3 4 5\n"
    )
    return Run(tmp_path, DENSITY, {"height_m": 4.0})


MASS = DENSITY * np.pi / 6.0 * 0.002**3
GRAIN = DENSITY * np.pi / 6.0 * 0.01**3
BOX = {"x": (0.15, 0.35)}
CASES = [
    ("last", {"file": "level.txt", "column": "z_m"}, 2.0),
    ("last", {"file": "level.txt", "column": "2"}, 2.0),
    ("last", {"file": "log.liggghts", "column": "KinEng"}, 0.25),
    ("last", {"file": "flow.txt", "column": "mass_kg"}, 2 * MASS),
    ("mean", {"file": "level.txt", "column": "z_m"}, 5.0),
    ("mean", {"file": "level.txt", "column": "z_m", "part": (0.5, 1.0)}, 2.0),
    ("mean", {"file": "log.liggghts", "column": "KinEng"}, 0.6875),
    ("extreme", {"file": "level.txt", "column": "z_m"}, 10.0),
    ("extreme", {"file": "level.txt", "column": "z_m", "which": "smallest"}, 2.0),
    ("time_to", {"file": "level.txt", "column": "z_m", "reaches": 4.0}, 1.5),
    ("time_to", {"file": "level.txt", "column": "z_m", "reaches": "height_m", "since": 1.0}, 0.5),
    ("time_to", {"file": "flow.txt", "column": "number", "reaches": 2.0}, 0.5),
    ("rate", {"file": "flow.txt", "column": "number", "between": (1.0, 2.0)}, 4.0),
    ("rate", {"file": "level.txt", "column": "time_s", "between": (0.5, 2.5), "time": "1"}, 1.0),
    ("rate", {"file": "level.txt", "column": "time_s", "between": (1.0, "0.5 * height_m")}, 1.0),
    ("count", {}, 4.0),
    ("count", {"box": BOX}, 2.0),
    ("count", {"box": {"z": (0.0, 0.15)}, "part": (0.0, 1.0)}, 8.0 / 3.0),
    ("count", {"slower_than": 0.25}, 2.0),
    ("mass", {"box": BOX}, 2 * GRAIN),
    ("grain_mean", {"column": "z", "box": BOX}, 0.225),
    ("grain_mean", {"column": "z", "box": BOX, "part": (0.0, 1.0)}, 0.125),
    ("grain_mean", {"column": "speed"}, 0.25),
    ("grain_percentile", {"column": "x", "percent": 0.0}, 0.1),
    ("grain_percentile", {"column": "x"}, 0.25),
]


@pytest.mark.parametrize(("kind", "options", "expected"), CASES)
def test_a_number_is_what_was_written(run, kind, options, expected):
    assert EXTRACTORS[kind](**options).read(run) == pytest.approx(expected, rel=1e-9)


def test_every_extractor_is_tested():
    assert {kind for kind, _, _ in CASES} | {"angle"} == set(EXTRACTORS)
    assert set(CURVE_EXTRACTORS) == {"columns", "profile"}


def test_a_column_over_another(run):
    x, y = CURVE_EXTRACTORS["columns"](file="level.txt", x="time_s", y="z_m").read(run)
    assert x.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert y.tolist() == [10.0, 6.0, 2.0, 2.0]


def slope(degrees, dense=0.3):
    """Return grains of 1 mm under a plane that rises to the right."""
    x, z = np.meshgrid(np.arange(0.0, 40.0, dense), np.arange(0.5, 60.0, dense))
    keep = z < 5.0 + x * np.tan(np.radians(degrees))
    x, z = x[keep], z[keep]
    rows = np.column_stack(
        [np.arange(1, len(x) + 1), x, 0 * x, z, 0 * x, 0 * x, 0 * x, 0 * x + 0.5]
    )
    return rows * np.array([1, *[1e-3] * 7])


@pytest.mark.parametrize("degrees", [-30.0, 0.0, 20.0, 40.0])
def test_a_slope_is_the_angle_of_its_surface(tmp_path, degrees):
    (tmp_path / "in.script").write_text(SCRIPT.replace("10 post", "20 post"))
    rows = slope(abs(degrees))
    rows[:, 1] *= np.sign(degrees) or 1.0
    dump(tmp_path / "post" / "g_0.dump", 0, rows)
    dump(tmp_path / "post" / "g_20.dump", 20, rows)
    box = {"x": (0.005, 0.035)} if degrees >= 0 else {"x": (-0.035, -0.005)}
    made = Run(tmp_path, DENSITY, {})
    found = EXTRACTORS["angle"](shape="slope", signed=True, box=box).read(made)
    assert found == pytest.approx(degrees, abs=0.5)  # discs of 1 mm on a grid of 0.3 mm
    if degrees == 20.0:
        x, z = CURVE_EXTRACTORS["profile"](box={**box, "z": (0.0, 1.0)}).read(made)
        rise = (z[150] - z[50]) / (x[150] - x[50])
        assert rise == pytest.approx(np.tan(np.radians(20.0)), rel=0.03)
        assert z[100] == pytest.approx(5.5e-3 + 20e-3 * np.tan(np.radians(20.0)), abs=3e-4)


REASONS = [
    ("time_to", {"file": "level.txt", "column": "z_m", "reaches": 1.0}, "does not reach 1"),
    ("rate", {"file": "flow.txt", "column": "number", "between": (1.0, 9.0)}, "it ends at 2"),
    ("rate", {"file": "flow.txt", "column": "number", "between": (2.0, 1.0)}, "smaller value"),
    ("last", {"file": "level.txt", "column": "zm"}, "no column 'zm'; did you mean 'z_m'"),
    ("grain_mean", {"column": "z", "box": {"z": (5.0, 6.0)}}, "no grain in the box"),
    ("count", {"dump": "none"}, "no dump 'none' that writes one file for each frame"),
]


@pytest.mark.parametrize(("kind", "options", "message"), REASONS)
def test_what_a_run_does_not_determine_is_a_reason(run, kind, options, message):
    with pytest.raises(CaseError, match=message) as refused:
        EXTRACTORS[kind](**options).read(run)
    assert not isinstance(refused.value, DamagedFile)


DAMAGE = [
    ("level.txt", lambda text: text[:-1], "last", {"file": "level.txt", "column": "2"}),
    ("level.txt", lambda text: text + "4\n", "last", {"file": "level.txt", "column": "2"}),
    ("level.txt", lambda _text: "", "last", {"file": "level.txt", "column": "2"}),
    ("flow.txt", lambda text: text + "8 0.6\n", "last", {"file": "flow.txt", "column": "number"}),
    ("post/g_20.dump", lambda text: text[:-20], "count", {}),
]


@pytest.mark.parametrize(("name", "damage", "kind", "options"), DAMAGE)
def test_a_damaged_file_gives_no_number(run, name, damage, kind, options):
    path = run.folder / name
    path.write_text(damage(path.read_text()))
    with pytest.raises(DamagedFile, match=path.name):
        EXTRACTORS[kind](**options).read(run)


def test_a_missing_frame_gives_no_number(run):
    (run.folder / "post" / "g_10.dump").unlink()
    with pytest.raises(DamagedFile, match=r"g_10\.dump: missing; the run has 3 frames"):
        EXTRACTORS["count"]().read(run)


@pytest.mark.parametrize(
    ("text", "steps", "frames"),
    [
        ("dump d all custom 10 p/a_*.d id\nrun 20", 20, (0, 10, 20)),
        ("run 5\ndump d all custom 10 p/a_*.d id\nrun 20", 25, (10, 20)),
        ("variable n equal 2*10\ndump d all custom ${n} p/a_*.d id\nrun $(v_n*2)", 40, (0, 20, 40)),
        ("variable n equal 10\nvariable m equal ${n}/2\ndump d all custom $m p/a_*.d id\nrun $n",
         10, (0, 5, 10)),
        ("run 5\nrun 20 upto\n", 20, None),
        ("dump d all custom 10 p/a_*.d id\nrun 20\nundump d\nrun 20", 40, (0, 10, 20)),
        ('dump d all custom 10 p/a_*.d id\nrun 20\nif "${x} > 1" then "run 10"', None, None),
        ("variable n equal ke\ndump d all custom 10 p/a_*.d id\nrun ${n}", None, None),
        ("dump d all custom 10 p/a_*.d id\ndump_modify d every 5\nrun 20", 20, None),
    ],
)  # fmt: skip
def test_what_a_script_tells_of_its_steps(text, steps, frames):
    found = schedule_of(text)
    assert found.steps == steps
    assert (found.dumps[0].frames if found.dumps else None) == frames


@pytest.mark.parametrize(
    "text",
    ["__import__('os')", "a.b", "[1]", "1 if 1 else 2", "9**9**9", "'a'", "lambda: 1", "a(1)", "",
     "1/0", "(" * 400 + "1", "sqrt(-1)", "True"],
)  # fmt: skip
def test_a_formula_is_arithmetic_and_nothing_else(text):
    with pytest.raises(CaseError):
        evaluate(text, {"a": 1.0})


def test_a_formula_has_the_value_that_it_has_on_paper():
    assert evaluate("-2 * (a + 1)^2 / max(1, 4) + sqrt(9)", {"a": 3.0}) == pytest.approx(-5.0)
