"""Options that the commands of the laboratory share, and how they write their files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from calibrate.cli import completion
from calibrate.cli.arguments import chosen_experiment, new_file
from calibrate.errors import CalibrationError
from liggghts_io.experiments import EXPERIMENTS, own_experiment
from liggghts_io.files import alone_with, write_bytes

if TYPE_CHECKING:
    from calibrate.laboratory.targets import Place

__all__ = [
    "CHECK",
    "ExperimentWord",
    "MaterialName",
    "ObservableName",
    "Out",
    "Plot",
    "SurfaceLabel",
    "TargetName",
    "TimeColumn",
    "TimeUnit",
    "alone_with_table",
    "checked_target",
    "new_picture",
    "place_of",
    "write_all",
]

CHECK: Final = "bulkcal check STUDY.toml"
"""What comes next when the lines of a study were printed."""

Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="FILE.csv", help="Table to write or to extend; needs --name."),
]
TargetName = Annotated[
    str, typer.Option("--name", help="Name of the target in a study: letters, digits and _.")
]
MaterialName = Annotated[
    str, typer.Option("--material", help="Bulk solid, where the study has several.")
]
SurfaceLabel = Annotated[str, typer.Option("--surface", help="Wall, where the study has several.")]
ExperimentWord = Annotated[
    str,
    typer.Option(
        "--experiment", metavar="NAME|DIR", autocompletion=completion.experiments,
        help="Experiment, or the folder of one of your own.",
    ),
]  # fmt: skip
ObservableName = Annotated[
    str,
    typer.Option("--observable", help="Its number or curve; 'bulkcal apparatus' lists them."),
]
Plot = Annotated[
    Path | None,
    typer.Option("--plot", metavar="FILE.png", help="Picture; default: NAME.png beside --out."),
]
TimeColumn = Annotated[
    str, typer.Option("--time-column", help="Column of the time, where the file does not say.")
]
TimeUnit = Annotated[
    str, typer.Option("--time-unit", help="Its unit: s, ms, min or h, where the file does not say.")
]


def place_of(experiment: str, observable: str) -> Place:
    """Return the simulated number or curve that options name.

    Raises
    ------
    CalibrationError
        For what is missing or unknown.
    """
    from calibrate.laboratory.targets import Place

    name, own = chosen_experiment(experiment, place="--experiment")
    found = own_experiment(own) if own else EXPERIMENTS[name]
    if not observable:
        known = [*(one.name for one in found.observables), *(one.name for one in found.curves)]
        msg = f"--observable: is missing; name what {name} gives, one of {', '.join(known)}"
        raise CalibrationError(msg)
    return Place(found, observable)


def checked_target(out: Path, name: str) -> None:
    """Refuse a table that cannot be written there, and a target without a name.

    Raises
    ------
    CalibrationError
    """
    from calibrate.laboratory.entries import check_folder

    check_folder("--out", out)
    if not name:
        msg = f"--name: is missing; name the target that {out} gets, such as t100_steel"
        raise CalibrationError(msg)


def new_picture(option: Path | None, usual: Path | None) -> Path | None:
    """Return where a picture goes, and refuse a file that is there; None where none is wanted."""
    from calibrate.laboratory.entries import check_folder

    path = option or usual
    if path is None:
        return None
    check_folder("--plot", path)
    if path.suffix.lower() != ".png":
        msg = f"--plot {path}: pictures are PNG; name a file that ends in .png"
        raise CalibrationError(msg)
    return new_file("--plot", path)


@contextmanager
def alone_with_table(out: Path | None) -> Iterator[None]:
    """Keep other commands from extending a table while it is read and written in a block.

    Raises
    ------
    CalibrationError
        When nothing can be written there.
    """
    if out is None:
        yield
        return
    with ExitStack() as stack:
        try:
            stack.enter_context(alone_with(out))
        except OSError as err:
            msg = f"--out {out}: cannot be written ({err.strerror}); name a file elsewhere"
            raise CalibrationError(msg) from err
        yield


def write_all(files: Mapping[Path, bytes]) -> None:
    """Write files, each whole; where one cannot be written, new ones before it are taken back."""
    made: list[Path] = []
    try:
        for path, content in files.items():
            new = not path.exists()
            write_bytes(path.resolve(), content)
            if new:
                made.append(path)
    except BaseException:
        for path in made:
            path.unlink(missing_ok=True)
        raise
