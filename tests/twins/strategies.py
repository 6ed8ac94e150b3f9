"""Random small scenes for hypothesis: structure from hypothesis, numbers from a seed it draws.

Numbers come from a generator because round ones would put spheres exactly on the border between
contact and none, where one rounding decides.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace

import numpy as np
from hypothesis import HealthCheck, assume, settings
from hypothesis import strategies as st

from tests.twins.model_list import ALL_SETTINGS, FEW, MODELS, SETTINGS, without_strays
from tests.twins.scene import Model, Primitive, Scene, Sphere
from tests.twins.slow.search import distance_to_triangle, nearest_image, wrapped
from tests.twins.slow.shapes import MOTIONS, SHAPES, TYPES, WIDE, mesh, primitive
from tests.twins.slow.triangle import unit
from tests.twins.slow.walls import gap_of_primitive, nearest_of_primitive

HALF = 0.05
DEEPEST = 0.9  # of a radius: nothing is nearer to a centre
RANGES = {
    "coefficientRestitution": (0.2, 0.9),
    "coefficientFriction": (0.0, 1.0),
    "coefficientRollingFriction": (0.0, 0.4),
    "coefficientRollingViscousDamping": (0.0, 0.6),
    "cohesionEnergyDensity": (0.0, 1e5),
    "restitutionExponent": (0.0, 0.5),
}
SPEEDS = {
    "characteristicVelocity": (0.5, 3.0),
    "weakeningVelocity": (0.01, 1.0),
    "restitutionVelocity": (0.05, 0.5),
}


RARE = {
    "kn": (500.0, 2e4),
    "kt": (500.0, 2e4),
    "gamman": (100.0, 2000.0),
    "gammat": (100.0, 2000.0),
    "gamman_abs": (0.01, 0.2),
    "gammat_abs": (0.01, 0.2),
    "FluidViscosity": (0.3, 1.0),
    "CriticalStokes": (0.1, 1.0),
    "MaximumRestitution": (0.5, 0.95),
    "LoadingStiffness": (500.0, 1e4),
    "UnloadingStiffness": (1.5, 6.0),
    "coefficientMaxElasticStiffness": (1.5, 6.0),
    "coefficientAdhesionStiffness": (0.0, 1.0),
    "coefficientPlasticityDepth": (0.002, 0.05),
    "pullOffForce": (-5e-3, 5e-3),
    "surfaceEnergy": (0.0, 2.0),
    "FrictionViscosity": (0.1, 1.0),
    "coeffFrictionStiffness": (0.1, 1.0),
    "coeffRollingStiffness": (0.05, 0.5),
}
"""Of models that few scripts have."""
EXPONENTS = {"overlapExponent": (1.0, 1.5), "adhesionExponent": (1.0, 1.5, 2.0)}


def examples(count: int) -> settings:
    """Return settings for a number of scenes, always the same ones.

    The environment variable ``TWINS_EXAMPLES`` sets another number of scenes, new ones every time
    (or those of ``--hypothesis-seed``).
    """
    more = os.environ.get("TWINS_EXAMPLES")
    return settings(
        max_examples=int(more or count),
        derandomize=more is None,
        deadline=None,
        database=None,
        suppress_health_check=[HealthCheck.too_slow],  # says more of the machine than of the test
    )


# -- contact models --------------------------------------------------------------------------------


@st.composite
def any_model(draw: st.DrawFn, known: tuple[str, ...] = ALL_SETTINGS) -> Model:
    """Draw any models of the registry and any of the settings."""
    names = {key: draw(st.sampled_from(found)) for key, found in MODELS.items()}
    on = {setting for setting in known if draw(st.booleans())}
    return without_strays(Model(names, frozenset(on), frozenset(known) - on))


def pair_models(few: bool) -> st.SearchStrategy[tuple[Model, bool]]:
    """Draw a model of pairs, and whether the box is periodic; or one of few, for one box each."""
    if few:
        return st.sampled_from([(model, k % 2 == 1) for k, model in enumerate(FEW)])
    return st.tuples(any_model(), st.booleans())


def base_models() -> st.SearchStrategy[Model]:
    """Draw any model that LIGGGHTS has too."""
    return any_model(tuple(SETTINGS))


def materials(rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Return values of all properties that the stored references of LIGGGHTS have."""
    found = {
        "youngsModulus": rng.uniform(5e6, 2e7, TYPES),
        "poissonsRatio": rng.uniform(0.1, 0.45, TYPES),
    }
    for name, ends in RANGES.items():
        table = rng.uniform(*ends, (TYPES, TYPES))
        found[name] = np.triu(table) + np.triu(table, 1).T
    lift = rng.uniform(0.0, 0.5)
    found["coefficientStaticFriction"] = found["coefficientFriction"] + lift
    return found | {name: np.array(rng.uniform(*ends)) for name, ends in SPEEDS.items()}


