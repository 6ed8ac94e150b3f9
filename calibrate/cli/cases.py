"""Commands for single cases: generate, run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from calibrate.cli.arguments import (
    ApparatusPairs,
    AsJson,
    CoarseGraining,
    Directory,
    DryRun,
    EffectPairs,
    EngineName,
    ExperimentFolder,
    ExperimentName,
    OtherEngine,
    ParameterPairs,
    Quiet,
    ScaleName,
    Seed,
    Sizes,
    SurfaceName,
    Verbose,
    chosen_experiment,
    existing_case,
    named_directory,
    one_of,
)
from calibrate.cli.pairs import numbers_of
from calibrate.cli.plans.case import plan_of_case, plan_of_run
from calibrate.cli.show.observables import show_result
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import StepBar
from calibrate.study.resources import bundled_particles
from liggghts_io import (
    CaseSpec,
    load_spec,
    particle_named,
    run_case,
    write_case,
)
from liggghts_io.case.runner import ENGINES
from liggghts_io.experiments import SCALES
from liggghts_io.files import shell_word
from liggghts_io.materials import CONTACT_PARAMETERS

__all__ = ["generate", "run"]


def generate(
    experiment: ExperimentName = "",
    *,
    out: Annotated[str, typer.Option("--out", metavar="DIR", help="Directory to write.")],
    particle: Annotated[str, typer.Option(help="Particle, by its name in --particles.")] = (
        "Carbo HSP13"
    ),
    particles: Annotated[
        Path | None,
        typer.Option(metavar="FILE.csv", help="Table of particles; default: those of the paper."),
    ] = None,
    sizes: Sizes = None,
    coarse_graining: CoarseGraining = None,
    folder: ExperimentFolder = "",
    surface: SurfaceName = "steel",
    scale: ScaleName = "quick",
    parameter: ParameterPairs = [],  # noqa: B006 - typer copies it
    apparatus: ApparatusPairs = [],  # noqa: B006
    effect: EffectPairs = [],  # noqa: B006
    seed: Seed = 1,
    engine: EngineName = "minidem",
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Write a case directory: LIGGGHTS script, meshes and the record of what made them.

    Example: bulkcal generate heap --particle "Carbo HSP13" --surface steel --scale quick
    -p mu_pp=0.69 -p mu_roll_pp=0.09 -p mu_pw=0.31 -p mu_roll_pw=0.27 -p e_pp=0.74 -p e_pw=0.44
    --out heap_steel
    """
    screen = Screen(quiet, verbose)
    name, own = chosen_experiment(experiment, folder)
    simulated = {"sizes": sizes, "coarse_graining": coarse_graining}
    spec = CaseSpec(
        experiment=name,
        particle=particle_named(particle, particles or bundled_particles(), simulated),
        surface=surface,
        scale=one_of("--scale", scale, SCALES),
        parameters=numbers_of("-p", parameter, CONTACT_PARAMETERS),
        apparatus=numbers_of("-a", apparatus),
        effects=numbers_of("-e", effect),
        seed=seed,
        engine=one_of("--engine", engine, ENGINES),
        own=own,
    )
    target = named_directory("--out", out)
    if dry_run:
        screen.plan(plan_of_case(spec, target), as_json)
        return
    write_case(spec, target, screen.remark)
    if verbose:
        screen.details(plan_of_run(target, spec.engine))
    if as_json:
        screen.json({"directory": str(target), "script": str(target / "in.script")})
    else:
        screen.result(f"wrote {target}/in.script")
        screen.hint(f"next: bulkcal run {shell_word(target)}")


def run(
    directory: Directory,
    engine: OtherEngine = "",
    again: Annotated[bool, typer.Option("--again", help="Run also when a result is stored.")] = (
        False
    ),
    dry_run: DryRun = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Run a case and show its observables.

    Example: bulkcal run heap_steel --engine minidem
    """
    screen = Screen(quiet, verbose)
    spec = load_spec(existing_case(directory))
    name = one_of("--engine", engine, ENGINES) if engine else spec.engine
    if dry_run:
        screen.plan(plan_of_run(directory, name), as_json)
        return
    if verbose:
        screen.details(plan_of_run(directory, name))
    with StepBar(f"{spec.experiment} on a {spec.kind} wall, {name}", screen.console) as bar:
        result = run_case(directory, engine, bar, again=again, tell=screen.remark)
    show_result(result, spec, screen, as_json)
    if not as_json:
        screen.hint(f"next: bulkcal render {shell_word(directory)}")
