"""Commands for single cases: generate, run, post, render."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from calibrate.cli.arguments import AsJson, existing_case, names_of, numbers_of, one_of
from calibrate.cli.output import say, say_json, stdout
from calibrate.errors import CalibrationError
from calibrate.study.resources import bundled_particles
from liggghts_io import (
    CaseResult,
    CaseSpec,
    load_spec,
    particle_named,
    post_case,
    run_case,
    write_case,
)
from liggghts_io.case.runner import ENGINES
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, SURFACES

__all__ = ["generate", "post", "render", "run"]

Directory = Annotated[Path, typer.Argument(metavar="DIR", help="Case directory.")]
Pairs = Annotated[
    list[str],
    typer.Option("-p", "--parameter", metavar="NAME=VALUE", help="Contact parameter, repeatable."),
]


def generate(
    experiment: Annotated[str, typer.Argument(help=f"{names_of(EXPERIMENTS)}.")],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Directory to write.")],
    particle: Annotated[str, typer.Option(help="Particle, by its name in --particles.")] = (
        "Carbo HSP13"
    ),
    particles: Annotated[
        Path | None,
        typer.Option(metavar="FILE.csv", help="Table of particles; default: those of the paper."),
    ] = None,
    surface: Annotated[str, typer.Option(help=f"{names_of(SURFACES)}.")] = "steel",
    scale: Annotated[str, typer.Option(help=f"{names_of(SCALES)}.")] = "quick",
    parameter: Pairs = [],  # noqa: B006 - typer copies it
    apparatus: Annotated[
        list[str],
        typer.Option("-a", "--apparatus", metavar="NAME=VALUE", help="Apparatus override."),
    ] = [],  # noqa: B006
    effect: Annotated[
        list[str],
        typer.Option("-e", "--effect", metavar="NAME=VALUE", help="Model extension, strength."),
    ] = [],  # noqa: B006
    seed: Annotated[int, typer.Option(help="Seed of the insertion.")] = 1,
    engine: Annotated[str, typer.Option(help=f"{names_of(ENGINES)}.")] = "minidem",
    as_json: AsJson = False,
) -> None:
    """Write a case directory: LIGGGHTS script, meshes and the record of what made them.

    Example: bulkcal generate heap --particle "Carbo HSP13" --surface steel --scale quick
    -p mu_pp=0.69 -p mu_roll_pp=0.09 -p mu_pw=0.31 -p mu_roll_pw=0.27 -p e_pp=0.74 -p e_pw=0.44
    --out heap_steel
    """
    spec = CaseSpec(
        experiment=one_of("EXPERIMENT", experiment, EXPERIMENTS),
        particle=particle_named(particle, particles or bundled_particles()),
        surface=surface,
        scale=one_of("--scale", scale, SCALES),
        parameters=numbers_of("-p", parameter, CONTACT_PARAMETERS),
        apparatus=numbers_of("-a", apparatus),
        effects=numbers_of("-e", effect),
        seed=seed,
        engine=one_of("--engine", engine, ENGINES),
    )
    if out.exists() and not out.is_dir():
        msg = f"--out {out}: is a file; name a directory"
        raise CalibrationError(msg)
    write_case(spec, out, partial(_tell, Console(stderr=True)))
    if as_json:
        say_json({"directory": str(out), "script": str(out / "in.script")})
    else:
        say(f"wrote {out}/in.script\nnext: bulkcal run {out}")


def run(
    directory: Directory,
    engine: Annotated[str, typer.Option(help=f"{names_of(ENGINES)}; default: as generated.")] = "",
    again: Annotated[bool, typer.Option("--again", help="Run also when a result is stored.")] = (
        False
    ),
    as_json: AsJson = False,
) -> None:
    """Run a case and show its observables.

    Example: bulkcal run heap_steel --engine minidem
    """
    from calibrate.cli.progress import StepBar  # the bar of a study needs pandas, half a second

    spec = load_spec(existing_case(directory))
    name = one_of("--engine", engine, ENGINES) if engine else ""
    console = Console(stderr=True)
    with StepBar(f"{spec.experiment} on {spec.surface}", console) as bar:
        result = run_case(directory, name, bar, again=again, tell=partial(_tell, console))
    _show(result, spec, as_json)
    if result.status == "ok" and not as_json:
        say(f"next: bulkcal render {directory}")


def post(directory: Directory, as_json: AsJson = False) -> None:
    """Compute the observables again from the files that the engine wrote.

    Example: bulkcal post heap_steel --json
    """
    spec = load_spec(existing_case(directory))
    _show(post_case(directory, partial(_tell, Console(stderr=True))), spec, as_json)


def render(directory: Directory, as_json: AsJson = False) -> None:
    """Draw a case as it ended, as a PNG in its directory.

    Example: bulkcal render heap_steel
    """
    from liggghts_io import render_case  # pyvista takes seconds to import

    path = render_case(existing_case(directory))
    if as_json:
        say_json({"picture": str(path)})
    else:
        say(f"wrote {path}")


def _tell(console: Console, line: str) -> None:
    console.print(line, highlight=False, markup=False, soft_wrap=True)


def _show(result: CaseResult, spec: CaseSpec, as_json: bool) -> None:
    if as_json:
        say_json(
            {
                "case_id": result.case_id,
                "status": result.status,
                "reason": result.reason,
                "failure": result.failure,
                "observables": dict(result.observables),
                "wall_s": result.wall_s,
            }
        )
    elif result.status == "ok":
        say(f"{spec.particle.name}, {spec.experiment} on {spec.surface}")
        table = Table()
        table.add_column("observable")
        table.add_column("value", justify="right")
        for name, value in result.observables.items():
            table.add_row(name, f"{value:.6g}")
        stdout().print(table)
        say(f"{result.wall_s:.1f} s")
    if result.status != "ok":
        # The run is data for a campaign; a person who asked for this one run wants to know.
        msg = f"{result.path}: the run failed: {result.reason}"
        raise CalibrationError(msg)
