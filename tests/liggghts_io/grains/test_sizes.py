"""Sizes of the simulated grains: measured distributions and coarse grains, and what stays."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from liggghts_io import CaseError, case_id, load_spec, write_case
from liggghts_io.bulk import Bulk, sauter_of_quantiles
from liggghts_io.case.spec import build_case, script_of
from liggghts_io.materials import MEASURED, ONE
from liggghts_io.scripts.filters import mean_mass
from liggghts_io.sizes import (
    coarse_restitution,
    lognormal_classes,
    mixture,
    quantile_spread,
    simulated_sizes,
)

EXPERIMENTS = ("heap", "conveyor", "plate_impact")
FACTORS = (1.254, 1.567, 1.881)
"""2, 2.5 and 3 mm instead of 1.595 mm, as in the paper's section 3.4."""
SURFACES = ("steel", "glued")


def sauter(sizes):
    """Return the Sauter diameter of diameters and mass fractions."""
    return sum(mass for _, mass in sizes) / sum(mass / d for d, mass in sizes)


def described(**numbers):
    """Return the particle of a bulk with these sizes."""
    return Bulk(name="x", density_kg_m3=2500, **numbers).particle


@pytest.fixture
def same(particles):
    """Return the particle with one diameter."""
    return replace(particles["Carbo HSP13"], sizes=ONE)


@pytest.fixture
def measured(particles):
    """Return a particle with its measured sizes."""
    return replace(particles["Carbo HSP13"], sizes=MEASURED)


def test_every_proppant_with_its_measured_sizes_has_the_measured_sauter_diameter(particles):
    for one in particles.values():
        sizes = simulated_sizes(replace(one, sizes=MEASURED))
        assert len(sizes) == 3
        assert sauter(sizes) == pytest.approx(one.d32_m)
        assert sizes[0][0] == pytest.approx(one.size_classes[0][0], rel=0.04)


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_measured_sizes_keep_mass_and_mass_flow(make_spec, same, measured, experiment):
    one = build_case(make_spec(experiment, particle=same)).variables
    many = build_case(make_spec(experiment, particle=measured)).variables
    for amount in ("grain_count", "grain_rate"):
        before = one[amount] * mean_mass(one["sizes"], one["density"])
        assert many[amount] * mean_mass(many["sizes"], many["density"]) == pytest.approx(before)
    # Eq. 6 with the smallest diameter, to the three digits of a time step.
    smallest = many["sizes"][0][0] / one["sizes"][0][0]
    assert many["dt"] / one["dt"] == pytest.approx(smallest, rel=0.01)


def test_the_script_says_which_classes_there_are_and_what_the_time_step_follows(
    make_spec, same, measured
):
    text = script_of(make_spec(particle=measured))
    assert "# Grains: Sauter diameter 1.595 mm, 3 classes from 1.348 to 1.78 mm, the small" in text
    assert text.count("particletemplate/sphere") == 3
    assert "# Grains" not in script_of(make_spec(particle=same))
    coarse = replace(measured, coarse_graining=1.5)
    assert "2.392 mm, 1.5 times that of the real ones, 3 classes" in script_of(
        make_spec(particle=coarse)
    )


def test_measured_sizes_are_what_is_simulated_where_nobody_says_it(make_spec, measured):
    assert case_id(make_spec()) == case_id(make_spec(particle=measured))


def test_measured_sizes_in_the_base_model_exclude_the_effect(make_spec, measured):
    spec = make_spec(particle=measured, effects={"size_distribution": 1.0})
    with pytest.raises(CaseError, match=r"size_distribution: .* has sizes = 'measured' already"):
        script_of(spec)


def test_measured_sizes_are_the_effect_at_full_strength(make_spec, measured):
    """The base model with measured sizes is the run that the diagnosis made with the effect."""
    base, effect = (
        build_case(make_spec("conveyor", **changes)).variables
        for changes in ({"particle": measured}, {"effects": {"size_distribution": 1.0}})
    )
    assert base == effect


