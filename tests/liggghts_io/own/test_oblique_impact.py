"""Oblique impacts: a published misfit of Hertz and Mindlin's contact, and what takes it away."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from liggghts_io import CaseSpec, Particle, execute, read_experiment
from tests.paths import ROOT

CASE = ROOT / "cases" / "oblique_impact"
SPHERE = Particle("aluminium oxide", d32_m=5e-3, density=4000.0)
CONTACT = {
    "mu_pp": 0.1, "mu_roll_pp": 0.0, "mu_roll_pw": 0.0, "e_pp": 0.9, "mu_pw": 0.092, "e_pw": 0.98,
}  # fmt: skip
ERRORS = {"e_t": 0.015, "spin": 15.0, "rebound": 0.5}


def curves(folder, effects: dict[str, float], **more) -> dict[str, np.ndarray]:
    """Return what the spheres do at the measured angles, by curve."""
    own = read_experiment(CASE / "apparatus")
    spec = CaseSpec(
        "oblique_impact", SPHERE, "flat", "quick", CONTACT | more.pop("contact", {}),
        effects=effects, own=own, **more,
    )  # fmt: skip
    result = execute(spec, folder)
    assert result.status == "ok", result.reason
    return {name: pd.read_csv(result.path / f"{name}.csv")["y"].to_numpy() for name in ERRORS}


def misfit(found: dict[str, np.ndarray]) -> float:
    """Return the sum of squares of all 23 distances in standard errors."""
    total = 0.0
    for name, error in ERRORS.items():
        measured = pd.read_csv(CASE / f"measured_{name}.csv", comment="#").iloc[:, 1].to_numpy()
        total += float((((found[name] - measured) / error) ** 2).sum())
    return total


def test_a_softer_tangential_spring_takes_the_published_misfit_away(tmp_path):
    base = curves(tmp_path, {})
    # the published discrepancy: 0.79 and 0.75 are measured
    assert base["e_t"][:2] == pytest.approx([0.98, 0.98], abs=0.01)
    soft = curves(tmp_path, {"tangential_stiffness": -0.27}, contact={"mu_pw": 0.096})
    # 23 numbers, three unknowns: 20 expected, 33 once in 28 studies; the base model is beyond 400
    assert misfit(soft) < 45.0 < 400.0 < misfit(base)


@pytest.mark.parametrize("wrong", [{"launcher_angle_deg": -0.44}, {"anvil_poisson_error": 0.05}])
def test_the_apparatus_does_not(tmp_path, wrong):
    # the best angle of all, and the most that Poisson's ratio may be off
    assert misfit(curves(tmp_path, wrong)) > 100.0


@pytest.mark.liggghts
def test_liggghts_gives_the_same(tmp_path):
    ours, theirs = (curves(tmp_path / name, {}, engine=name) for name in ("minidem", "liggghts"))
    for name in ERRORS:
        # the tables of a case have six digits
        np.testing.assert_allclose(ours[name], theirs[name], rtol=1e-5)
