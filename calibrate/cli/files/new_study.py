"""The commands `init` and `migrate`: write a study file, new or from one of the first form."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Annotated

import typer

from calibrate.cli import completion
from calibrate.cli.arguments import Quiet, ScaleName, chosen_experiment, names_of, one_of
from calibrate.cli.show.output import Screen
from calibrate.errors import CalibrationError
from liggghts_io.experiments import EXPERIMENTS, SCALES, own_experiment
from liggghts_io.files import shell_word

__all__ = ["init", "migrate"]

_SURFACES = ("glued", "steel")


def init(
    material: Annotated[
        list[str] | None, typer.Option("--material", help="Name of a bulk solid, repeatable.")
    ] = None,
    surface: Annotated[
        list[str] | None, typer.Option("--surface", help="Name of a wall, repeatable.")
    ] = None,
    experiment: Annotated[
        list[str] | None,
        typer.Option(
            "--experiment",
            help=f"{names_of(EXPERIMENTS)}, or the folder of an experiment of your own; "
            "repeatable.",
            autocompletion=completion.experiments,
        ),
    ] = None,
    scale: ScaleName = SCALES[0],
    out: Annotated[
        str, typer.Option("--out", metavar="STUDY.toml", help="New file.")
    ] = "study.toml",
    quiet: Quiet = False,
) -> None:  # fmt: skip
    """Write a commented study file to be filled in; asks in a terminal where flags are missing.

    Numbers that are missing are 0.0 and marked; 'bulkcal check' names those that are left.

    Example: bulkcal init --material Sand --surface glued --surface steel --experiment heap
    """
    materials = material or _asked("materials", "--material", "")
    surfaces = surface or _asked("surfaces", "--surface", ", ".join(_SURFACES))
    experiments = experiment or _asked("experiments", "--experiment", ", ".join(EXPERIMENTS))
    chosen = [chosen_experiment(word, place="--experiment") for word in experiments]
    one_of("--scale", scale, SCALES)
    path = _new_file(out)
    own = {
        name: (_beside(path, Path(word)), own_experiment(one))
        for word, (name, one) in zip(experiments, chosen, strict=True)
        if one is not None
    }
    from calibrate.study.grains import PARTICLES
    from calibrate.study.writing.skeleton import Plan, skeleton_text

    tabled = _tabled(path.parent / PARTICLES, materials)
    names = [name for name, _ in chosen]
    plan = Plan(path.stem, materials, surfaces, names, scale, tabled, own)
    _write(path, skeleton_text(plan))
    screen = Screen(quiet)
    count = "1 material" if len(materials) == 1 else f"{len(materials)} materials"
    screen.result(f"{path}: {count}, fill in the numbers marked FILL IN")
    screen.hint(f"next: bulkcal check {shell_word(path)}")


def migrate(
    old: Annotated[Path, typer.Argument(metavar="OLD.toml", help="Study of the first form.")],
    new: Annotated[
        str | None, typer.Argument(metavar="NEW.toml", help="New file; default: OLD_new.toml.")
    ] = None,
    quiet: Quiet = False,
) -> None:
    """Write a study file of the first form anew, with equal meaning; comments on top are kept.

    The old file stays. The new one belongs into the same folder, beside the data.

    Example: bulkcal migrate old.toml new.toml
    """
    from calibrate.study.load import load_study
    from calibrate.study.old_form import stem_of_new
    from calibrate.study.writing.migrate import migrated_text

    text = migrated_text(old)
    path = _new_file(str(old.with_name(stem_of_new(old))) if new is None else new)
    _write(path, text)
    screen = Screen(quiet)
    screen.result(f"{path}: written")
    try:
        load_study(path)
    except CalibrationError as err:  # what was wrong in the old file, or needs a decision
        screen.result(f"and to be corrected by you:\n{err}")
    screen.hint(f"next: bulkcal check {shell_word(path)}")


def _asked(what: str, option: str, usual: str) -> list[str]:
    """Ask for names in a terminal; elsewhere say with which option to give them."""
    if not sys.stdin.isatty():
        example = usual.partition(",")[0] or "Sand"
        msg = f"{option}: is missing; name the {what}, for example {option} {example}"
        raise CalibrationError(msg)
    ask: Callable[..., str] = typer.prompt
    said = ask(f"{what}, separated by commas", default=usual or None, err=True)
    return [word.strip() for word in said.split(",") if word.strip()]


def _new_file(text: str) -> Path:
    """Return the path of a file that is not there yet; nothing is written over."""
    path = Path(text)
    if not text.strip() or path.name == "":
        msg = f"{text!r}: is no name of a file; name the new study, such as study.toml"
        raise CalibrationError(msg)
    try:
        there = path.exists() or path.is_symlink()
        folder = path.parent.is_dir()
    except (OSError, ValueError) as err:
        msg = f"{text!r}: cannot be used ({err}); name another file"
        raise CalibrationError(msg) from err
    if there:
        msg = f"{path}: exists already; name another file, nothing is written over"
        raise CalibrationError(msg)
    if not folder:
        msg = f"{path.parent}: no such directory; make it, or name another file"
        raise CalibrationError(msg)
    return path


def _beside(study: Path, folder: Path) -> str:
    """Return a folder as a study names it, which has it in its own directory."""
    home = study.parent.resolve()
    real = folder.resolve()
    if real == home or not real.is_relative_to(home):
        msg = f"--experiment {folder}: lies outside the study's directory; copy it to {home}"
        raise CalibrationError(msg)
    return real.relative_to(home).as_posix()


def _tabled(table: Path, materials: Collection[str]) -> list[str]:
    """Return the materials that stand in the table of particles beside the new file."""
    if not table.is_file():
        return []
    from liggghts_io.particles import read_bulks

    known = read_bulks(table)
    return [name for name in materials if name in known]


def _write(path: Path, text: str) -> None:
    from liggghts_io.files import write_text

    write_text(path, text)
