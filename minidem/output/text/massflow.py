"""The file of ``fix massflow/mesh``: one line per particle that has passed."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["massflow_header", "massflow_rows"]

_NUMBER: Final = " %4.4g"


def massflow_header(*, with_time: bool) -> str:
    """Return the first line; `with_time` for keyword ``writeTime``."""
    names = " time " if with_time else ""
    return f"# ID{names} diameter x y z u v w  (ex ey ez, color)\n"


def massflow_rows(
    ids: NDArray[np.int64],
    diameter: NDArray[np.float64],
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    time: float | None = None,
) -> str:
    """Return the lines of the particles counted in one step.

    Parameters
    ----------
    ids : (n,) ndarray
        Particle ids.
    diameter : (n,) ndarray
        m.
    position, velocity : (n, 3) ndarray
        m and m/s.
    time : float or None
        Simulation time in s with keyword ``writeTime``.

    Returns
    -------
    str
        n lines, 4 digits per number, as LIGGGHTS writes them.
    """
    stamp = "" if time is None else f" {_NUMBER % time} "
    pattern = f"%d{stamp}{_NUMBER * 7}\n"
    rows = np.concatenate([diameter[:, None], position, velocity], axis=1)
    return "".join(
        pattern % (number, *row) for number, row in zip(ids.tolist(), rows.tolist(), strict=True)
    )
