"""A whole time step, slowly: velocity Verlet in the order of operations of LIGGGHTS 3.8.0.

Half kick and move; meshes move; new lists if it is time; contact forces with the half-step
velocities, pairs first, then walls in the order of the script; weight; second half kick. A run
begins with new lists and with forces of the full-step velocities, which leave histories alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tests.twins.scene import Model, Scene
from tests.twins.slow.contact import contact
from tests.twins.slow.search import nearest_image, pairs_near, wrapped
from tests.twins.slow.touch import Body, History, Materials, Touch
from tests.twins.slow.walls import Surface, move, nearest_of_primitive

Key = tuple[int, int]


@dataclass
class Outcome:
    """What a simulation came to; arrays by id.

    Attributes
    ----------
    x, v, w, force, torque : ndarray, shape (n, 3)
        Positions without wrapping, m.
    pairs : dict
        History by ids (smaller first), as the smaller one sees it, of pairs that have touched.
    primitives, triangles : dict
        History by id and number of the wall, or of the triangle.
    near_pairs, near_primitives, near_triangles : set
        Candidates of the last search.
    held : ndarray, shape (n, 3)
        Positions at the last search.
    builds : int
        Searches.
    skin : float
        That the candidates were sought with, m.
    lasted : bool
        Whether they have served for searches since.
    """

    x: np.ndarray
    v: np.ndarray
    w: np.ndarray
    force: np.ndarray
    torque: np.ndarray
    pairs: dict[Key, History]
    primitives: dict[Key, History]
    triangles: dict[Key, History]
    near_pairs: set[Key] = field(default_factory=set)
    near_primitives: set[Key] = field(default_factory=set)
    near_triangles: set[Key] = field(default_factory=set)
    held: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    builds: int = 0
    skin: float = 0.0
    lasted: bool = False


@dataclass
class Twin:
    """The slow engine.

    Attributes
    ----------
    undecided : bool
        True if a contact was where rounding decides, see `contact.Result.tie`.
    parted : dict
        Stiffness of adhesion, which LIGGGHTS leaves where it clears the rest of a history.
    """

    scene: Scene
    pairs: dict[Key, History] = field(default_factory=dict)
    primitives: dict[Key, History] = field(default_factory=dict)
    triangles: dict[Key, History] = field(default_factory=dict)
    builds: int = 0
    undecided: bool = False
    parted: dict[Key, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Place spheres and meshes."""
        spheres = self.scene.spheres
        self.x, self.v, self.w = (
            np.array([getattr(sphere, name) for sphere in spheres]) for name in "xvw"
        )
        self.turns = np.zeros((len(spheres), 3))
        self.radius = np.array([sphere.radius for sphere in spheres])
        self.mass = np.array([sphere.mass for sphere in spheres])
        self.force, self.torque = np.zeros_like(self.x), np.zeros_like(self.x)
        self.materials = Materials(self.scene.materials)
        self.surfaces = [Surface(mesh) for mesh in self.scene.meshes]
        ids = np.arange(1, len(spheres) + 1)
        self.frozen = np.isin(ids, self.scene.frozen)
        self.free = ~np.isin(ids, self.scene.loose)
        self.part = np.isin(ids, self.scene.part)
        self.near: set[Key] = set()
        self.time, self.ago, self.renew = 0.0, 0, False

    def run(self) -> Outcome:
        """Make all runs of the scene."""
        for steps in self.scene.runs:
            self._search()
            if self.scene.moves_first:
                for surface in self.surfaces:
                    if surface.mesh.motion:
                        surface.v[:] = 0.0
            self._forces(advance=False)
            for _ in range(steps):
                self._step()
        length = 2.0 * np.array(self.scene.size)
        return Outcome(
            self.x + self.turns * length, self.v, self.w, self.force, self.torque,
            self.pairs, self.primitives, self.triangles, builds=self.builds,
        )  # fmt: skip

    def _kick(self) -> None:
        half = 0.5 * self.scene.dt * self.free[:, None]
        inertia = 0.4 * self.mass * self.radius**2
        self.v = self.v + half * self.force / self.mass[:, None]
        self.w = self.w + half * self.torque / inertia[:, None]

    def _step(self) -> None:
        scene = self.scene
        self._kick()
        self.x = self.x + scene.dt * self.v * self.free[:, None]
        self.time += scene.dt
        for surface in self.surfaces:
            move(surface, self.time, scene.dt)
        if self._search_is_due():
            self._search()
        self._forces(advance=True)
        self._kick()

    # -- neighbour search --------------------------------------------------------------------------

    def _search_is_due(self) -> bool:
        """Return True if new lists are made in this step."""
        scene = self.scene
        if self.renew:
            return True
        self.ago += 1
        due = self.ago >= scene.delay and self.ago % scene.every == 0
        if due and scene.check:
            due = (np.linalg.norm(self.x - self.held, axis=1) > 0.5 * scene.skin).any()
        if not due:  # meshes that have moved far ask for the next step
            moved = [s.nodes - held for s, held in zip(self.surfaces, self.held_nodes, strict=True)]
            self.renew = any(
                (np.linalg.norm(shift, axis=2) > 0.5 * scene.skin).any() for shift in moved
            )
        return bool(due)

    def _search(self) -> None:
        """Wrap positions, make lists; pairs that do not overlap now forget."""
        x = wrapped(self.scene, self.x)
        self.turns = self.turns + np.rint((self.x - x) / (2.0 * np.array(self.scene.size)))
        self.x, self.held = x, x.copy()
        self.held_nodes = [surface.nodes.copy() for surface in self.surfaces]
        self.near = pairs_near(self.scene, x)
        self.parted = {}
        self.pairs = {key: found for key, found in self.pairs.items() if self._overlap(*key)}
        self.builds += 1
        self.ago, self.renew = 0, False

    def _between(self, i: int, j: int) -> np.ndarray:
        """Return the vector from sphere j to sphere i."""
        return nearest_image(self.scene, self.x[i - 1] - self.x[j - 1])

    def _overlap(self, i: int, j: int) -> bool:
        return bool(np.linalg.norm(self._between(i, j)) < self.radius[i - 1] + self.radius[j - 1])

    # -- forces ------------------------------------------------------------------------------------

    def _forces(self, *, advance: bool) -> None:
        self.force, self.torque = np.zeros_like(self.x), np.zeros_like(self.x)
        for i, j in sorted(self.near):
            self._pair(i, j, advance=advance)
        for number in range(len(self.scene.spheres)):
            self._walls(number, advance=advance)
        weight = self.mass[:, None] * np.array(self.scene.gravity)
        self.force += weight * self.part[:, None]
        self.force[self.frozen] = 0.0
        self.torque[self.frozen] = 0.0

    def _body(self, number: int) -> Body:
        return Body(
            self.v[number], self.w[number], self.scene.spheres[number].kind, self.radius[number],
            self.mass[number], bool(self.frozen[number]),
        )  # fmt: skip

    def _pair(self, i: int, j: int, *, advance: bool) -> None:
        if not self._overlap(i, j):
            if (i, j) in self.pairs:
                self._part(i, j)
            return
        touch = Touch.of(self._body(i - 1), self._body(j - 1), self._between(i, j))
        history = self.pairs.get((i, j), History(adhesion=self.parted.get((i, j), 0.0)))
        found = contact(
            self.scene.model, self.materials, touch, history, dt=self.scene.dt, advance=advance
        )
        self.undecided |= found.tie
        self.pairs[i, j] = found.history
        self.force[i - 1] += found.force
        self.force[j - 1] -= found.force
        self.torque[i - 1] += found.torque
        self.torque[j - 1] += found.torque_other

    def _part(self, i: int, j: int) -> None:
        """Let a pair forget its impact; all of it if surfaces count as close without contact."""
        close = self.scene.factor * (self.radius[i - 1] + self.radius[j - 1])
        if self.scene.factor > 1.0 and np.linalg.norm(self._between(i, j)) < close:
            self.parted[i, j] = self.pairs.pop((i, j)).adhesion
        else:  # as in LIGGGHTS, until the next search
            self.pairs[i, j] = replace(self.pairs[i, j], impact=0.0)

    def _walls(self, number: int, *, advance: bool) -> None:
        """Add the forces of all walls on a sphere."""
        x, radius = self.x[number], self.radius[number]
        kept = {}
        for w, wall in enumerate(self.scene.primitives):
            if wall.part and not self.part[number]:
                continue
            found = nearest_of_primitive(wall, x)
            if found is None or np.linalg.norm(found.d) > radius:
                continue
            history = self.primitives.get((number + 1, w), History())
            body = Body(found.v, np.zeros(3), wall.kind)
            kept[number + 1, w] = self._wall(number, body, found.d, wall.model, history, advance)
        self._keep(self.primitives, number, kept)
        first, kept = 0, {}
        for surface in self.surfaces:
            kept |= self._surface(number, surface, first, advance)
            first += len(surface.nodes)
        self._keep(self.triangles, number, kept)

    def _keep(self, table: dict[Key, History], number: int, kept: dict[Key, History]) -> None:
        """Replace the wall histories of a sphere."""
        for key in [key for key in table if key[0] == number + 1]:
            del table[key]
        table.update(kept)

    def _surface(
        self, number: int, surface: Surface, first: int, advance: bool
    ) -> dict[Key, History]:
        """Add the forces of a mesh whose triangles count from `first`."""
        now: dict[int, History] = {}
        count = range(len(surface.nodes))
        before = {
            t: self.triangles[number + 1, first + t]
            for t in count
            if (number + 1, first + t) in self.triangles
        }
        for t in count:
            found = surface.nearest(t, self.x[number])
            if found is None:
                continue
            gap = float(np.linalg.norm(found.d)) - self.radius[number]
            if gap > 0.0 and gap >= (self.scene.factor - 1.0) * self.radius[number]:
                continue
            history = before.get(t)
            if history is None:
                history = History()
                beside = [u for u in {**before, **now} if surface.coplanar_neighbours(t, u)]
                if found.face and any(u in now for u in beside):
                    continue  # this plane has pushed already
                if found.face and beside:
                    history = before[max(beside)]
            if gap > 0.0:  # close only: it has no force, but keeps coplanar neighbours out
                now[t] = History()
                continue
            body = Body(found.v, np.zeros(3), surface.mesh.kind)
            model = self.scene.mesh_model
            now[t] = self._wall(number, body, found.d, model, history, advance)
        return {(number + 1, first + t): history for t, history in now.items()}

    def _wall(
        self, number: int, wall: Body, d: np.ndarray, model: Model, history: History, advance: bool
    ) -> History:
        touch = Touch.of(self._body(number), wall, d)
        found = contact(model, self.materials, touch, history, dt=self.scene.dt, advance=advance)
        self.undecided |= found.tie
        self.force[number] += found.force
        self.torque[number] += found.torque
        return found.history
