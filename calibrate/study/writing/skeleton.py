"""A commented study file to be filled in: what was measured where, with zeros for the numbers.

A zero is no possible size, density or measured value, so that a number that was forgotten is told
with its line before the first run.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from pydantic import TypeAdapter, ValidationError

from calibrate.errors import CalibrationError
from calibrate.study.schema.materials import FLAT, GLUED
from calibrate.study.schema.words import Label
from calibrate.study.writing.toml import setting
from liggghts_io.errors import told
from liggghts_io.experiments import EXPERIMENTS, SCALES, Experiment, Observable
from liggghts_io.materials import CONTACT_PARAMETERS

__all__ = ["Plan", "skeleton_text"]

FILL_IN: Final = "FILL IN"
"""Words behind every number that is missing."""

_RANGES: Final = {"mu": (0.1, 0.8), "mu_roll": (0.05, 0.6), "e": (0.2, 0.9)}
"""Of the paper's stages; wide enough for most dry bulk solids."""

_STAGES: Final = (
    ("particles", GLUED, ("mu_pp", "mu_roll_pp"), ("angle_deg", "t100_s")),
    ("wall", FLAT, ("mu_pw", "mu_roll_pw"), ("angle_deg", "t100_s")),
    ("restitution", FLAT, ("e_pp", "e_pw"), ("m1_g", "m2_g", "m3_g")),
)
"""Name, kind of surface, parameters and observables of the paper's stages."""

_LABEL: Final[TypeAdapter[str]] = TypeAdapter(Label)
_LONGEST_PART: Final = 24
"""Letters of a material or surface in the name of a target."""
_LONGEST_NAME: Final = 80
_LONGEST: Final = 200
"""Letters of a title."""

_BETWEEN: Final = 0.6
"""Value of a parameter until a stage frees it: restitution of the paper's first stages."""


