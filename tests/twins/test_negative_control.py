"""Small errors are found: a law wrong by one part in a million, a rule that is not LIGGGHTS'.

The error is put into the twin; for the comparison that is the same as an error in the engine.
"""

from __future__ import annotations

from collections.abc import Callable
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import Phase, given, settings

from tests.twins.compare import check_lists, check_scene
from tests.twins.scene import Scene
from tests.twins.slow import laws, search, step, triangle, walls
from tests.twins.slow.touch import Body, Touch
from tests.twins.strategies import examples, scenes

WRONG = 1.0 + 1e-6
ENOUGH = 150  # scenes; most errors show in the first ten
Check = Callable[[Scene], object]


def with_wrong_limit(touch: Touch, slip: laws.Slip, s: np.ndarray) -> laws.Pull:
    """Return friction with a limit that is too high."""
    return laws.with_history(touch, slip._replace(limit=slip.limit * WRONG), s)


def with_wrong_resistance(touch: Touch, roll: laws.Roll, m: np.ndarray) -> laws.Pull:
    """Return a rolling torque with a resistance that is too high."""
    return laws.epsd2(touch, roll._replace(resistance=roll.resistance * WRONG), m)


def wrong_area(touch: Touch) -> float:
    """Return a cohesion area too large."""
    return WRONG * laws.sjkr(touch)


def wrong_edge(nodes: np.ndarray, x: np.ndarray, edge: int) -> triangle.Feature:
    """Return a point of an edge that is a little beside the nearest."""
    s, length = triangle._along(nodes, x, edge)
    return triangle._point_of_edge(nodes, x, edge, s / length * (1.0 - 1e-4))


def wrong_features(nodes: np.ndarray, limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Return common edges that both triangles take."""
    del limit
    return np.ones((len(nodes), 3), bool), np.ones((len(nodes), 3), bool)


def wrong_mass(i: Body, j: Body, d: np.ndarray) -> Touch:
    """Return a contact that does not know what is frozen."""
    return Touch.of(i._replace(frozen=False), j._replace(frozen=False), d)


class WrongTouch:
    """Stands for `Touch` in `step`."""

    of = staticmethod(wrong_mass)


def forgetful(twin: step.Twin, i: int, j: int) -> None:
    """Forget the history of a pair as soon as it separates."""
    twin.pairs.pop((i, j))


ERRORS = {
    "friction": (patch.dict(laws.TANGENTIAL, history=with_wrong_limit), check_scene, {}),
    "rolling": (patch.dict(laws.ROLLING, epsd2=with_wrong_resistance), check_scene, {}),
    "cohesion": (patch.dict(laws.COHESION, sjkr=wrong_area), check_scene, {}),
    "frozen": (patch.object(step, "Touch", WrongTouch), check_scene, {"walls": ()}),
    "edge": (patch.object(triangle, "_on_edge", wrong_edge), check_scene, {"walls": ("mesh",)}),
    "shared edge": (
        patch.object(walls, "active_features", wrong_features), check_scene, {"walls": ("mesh",)},
    ),
    "separation": (
        patch.object(step.Twin, "_part", forgetful), check_scene,
        {"walls": (), "runs": ((1, 40),)},
    ),
    "images": (
        patch.object(search, "nearest_image", lambda scene, d: d), check_lists, {"walls": ()},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(ERRORS))
def test_a_wrong_law_is_found(name: str):
    error, check, words = ERRORS[name]
    drawn = {"runs": ((1,), (5,)), "ways": ("still",), **words}

    @settings(examples(ENOUGH), max_examples=ENOUGH, phases=[Phase.generate])
    @given(scenes(**drawn))
    def compare(scene: Scene) -> None:
        check(scene)

    with error, pytest.raises(AssertionError):
        compare()
