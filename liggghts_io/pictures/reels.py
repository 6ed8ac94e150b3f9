"""Reels of a case, and of output without our records."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from liggghts_io.case.directory import load_setup, load_spec
from liggghts_io.case.spec import experiment_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments import View
from liggghts_io.foreign import Grains, Output, as_frame
from liggghts_io.measure.dumps import POST, SCRIPT, Frame, frame_paths, read_frame
from liggghts_io.pictures.placed import placed_meshes
from liggghts_io.pictures.reel import Reel
from liggghts_io.pictures.shot import FloatArray
from liggghts_io.stl import read_stl

GLASS: Final = 0.35
"""Opacity of a mesh of which nobody says how it looks."""


def reel_of_case(directory: Path, folder: Path, observables: Mapping[str, float]) -> Reel:
    """Return the frames of a case.

    Parameters
    ----------
    directory : Path
        A case that ran.
    folder : Path
        Where its run lies.
    observables : Mapping[str, float]
        What was measured, for the words on a picture; empty where nothing is known.

    Raises
    ------
    CaseError
        If the case is not intact, or has no frame.
    """
    setup, spec = load_setup(directory), load_spec(directory)
    experiment = experiment_of(spec)
    view = experiment.view
    paths = frame_paths(folder)
    if not paths:
        msg = f"{folder / POST}: no frame_*.dump; the run ended before the first one"
        raise CaseError(msg)
    last = len(paths) - 1

    def frames(wanted: Collection[int] | None) -> Iterator[Frame]:
        return (read_frame(paths[k]) for k in (range(last + 1) if wanted is None else wanted))

    return Reel(
        last,
        frames,
        int(view.at(setup) * last + 1e-9),
        f"{experiment.title}: {spec.particle.name} on a {spec.kind} wall",
        _meshes(folder, view),
        view.solid,
        view.window(setup) if view.window else None,
        lambda frame: view.notes(frame, setup, observables),
    )


def _meshes(folder: Path, view: View) -> dict[str, FloatArray]:
    found: dict[str, FloatArray] = {}
    for name, triangles in placed_meshes(folder / SCRIPT):
        if name in view.solid:
            there = [found[name]] if name in found else []
            found[name] = np.concatenate([*there, triangles])
    return found


def reel_of_output(output: Output, grains: Grains, meshes: Sequence[Path]) -> Reel:
    """Return the frames of somebody else's run.

    Parameters
    ----------
    output : Output
    grains : Grains
        What the dump may not say of its grains.
    meshes : sequence of Path
        STL files that are drawn as they are.

    Raises
    ------
    CaseError
        If there is no dump, or a mesh cannot be read.
    """
    last = len(output.dump.steps) - 1

    def frames(wanted: Collection[int] | None) -> Iterator[Frame]:
        return (as_frame(table, ("radius",), grains) for table in output.frames(wanted))

    found = {f"{k}_{path.stem}": read_stl(path) for k, path in enumerate(meshes)}
    return Reel(last, frames, last, output.dump.name, found, dict.fromkeys(found, GLASS))
