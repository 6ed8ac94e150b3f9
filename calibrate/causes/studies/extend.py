"""The extended study: the same study with the named cause free, and cases that show its effect."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from calibrate.causes.candidates import Candidate
from calibrate.causes.diagnosis import Diagnosis
from calibrate.study.cases import case_spec
from calibrate.study.data import StudyData
from calibrate.study.load import data_file
from calibrate.study.model import Study
from calibrate.study.places import Place, ScopeName
from calibrate.study.schema.parameters import Parameter
from calibrate.study.write import study_text
from liggghts_io import CaseSpec, experiment_files, free_directory, write_case
from liggghts_io.files import write_bytes, write_text

__all__ = ["extended_study", "write_extended"]

SCOPES: Final[tuple[ScopeName, ...]] = ("apparatus", "surface", "material", "material+surface")
"""Between what an effect that acts in one apparatus alone may differ, the plainest first."""
_DIGITS: Final = "{:.6g}"


def extended_study(study: Study, found: Diagnosis) -> Study:
    """Return the study with the leading cause, or pair, free and everything at its optimum.

    Parameters
    ----------
    study : Study
    found : Diagnosis
        With a name.
    """
    best, strengths = found.best(found.leading)
    values = dict(zip(found.board.problem.space.names, map(float, best), strict=True))
    parameters = dict(study.parameters)
    # The unknowns of a problem begin with what the study frees, in the same order.
    for (parameter, instance), key in zip(study.free, values, strict=False):
        old = parameters[parameter]
        alone = len(study.instances(parameter)) == 1
        value = {**old.value, "" if alone else instance: _rounded(values[key])}
        if alone:
            value = {"": value[""]}
        parameters[parameter] = old.model_copy(update={"value": value})
    effects = dict(study.effects)
    for cause, strength in zip(found.board.members(found.leading), strengths, strict=True):
        if cause.switch:
            effects[cause.effect] = 1.0
        else:
            parameters[cause.effect] = _freed(study, cause, _rounded(float(strength)))
    changes = {
        "name": f"{study.name[:60]}_extended",
        "title": f"{study.title[:100]}, with {' and '.join(found.leading)}",
        "parameters": parameters,
        "effects": effects,
    }
    return study.model_copy(update=changes)


def _rounded(value: float) -> float:
    return float(_DIGITS.format(value))


def _freed(study: Study, cause: Candidate, strength: float) -> Parameter:
    """Return the effect as a free parameter that acts where the cause does."""
    span = (cause.low, cause.high)
    mine = [study.places[k] for k, _ in cause.acts]
    others = [p for p in study.places if study.layout.acts(cause.effect, p) and p not in mine]
    if others:
        for scope in SCOPES:
            here, there = ({_instance(p, scope) for p in places} for places in (mine, others))
            if len(here) == 1 and not here & there:
                (instance,) = here
                value = {**dict.fromkeys(sorted(there), 0.0), instance: strength}
                return Parameter(range={instance: span}, value=value, scope=scope)
    return Parameter(range={"": span}, value={"": strength}, scope="global")


def _instance(place: Place, scope: ScopeName) -> str:
    words: dict[str, str] = {
        "apparatus": place.experiment,
        "surface": place.surface,
        "material": place.material,
        "material+surface": f"{place.material}/{place.surface}",
    }
    return words[scope]


def _pairs(study: Study, causes: Sequence[Candidate]) -> dict[str, tuple[CaseSpec, CaseSpec]]:
    """Return the cases with and without the causes, by the place where one of them acts."""
    found, effects = {}, {cause.effect for cause in causes}
    for k in sorted({k for cause in causes for k, _ in cause.acts}):
        place = study.places[k]
        on = case_spec(study, place, {}, study.run.seed)
        rest = {name: one for name, one in on.effects.items() if name not in effects}
        several = [place.material] if len(study.materials) > 1 else []
        words = "_".join([place.experiment, *several, place.surface])
        found[words.replace("/", "-").replace(" ", "-")] = on, replace(on, effects=rest)
    return found


def write_extended(
    found: Diagnosis,
    data: StudyData,
    out: Path,
    write: Callable[[CaseSpec, Path], Path] = write_case,
) -> list[Path]:
    """Write the extended study with its data, and cases with and without the cause.

    The cases use the same templates and run on both engines; where one of an earlier verdict was
    run, the new one gets a directory beside it. Nothing is written without a name; an extended
    study of an earlier verdict is then marked as outdated.

    Parameters
    ----------
    found : Diagnosis
    data : StudyData
        The study that was diagnosed.
    out : Path
        Directory to write to; made if it is missing.
    write : callable
        Writes the directory of a case.

    Returns
    -------
    list of Path
        The study file, then the case directories.
    """
    file = out / f"{data.path.stem}_extended.toml"
    if not found.leading:
        if file.exists():  # of an earlier verdict; kept, but no longer what the data say
            file.replace(file.with_name(file.name + ".outdated"))
        return []
    wider = extended_study(data.study, found)
    causes = found.board.members(found.leading)
    out.mkdir(parents=True, exist_ok=True)
    for name, content in _files(data).items():
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        write_bytes(out / name, content)
    write_text(file, study_text(wider, _header(found, data, causes)))
    written = [file]
    for place, (on, off) in _pairs(wider, causes).items():
        written.append(write(on, free_directory(on, out / "cases" / place)))
        written.append(write(off, free_directory(off, out / "cases" / f"{place}_without")))
    return written


def _files(data: StudyData) -> Mapping[str, bytes]:
    """Return what the study file needs beside it: data, and folders of its own experiments."""
    named = {target.file for target in data.study.targets if target.file is not None}
    found = {name: data_file(data.path, name).read_bytes() for name in sorted(named)}
    for rig in data.study.rigs:
        if rig.folder is not None:  # what was diagnosed, and nothing else that may lie there
            own = experiment_files(data.study.own[rig.name])
            found |= {f"{rig.folder}/{name}": content for name, content in own.items()}
    return found


def _header(found: Diagnosis, data: StudyData, causes: Sequence[Candidate]) -> str:
    lines = []
    for cause in causes:
        span = found.interval(cause.name, names=found.leading)
        strength = found.strength(cause.name, found.leading)
        lines.append(
            f"Extended by 'bulkcal diagnose': {cause.name} is free, found at {strength:.4g}, "
            f"95 % interval {span.low:.4g} to {span.high:.4g}."
        )
    lines += [
        f"Baseline: {data.path.name}, sha256 {data.sha256}.",
        "Values of parameters are those of the optimum with the cause; a joint calibration finds "
        "them anew.",
    ]
    others = ", ".join(name for name in found.verdict.names if name not in found.leading)
    if others:
        lines.append(f"Not the only possible cause; the data do not exclude {others}.")
    return "\n".join(lines)
