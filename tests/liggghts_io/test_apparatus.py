"""Every number of an apparatus has limits: inside them a case is written, outside it is refused."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from liggghts_io import CaseError, CaseSpec
from liggghts_io.case.spec import script_of
from liggghts_io.experiments import EXPERIMENTS, SCALES
from tests.liggghts_io.conftest import PARAMETERS, PARTICLES

EVERY = [(e, p) for e in sorted(EXPERIMENTS) for p in EXPERIMENTS[e].parameters]
NAMES = [f"{experiment}-{one.name}" for experiment, one in EVERY]


@pytest.mark.parametrize(("experiment", "one"), EVERY, ids=NAMES)
def test_the_value_of_every_scale_is_inside_its_limits(experiment, one):
    low, high = one.limits
    assert low < high < math.inf
    for scale in SCALES:
        one.check(getattr(one, scale))


@pytest.mark.parametrize(("experiment", "one"), EVERY, ids=NAMES)
def test_every_number_says_its_unit_its_meaning_and_where_it_comes_from(experiment, one):
    assert one.unit
    assert one.meaning
    sources = ("Grobbel et al. 2019, ", "paper: ", "ours", "nuisance, ")
    assert one.source.startswith(sources), experiment


@pytest.mark.parametrize(("experiment", "one"), EVERY, ids=NAMES)
def test_a_value_outside_is_refused_with_name_value_limits_and_meaning(make_spec, experiment, one):
    low, high = one.limits
    for value in (low - 1.0, high * 1.001 + 1.0, math.nan, math.inf, -math.inf):
        with pytest.raises(CaseError) as caught:
            script_of(make_spec(experiment, apparatus={one.name: value}))
        for words in (experiment, f"{one.name} = {value:g}", f"{high:g}", one.meaning):
            assert words in str(caught.value)


@pytest.mark.parametrize(
    ("experiment", "override"),
    [
        ("heap", {"frames": 0.0}),
        ("heap", {"frames": 7.5}),
        ("heap", {"pour_stages": 0.0}),
        ("heap", {"pour_stages": 1e5}),
        ("heap", {"slice_width_d": 0.0}),
        ("heap", {"pour_grains": 0.0}),
        ("heap", {"timestep_fraction": 1e-30}),
        ("heap", {"flank_low": 0.5, "flank_high": 0.4}),
        ("heap", {"frames": 5.0, "settle_tau": 1e5}),
        ("conveyor", {"timestep_fraction": 0.0}),
        ("plate_impact", {"box_2_far_m": 0.03}),
        ("plate_impact", {"spout_radius_m": 0.05}),
    ],
)
def test_known_traps_are_refused_at_once(make_spec, experiment, override):
    started = time.process_time()
    with pytest.raises(CaseError, match=next(iter(override))):
        script_of(make_spec(experiment, apparatus=override))
    assert time.process_time() - started < 2.0


@given(data=st.data())
@settings(max_examples=150, deadline=None)
def test_any_apparatus_gives_a_script_or_a_refusal(data):
    """Values inside the limits, at their ends and beyond, several at once."""
    experiment = EXPERIMENTS[data.draw(st.sampled_from(sorted(EXPERIMENTS)))]
    chosen = data.draw(st.lists(st.sampled_from(experiment.parameters), max_size=4))
    override = {}
    for one in chosen:
        low, high = one.limits
        inside = st.floats(low, high).map(lambda x, one=one: float(round(x)) if one.whole else x)
        wild = st.floats(allow_nan=True, allow_infinity=True)
        override[one.name] = data.draw(st.one_of(inside, st.sampled_from([low, high]), wild))
    spec = CaseSpec(
        experiment=experiment.name,
        particle=PARTICLES["Carbo HSP13"],
        surface=data.draw(st.sampled_from(["steel", "glued"])),
        scale=data.draw(st.sampled_from(SCALES)),
        parameters=PARAMETERS,
        apparatus=override,
        seed=data.draw(st.integers(-(10**12), 10**12)),
    )
    with suppress(CaseError):
        assert "run " in script_of(spec)


@pytest.mark.parametrize("seed", [-3, 0, 2**31])
def test_a_seed_outside_its_range_is_refused(make_spec, seed):
    with pytest.raises(CaseError, match=f"seed = {seed}: give a whole number from 1"):
        script_of(make_spec(seed=seed))


def test_a_run_of_too_many_steps_or_grains_is_refused(make_spec):
    endless = {"pour_tau": 1e5, "settle_tau": 1e5, "timestep_fraction": 1e-3}
    with pytest.raises(CaseError, match="time steps; at most 1e"):
        script_of(make_spec(apparatus=endless))
    much = {"poured_mass_kg": 100.0, "length_fraction": 1.0, "width_fraction": 1.0}
    fine = replace(PARTICLES["Carbo HSP13"], d32_m=1e-5)
    with pytest.raises(CaseError, match=r"grains; at most 1e\+08"):
        script_of(make_spec("conveyor", particle=fine, apparatus=much))