def test_a_case_keeps_how_its_grains_are_simulated(make_spec, measured, tmp_path):
    spec = make_spec(particle=replace(measured, coarse_graining=1.5))
    write_case(spec, tmp_path)
    assert load_spec(tmp_path).particle == spec.particle
    assert case_id(load_spec(tmp_path)) == case_id(spec)
    assert len({case_id(make_spec(particle=one)) for one in (measured, spec.particle)}) == 2


@given(
    st.floats(50.0, 5000.0), st.floats(0.02, 0.6), st.integers(2, 20),
    st.sampled_from(["number", "mass"]),
)  # fmt: skip
def test_lognormal_classes_keep_mass_and_surface(d50, spread, count, of):
    """However many classes: the Sauter diameter is that of the whole distribution."""
    tails = [d50 * math.exp(z * spread) for z in (-1.2815515655446004, 1.2815515655446004)]
    given = {"d10_um": tails[0], "d50_um": d50, "d90_um": tails[1], "quantiles_of": of}
    particle = described(**given, lognormal_classes=count, sizes="measured")
    sizes = simulated_sizes(particle)
    assert len(sizes) == count
    assert sauter(sizes) == pytest.approx(particle.d32_m)
    assert particle.d32_m * 1e6 == pytest.approx(
        sauter_of_quantiles(given["d10_um"], d50, given["d90_um"], of)
    )
    assert [mass for _, mass in sizes] == pytest.approx([1.0 / count] * count)
    # Classes are cut from the measured distribution, not moved to the Sauter diameter.
    diameters = [d for d, _ in particle.size_classes]
    assert diameters == pytest.approx([d for d, _ in sizes])
    assert diameters == sorted(diameters)


def test_many_lognormal_classes_are_a_drawn_distribution(rng):
    """A million drawn grains, weighed class by class."""
    drawn = np.sort(rng.lognormal(math.log(1e-3), 0.25, 1_000_000))
    mass = np.cumsum(drawn**3)
    cuts = np.searchsorted(mass, mass[-1] * np.array([0.25, 0.5, 0.75]))
    parts = np.split(drawn, cuts)
    expected = [(one**3).sum() / (one**2).sum() for one in parts]
    classes = lognormal_classes(1e-3, 0.25, 4)
    # Three standard errors of what a million grains tell of the largest quarter of the mass.
    assert [d for d, _ in classes] == pytest.approx(expected, rel=5e-3)


def test_number_and_mass_quantiles_of_one_bulk_are_the_same_bulk():
    """The mass distribution of log-normal grains lies at exp(3 s^2) times the number's."""
    number = {"d10_um": 800.0, "d50_um": 1000.0, "d90_um": 1250.0}
    factor = math.exp(3.0 * quantile_spread(800.0, 1250.0) ** 2)
    mass = {name: factor * value for name, value in number.items()} | {"quantiles_of": "mass"}
    one, other = (described(lognormal_classes=5, **given) for given in (number, mass))
    assert one.d32_m == pytest.approx(other.d32_m)
    assert np.array(one.size_classes) == pytest.approx(np.array(other.size_classes))


def test_mass_quantiles_without_classes_are_the_sieve_table_of_the_same_shares():
    quantiles = {"d10_um": 800.0, "d50_um": 1000.0, "d90_um": 1250.0, "quantiles_of": "mass"}
    weighed = described(**quantiles).size_classes
    sieved = described(sieve=[[800, 0.3], [1000, 0.4], [1250, 0.3]]).size_classes
    assert np.array(weighed) == pytest.approx(np.array(sieved))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"d32_um": 1000, "sizes": "measured"}, "none were; give d10_um"),
        ({"d32_um": 1000, "lognormal_classes": 5}, "lognormal_classes says more about d10_um"),
        ({"d32_um": 1000, "quantiles_of": "mass"}, "quantiles_of says more about"),
        ({"d32_um": 1000, "coarse_graining": 0.9}, "greater than or equal to 1"),
        ({"d32_um": 1000, "sizes": "some"}, "'one' or 'measured'"),
    ],
)
def test_a_statement_about_sizes_that_means_nothing_is_refused(given, words):
    with pytest.raises(ValueError, match=words):
        described(**given)


