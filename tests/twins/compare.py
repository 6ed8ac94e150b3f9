"""Compare engine and twin, every quantity on the scale on which its rounding shows."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import reject

from tests.twins import fast
from tests.twins.scene import Scene
from tests.twins.slow.search import pairs_near, primitives_near, triangles_near
from tests.twins.slow.step import Key, Outcome, Twin
from tests.twins.slow.touch import History
from tests.twins.slow.walls import Surface

TOLERANCE = 1e-10
"""Of the scales of `differences`. Measured in some thousand scenes: up to 1e-12, which is the
rounding of coordinates (1e-17 m) in an overlap of 1e-5 m, grown in twenty steps."""


def check_scene(scene: Scene) -> Outcome:
    """Run a scene on both engines; fail if they differ. Returns what the fast one came to."""
    with tempfile.TemporaryDirectory() as folder:
        found = fast.run(scene, Path(folder))
    twin = Twin(scene)
    slow = twin.run()
    if twin.undecided:
        reject()
    apart = differences(scene, found, slow)
    worst = {name: value for name, value in apart.items() if not value <= TOLERANCE}
    assert not worst, f"{worst}\n{scene.script()}"
    return found


def check_lists(scene: Scene) -> None:
    """Compare the lists of the last search with what is near in fact."""
    with tempfile.TemporaryDirectory() as folder:
        found = fast.run(scene, Path(folder))
    surfaces = [Surface(mesh) for mesh in scene.meshes]
    assert found.near_pairs >= pairs_near(scene, found.held)
    assert found.near_primitives >= primitives_near(scene, found.held)
    assert found.near_triangles >= triangles_near(scene, surfaces, found.held)
    if found.lasted:
        return  # they were made elsewhere
    scene = replace(scene, skin=found.skin)
    assert found.near_pairs == pairs_near(scene, found.held)
    assert found.near_primitives == primitives_near(scene, found.held)
    # the list of triangles may be generous, but not beyond their planes
    assert found.near_triangles >= triangles_near(scene, surfaces, found.held)
    planes = [(surface.nodes[t, 0], surface.normal(t))
              for surface in surfaces for t in range(len(surface.nodes))]  # fmt: skip
    for i, t in found.near_triangles:
        point, normal = planes[t]
        reach = scene.spheres[i - 1].radius + scene.skin
        assert abs(float((found.held[i - 1] - point) @ normal)) <= reach * (1.0 + 1e-12)


def differences(scene: Scene, fast: Outcome, slow: Outcome) -> dict[str, float]:
    """Return the largest difference of every quantity as a fraction of its scale.

    Forces and torques round like the largest force, velocities like the largest velocity at a
    surface, histories like what moves in a step or, if that is more, like the largest history.
    """
    radius = max(sphere.radius for sphere in scene.spheres)
    inner = float(max(np.abs(slow.force).max(), np.abs(slow.torque).max() / radius, _weight(scene)))
    speed = float(max(np.abs(slow.v).max(), np.abs(slow.w).max() * radius))
    found = {
        "position": _apart(fast.x, slow.x, radius),
        "velocity": _apart(fast.v, slow.v, speed),
        "spin": _apart(fast.w * radius, slow.w * radius, speed),
        "force": _apart(fast.force, slow.force, inner),
        "torque": _apart(fast.torque, slow.torque, inner * radius),
    }
    for name in ("pairs", "primitives", "triangles"):
        mine, other = (_seen(scene, getattr(side, name)) for side in (fast, slow))
        if set(mine) != set(other):
            found[f"{name} in contact: {sorted(set(mine) ^ set(other))}"] = np.inf
            continue
        found |= _histories(name, mine, other, speed * scene.dt, inner * radius, speed)
    if fast.builds != slow.builds:
        found[f"searches: {fast.builds}, {slow.builds}"] = np.inf
    return found


def _weight(scene: Scene) -> float:
    """Return the largest weight, N."""
    strength = float(np.linalg.norm(scene.gravity))
    return strength * max(sphere.mass for sphere in scene.spheres)


def _seen(scene: Scene, table: Mapping[Key, History]) -> Mapping[Key, History]:
    """Leave out pairs of frozen spheres: nobody feels them, and LIGGGHTS' order decides on them.

    Their effective mass is that of the one that comes first in the list of neighbours.
    """
    still = set(scene.frozen)
    return {key: found for key, found in table.items() if not still >= set(key)}


def _apart(a: np.ndarray, b: np.ndarray, scale: float) -> float:
    worst = float(np.abs(a - b).max(initial=0.0))
    if worst == 0.0:
        return 0.0
    return worst / scale if scale > 0.0 and np.isfinite(worst) else np.inf


def _histories(
    name: str, fast: Mapping[Key, History], slow: Mapping[Key, History], *scales: float
) -> dict[str, float]:
    keys = sorted(fast)
    found = {}
    # largest and latest overlaps round like the positions, and have the size of what moves
    loaded = {"largest": scales[0], "latest": scales[0], "adhesion": 1.0}
    for part, floor in (dict(zip(("s", "m", "impact"), scales, strict=True)) | loaded).items():
        a, b = (
            np.array([np.ravel(getattr(side[key], part)) for key in keys]) for side in (fast, slow)
        )
        a, b = a[~np.isnan(b)], b[~np.isnan(b)]  # the twin's are where rounding decides
        found[f"{name} {part}"] = _apart(a, b, max(floor, float(np.abs(b).max(initial=0.0))))
    return found
