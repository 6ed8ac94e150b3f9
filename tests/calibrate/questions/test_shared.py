"""Several materials and walls at once: what they share is known better, and costs no run twice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibrate.questions.core.design import first_cases
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.joint.calibration import calibrate_jointly
from calibrate.questions.joint.result import JointResult
from tests.calibrate.questions import planted
from tests.calibrate.questions.planted import TRUTH, Measurement, planted_study

CONVEYOR = "conveyor", "t100_s"


def wall_of(material: str, surface: str) -> list[Measurement]:
    return [
        Measurement(material, surface, "heap", "angle_deg"),
        Measurement(material, surface, *CONVEYOR),
    ]


def on_one_wall(folder: Path, materials: str, seed: int) -> JointResult:
    """Return the result of materials that share the friction of the wall."""
    folder.mkdir(exist_ok=True)
    measured = [m for one in materials for m in wall_of(one, "steel")]
    data = planted_study(
        folder, measured, np.random.default_rng(seed),
        truths={"A": {"mu_pp": 0.35}, "B": {"mu_pp": 0.55}}, free=("mu_pp", "mu_pw"),
        scopes={"mu_pw": "surface"}, design="runs = 160",
    )  # fmt: skip
    return calibrate_jointly(data, planted.run)


@pytest.fixture(scope="module")
def two_materials(tmp_path_factory):
    """Return results of one material, and of two that share the friction of the wall."""
    return {one: on_one_wall(tmp_path_factory.mktemp(one), one, 3) for one in ("A", "AB")}


@pytest.mark.slow
def test_intervals_of_two_materials_cover(tmp_path) -> None:
    truths = {"mu_pp[A]": 0.35, "mu_pp[B]": 0.55, "mu_pw": TRUTH["mu_pw"]}
    inside = []
    for seed in range(4):
        posterior = on_one_wall(tmp_path / str(seed), "AB", seed).posterior
        spans = {name: posterior.interval(name, 0.9) for name in truths}
        inside += [spans[name].low <= truth <= spans[name].high for name, truth in truths.items()]
    # Of 12 honest intervals fewer than 8 cover once in 2000 times, were they independent.
    assert np.mean(inside) >= 8 / 12


@pytest.mark.slow
def test_what_two_materials_share_is_known_better(two_materials) -> None:
    widths = {}
    for name, result in two_materials.items():
        span = result.posterior.interval("mu_pw", 0.68)
        widths[name] = span.high - span.low
    # Two equal measurements narrow by 0.71; emulators and the shape of the response vary it.
    assert 0.5 < widths["AB"] / widths["A"] < 0.9


@pytest.mark.slow
def test_a_second_material_costs_in_proportion(two_materials) -> None:
    counts = {name: len(result.runs) for name, result in two_materials.items()}
    assert counts["AB"] < 2.2 * counts["A"]


def test_two_flat_walls_run_the_same_cases(tmp_path, rng) -> None:
    one = planted_study(tmp_path, wall_of("A", "steel"), rng, free=("mu_pp", "mu_pw"))
    specs = first_cases(one.study, forms_of(one), np.random.default_rng(1))
    both = [*wall_of("A", "steel"), *wall_of("A", "alumina")]
    two = planted_study(tmp_path, both, rng, free=("mu_pp", "mu_pw"))
    again = first_cases(two.study, forms_of(two), np.random.default_rng(1))
    assert again == specs


@pytest.mark.slow
def test_one_material_on_two_walls(tmp_path) -> None:
    measured = [*wall_of("A", "steel"), *wall_of("A", "alumina")]
    data = planted_study(
        tmp_path, measured, np.random.default_rng(4), free=("mu_pp", "mu_pw"),
        truths={"alumina": {"mu_pw": 0.45}}, design="runs = 160",
    )  # fmt: skip
    posterior = calibrate_jointly(data, planted.run).posterior
    assert set(posterior.names) == {"mu_pp", "mu_pw[A/steel]", "mu_pw[A/alumina]"}
    for name, truth in {"mu_pp": 0.45, "mu_pw[A/steel]": 0.3, "mu_pw[A/alumina]": 0.45}.items():
        span = posterior.interval(name, 0.95)
        assert span.low <= truth <= span.high
