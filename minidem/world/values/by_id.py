"""Values that belong to particles, whatever becomes of their rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from minidem.record import field, record
from minidem.world.state import Floats, Ints
from minidem.world.world import World

__all__ = ["ById", "places", "warn_of_joined"]


@record
class ById:
    """Values by particle id.

    Attributes
    ----------
    usual : tuple of float
        Values of particles that have none yet.
    ids : ndarray of int64, shape (n,)
        Ids, ascending.
    values : ndarray, shape (n, columns)
        Their values.
    """

    usual: tuple[float, ...]
    ids: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    values: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    _seen: tuple[Ints, Ints, Floats] | None = None

    def rows(self, world: World) -> Floats:
        """Return the values of the particles in the internal order, shape (n, columns)."""
        return self.of(world.state.ids[: world.state.n])

    def of(self, now: Ints) -> Floats:
        """Return the values of some ids, of particles that have left too, shape (n, columns)."""
        found = np.tile(np.array(self.usual, np.float64), (len(now), 1))
        if len(self.ids):
            at = np.minimum(np.searchsorted(self.ids, now), len(self.ids) - 1)
            known = self.ids[at] == now
            found[known] = self.values[at[known]]
        return found

    def seen(self, world: World) -> Floats:
        """Return what `rows` returns, not to be changed; fast while the particles keep order."""
        now = world.state.ids[: world.state.n]
        if (
            self._seen is None
            or self._seen[0] is not self.ids
            or not np.array_equal(self._seen[1], now)
        ):
            self._seen = self.ids, now.copy(), self.rows(world)
            self._seen[2].flags.writeable = False
        return self._seen[2]

    def keep(self, world: World, values: Floats) -> None:
        """Keep the values of the particles, in the internal order."""
        now = world.state.ids[: world.state.n]
        order = np.argsort(now)
        self.ids, self.values = now[order].copy(), values[order]

    def ids_changed(self, new: Mapping[int, int]) -> None:
        """Follow particles that have got new ids; those that are not in `new` are gone."""
        stay = np.array([id in new for id in self.ids.tolist()], bool)
        ids = np.array([new[id] for id in self.ids[stay].tolist()], np.int64)
        order = np.argsort(ids)
        self.ids, self.values = ids[order], self.values[stay][order]

    def copied(self, steps: Sequence[int]) -> None:
        """Give copies of particles, with ids higher by each of `steps`, the same values."""
        ids = (self.ids + np.array([0, *steps])[:, None]).ravel()
        order = np.argsort(ids, kind="stable")
        self.values = np.tile(self.values, (1 + len(steps), 1))[order]
        self.ids = ids[order]

    def state(self) -> dict[str, Any]:
        """Return what a restart file keeps."""
        return {"ids": self.ids.tolist(), "values": self.values.tolist()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Take the values from a restart file."""
        ids = np.array(saved.get("ids", ()), np.int64)
        values = np.array(saved.get("values", ()), np.float64).reshape(len(ids), -1)
        if values.shape[1] == len(self.usual):
            self.ids, self.values = ids, values


def places(world: World, bit: int) -> Floats:
    """Return where the particles are, without wrapping, shape (n, 3), m.

    As in LIGGGHTS those that are not in the group are at the origin: what is measured or pulled
    from where they were begins there when they come into the group later.
    """
    return np.where(world.member(bit)[:, None], world.unwrapped(), 0.0)


def warn_of_joined(world: World, what: str, bit: int, origin: ById) -> bool:
    """Say if particles have come into a group behind the fix that knows where they were."""
    rows = origin.rows(world)
    joined = world.member(bit) & (rows == 0.0).all(axis=1)
    joined &= (world.unwrapped() != 0.0).any(axis=1)
    if joined.any():
        who = int(world.state.ids[int(np.argmax(joined))])
        world.warn(
            f"{what}: particle {who}, one of {int(joined.sum())}, came into the group behind it; "
            "as in LIGGGHTS it takes the origin of the coordinates for where that was"
        )
    return bool(joined.any())
