"""Emulators as files: NumPy's npz, without pickles, equal to the last bit when loaded."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from calibrate.arrays import Array
from calibrate.emulator.components import Components
from calibrate.emulator.covariance import Hyper
from calibrate.emulator.emulator import TrainedEmulator
from calibrate.emulator.part import Part
from calibrate.emulator.process import Form, Process, Runs, condition
from calibrate.emulator.types import Inputs, Output
from calibrate.errors import CalibrationError

__all__ = ["load_emulator", "save_emulator"]

VERSION: Final = 1
_INPUTS: Final = ("u", "strengths", "seeds")
_COMPONENTS: Final = ("centre", "basis", "analysis", "truncation")
_HYPER: Final = ("lengths", "surface", "bends", "offset", "noise")
_FORM: Final = ("shift", "scale", "acting", "unit")


def save_emulator(emulator: TrainedEmulator, path: Path) -> None:
    """Write an emulator to a file; runs and hyperparameters, from which the rest follows.

    Parameters
    ----------
    emulator : TrainedEmulator
    path : Path
        Its name is taken as it is.
    """
    arrays: dict[str, Array] = {
        "version": np.array(VERSION),
        "shape": np.array([emulator.parameters, emulator.effects, emulator.width]),
        "names": np.array([part.output.name for part in emulator.parts]),
        "columns": np.array(
            [part.output.columns.indices(emulator.width) for part in emulator.parts]
        ),
        "components": np.array([len(part.processes) for part in emulator.parts]),
    }
    for k, part in enumerate(emulator.parts):
        arrays[f"{k}/y"] = part.y
        arrays |= _fields(f"{k}/", part.inputs, _INPUTS)
        arrays |= _fields(f"{k}/", part.components, _COMPONENTS)
        for f, one in enumerate(part.processes):
            arrays[f"{k}/{f}/y"] = one.runs.y
            arrays[f"{k}/{f}/believed"] = one.runs.believed
            arrays |= _fields(f"{k}/{f}/", one.form, _FORM)
            arrays |= _fields(f"{k}/{f}/", one.form.hyper, _HYPER)
    with path.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **arrays)


def load_emulator(path: Path) -> TrainedEmulator:
    """Read an emulator.

    Raises
    ------
    CalibrationError
        For a file that is no emulator, is damaged, or is of another version.
    """
    try:
        with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        if int(arrays["version"]) != VERSION:
            msg = f"{path}: emulator of version {int(arrays['version'])}, not {VERSION}; train anew"
            raise CalibrationError(msg)
        return _emulator(arrays)
    except (OSError, ValueError, KeyError, IndexError, zipfile.BadZipFile) as err:
        msg = f"{path}: no emulator, or a damaged one ({err}); train it again"
        raise CalibrationError(msg) from err


def _fields(prefix: str, record: object, names: tuple[str, ...]) -> dict[str, Array]:
    return {prefix + name: np.asarray(getattr(record, name)) for name in names}


def _emulator(arrays: Mapping[str, Array]) -> TrainedEmulator:
    parameters, effects, width = map(int, arrays["shape"])
    parts = []
    for k, name in enumerate(arrays["names"]):
        inputs = Inputs(*(arrays[f"{k}/{field}"] for field in _INPUTS))
        components = Components(*(arrays[f"{k}/{field}"] for field in _COMPONENTS))
        count = int(arrays["components"][k])
        processes = tuple(_process(arrays, f"{k}/{f}/", inputs) for f in range(count))
        start, stop, step = map(int, arrays["columns"][k])
        output = Output(str(name), slice(start, stop, None if step == 1 else step))
        parts.append(Part(output, components, processes, inputs, arrays[f"{k}/y"]))
    return TrainedEmulator(tuple(parts), parameters, effects, width)


def _process(arrays: Mapping[str, Array], prefix: str, inputs: Inputs) -> Process:
    lengths, surface, bends, offset, noise = (arrays[prefix + name] for name in _HYPER)
    hyper = Hyper(lengths, float(surface), bends, float(offset), float(noise))
    shift, scale, acting, unit = (arrays[prefix + name] for name in _FORM)
    form = Form(hyper, float(shift), float(scale), acting, unit)
    return condition(form, Runs(inputs, arrays[prefix + "y"], arrays[prefix + "believed"]))
