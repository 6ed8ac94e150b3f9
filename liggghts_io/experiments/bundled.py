"""Experiments of bulkcal that are folders, as a user's own are: `templates/NAME/`."""

from __future__ import annotations

from pathlib import Path

from liggghts_io.errors import CaseError
from liggghts_io.experiments.own.experiment import own_experiment
from liggghts_io.experiments.own.folder import read_experiment
from liggghts_io.experiments.own.record import DEFINITION
from liggghts_io.plug_ins import Loaded
from liggghts_io.scripts.templating import template_folder


def bundled_experiments() -> Loaded:
    """Read the folders beside the shared template; a broken one is named and stops nothing."""
    loaded = Loaded({}, [])
    try:
        definitions = sorted(template_folder().glob(f"*/{DEFINITION}"))
    except CaseError as err:
        return Loaded({}, [str(err)])
    for definition in definitions:
        folder = definition.parent
        try:
            one = own_experiment(read_experiment(folder))
        except CaseError as err:
            loaded.broken.append(f"{err}; install bulkcal again")
            continue
        if one.name == folder.name:
            loaded.found[one.name] = one
        else:
            loaded.broken.append(f"{folder}: describes {one.name!r}; call the folder so")
    return loaded


def bundled_folder(name: str) -> Path | None:
    """Return the folder of an experiment of bulkcal, None for one that is written in Python.

    Parameters
    ----------
    name : str
        Of a known experiment.
    """
    folder = template_folder() / name
    return folder if (folder / DEFINITION).is_file() else None