def rare_materials(rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Return values of the properties that the other models have."""
    found = {"rollingStiffness": np.array(rng.uniform(1.0, 3.0))}
    for name, ends in RARE.items():
        table = rng.uniform(*ends, (TYPES, TYPES))
        found[name] = np.triu(table) + np.triu(table, 1).T
    for name in ("coefficientAdhesionStiffness", "pullOffForce"):
        found[name] *= rng.choice([0.0, 1.0])
    return found | {name: np.array(rng.choice(values)) for name, values in EXPONENTS.items()}


# -- spheres ---------------------------------------------------------------------------------------


@dataclass
class Heap:
    """Spheres put one by one so that they touch something, or just do not."""

    rng: np.random.Generator
    frame: Scene
    targets: tuple[str, ...]

    def fill(self, count: int) -> tuple[Sphere, ...]:
        """Return up to `count` spheres."""
        found: list[Sphere] = []
        for _ in range(20 * count):
            sphere = self._sphere(found)
            if len(found) < count and self._fits(sphere, found):
                found.append(sphere)
        return tuple(found)

    def _sphere(self, others: list[Sphere]) -> Sphere:
        rng = self.rng
        radius = float(rng.choice([0.002, 0.003, 0.0045]) * rng.uniform(0.9, 1.0))
        near = radius * (1.0 - rng.uniform(-0.005, 0.03))
        x = self._place(others, radius, near)
        x = wrapped(self.frame, x[None])[0]
        return Sphere(
            *(tuple(map(float, vector)) for vector in
              (x, rng.normal(size=3) * 0.5, rng.normal(size=3) * 100.0)),
            radius, float(rng.uniform(1000.0, 3000.0)),
            int(rng.integers(1, TYPES + 1)) if others else 1,  # LIGGGHTS wants a first type
        )  # fmt: skip

    def _place(self, others: list[Sphere], radius: float, near: float) -> np.ndarray:
        """Return a place in contact with what is drawn: a sphere, a wall, a triangle."""
        rng = self.rng
        target = str(rng.choice(self.targets))
        way = unit(rng.normal(size=3))
        if target == "primitive":
            wall = self.frame.primitives[rng.integers(len(self.frame.primitives))]
            x = rng.uniform(-WIDE, WIDE, 3)
            found = nearest_of_primitive(wall, x)
            return x if found is None else x + (near - np.linalg.norm(found.d)) * unit(found.d)
        if target == "triangle":
            body = self.frame.meshes[rng.integers(len(self.frame.meshes))]
            nodes = np.array(body.nodes[rng.integers(len(body.nodes))])
            weights = rng.dirichlet([1.0] * 3) * rng.choice([0, 1, 1], size=3)
            weights = np.eye(3)[rng.integers(3)] if weights.sum() == 0.0 else weights
            return weights / weights.sum() @ nodes + near * way
        if others:
            other = others[rng.integers(len(others))]
            return np.array(other.x) + (other.radius * near / radius + near) * way
        # the first near a periodic face, so that some pairs meet through it
        spread = np.where(self.frame.periodic, 0.1 * WIDE, WIDE)
        return np.where(self.frame.periodic, HALF, 0.0) + rng.uniform(-1.0, 1.0, 3) * spread

    def _fits(self, sphere: Sphere, others: list[Sphere]) -> bool:
        """Return True in the box and without deep overlap, which would shoot the sphere away."""
        x, least = np.array(sphere.x), DEEPEST * sphere.radius
        inside = (np.abs(x) < 0.9 * HALF) | np.array(self.frame.periodic)
        gaps = [
            float(np.linalg.norm(nearest_image(self.frame, x - other.x))) - DEEPEST * other.radius
            for other in others
        ]
        gaps += [gap_of_primitive(wall, x) for wall in self.frame.primitives]
        gaps += [
            distance_to_triangle(np.array(nodes), x)
            for body in self.frame.meshes for nodes in body.nodes
        ]  # fmt: skip
        return bool(inside.all()) and min(gaps, default=least) >= least


# -- scenes ----------------------------------------------------------------------------------------


@st.composite
def scenes(
    draw: st.DrawFn,
    *,
    runs: tuple[tuple[int, ...], ...] = ((1,),),
    walls: tuple[str, ...] = ("plane", "cylinder", "mesh"),
    ways: tuple[str, ...] = ("still", "still", "belt", *MOTIONS),
    extended: bool = True,
    few: bool = False,
) -> Scene:
    """Draw scenes of up to twelve spheres with one to three walls of these kinds, if any.

    `ways` are the motions that meshes may have; without `extended` LIGGGHTS can run the scene. With
    `few` the model of pairs is one of a few.
    """
    others = any_model() if extended else base_models()
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    model, periodic = draw(pair_models(few) if extended else st.tuples(others, st.booleans()))
    faces = tuple(periodic and draw(st.booleans()) for _ in range(3))
    if periodic and not any(faces):
        faces = (True, False, False)
    chosen = draw(st.lists(st.sampled_from(walls), min_size=1, max_size=3)) if walls else []
    primitives = tuple(
        _primitive(draw, rng, kind, draw(st.sampled_from((model, draw(others)))))
        for kind in chosen
        if kind in ("plane", "cylinder")
    )
    meshes = tuple(
        mesh(rng, draw(st.sampled_from(sorted(SHAPES))),
             draw(st.sampled_from(ways)), draw(st.booleans()))
        for kind in chosen if kind == "mesh"
    )  # fmt: skip
    delay, every = draw(st.sampled_from(((0, 1), (0, 1), (5, 1), (0, 3), (6, 3))))
    values = materials(rng)
    values["restitutionDeviation"] = 0.5 * values["coefficientFriction"]
    values["tangentialStiffnessFactor"] = 0.5 + values["coefficientFriction"]
    values |= rare_materials(np.random.default_rng(draw(st.integers(0, 2**32 - 1))))
    frame = Scene(
        model, values, (), draw(st.one_of(st.just(model), others)),
        primitives, meshes, TYPES, (HALF,) * 3, faces,
        skin=draw(st.sampled_from((1e-3, 1e-4))), factor=draw(st.sampled_from((1.0, 1.01))),
        delay=delay, every=every,
        check=draw(st.sampled_from((True, True, False))),
        gravity=tuple(map(float, rng.normal(size=3) * 5.0)) if draw(st.booleans()) else (0.0,) * 3,
        moves_first=draw(st.booleans()), runs=draw(st.sampled_from(runs)),
    )  # fmt: skip
    targets = (
        "sphere",
        *(["primitive"] if primitives else []),
        *(["triangle"] * 3 if meshes else []),
    )
    spheres = Heap(rng, frame, targets).fill(draw(st.sampled_from((2, 3, 6, 12))))
    assume(spheres)
    ids = range(1, len(spheres) + 1)
    part = tuple(k for k in ids if rng.uniform() < 0.7)
    frozen = tuple(k for k in ids if rng.uniform() < 0.3) if draw(st.booleans()) else ()
    loose = tuple(k for k in frozen if rng.uniform() < 0.5)
    return replace(frame, spheres=spheres, part=part, frozen=frozen, loose=loose)


def _primitive(draw: st.DrawFn, rng: np.random.Generator, shape: str, model: Model) -> Primitive:
    """Draw a primitive wall of a model."""
    word, values, shear = primitive(rng, shape, draw(st.booleans()))
    return Primitive(
        model, word, values, int(rng.integers(1, TYPES + 1)), shear, draw(st.booleans())
    )
