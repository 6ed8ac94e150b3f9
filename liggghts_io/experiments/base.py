"""What an experiment is: named apparatus parameters, a script, meshes, observables and curves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TypeAlias

from liggghts_io.errors import CaseError, nearest
from liggghts_io.experiments.numbers import Adjustment, Curve, Observable, Parameter
from liggghts_io.experiments.setup import Build, Observed, Setup
from liggghts_io.experiments.view import View
from liggghts_io.materials import CONTACT_PARAMETERS, FLAT, GLUED, GLUED_PARAMETERS
from liggghts_io.scripts.templating import render

SCALES: Final = ("quick", "lab", "paper")
Write: TypeAlias = Callable[[Mapping[str, Any]], str]
"""Variables to the text of a script."""

ACTING: Final = {FLAT: CONTACT_PARAMETERS, GLUED: GLUED_PARAMETERS}
"""Contact parameters that act in an experiment of grains on a wall, by the kind of the wall."""


def bundled(template: str) -> Write:
    """Return what writes a script from a template of this package, by its file name."""

    def write(variables: Mapping[str, Any]) -> str:
        return render(template, variables)

    return write


def nothing(_kind: str) -> Sequence[str]:
    """Return no field: what an experiment needs that asks nothing special of the particle."""
    return ()


@dataclass(frozen=True)
class Experiment:
    """One experiment.

    Attributes
    ----------
    name, title : str
    caption : str
        What its picture shows, for reports.
    parameters : tuple of Parameter
    observables : tuple of Observable
    build : callable
        Setup to Build.
    write : callable
        Variables of a build, after effects have changed them, to the text of the script.
    observe : callable
        Folder of a finished run and Setup to Observed. It writes nothing. It raises DamagedFile
        when a file is not as the script says, and any other CaseError, with the reason, when the
        run does not determine an observable.
    chart : callable
        Folder of a finished run, Setup, observables and matplotlib axes: draws what was measured.
    view : View
    needs : callable
        Kind of the wall to the optional fields of `Particle` without which there is no case.
    curves : tuple of Curve
    contact : Mapping[str, tuple of str]
        Contact parameters that act, by the kind of the wall under test.
    effects : tuple of Adjustment
        Effects of this experiment alone.
    templated : bool
        Whether the script is written from the variables that all templates share, so that the
        effects that change those can act.
    definition_digest : str
        Sha256 of the definition in the folder that describes it, which says what is measured;
        empty for one that is written in Python.
    """

    name: str
    title: str
    caption: str
    parameters: tuple[Parameter, ...]
    observables: tuple[Observable, ...]
    build: Callable[[Setup], Build]
    write: Write
    observe: Callable[[Path, Setup], Observed]
    chart: Callable[[Path, Setup, Mapping[str, float], Any], None]
    view: View
    needs: Callable[[str], Sequence[str]] = nothing
    curves: tuple[Curve, ...] = ()
    contact: Mapping[str, tuple[str, ...]] = field(default_factory=lambda: ACTING)
    effects: tuple[Adjustment, ...] = ()
    templated: bool = True
    definition_digest: str = ""

    def acting(self, kind: str) -> tuple[str, ...]:
        """Return the contact parameters that matter on a wall of a kind, "flat" or "glued".

        Raises
        ------
        CaseError
            For an unknown kind, with the nearest known one.
        """
        try:
            return self.contact[kind]
        except KeyError:
            msg = f"{self.name}: no wall of the kind {kind!r}{nearest(kind, list(self.contact))}"
            raise CaseError(msg) from None

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

    def curve_named(self, name: str) -> Curve:
        """Return the curve of that name.

        Raises
        ------
        CaseError
            For an unknown name, with the nearest known one.
        """
        known = {one.name: one for one in self.curves}
        if name not in known:
            hint = nearest(name, list(known)) if known else "; it gives no curve"
            msg = f"{self.name}: unknown curve {name!r}{hint}"
            raise CaseError(msg)
        return known[name]
