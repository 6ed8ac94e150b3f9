"""``dump custom``: particles as text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minidem.kernels.columns import LOWER, UPPER
from minidem.output.text.table import format_rows

__all__ = ["custom_frame", "frame_name"]


def custom_frame(
    step: int,
    box: NDArray[np.float64],
    boundary: tuple[str, str, str],
    columns: Sequence[tuple[str, NDArray[Any]]],
    formats: Sequence[str],
    label: str = "ATOMS",
    title: str = "",
) -> str:
    """Return one frame of a ``dump custom`` or ``dump local``.

    Parameters
    ----------
    step : int
        Time step.
    box : (2, 3) ndarray
        Lower and upper corner of the simulation box, m.
    boundary : tuple of str
        Per axis one letter, or two for lower and upper face: p, f, s or m.
    columns : sequence of (str, (N,) ndarray)
        Names and values in the order of the dump command.
    formats : sequence of str
        One Python format per column, see `formats.column_formats`.
    label : str
        What a line is.
    title : str
        Stands behind the step; empty for none.

    Returns
    -------
    str
        Header and N lines, byte for byte as LIGGGHTS writes them.
    """
    count = len(columns[0][1]) if columns else 0
    faces = " ".join(face * 2 if len(face) == 1 else face for face in boundary)
    lines = [
        "ITEM: TIMESTEP",
        str(step),
        *(("ITEM: LABEL", title) if title else ()),
        f"ITEM: NUMBER OF {label}",
        str(count),
        f"ITEM: BOX BOUNDS {faces}",
        *("%g %g" % (box[LOWER, d], box[UPPER, d]) for d in range(3)),  # noqa: UP031 - C's %g
        f"ITEM: {label} " + "".join(f"{name} " for name, _ in columns),
    ]
    return "\n".join(lines) + "\n" + format_rows([values for _, values in columns], formats)


def frame_name(pattern: str, step: int, pad: int = 0) -> str:
    """Return the file name of a frame: the first ``*`` becomes the step, the first ``%`` 0.

    Parameters
    ----------
    pattern : str
        As in the dump command. ``%`` stands for a process of LIGGGHTS, of which there is one.
    step : int
        Time step.
    pad : int
        Digits to pad to with zeros (``dump_modify pad``).

    Examples
    --------
    >>> frame_name("post/d_*.vtk", 800)
    'post/d_800.vtk'
    """
    return pattern.replace("*", str(step).zfill(pad), 1).replace("%", "0", 1)
