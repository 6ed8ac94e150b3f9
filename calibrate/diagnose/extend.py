"""The extended study: the same study with the named cause switched on, and its cases."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.study.data import StudyData
from calibrate.study.load import data_file
from calibrate.study.write import study_text
from liggghts_io import CaseSpec, free_directory, write_case
from liggghts_io.files import write_bytes, write_text


def extended_effects(found: Diagnosis) -> Mapping[str, float]:
    """Effect and fitted strength of the best named cause; empty without one."""
    if not found.verdict.names:
        return {}
    best = found.verdict.suspects[0]
    effect = next(c.effect for c in found.problem.candidates if c.name == best.candidate)
    return {effect: best.strength}


def extended_specs(found: Diagnosis) -> dict[str, CaseSpec]:
    """Cases at the refitted parameters with the cause switched on where it acts."""
    best = found.verdict.suspects[0]
    theta = found.problem.theta(best.fitted.u)
    specs = {}
    for experiment, base in found.problem.experiments.items():
        on = found.problem.effects_in(experiment, {best.candidate: best.strength})
        specs[experiment] = replace(
            base, parameters={**base.parameters, **theta}, effects={**base.effects, **on}
        )
    return specs


def write_extended(
    found: Diagnosis,
    data: StudyData,
    out: Path,
    write: Callable[[CaseSpec, Path], Path] = write_case,
) -> list[Path]:
    """Write the extended study with its data, and one case directory per experiment.

    The cases use the same templates and run on both engines; where one of an earlier verdict was
    run, the new one gets a directory beside it. Nothing is written without a name;
    an extended study of an earlier verdict is then marked as outdated.

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
        The study file and the case directories.
    """
    effects, study, path = extended_effects(found), data.study, data.path
    file = out / f"{path.stem}_extended.toml"
    if not effects:
        if file.exists():  # of an earlier verdict; kept, but no longer what the data say
            file.replace(file.with_name(file.name + ".outdated"))
        return []
    out.mkdir(parents=True, exist_ok=True)
    best = found.verdict.suspects[0]
    theta = found.problem.theta(best.fitted.u)
    parameters = dict(study.parameters)
    for name, value in theta.items():
        rounded = {"": float(f"{value:.6g}")}
        parameters[name] = parameters[name].model_copy(update={"value": rounded})
    on = {k: float(f"{v:.6g}") for k, v in effects.items()}
    wider = study.model_copy(update={"effects": {**study.effects, **on}, "parameters": parameters})
    for name in {target.file for target in study.targets if target.file is not None}:
        target = out / name
        write_bytes(target, data_file(path, name).read_bytes())
    write_text(file, study_text(wider, _header(found, data)))
    written = [file]
    for experiment, spec in extended_specs(found).items():
        written.append(write(spec, free_directory(spec, out / "cases" / experiment)))
    return written


def _header(found: Diagnosis, data: StudyData) -> str:
    verdict = found.verdict
    best = verdict.suspects[0]
    low, high = verdict.intervals[best.candidate].interval95
    lines = [
        f"Extended by 'bulkcal diagnose': {best.candidate} = {best.strength:.4g}, "
        f"95 % interval {low:.4g} to {high:.4g}.",
        f"Baseline: {data.path.name}, sha256 {data.sha256}.",
        "The values of the parameters are those of the joint fit with the effect switched on.",
    ]
    if verdict.kind == "group":
        others = ", ".join(verdict.names[1:])
        lines.append(f"Not the only possible cause; the data do not exclude {others}.")
    if ":" in best.candidate:
        lines.append(
            "The effect acts in one experiment only; a study switches it on in all of its kind. "
            "The case directories beside this file have it right."
        )
    return "\n".join(lines)
