"""Head-on impacts: tests 1 to 3 of Chung and Ooi, and what the given restitution means.

Numbers: Chung and Ooi, Granular Matter 13 (2011) 643, as the verification scripts of YADE (tests 1
to 4) and Kratos (4 and 8) digitised them. A "rigid" plane is a thousand times stiffer than the
sphere, as in those scripts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.minidem.laws.impact_scripts import (
    ALUMINIUM,
    GLASS,
    IRON,
    LIMESTONE,
    MAGNESIUM,
    NO_WEIGHT,
    OXIDE,
    damping_of,
    duration,
    impacts,
    nominal_of,
    rebound,
    thornton,
)  # fmt: skip
from tests.minidem.laws.law_scripts import Ball, Scene, run


@pytest.mark.parametrize(
    ("material", "depth", "force", "time"),
    [(GLASS, 274.1e-6, 10.70e3, 40.3e-6), (LIMESTONE, 368.3e-6, 7.11e3, 54.2e-6)],
)
def test_1_two_spheres_meet_head_on(tmp_path, material, depth, force, time):
    young, poisson, density = material
    balls = (
        Ball((0.0, 0.0, 0.0), (0.0, 0.0, 10.0), radius=0.01, density=density),
        Ball((0.0, 0.0, 0.020001), (0.0, 0.0, -10.0), radius=0.01, density=density),
    )
    scene = Scene(
        balls, restitution=1.0, young=young, poisson=poisson, floor=False, gravity=NO_WEIGHT,
        dt=time / 1000,
    )  # fmt: skip
    track = run(scene, tmp_path, 1100, 1)
    overlap = 0.02 - (track.x[:, 1, 2] - track.x[:, 0, 2])
    # the expected values are rounded to three and four digits
    assert overlap.max() == pytest.approx(depth, rel=1e-3)
    assert np.abs(track.f[:, 0, 2]).max() == pytest.approx(force, rel=1e-3)
    assert np.count_nonzero(overlap > 0.0) * scene.dt == pytest.approx(time, rel=3e-3)
    np.testing.assert_allclose(track.v[-1, :, 2], [-10.0, 10.0], rtol=1e-5)


@pytest.mark.parametrize(
    ("material", "radius", "speed", "depth", "force", "time"),
    [
        (ALUMINIUM, 0.1, 0.2, 49.7e-6, 11.37e3, 732e-6),
        (MAGNESIUM, 0.1, 0.2, 52.1e-6, 7.23e3, 767e-6),
        (OXIDE, 0.0025, 3.9, 8.09e-6, 615.0, 6.10e-6),
        (IRON, 0.0025, 3.9, 17.2e-6, 507.0, 13.0e-6),
    ],
)
def test_2_and_3_sphere_on_a_rigid_plane(tmp_path, material, radius, speed, depth, force, time):
    young, poisson, density = material
    scene = Scene((), restitution=1.0, friction=0.0, young=young, poisson=poisson)
    track = impacts(
        np.array([[0.0, 0.0, -speed]]), tmp_path, scene, radius, density, parts=1000, every=1
    )
    overlap = radius - track.x[:, 0, 2]
    dt = duration(scene, speed, track.mass[0], radius) / 1000
    # the wall's share of E* and the rounding of the expected values are below 0.3 %
    assert overlap.max() == pytest.approx(depth, rel=3e-3)
    assert track.f[:, 0, 2].max() == pytest.approx(force, rel=3e-3)
    assert np.count_nonzero(overlap > 0.0) * dt == pytest.approx(time, rel=5e-3)


RESTITUTIONS = (0.2, 0.4, 0.6, 0.8)


@pytest.mark.parametrize("e", RESTITUTIONS)
def test_3_restitution_is_met_only_with_tension_at_separation(tmp_path, e):
    young, poisson, density = OXIDE
    scene = Scene((), restitution=e, friction=0.0, young=young, poisson=poisson)
    found = {}
    for settings in ("", "limitForce on"):
        folder = tmp_path / (settings or "default").replace(" ", "_")
        folder.mkdir()
        track = impacts(
            np.array([[0.0, 0.0, -3.9]]), folder, replace(scene, wall_settings=settings), 0.0025,
            density, parts=4000,
        )  # fmt: skip
        found[settings] = float(track.v[-1, 0, 2]) / 3.9
    # 4000 steps a contact: the first-order error of damping in velocity Verlet is 1e-4 to 5e-4
    assert found[""] == pytest.approx(e, rel=1e-3)
    # exact: Antypov and Elliott, EPL 94 (2011) 50004
    assert rebound(damping_of(e), tension=True) == pytest.approx(e, rel=1e-6)
    assert found["limitForce on"] == pytest.approx(rebound(damping_of(e), tension=False), rel=1e-3)
    assert found["limitForce on"] > 1.005 * e


# 0.2 would need a nominal value below the 0.05 that LIGGGHTS accepts
@pytest.mark.parametrize("e", RESTITUTIONS[1:])
def test_3_without_tension_the_fit_of_thornton_meets_restitution(tmp_path, e):
    young, poisson, density = OXIDE
    fitted = nominal_of(thornton(e))
    scene = Scene(
        (), restitution=fitted, friction=0.0, young=young, poisson=poisson,
        wall_settings="limitForce on",
    )  # fmt: skip
    track = impacts(np.array([[0.0, 0.0, -3.9]]), tmp_path, scene, 0.0025, density, parts=4000)
    # the fit itself is good to about 0.13 %
    assert track.v[-1, 0, 2] / 3.9 == pytest.approx(e, rel=2.5e-3)