@pytest.mark.parametrize("factor", FACTORS)
@pytest.mark.parametrize("experiment", EXPERIMENTS)
@pytest.mark.parametrize("surface", SURFACES)
def test_coarse_grains_keep_apparatus_masses_and_flows(make_spec, particles, experiment, factor,
                                                       surface):  # fmt: skip
    if experiment == "plate_impact" and surface == "glued":
        pytest.skip("never glued")
    grain = particles["Carbo HSP13"]
    fine = build_case(make_spec(experiment, surface=surface))
    coarse = build_case(
        make_spec(experiment, surface=surface, particle=replace(grain, coarse_graining=factor))
    )
    was, now = fine.variables, coarse.variables
    for (large, share), (small, known) in zip(now["sizes"], was["sizes"], strict=True):
        assert large == pytest.approx(factor * small)
        assert share == pytest.approx(known)
    assert now["grain_count"] * factor**3 == pytest.approx(was["grain_count"])
    assert now["grain_rate"] * factor**3 == pytest.approx(was["grain_rate"])
    loss = 1.0 - was["e_pp"] ** 2
    assert 1.0 - now["e_pp"] ** 2 == pytest.approx(factor * loss)
    assert now["skin"] == pytest.approx(factor * was["skin"])
    changed = {"sizes", "grain_count", "grain_rate", "e_pp", "skin", "dt", "about_grains"}
    # Where whole grains appear there is more room, so that their centres have the same.
    room = {"spout", "spout_radius", "spouts", "domain"}
    assert changed <= {name for name in was if was[name] != now[name]} <= changed | room
    # All stays where it is, but for the planes below the pour and above the rims of the boxes.
    same = [name for name in fine.meshes if name not in ("landing", "outlet")]
    assert all((coarse.meshes[name] == fine.meshes[name]).all() for name in same)


def test_energy_lost_among_coarse_grains_is_that_of_the_real_ones():
    """Eq. 20: N grains in a volume, diameter d, lose N z m (1 - e^2) with z ~ d^2 N, m ~ d^3."""
    for factor in FACTORS:
        coarse = coarse_restitution(0.742, factor)
        rates = [
            number * (d**2 * number) * d**3 * (1.0 - e**2)
            for number, d, e in ((1.0, 1.0, 0.742), (factor**-3, factor, coarse))
        ]
        assert rates[1] == pytest.approx(rates[0])
    assert coarse_restitution(0.3, 1.0) == 0.3


@given(st.floats(0.06, 0.99), st.floats(1.0001, 10.0))
def test_a_refused_factor_names_values_that_are_taken(restitution, factor):
    try:
        assert 0.05 < coarse_restitution(restitution, factor) <= restitution
    except CaseError as err:
        words = str(err).replace(",", "").split()
        assert f"{factor:g}" in words[2]
        lowest = float(words[words.index("raise") + 3])
        assert lowest > restitution
        if lowest < 1.0:
            assert coarse_restitution(lowest, factor) > 0.05
        if "take" in words:
            largest = float(words[words.index("take") + 3])
            assert largest < factor
            assert coarse_restitution(restitution, largest) > 0.05


def test_a_factor_without_a_real_restitution_is_refused_by_its_case(make_spec, particles):
    coarse = replace(particles["Carbo HSP13"], coarse_graining=2.5)
    with pytest.raises(CaseError, match=r"coarse_graining = 2.5 with e_pp = 0.742: .* 2.217 or l"):
        script_of(make_spec(particle=coarse))


def test_a_mixture_of_coarse_grains_is_that_of_the_real_ones_enlarged(measured):
    coarse = replace(measured, coarse_graining=1.5)
    for spread in (0.0, 0.5, 1.0):
        fine = mixture(measured, spread)
        assert mixture(coarse, spread) == [
            (pytest.approx(1.5 * d), pytest.approx(mass)) for d, mass in fine
        ]
