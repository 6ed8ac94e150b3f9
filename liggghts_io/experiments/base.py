"""What an experiment is: named apparatus parameters, a template, meshes and observables."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.numbers import Observable, Parameter, same
from liggghts_io.materials import GLUED, GLUED_FRICTION, Particle
from liggghts_io.measure.dumps import Frame

SCALES: Final = ("quick", "lab", "paper")
Meshes: TypeAlias = dict[str, npt.NDArray[np.float64]]


@dataclass(frozen=True)
class Setup:
    """Inputs of one case after defaults are filled in.

    Attributes
    ----------
    particle : Particle
    surface : str
    contact : Mapping[str, float]
        Contact parameters of the case.
    apparatus : Mapping[str, float]
        All apparatus parameters of the experiment.
    seed : int
    """

    particle: Particle
    surface: str
    contact: Mapping[str, float]
    apparatus: Mapping[str, float]
    seed: int

    @property
    def glued(self) -> bool:
        """Whether the wall under test is laminated with grains."""
        return self.surface == GLUED


@dataclass(frozen=True)
class Build:
    """What a template and a case directory need.

    Attributes
    ----------
    variables : dict of str to Any
        Variables of the template.
    meshes : dict of str to (n, 3, 3) float64
        Triangles by file name [m].
    """

    variables: dict[str, Any]
    meshes: Meshes


@dataclass(frozen=True)
class Notes:
    """What is written on a picture of a case.

    Positions are those of the apparatus, seen from the side: x to the right, z up.

    Attributes
    ----------
    title : str
    lines : tuple of (n, 2) float64
        Lines, such as fitted flanks: x and z of their points [m].
    labels : tuple of (float, float, str)
        x and z [m] of the middle of a text, and the text.
    """

    title: str = ""
    lines: tuple[npt.NDArray[np.float64], ...] = ()
    labels: tuple[tuple[float, float, str], ...] = ()


def no_notes(_frame: Frame, _setup: Setup, _observables: Mapping[str, float]) -> Notes:
    """Return nothing: a picture without words."""
    return Notes()


def whole_run(_setup: Setup) -> float:
    """Return 1: the last frame is the one that shows most."""
    return 1.0


@dataclass(frozen=True)
class View:
    """How a case of an experiment is drawn: from the side, x to the right and z up.

    Attributes
    ----------
    solid : Mapping[str, float]
        Opacity of every mesh that is drawn; meshes left out only count grains.
    at : callable
        Setup to the part of the run whose frame is drawn where nobody asks for another.
    window : callable, optional
        Setup to what the picture holds: left, right, bottom and top [m]; without it, all grains
        and meshes.
    notes : callable
        Frame, Setup and observables, empty where none are known, to what is written on the picture.
    """

    solid: Mapping[str, float]
    at: Callable[[Setup], float] = whole_run
    window: Callable[[Setup], tuple[float, float, float, float]] | None = None
    notes: Callable[[Frame, Setup, Mapping[str, float]], Notes] = no_notes


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


def nothing(_surface: str) -> Sequence[str]:
    """Return no field: what an experiment needs that asks nothing special of the particle."""
    return ()


@dataclass(frozen=True)
class Experiment:
    """One experiment.

    Attributes
    ----------
    name, title, template : str
    caption : str
        What its picture shows, for reports.
    parameters : tuple of Parameter
    observables : tuple of Observable
    build : callable
        Setup to Build.
    observe : callable
        Folder of a finished run and Setup to Observed. It writes nothing. It raises DamagedFile
        when a file is not as the script says, and any other CaseError, with the reason, when the
        run does not determine an observable.
    chart : callable
        Folder of a finished run, Setup, observables and matplotlib axes: draws what was measured.
    view : View
    needs : callable
        Surface to the optional fields of `Particle` without which there is no case.
    curve : str
        Table of `Observed` with the mass-time curve (columns time_s, mass_g); empty if none.
    """

    name: str
    title: str
    caption: str
    template: str
    parameters: tuple[Parameter, ...]
    observables: tuple[Observable, ...]
    build: Callable[[Setup], Build]
    observe: Callable[[Path, Setup], Observed]
    chart: Callable[[Path, Setup, Mapping[str, float], Any], None]
    view: View
    needs: Callable[[str], Sequence[str]] = nothing
    curve: str = ""

    def apparatus(self, scale: str, overrides: Mapping[str, float]) -> dict[str, float]:
        """Return all apparatus parameters of a scale with overrides applied.

        Raises
        ------
        CaseError
            For an unknown scale or parameter, with the nearest known one, or a value outside
            the limits.
        """
        if scale not in SCALES:
            msg = f"unknown scale {scale!r}{nearest(scale, SCALES)}"
            raise CaseError(msg)
        known = {one.name: one for one in self.parameters}
        values = {name: float(getattr(one, scale)) for name, one in known.items()}
        for name, value in overrides.items():
            if name not in known:
                hint = nearest(name, list(values))
                msg = f"{self.name}: unknown apparatus parameter {name!r}{hint}"
                raise CaseError(msg)
            try:
                known[name].check(float(value))
            except CaseError as err:
                msg = f"{self.name}: apparatus {err}"
                raise CaseError(msg) from err
            values[name] = float(value)
        return values

    def observable(self, name: str) -> Observable:
        """Return the observable of that name.

        Raises
        ------
        CaseError
            For an unknown name, with the nearest known one.
        """
        known = {one.name: one for one in self.observables}
        if name not in known:
            msg = f"{self.name}: unknown observable {name!r}{nearest(name, list(known))}"
            raise CaseError(msg)
        return known[name]


def common_parameters(
    mu_side: float = 0.0, mu_roll_side: float = 0.0, e_side: float = 0.5
) -> tuple[Parameter, ...]:
    """Return the parameters every experiment has; walls not under test are smooth by default."""
    return (
        same(
            "timestep_fraction",
            "-",
            "time step as a part of the Rayleigh time (eq. 6)",
            0.2,
            (1e-3, 0.3),
        ),
        same(
            "mu_side",
            "-",
            "sliding friction of grains on walls not under test",
            mu_side,
            (0.0, 1000.0),
        ),
        same(
            "mu_roll_side",
            "-",
            "rolling friction on walls not under test",
            mu_roll_side,
            (0.0, 1000.0),
        ),
        same("e_side", "-", "restitution on walls not under test", e_side, (0.051, 1.0)),
    )


def common_variables(setup: Setup) -> dict[str, Any]:
    """Return the variables every template needs: material, contact, gravity, seed."""
    contact, apparatus, particle = setup.contact, setup.apparatus, setup.particle
    wall = (
        {"mu_pw": GLUED_FRICTION, "mu_roll_pw": GLUED_FRICTION, "e_pw": contact["e_pp"]}
        if setup.glued
        else {name: contact[name] for name in ("mu_pw", "mu_roll_pw", "e_pw")}
    )
    return {
        "sizes": [(particle.d32_m, 1.0)],
        "density": particle.density,
        "youngs_modulus": particle.youngs_modulus,
        "poisson_ratio": particle.poisson_ratio,
        **{name: contact[name] for name in ("mu_pp", "mu_roll_pp", "e_pp")},
        **wall,
        **{name: apparatus[name] for name in ("mu_side", "mu_roll_side", "e_side")},
        "timestep_fraction": apparatus["timestep_fraction"],
        "cohesive": False,
        "cohesion_pp": 0.0,
        "cohesion_pw": 0.0,
        "static_friction": False,
        "restitution_exponent": 0.0,
        "air_drag": 0.0,
        "extensions": [],
        "gravity": (0.0, 0.0, -1.0),
        "seed": setup.seed,
        "skin": apparatus["skin_d"] * particle.d32_m,
        "frames": apparatus["frames"],
    }
