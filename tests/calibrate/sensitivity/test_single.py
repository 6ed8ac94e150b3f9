"""One parameter at a time: what is seen, in which direction, and what is luck."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from calibrate.errors import CalibrationError
from calibrate.questions.sensitivity.baseline import baseline_of, read_baseline
from calibrate.questions.sensitivity.responses import Response
from calibrate.questions.sensitivity.steps import series_of, specs_of
from calibrate.questions.sensitivity.study import Asked, plan_of, result_of
from calibrate.runs.campaign import run_table
from calibrate.study.data import load_data
from calibrate.study.resources import bundled_study
from liggghts_io import execute
from tests.calibrate import stand_in
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import bench, planted_study
from tests.calibrate.study.rigs import CURVE, write_rig


def response(y: np.ndarray, p: float = 0.001) -> Response:
    nothing = (math.nan, math.nan)
    x = np.arange(float(len(y)))
    return Response("heap", "angle_deg", "deg", "mu_pp", "A", 0.0, False, x, y, nothing, p)


@pytest.mark.parametrize(
    ("means", "word"),
    [((0.0, 1.0, 2.0), "rises"), ((2.0, 0.5, 0.0), "falls"), ((0.0, 2.0, 0.1), "both ways")],
)
def test_directions(means, word) -> None:
    y = np.column_stack([means, means])
    assert response(y).direction == word
    assert response(y, p=0.2).direction == "not seen"
    assert response(y, p=math.nan).direction == "not seen"


def test_failed_runs_leave_the_others(rng) -> None:
    y = rng.normal(size=(4, 3))
    y[1] = math.nan
    y[2, 0] = math.nan
    found = response(y)
    assert np.isnan(found.means[1])
    assert found.means[2] == pytest.approx(y[2, 1:].mean())
    assert found.change == pytest.approx(y[3].mean() - y[0].mean())


@pytest.fixture(scope="module")
def hsp13(tmp_path_factory):
    """Return the result of the bundled study on formulas, and its table by output and name."""
    root = tmp_path_factory.mktemp("runs")
    plan = plan_of(load_data(bundled_study()), Asked(points=0))
    rows = [stand_in.execute(spec, root) for spec in plan.specs]
    found = result_of(plan, run_table(plan.specs, rows))
    return found, found.table().set_index(["place", "output", "parameter"])


def test_signs_are_those_of_the_formulas(hsp13) -> None:
    _, table = hsp13
    heap, conveyor, impact = (f"{e} of Carbo HSP13 on steel" for e in
                              ("heap", "conveyor", "plate_impact"))  # fmt: skip
    direction = table["direction"]
    for name in ("mu_pp", "mu_roll_pp", "mu_pw"):
        assert direction[heap, "angle_deg", name] == "rises"
    assert direction[conveyor, "t100_s", "mu_pw"] == "rises"
    for name in ("e_pp", "e_pw"):
        assert direction[impact, "m1_g", name] == "falls"
    for box in ("m2_g", "m3_g", "m4_g"):  # the steep peak of Fig. B.13
        assert direction[impact, box, "e_pw"] == "both ways"
    assert table["change"][heap, "angle_deg", "mu_pp"] > 5.0
    # Nothing in the formulas knows of these: one false alarm among twenty is chance.
    silent = direction[[row for row in table.index if row[2] == "poisson_ratio"]]
    assert (silent == "not seen").all()


def test_all_observables_and_the_elastic_constants_are_there(hsp13) -> None:
    found, table = hsp13
    assert {"angle_deg", "t100_s", "m1_g", "m4_g", "beside_g"} <= set(table.index.levels[1])
    assert {"youngs_modulus_pa", "poisson_ratio"} <= set(table.index.levels[2])
    (said,) = [line for line in found.sentences if line.startswith("youngs_modulus_pa")]
    assert said == (
        "youngs_modulus_pa from 5e+06 to 5e+07: no output moves by more than the luck of the seeds"
    )
    glued = table.loc["heap of Carbo HSP13 on glued"]
    assert "mu_pw" not in glued.index.get_level_values("parameter")


def test_the_figure_has_a_row_per_output_and_the_measured_values(hsp13) -> None:
    found, _ = hsp13
    figure = found.figure("plate_impact of Carbo HSP13 on steel")
    assert len([axis for axis in figure.axes if axis.get_visible()]) == 5 * 8
    with pytest.raises(CalibrationError, match="did you mean"):
        found.figure("plate_impact of Carbo HSP13 on stel")
    with pytest.raises(CalibrationError, match="no Sobol indices"):
        found.indices_figure()


def test_the_bundled_studies_stand_around_the_papers_table(hsp13) -> None:
    found, _ = hsp13
    paper = {"mu_pp": 0.35, "mu_pw": 0.35, "mu_roll_pp": 0.2, "mu_roll_pw": 0.2, "e_pp": 0.6,
             "e_pw": 0.6, "youngs_modulus_pa": 5e6, "poisson_ratio": 0.3}  # fmt: skip
    assert dict(found.baseline) == paper
    for one in found.responses:
        assert one.baseline in one.x


def test_luck_is_called_seen_once_in_twenty_outputs_at_most(tmp_path, rng) -> None:
    """Eight parameters of an output together have the 5 % of one test."""
    data = planted_study(tmp_path, bench("A", "steel")[:1], rng, free=tuple(planted.TRUTH))
    plan = plan_of(data, Asked(points=0))
    alarms = 0
    for _ in range(60):
        angles = rng.normal(30.0, 1.0, len(plan.specs))
        found = result_of(plan, pd.DataFrame({"status": "ok", "angle_deg": angles}))
        alarms += any(one.direction != "not seen" for one in found.responses)
    # Sixty trials of 5 %: more than nine happen once in a thousand sets.
    assert alarms <= 9


def test_a_study_without_a_table_stands_around_its_values_and_middles(tmp_path, rng) -> None:
    data = planted_study(tmp_path, bench("A", "steel"), rng)
    found = baseline_of(data)
    assert found["mu_pp", "A"] == pytest.approx(0.45)  # middle of 0.1 to 0.8
    assert found["mu_pw", "A/steel"] == pytest.approx(planted.TRUTH["mu_pw"])
    series = series_of(data.study, found, levels=3, seeds=2)
    names = [one.varied.name for one in series if one.place.experiment == "heap"]
    assert names == ["mu_pp", "mu_roll_pp", "youngs_modulus_pa", "poisson_ratio"]
    assert all(len(row) == 2 for one in series for row in one.specs)


def test_surfaces_with_the_same_cases_are_run_once(tmp_path, rng) -> None:
    both = [one for surface in ("steel", "alumina") for one in bench("A", surface)[:1]]
    data = planted_study(tmp_path, both, rng, free=("mu_pp",))
    series = series_of(data.study, baseline_of(data), levels=3, seeds=2)
    assert {one.where for one in series} == {"heap of A on steel, alumina"}
    # mu_pp: 3 values and none more (the baseline is the middle), Y 3, nu 3 and the baseline.
    assert len(specs_of(series)) == 2 * (3 + 2 + 3)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("mu_rol_pp,0.4,-", "did you mean 'mu_roll_pp'"),
        ("mu_pp,much,-", "is not a number"),
        ("mu_pp,0.4", "2 cells"),
        ("youngs_modulus,200,GPa", "give it in Pa"),
        ("youngs_modulus,2e11,Pa", "the engines take 5e+06 to 1e+09"),
        ("mu_pp,0.4,-\nmu_pp,0.5,-", "has a value above"),
    ],
)
def test_a_wrong_baseline_is_told_with_its_line(tmp_path, rng, line, said) -> None:
    data = planted_study(tmp_path, bench("A", "steel"), rng)
    path = tmp_path / "base.csv"
    path.write_text(f"# mine\nquantity,value,unit\n{line}\n", encoding="utf-8")
    with pytest.raises(CalibrationError, match=r"base\.csv:[34]: ") as found:
        read_baseline(path, data.study)
    assert said in str(found.value)


def test_an_own_script_and_its_curve(tmp_path: Path) -> None:
    """A grain that falls from twice the height takes the root of two times longer."""
    times = np.linspace(0.002, 0.05, 9)
    rows = "".join(f"{t:.4f},{22.0 - 4905.0 * t**2:.4f},0.05\n" for t in times)
    (tmp_path / "path.csv").write_text(f"time_s,height_mm,sem_mm\n{rows}", encoding="utf-8")
    levels = "levels = [0.01, 0.02, 0.03, 0.04]\n"
    design = ("[[material]]", "[design]\nruns = 16\nstart = 6\n[[material]]")
    data = load_data(write_rig(tmp_path, design, more=CURVE + levels))
    plan = plan_of(data, Asked(levels=3, seeds=2))
    root = tmp_path / "runs"
    found = result_of(plan, run_table(plan.specs, [execute(spec, root) for spec in plan.specs]))
    table = found.table().set_index(["output", "parameter"])
    time = table.loc[("t_ground_s", "height_m")]
    assert time["direction"] == "rises"
    assert time["at_high"] / time["at_low"] == pytest.approx(math.sqrt(2.0), rel=0.01)
    assert time["total"] == pytest.approx(1.0, abs=0.03)
    path = table.loc[("height: component 1", "height_m")]
    assert path["direction"] == "rises"
    assert path["first"] == pytest.approx(1.0, abs=0.03)
