"""Which unknowns move which outputs over the whole prior: Sobol indices."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from scipy import stats

from calibrate.arrays import Array
from calibrate.inference.space import Space

__all__ = ["sobol"]


def sobol(
    space: Space,
    function: Callable[[Array], Array],
    outputs: Sequence[str],
    rng: np.random.Generator,
    points: int = 1024,
) -> pd.DataFrame:
    """Return the shares of the outputs' variance over the prior that the unknowns cause.

    Parameters
    ----------
    space : Space
    function : callable
        Values (n, K) to outputs (n, S), such as the mean of an emulator.
    outputs : sequence of str
        Names of the S outputs.
    rng : Generator
    points : int
        Power of two; the function sees 2 + K times as many.

    Returns
    -------
    DataFrame
        Columns output, unknown, first (share by itself) and total (with all interactions). A tied
        unknown's share is that of its own deviation from the mean of the tie.

    References
    ----------
    Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270.
    """
    found = stats.sobol_indices(
        func=lambda cube: function(space.transform(cube.T)).T,
        n=points,
        dists=[stats.uniform()] * space.size,
        rng=rng,
    )
    first = np.reshape(found.first_order, (len(outputs), space.size))
    total = np.reshape(found.total_order, (len(outputs), space.size))
    rows = [
        {"output": output, "unknown": name, "first": first[s, i], "total": total[s, i]}
        for s, output in enumerate(outputs)
        for i, name in enumerate(space.names)
    ]
    return pd.DataFrame(rows)
