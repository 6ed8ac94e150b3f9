"""How a study is run, and what is known of the apparatus and from elsewhere."""

from __future__ import annotations

from typing import Annotated, Final, TypeAlias

from pydantic import AfterValidator, Field, model_validator

from calibrate.executor_names import LOCAL, check_executor
from calibrate.study.schema.words import EngineName, File, Label, Name, ScaleName, Table

__all__ = ["LARGEST_STUDY_SEED", "Apparatus", "Design", "Known", "Likelihood", "Run", "Shared"]

Points: TypeAlias = Annotated[int, Field(ge=0, le=10_000)]
"""First points of a place."""
LARGEST_STUDY_SEED: Final = 2**30
"""Runs count their seeds from it, and stay below the largest that an engine takes."""


def _known_executor(text: str) -> str:
    check_executor(text)
    return text


class Run(Table):
    """How the simulations are run.

    Attributes
    ----------
    scale, engine : str
        Size of the simulated experiments, and the program that runs them.
    seed : int
        First seed of the runs, and seed of every draw.
    workers : int
        Processes; 0 for one per core.
    executor : str
        Where they run: ``local``, ``dask-local``, ``dask://HOST:PORT``, ``slurm``, ``pbs`` or
        ``lsf``.
    time_limit_s : float, optional
        Longest time that one run may take on the clock [s].
    """

    scale: ScaleName = "quick"
    engine: EngineName = "minidem"
    seed: Annotated[int, Field(ge=1, le=LARGEST_STUDY_SEED)] = 1
    workers: Annotated[int, Field(ge=0, le=256)] = 0
    executor: Annotated[str, AfterValidator(_known_executor)] = LOCAL
    time_limit_s: Annotated[float, Field(gt=0.0, le=1e7)] | None = None


class Design(Table):
    """How many runs there are, and when there are enough.

    Attributes
    ----------
    runs : int
        Budget of a joint calibration.
    start : int or dict of str to int
        First points of every place, for all materials or by material: materials share emulators,
        so that dear ones need fewer. 0, and a material that is not named: ten per acting unknown.
    tolerance : float
        Part of the measurement's variance that the emulator's may be in the end.
    check_seeds : int
        Runs per place of the final check at the found values.
    check_draws : int
        Draws from the posterior that are checked with the engine.
    """

    runs: Annotated[int, Field(ge=10, le=100_000)] = 400
    start: Points | dict[str, Points] = 0
    tolerance: Annotated[float, Field(gt=0.0, le=10.0)] = 0.1
    check_seeds: Annotated[int, Field(ge=2, le=50)] = 3
    check_draws: Annotated[int, Field(ge=0, le=100)] = 5

    def start_of(self, material: str) -> int:
        """Return the first points of a material's places; 0 where it is not said."""
        return self.start.get(material, 0) if isinstance(self.start, dict) else self.start


class Likelihood(Table):
    """What is believed of the simulation before the data.

    Attributes
    ----------
    discrepancy : float
        Chance, for each target, that the simulation misses it whatever the parameters are. A joint
        calibration then rests on the other targets, and says so. 0: all targets have to be met.
        Stages, as the paper has them, and the diagnosis, which looks for the reason, take 0.
    """

    discrepancy: Annotated[float, Field(ge=0.0, le=0.5)] = 0.05


class Apparatus(Table):
    """What differs from the documented apparatus of an experiment, or a user's own experiment.

    Attributes
    ----------
    name : str
        Of the experiment.
    folder : str, optional
        Folder beside the study that describes it.
    apparatus : dict of str to float
        Overrides of its parameters.
    """

    name: Name
    folder: File | None = None
    apparatus: dict[str, float] = Field(default_factory=dict)


class Known(Table):
    """An independent measurement of a parameter or of an effect's strength.

    A level on the plate, a period timed over many strokes, friction from a shear cell. The
    diagnosis considers only strengths that such a measurement allows.

    Attributes
    ----------
    value, se : float
        In the unit of what was measured, with its standard error.
    material, surface, experiment : str, optional
        Where, as far as the parameter differs between them.
    """

    value: float = 0.0
    se: Annotated[float, Field(gt=0.0)]
    material: Label | None = None
    surface: Label | None = None
    experiment: Name | None = None


class Shared(Table):
    """An error that targets have in common, such as that of a balance, or of coarse grains.

    Attributes
    ----------
    name : str
    targets : list of str
    relative_se, se : float, optional
        One of the two: part of the value, or in the targets' unit.
    """

    name: Name
    targets: Annotated[list[str], Field(min_length=1)]
    relative_se: Annotated[float, Field(gt=0.0, le=1.0)] | None = None
    se: Annotated[float, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _one(self) -> Shared:
        if (self.relative_se is None) == (self.se is None):
            msg = f"shared error '{self.name}': give relative_se or se, one of them"
            raise ValueError(msg)
        return self
