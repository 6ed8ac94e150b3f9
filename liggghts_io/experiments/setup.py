"""What goes into a case of an experiment, and what comes out of its run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from liggghts_io.materials import GLUED, Particle

Meshes: TypeAlias = dict[str, npt.NDArray[np.float64]]


@dataclass(frozen=True)
class Setup:
    """Inputs of one case after defaults are filled in.

    Attributes
    ----------
    particle : Particle
    kind : str
        Of the wall under test: "flat" or "glued".
    contact : Mapping[str, float]
        Contact parameters of the case.
    apparatus : Mapping[str, float]
        All apparatus parameters of the experiment.
    seed : int
    """

    particle: Particle
    kind: str
    contact: Mapping[str, float]
    apparatus: Mapping[str, float]
    seed: int

    @property
    def glued(self) -> bool:
        """Whether the wall under test is laminated with grains."""
        return self.kind == GLUED


@dataclass(frozen=True)
class Build:
    """What a script and a case directory need.

    Attributes
    ----------
    variables : dict of str to Any
        Variables of the script.
    meshes : dict of str to (n, 3, 3) float64
        Triangles by name [m]: `NAME.stl` is written from them.
    stl : Mapping[str, bytes]
        STL files that are taken as they are, by file name.
    """

    variables: dict[str, Any]
    meshes: Meshes
    stl: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True)
class Observed:
    """What a finished run says.

    Attributes
    ----------
    values : Mapping[str, float]
        Observables by name.
    tables : Mapping[str, Mapping[str, (n,) float64]]
        Curves by file name: columns by name, in their order. They are stored beside the result.
    """

    values: Mapping[str, float]
    tables: Mapping[str, Mapping[str, npt.NDArray[np.float64]]] = field(default_factory=dict)
