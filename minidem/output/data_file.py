"""``write_data``: the particles as a file that ``read_data`` reads."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from minidem.errors import InputError
from minidem.kernels.columns import OMEGA, POSITION, RADIUS, VELOCITY
from minidem.output.dump import write_whole
from minidem.output.text.table import format_rows
from minidem.world.periodic import wrapped
from minidem.world.world import World

__all__ = ["check_columns_of_file", "write_data"]

_NUMBER = "%.16e"


def check_columns_of_file(world: World, command: str) -> None:
    """Refuse a file in which radius and density stand twice, as LIGGGHTS cannot read it either."""
    if world.hybrid > 1:
        msg = (
            f"{command}: with 'atom_style hybrid sphere granular' a data file has radius and "
            "density twice; write 'atom_style granular'"
        )
        raise InputError(msg)


def write_data(world: World, path: Path, shift: int) -> None:
    """Write box, particles and velocities as LIGGGHTS does.

    Parameters
    ----------
    world : World
        The simulation, with faces where the particles are; those beyond a fixed one are left out.
    path : Path
        Full path of the file.
    shift : int
        What is added to the ids.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    state, box = world.state, world.need_box()
    place, turns = wrapped(box, state.row[: state.n, POSITION])
    fixed = np.array([face == "ff" for face in box.boundary])
    lost = (((place < box.lo) | (place >= box.hi)) & fixed).any(axis=1)
    order = state.output_order()
    order = order[~lost[order]]
    ids = state.ids[order] + shift
    row, image = state.row[order], (state.image[: state.n] + turns)[order]
    own, places = [2.0 * row[:, RADIUS], state.density[order]], [*place[order].T]
    atoms = [ids, state.kind[order].astype(np.int64) + 1]
    atoms += [*places, *own, *image.T] if world.hybrid else [*own, *places, *image.T]
    moves = [ids, *row[:, VELOCITY].T, *state.spin[order][:, OMEGA].T]
    lines = [
        f"LAMMPS data file via write_data, version minidem, timestep = {world.step}", "",
        f"{len(order)} atoms", f"{world.types} atom types", "",
        *(f"{a:.16e} {b:.16e} {c}lo {c}hi" for a, b, c in zip(box.lo, box.hi, "xyz", strict=True)),
    ]  # fmt: skip
    if len(order):
        lines += ["", "Atoms", "", _table(atoms), "Velocities", "", _table(moves)]
    write_whole(path, "\n".join(lines).rstrip("\n") + "\n")


def _table(columns: list[np.ndarray]) -> str:
    """Return lines without the blank at their ends."""
    formats = ["%d" if np.issubdtype(one.dtype, np.integer) else _NUMBER for one in columns]
    return format_rows(columns, formats).replace(" \n", "\n")