@dataclass(frozen=True)
class Plan:
    """What a new study is about.

    Attributes
    ----------
    name : str
    materials, surfaces, experiments : sequence of str
        Every experiment is meant to have been done with every material on every surface that
        shows something in it (`surfaces_of`).
    scale : str
    tabled : collection of str
        Materials that stand in the table of particles beside the study.
    own : mapping of str to (str, Experiment)
        Experiments of the user's own among these: the folder, seen from the study, and what it
        describes.
    """

    name: str
    materials: Sequence[str]
    surfaces: Sequence[str]
    experiments: Sequence[str]
    scale: str = SCALES[0]
    tabled: Sequence[str] = ()
    own: Mapping[str, tuple[str, Experiment]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse a study of nothing, and names that no study takes."""
        for what, words in (("material", self.materials), ("surface", self.surfaces)):
            for word in words:
                _check_label(what, word)
        for what in ("materials", "surfaces", "experiments"):
            words = getattr(self, what)
            if not words or len(set(words)) < len(words):
                msg = f"{what}: {', '.join(words) or 'none'}; name each once, and at least one"
                raise CalibrationError(msg)
        for experiment in self.experiments:
            if not self.surfaces_of(experiment):
                msg = (
                    f"{experiment}: no contact parameter acts on {', '.join(self.surfaces)}; "
                    "name a flat surface too, for example steel"
                )
                raise CalibrationError(msg)

    def described(self, experiment: str) -> Experiment:
        """Return an experiment by its name."""
        return self.own[experiment][1] if experiment in self.own else EXPERIMENTS[experiment]

    def surfaces_of(self, experiment: str) -> list[str]:
        """Return the surfaces on which an experiment can be done.

        A plate with grains glued to it tells nothing on the tilting plate: nothing slides there.
        """
        acting = self.described(experiment).acting
        return [surface for surface in self.surfaces if acting(_kind_of(surface))]


def _check_label(what: str, word: str) -> None:
    """Refuse a name of a material or surface that the study's own check refuses."""
    try:
        _LABEL.validate_python(word)
    except ValidationError as err:
        msg = f"{what} {word!r}: {told(err.errors()[0])}"
        raise CalibrationError(msg) from err


def _in_ascii(words: Sequence[str]) -> dict[str, str]:
    """Return parts of names of targets, each once: short, and of the letters that they may have."""
    found: dict[str, str] = {}
    for k, word in enumerate(words, 1):
        part = re.sub(r"[^A-Za-z0-9]+", "_", word)[:_LONGEST_PART].strip("_")
        if not part or part in found.values():
            part = f"{part}{k}"
        found[word] = part
    return found


@dataclass(frozen=True)
class _Row:
    """A target of the new study."""

    name: str
    material: str
    surface: str
    experiment: str
    observable: Observable


def skeleton_text(plan: Plan) -> str:
    """Return the text of a new study file."""
    rows = _rows(plan)
    stages = _stages(plan, rows)
    blocks = [
        _head(plan),
        *(_material(plan, name) for name in plan.materials),
        *([f"[[surface]]\n{setting('name', name)}  # {_kind(name)}"] for name in plan.surfaces),
        *(_own(name, *plan.own[name]) for name in plan.experiments if name in plan.own),
        _lead("What was measured: mean and standard error of the mean of `repeats` repeats. Delete",
              "what you did not measure; cases/README.md shows how to read tables and curves."),
        *(_target(plan, row) for row in rows),
        _lead("Free parameters with their ranges; the value holds until a stage frees one."),
        *(_parameter(name) for name in _acting(plan)),
        *stages,
    ]  # fmt: skip
    return "\n\n".join("\n".join(lines) for lines in blocks) + "\n"


def _own(name: str, folder: str, experiment: Experiment) -> list[str]:
    """Return the table of an experiment of the user's own; curves need files that nobody knows."""
    curves = [
        f"# Its curve {one.name!r} ({one.meaning}) is a target with file, x_column and columns."
        for one in experiment.curves
    ]
    return ["[[experiment]]", setting("name", name), setting("folder", folder), *curves]


def _kind(surface: str) -> str:
    if _kind_of(surface) == GLUED:
        return "plate laminated with grains"
    return 'flat; add kind = "glued" if it is laminated with grains'


def _kind_of(surface: str) -> str:
    return GLUED if surface.casefold() == GLUED else FLAT


def _rows(plan: Plan) -> list[_Row]:
    """Return the targets; names are those of observable, surface and, of several, material."""
    rows = []
    materials, surfaces = _in_ascii(plan.materials), _in_ascii(plan.surfaces)
    for material in plan.materials:
        for experiment in plan.experiments:
            for surface in plan.surfaces_of(experiment):
                observables = plan.described(experiment).observables
                short = [one.name.rpartition("_")[0] for one in observables]
                for one, word in zip(observables, short, strict=True):
                    unit_only = word and short.count(word) == 1
                    parts = [word if unit_only else one.name, surfaces[surface]]
                    if len(materials) > 1:
                        parts.append(materials[material])
                    rows.append(_Row("_".join(parts), material, surface, experiment, one))
    return rows


def _head(plan: Plan) -> list[str]:
    return [
        f"# Written by 'bulkcal init'. Replace every number marked {FILL_IN}, then: bulkcal check",
        setting("name", re.sub(r"[^A-Za-z0-9_]+", "_", plan.name)[:_LONGEST_NAME] or "study"),
        setting("title", f"{', '.join(plan.materials)} on {', '.join(plan.surfaces)}"[:_LONGEST]),
        "",
        "[run]",
        f"{setting('scale', plan.scale)}  # {', '.join(SCALES)}",
        'engine = "minidem"  # or "liggghts"',
        "seed = 1",
    ]


def _lead(*lines: str) -> list[str]:
    return [f"# {line}" for line in lines]


def _material(plan: Plan, name: str) -> list[str]:
    lines = ["[[material]]", setting("name", name)]
    if name in plan.tabled:
        return [*lines[:1], f"{lines[1]}  # a row of particles.csv"]
    needs = {
        word.replace("_kg", "_g")
        for experiment in plan.experiments
        for surface in plan.surfaces_of(experiment)
        for word in plan.described(experiment).needs(_kind_of(surface))
    }
    words = {
        "d32_um": "Sauter diameter, or d10_um, d50_um and d90_um, or sieve",
        "density_kg_m3": "of a grain, not of the heap",
        "flow_flat_g_s": "mass flow of the funnel used with flat plates",
        "flow_glued_g_s": "mass flow of the funnel used with glued plates",
        "impact_mass_g": "mass poured in the plate impact",
    }
    always = ("d32_um", "density_kg_m3")
    return lines + [
        f"{key} = 0.0  # {FILL_IN}: {text}"
        for key, text in words.items()
        if key in always or key in needs
    ]


def _target(plan: Plan, row: _Row) -> list[str]:
    several = {
        "material": row.material if len(plan.materials) > 1 else "",
        "surface": row.surface if len(plan.surfaces) > 1 else "",
    }
    return [
        "[[target]]",
        setting("name", row.name),
        *(setting(key, value) for key, value in several.items() if value),
        setting("experiment", row.experiment),
        f"{setting('observable', row.observable.name)}  # {row.observable.meaning}",
        setting("unit", row.observable.unit),
        f"value = 0.0  # {FILL_IN}",
        f"se = 0.0  # {FILL_IN}",
        f"repeats = 0  # {FILL_IN}, or leave 0 if unknown",
    ]


def _acting(plan: Plan) -> list[str]:
    acting = {
        name
        for experiment in plan.experiments
        for surface in plan.surfaces_of(experiment)
        for name in plan.described(experiment).acting(_kind_of(surface))
    }
    return [name for name in CONTACT_PARAMETERS if name in acting]


def _parameter(name: str) -> list[str]:
    low, high = _RANGES[name.rpartition("_")[0]]
    return [f"[parameter.{name}]", f"range = [{low:g}, {high:g}]", f"value = {_middle(name):g}"]


def _middle(name: str) -> float:
    low, high = _RANGES[name.rpartition("_")[0]]
    return _BETWEEN if name.startswith("e_") else 0.5 * (low + high)


def _stages(plan: Plan, rows: Iterable[_Row]) -> list[list[str]]:
    """Return the paper's stages as far as the targets allow; of one material and flat surface."""
    flat = [name for name in plan.surfaces if _kind_of(name) == FLAT]
    if len(plan.materials) > 1 or len(flat) > 1:
        return [_lead("No [[stage]]: several materials or walls are calibrated together.")]
    blocks = []
    for name, kind, free, observables in _STAGES:
        here = [
            row.name
            for row in rows
            if _kind_of(row.surface) == kind and row.observable.name in observables
        ]
        if len(here) > 1:
            blocks.append(_stage(name, {"free": list(free), "targets": here}))
    return blocks or [_lead("No [[stage]]: two parameters need two measured numbers at least.")]


def _stage(name: str, lists: Mapping[str, list[str]]) -> list[str]:
    return [
        "[[stage]]",
        setting("name", name),
        *(setting(key, value) for key, value in lists.items()),
        "points = 12",
        "repeats = 4",
        "infill = 16",
    ]
