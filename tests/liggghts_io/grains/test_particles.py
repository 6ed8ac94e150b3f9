"""Particles as people describe them: tables, sizes in three ways, and every kind of mistake."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from pydantic import ValidationError

from liggghts_io import CaseError, case_id, load_spec, read_particles, write_case
from liggghts_io.bulk import Bulk, sauter_of_masses, sauter_of_quantiles
from liggghts_io.case.spec import build_case
from liggghts_io.materials import MEASURED, Particle
from liggghts_io.particles import bulk_named, particle_named
from liggghts_io.sizes import mixture
from tests.paths import CASES

HEAD = "particle,d32_um,density_kg_m3"


@pytest.fixture
def table(tmp_path):
    """Write a table of particles and return its path."""

    def write(text, encoding="utf-8"):
        path = tmp_path / "particles.csv"
        path.write_text(text, encoding=encoding)
        return path

    return write


def sizes(**given):
    """Return the particle of a bulk with these sizes."""
    return Bulk(name="x", density_kg_m3=2500, **given).particle


def test_particles_are_those_of_the_published_tables(particles):
    published = pd.read_csv(CASES / "particles.csv", comment="#").set_index("particle")
    flows = pd.read_csv(CASES / "funnel_mass_flow.csv", comment="#").set_index("particle")
    constants = pd.read_csv(CASES / "baseline.csv", comment="#").set_index("quantity")["value"]
    impact = pd.read_csv(CASES / "plate_impact.csv", comment="#")
    steel = impact[impact["surface"] == "steel"].set_index("particle")
    assert list(particles) == list(published.index)
    for name, one in particles.items():
        row = published.loc[name]
        assert one.d32_m == pytest.approx(row["d32_um"] * 1e-6)
        quantiles = [row[f"{column}_um"] * 1e-6 for column in ("d10", "d50", "d90")]
        assert [d for d, _ in one.size_classes] == pytest.approx(quantiles)
        assert one.density == constants["density"]
        assert one.youngs_modulus == constants["youngs_modulus"]
        assert one.poisson_ratio == constants["poisson_ratio"]
        assert one.flow_flat_kg_s == pytest.approx(flows.loc[name, "flat_d_g_s"] * 1e-3)
        assert one.flow_glued_kg_s == pytest.approx(flows.loc[name, "glued_c_g_s"] * 1e-3)
        assert one.impact_mass_kg == pytest.approx(steel.loc[name, "initial_g"] * 1e-3)


def test_what_a_table_does_not_say_has_its_documented_default(table):
    path = table(f"# source\n\n{HEAD},flow_flat_g_s\nGlass beads,1000,2500,\n")
    assert read_particles(path) == {"Glass beads": Particle("Glass beads", 1000 * 1e-6, 2500.0)}
    assert particle_named("Glass beads", path).youngs_modulus == 5e6
    assert particle_named("Glass beads", path).poisson_ratio == 0.3
    assert particle_named("Glass beads", path).flow_flat_kg_s is None


def test_a_byte_order_mark_quotes_and_spaces_are_tolerated(table):
    path = table(f'{HEAD} , remark\n"Sand, dry", 700 ,2650, "from a, b"\n', "utf-8-sig")
    assert read_particles(path)["Sand, dry"].d32_m == pytest.approx(700e-6)


BAD_CASES = {
    "empty": ("# nothing\n", ["holds no table"]),
    "bars": (f"{HEAD.replace(',', '|')}\n", ["no column 'particle'", "commas"]),
    "column": ("particle,d32_mm,density_kg_m3\n", ["'d32_mm'", "did you mean 'd32_um'"]),
    "twice": (f"{HEAD},d32_um\n", ["column 'd32_um' appears twice"]),
    "cells": (f"{HEAD}\nx,1,5,2500\n", ["csv:2", "4 cells", "3 columns", "point"]),
    "word": (f"{HEAD}\nx,big,2500\n", ["csv:2", "particle 'x'", "d32_um = 'big'", "number"]),
    "metres": (f"{HEAD}\nx,0.001,2500\n", ["d32_um = '0.001'", "must be at least 10"]),
    "density": (f"# a\n{HEAD}\nx,900,2.5\n", ["csv:3", "density_kg_m3 = '2.5'"]),
    "infinite": (f"{HEAD}\nx,inf,2500\n", ["d32_um = 'inf'"]),
    "no density": ("particle,d32_um\nx,900\n", ["density_kg_m3 is missing", "add the column"]),
    "no name": (f"{HEAD}\n,900,2500\n", ["csv:2", "name = ''"]),
    "same name": (f"{HEAD}\nx,900,2500\nx,901,2500\n", ["csv:3", "'x' stands in a row above"]),
    "no size": (f"{HEAD}\nx,,2500\n", ["no size; give d32_um"]),
    "stiffness": (f"{HEAD},youngs_modulus_pa\nx,90,9e2,7e10\n", ["youngs_modulus_pa = '7e10'"]),
    "sieve": (f"{HEAD},sieve\nx,,2500,900;0.2\n", ["sieve", "1400:0.3 1600:0.7"]),
    "flow": (f"{HEAD},flow_flat_g_s\nx,900,2500,-3\n", ["flow_flat_g_s = '-3'", "must be above 0"]),
}


@pytest.mark.parametrize("name", BAD_CASES)
def test_a_bad_table_is_refused_with_place_value_and_remedy(name, table):
    text, words = BAD_CASES[name]
    path = table(text)
    with pytest.raises(CaseError) as caught:
        read_particles(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_a_table_that_is_no_text_or_not_there_is_refused(tmp_path):
    with pytest.raises(CaseError, match=r"none\.csv: cannot be read"):
        read_particles(tmp_path / "none.csv")
    (tmp_path / "a.csv").write_bytes(b"particle,\x81\n")  # no letter of Windows either
    with pytest.raises(CaseError, match=r"a\.csv: cannot be read .* UTF-8"):
        read_particles(tmp_path / "a.csv")


def test_an_unknown_particle_names_the_nearest():
    with pytest.raises(
        CaseError, match=r"particles\.csv: unknown particle 'Carbo HSP'; did you mean 'Carbo HSP13'"
    ):
        particle_named("Carbo HSP", CASES / "particles.csv")


QUANTILES = {"d10_um": 900, "d50_um": 1000, "d90_um": 1120}


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"d10_um": 900, "d50_um": 1000}, "all three or none"),
        ({"d10_um": 900, "d50_um": 1100, "d90_um": 1000}, "must rise"),
        ({"sieve": [[900, 1]], "d10_um": 90, "d50_um": 100, "d90_um": 110}, "give one of them"),
        ({"sieve": [[900, 1], [900, 2]]}, "appears twice"),
        ({"sieve": [[900, 1], [1000, 2]], "d32_um": 120}, "outside the sieve classes"),
        ({**QUANTILES, "d32_um": 150}, "d32_um = 150 does not belong to quantiles 900, 1000, 1120"),
        ({**QUANTILES, "d32_um": 15000}, "does not belong to quantiles"),
        ({**QUANTILES, "quantiles_of": "mass", "d32_um": 1200}, "from 498.2 to 1152 um"),
    ],
)
def test_sizes_that_contradict_each_other_are_refused(given, words):
    with pytest.raises(ValidationError, match=words):
        sizes(**given)


@pytest.mark.parametrize("spread", [0.05, 0.2, 0.5])
@pytest.mark.parametrize("tail", [1.0, 1.5])
def test_a_sauter_diameter_that_grains_can_have_is_taken(rng, spread: float, tail: float):
    """That of drawn grains, log-normal or with coarser ones than that, whatever is counted."""
    normal = rng.normal(0.0, spread, 20_000)
    grains = 1000.0 * np.exp(np.where(normal > 0.0, tail * normal, normal))
    sauter = (grains**3).sum() / (grains**2).sum()
    order = np.argsort(grains)
    mass = np.cumsum(grains[order] ** 3)
    for of, shares in (("number", np.arange(1, len(grains) + 1)), ("mass", mass)):
        found = np.interp([0.1, 0.5, 0.9], shares / shares[-1], grains[order])
        given = dict(zip(QUANTILES, found, strict=True))
        assert sizes(**given, quantiles_of=of, d32_um=sauter).d32_m == pytest.approx(sauter * 1e-6)


def test_sauter_diameter_of_a_drawn_distribution(rng):
    """A million drawn grains: the closed forms agree with sums over the grains themselves."""
    grains = rng.lognormal(np.log(1000.0), 0.2, 1_000_000)
    sauter = (grains**3).sum() / (grains**2).sum()
    # 0.3 %: three standard errors of the sums, and of the quantiles that a million grains give.
    quantiles = np.quantile(grains, [0.1, 0.5, 0.9])
    assert sauter_of_quantiles(*quantiles) == pytest.approx(sauter, rel=3e-3)
    mass, edges = np.histogram(grains, bins=400, weights=grains**3)
    middles = 0.5 * (edges[1:] + edges[:-1])
    classes = [(d, m) for d, m in zip(middles, mass, strict=True) if m > 0.0]
    assert sauter_of_masses(classes) == pytest.approx(sauter, rel=3e-3)


def test_published_sauter_diameters_follow_from_number_quantiles_within_one_percent():
    for name in read_particles(CASES / "particles.csv"):
        bulk = bulk_named(name, CASES / "particles.csv")
        numbers = sauter_of_quantiles(bulk.d10_um, bulk.d50_um, bulk.d90_um)
        assert numbers == pytest.approx(bulk.d32_um, rel=0.01)
        # Read as quantiles of the mass they would give d50 exp(-s^2 / 2), 2.5 to 5.5 % too little:
        # the table's quantiles count grains.
        spread = np.log(bulk.d90_um / bulk.d10_um) / 2.5631
        assert bulk.d50_um * np.exp(-0.5 * spread**2) < 0.976 * bulk.d32_um


def test_a_measured_sauter_diameter_goes_before_a_computed_one():
    quantiles = {"d10_um": 900.0, "d50_um": 1000.0, "d90_um": 1120.0}
    assert sizes(d32_um=1050.0, **quantiles).d32_m == pytest.approx(1050e-6)
    assert sizes(**quantiles).d32_m == pytest.approx(sauter_of_quantiles(900, 1000, 1120) * 1e-6)
    assert sizes(sieve=[[1400, 2], [1000, 2]]).d32_m == pytest.approx(1e-6 * 4 / (0.002 + 1 / 700))


def test_a_sieve_table_is_simulated_with_its_classes_and_masses(make_spec, table):
    """Full strength gives back what was sieved: diameters, mass shares, Sauter diameter."""
    cell = "2000:10 1000:30 1400:60"
    path = table(f"{HEAD},sieve,flow_flat_g_s,flow_glued_g_s\nSand,,2650,{cell},20,20\n")
    sand = particle_named("Sand", path)
    spec = make_spec(particle=sand, effects={"size_distribution": 1.0})
    assert build_case(spec).variables["sizes"] == [
        pytest.approx(one) for one in ((1e-3, 0.3), (1.4e-3, 0.6), (2e-3, 0.1))
    ]
    half = mixture(sand, 0.5)
    assert 1.0 / sum(part / d for d, part in half) == pytest.approx(sand.d32_m)
    assert half[0][0] > 1e-3


@pytest.mark.parametrize("strength", [0.5, 1.0, 1.5])
def test_a_wide_spread_always_leaves_grains(strength):
    """The diagnosis tries more than the measured spread, which would leave the fines no size."""
    wide = sizes(sieve=[[50, 0.001], [300, 3], [1000, 100], [1100, 100]])
    classes = mixture(wide, strength)
    assert classes[0][0] > 0.0
    assert 1.0 / sum(part / d for d, part in classes) == pytest.approx(wide.d32_m)
    if strength == 1.0:
        assert [d for d, _ in classes] == pytest.approx([d for d, _ in wide.size_classes])


@pytest.mark.parametrize(
    ("changes", "missing"),
    [
        ({"experiment": "conveyor"}, "no flow_flat_g_s .*which the experiment conveyor on steel"),
        ({"experiment": "conveyor", "surface": "glued"}, "no flow_glued_g_s"),
        ({"experiment": "plate_impact"}, "no flow_flat_g_s"),
        ({"effects": {"size_distribution": 1.0}}, "no size distribution .*d10_um.*sieve"),
    ],
)
def test_a_case_says_what_it_needs_to_know_of_its_particle(make_spec, changes, missing):
    plain = sizes(d32_um=1000.0)
    assert case_id(make_spec(particle=plain))  # a heap needs none of it
    with pytest.raises(CaseError, match=missing):
        case_id(make_spec(particle=plain, **changes))
    with pytest.raises(CaseError, match="has no impact_mass_g"):
        sizes(d32_um=1000.0, flow_flat_g_s=20.0).amount("impact_mass_kg")


def test_a_case_carries_its_particle(make_spec, tmp_path):
    """No table is asked again: the record gives the particle back with every number."""
    sand = sizes(sieve=[[1000, 0.3], [1400, 0.7]], impact_mass_g=30, flow_flat_g_s=20)
    spec = make_spec("plate_impact", particle=sand)
    write_case(spec, tmp_path)
    assert load_spec(tmp_path).particle == replace(sand, sizes=MEASURED)  # as it was decided
    assert case_id(load_spec(tmp_path)) == case_id(spec)
    heavier = make_spec("plate_impact", particle=sizes(sieve=[[1000, 0.3], [1400, 0.71]]))
    with pytest.raises(CaseError):
        case_id(heavier)
    for change in ({"density_kg_m3": 2501}, {"impact_mass_g": 31}, {"poisson_ratio": 0.25}):
        facts = {"name": "x", "density_kg_m3": 2500, "sieve": [[1000, 0.3], [1400, 0.7]]}
        facts |= {"impact_mass_g": 30, "flow_flat_g_s": 20} | change
        assert case_id(make_spec("plate_impact", particle=Bulk(**facts).particle)) != case_id(spec)


def test_integers_and_floats_are_the_same_particle(make_spec):
    one, other = Particle("x", 1e-3, 2500), Particle("x", 1e-3, 2500.0)
    assert case_id(make_spec(particle=one)) == case_id(make_spec(particle=other))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "cp1252"])
def test_a_table_is_read_as_a_spreadsheet_saves_it(table, encoding: str):
    """Its letters, columns and rows that are empty, capitals and units in brackets."""
    text = "Particle;d32 [µm];Density_kg_m3;remark;;\r\nSand;700,5;2650;größer;;\r\n;;;;;\r\n"
    found = read_particles(table(text, encoding))
    assert found["Sand"].d32_m == pytest.approx(700.5e-6)
    assert found["Sand"].density == 2650.0


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ("1500;25,000", "density_kg_m3 = '25,000' may be 25.000 or 25000"),
        ("1500,5;2.650", "has a decimal point in a table with decimal commas"),
    ],
)
def test_a_number_that_may_be_two_is_none(table, cells: str, words: str):
    """A density of 25 kg/m3 was taken where 25000 was meant, or the other way round."""
    with pytest.raises(CaseError, match=words):
        read_particles(table(f"{HEAD.replace(',', ';')}\nSand;{cells}\n"))


@pytest.mark.parametrize("separator", [";", "\t"])
def test_a_table_of_a_spreadsheet_in_german_is_read(table, separator: str):
    head = ["particle", "d32_um", "density_kg_m3", "remark"]
    rows = [head, ["Sand, dry", "700,5", "2650", "Ofen, 105 Grad"]]
    found = read_particles(table("".join(separator.join(row) + "\r\n" for row in rows)))
    assert found["Sand, dry"].d32_m == pytest.approx(700.5e-6)
    assert found["Sand, dry"].density == 2650.0
