"""How a study says what its simulated grains are: measured sizes, coarse grains, their error."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.study.cases import case_spec, middle
from calibrate.study.load import load_study
from calibrate.study.model import Study
from calibrate.study.places import Place
from calibrate.study.write import study_text
from liggghts_io.case.spec import build_case
from tests.calibrate.study.two import FREE, TARGETS, TWO

FINE = 'name = "fine"\nd32_um = 800.0\n'
QUANTILES = "d10_um = 700.0\nd50_um = 780.0\nd90_um = 870.0\n"
HEAP, STEEL = "heap", "steel"


@pytest.fixture
def study(tmp_path: Path):
    """Return a function that loads the study of two materials, with more said of the fine one."""

    def load(of_fine: str = "", more: str = "", free: str = FREE) -> Study:
        text = (TWO + TARGETS + free).replace(FINE, FINE + of_fine, 1) + more
        path = tmp_path / "two.toml"
        path.write_text(text, encoding="utf-8")
        return load_study(path)

    return load


def high_restitution() -> str:
    """Return free parameters with a restitution between grains that coarse ones can have."""
    return FREE.replace("[parameter.e_pp]\nrange = [0.1, 0.8]", "[parameter.e_pp]\n"
                        "range = [0.75, 0.9]")  # fmt: skip


def grains_of(study: Study, material: str) -> dict:
    """Return the variables of the heap of a material in the middle of all ranges."""
    spec = case_spec(study, Place(material, STEEL, HEAP), middle(study), 1)
    return build_case(spec).variables


def test_each_material_says_how_it_is_simulated(study):
    one = study(QUANTILES + 'sizes = "measured"\ncoarse_graining = 1.5\n', free=high_restitution())
    coarse, fine = grains_of(one, "coarse"), grains_of(one, "fine")
    assert coarse["sizes"] == [(1.5e-3, 1.0)]
    assert len(fine["sizes"]) == 3
    sauter = 1.0 / sum(mass / d for d, mass in fine["sizes"])
    assert sauter == pytest.approx(1.5 * 800e-6)
    assert 1.0 - fine["e_pp"] ** 2 == pytest.approx(1.5 * (1.0 - coarse["e_pp"] ** 2))


def test_a_study_written_again_keeps_it(study, tmp_path):
    one = study(QUANTILES + 'sizes = "measured"\ncoarse_graining = 1.5\n', free=high_restitution())
    again = tmp_path / "again.toml"
    again.write_text(study_text(one), encoding="utf-8")
    assert grains_of(load_study(again), "fine") == grains_of(one, "fine")


def test_a_row_of_a_table_is_simulated_as_the_study_says(tmp_path):
    (tmp_path / "particles.csv").write_text(
        "particle,d32_um,d10_um,d50_um,d90_um,density_kg_m3,flow_flat_g_s,sizes\n"
        "coarse,1500,,,,2500,20,\nfine,800,700,780,870,2500,22,measured\n"
    )
    text = (TWO + TARGETS + high_restitution()).replace(
        "d32_um = 1500.0\ndensity_kg_m3 = 2500.0\nflow_flat_g_s = 20.0\n", ""
    )
    text = text.replace(
        "d32_um = 800.0\ndensity_kg_m3 = 2500.0\nflow_flat_g_s = 22.0\n",
        'sizes = "one"\ncoarse_graining = 1.2\n',
    )
    (tmp_path / "two.toml").write_text(text)
    one = load_study(tmp_path / "two.toml")
    assert grains_of(one, "fine")["sizes"] == [(pytest.approx(1.2 * 800e-6), 1.0)]


def test_one_factor_for_all_materials_is_a_parameter(study):
    one = study(more="\n[parameter.coarse_graining]\nvalue = 1.2\n", free=high_restitution())
    for material, d in (("coarse", 1.5e-3), ("fine", 0.8e-3)):
        assert grains_of(one, material)["sizes"] == [(pytest.approx(1.2 * d), 1.0)]


def test_a_range_of_restitution_that_coarse_grains_cannot_have_is_told_with_its_line(study):
    with pytest.raises(CalibrationError) as caught:
        study("coarse_graining = 1.5\n")
    (line,) = [one for one in str(caught.value).splitlines() if "coarse_graining" in one]
    assert "two.toml:" in line
    assert "coarse_graining = 1.5 with e_pp = 0.1" in line
    assert "raise e_pp to 0.58" in line


def test_the_effect_and_the_measured_sizes_are_not_both_taken(tmp_path):
    both = (TWO + TARGETS + FREE).replace("d32_um = 1500.0\n", "d32_um = 1500.0\n" + QUANTILES)
    both = both.replace(FINE, FINE + QUANTILES + 'sizes = "measured"\n')
    path = tmp_path / "two.toml"
    path.write_text(both + "\n[effects]\nsize_distribution = 1.0\n")
    with pytest.raises(CalibrationError, match=r"size_distribution: 'fine' has sizes = 'measured"):
        load_study(path)


def test_the_error_of_coarse_grains_is_one_of_a_target(study):
    """The bias that was measured goes into `[[shared]]`, for one target or for several."""
    one = study(
        more='\n[[shared]]\nname = "coarse_grains"\ntargets = ["heap_fine_steel"]\n'
        "relative_se = 0.03\n"
    )
    assert one.shared[0].targets == ["heap_fine_steel"]
