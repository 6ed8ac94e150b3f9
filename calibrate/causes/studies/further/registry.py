"""Further experiments that a laboratory could make: a TOML file each, in `experiments/`.

    words = "the conveyor with a period a fifth shorter"
    hours = 1.0                  # that it takes
    experiment = "conveyor"
    times = { period_s = 0.8 }   # numbers of its apparatus, multiplied; or set:
    apparatus = { frames = 20 }
    wall = "alumina"             # a wall that the study may not have
    particle = { ... }           # grains that it may not have, as a [[material]] of a study

    [se]                         # what is read: observable to standard error, usual repeats
    t100_s = 0.07

The name of the file is that of the experiment in reports. What stands in the folder `further` of a
study's own experiment is tried, too.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Final

from pydantic import Field, ValidationError

from calibrate.errors import CalibrationError, unknown_name
from calibrate.study.data import StudyData
from calibrate.study.model import Study
from calibrate.study.schema.materials import Material
from calibrate.study.schema.words import Label, Name, Table, Words
from liggghts_io.errors import told

__all__ = ["FOLDER", "Entry", "entries_of", "read_entry"]

FOLDER: Final = Path(__file__).resolve().parent / "experiments"
OWN: Final = "further"
"""Folder in that of a study's own experiment."""
_PAGE: Final = "docs/how-to/add-a-further-experiment.md"
_Positive = Annotated[float, Field(gt=0.0)]


class Entry(Table):
    """A further experiment.

    Attributes
    ----------
    words : str
        What is done.
    hours : float
        Hours that it takes.
    experiment : str
    apparatus, times : dict of str to float
        Numbers of the apparatus that are set, and that are multiplied.
    wall : str, optional
        Wall under test; without it those of the study.
    particle : Material, optional
        Grains; without it those of the study.
    se : dict of str to float
        Standard error of each observable that is read, in its unit.
    """

    words: Words
    hours: _Positive
    experiment: Name
    apparatus: dict[str, float] = Field(default_factory=dict)
    times: dict[str, _Positive] = Field(default_factory=dict)
    wall: Label | None = None
    particle: Material | None = None
    se: Annotated[dict[str, _Positive], Field(min_length=1)]

    @property
    def changes(self) -> bool:
        """Whether it is an experiment of the study with something else in it."""
        return bool(self.apparatus or self.times or self.wall or self.particle)


def entries_of(data: StudyData) -> dict[str, Entry]:
    """Return the further experiments that a study may try by name: known ones, its own.

    Parameters
    ----------
    data : StudyData

    Raises
    ------
    CalibrationError
        For a mistake in a file, with its place, value and remedy.
    """
    found: dict[str, Entry] = {}
    for path in [*sorted(FOLDER.glob("*.toml")), *_own_files(data)]:
        if path.stem in found:
            msg = f"{path}: '{path.stem}' is the name of another further experiment; rename it"
            raise CalibrationError(msg)
        found[path.stem] = read_entry(path, data.study)
    return found


def _own_files(data: StudyData) -> list[Path]:
    """Return the files of a study's own experiments; what leads out of its directory is none."""
    home = data.path.resolve().parent
    folders = [home / rig.folder / OWN for rig in data.study.rigs if rig.folder is not None]
    files = [path for folder in folders for path in sorted(folder.glob("*.toml"))]
    return [path for path in files if path.resolve().is_relative_to(home)]


def read_entry(path: Path, study: Study) -> Entry:
    """Return the further experiment that a file describes.

    Parameters
    ----------
    path : Path
    study : Study
        Knows the experiments.

    Raises
    ------
    CalibrationError
        With file, key and remedy.
    """
    try:
        one = Entry.model_validate(tomllib.loads(path.read_text(encoding="utf-8-sig")))
    except ValidationError as err:
        first = err.errors(include_url=False)[0]
        key = ".".join(map(str, first["loc"]))
        msg = f"{path}: {key}: {told(first)}; see {_PAGE}"
        raise CalibrationError(msg) from err
    except (OSError, ValueError) as err:
        msg = f"{path}: {err}; see {_PAGE}"
        raise CalibrationError(msg) from err
    if one.experiment not in study.experiments:
        msg = f"{path}: experiment: {unknown_name(one.experiment, study.experiments)}"
        raise CalibrationError(msg)
    experiment = study.experiments[one.experiment]
    numbers = [parameter.name for parameter in experiment.parameters]
    for table, names, known in (
        ("apparatus", one.apparatus, numbers),
        ("times", one.times, numbers),
        ("se", one.se, [observable.name for observable in experiment.observables]),
    ):
        for name in names:
            if name not in known:
                msg = f"{path}: {table}: {unknown_name(name, known)}"
                raise CalibrationError(msg)
    return one
