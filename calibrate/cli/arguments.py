"""Words of the command line that need checking, and the options that several commands share."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Annotated, Final

import typer

from calibrate.cli import completion
from calibrate.errors import CalibrationError, unknown_name
from liggghts_io.case.runner import ENGINES
from liggghts_io.experiments import DEFINITION, EXPERIMENTS, SCALES, OwnExperiment, read_experiment
from liggghts_io.materials import SIZES, SURFACES

__all__ = [
    "BOTH",
    "JOINT",
    "MODES",
    "STAGED",
    "ApparatusPairs",
    "AsJson",
    "Directory",
    "DryRun",
    "EffectPairs",
    "EngineName",
    "ExecutorName",
    "ExecutorPairs",
    "ExperimentFolder",
    "ExperimentName",
    "FrameWord",
    "ModeName",
    "More",
    "OtherEngine",
    "ParameterPairs",
    "Quiet",
    "RunTable",
    "ScaleName",
    "Seed",
    "SurfaceName",
    "TimeLimit",
    "Twins",
    "Verbose",
    "Workers",
    "chosen_experiment",
    "existing_case",
    "named_directory",
    "names_of",
    "new_file",
    "one_of",
]

STAGED: Final = "staged"
JOINT: Final = "joint"
BOTH: Final = "both"
MODES: Final = (STAGED, JOINT, BOTH)
"""How a study is calibrated."""
MOST_WORKERS: Final = 256
LEAST_TIME_S: Final = 0.1


def names_of(known: Iterable[str]) -> str:
    """Return names as a help text lists them.

    Examples
    --------
    >>> names_of(["quick", "lab", "paper"])
    'quick, lab or paper'
    """
    *first, last = known
    return f"{', '.join(first)} or {last}" if first else last


AsJson = Annotated[bool, typer.Option("--json", help="Print JSON for a program to read.")]
Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="Print results only, no progress.")]
Verbose = Annotated[bool, typer.Option("-v", "--verbose", help="Say more.")]
DryRun = Annotated[
    bool, typer.Option("--dry-run", help="Say what would be done, and write nothing.")
]
Workers = Annotated[int, typer.Option(min=0, max=MOST_WORKERS, help="Processes; 0: one per core.")]
Twins = Annotated[
    int | None,
    typer.Option(
        metavar="N", min=2, max=1000,
        help="Most runs of each effect in each experiment; 12 where it is left out.",
    ),
]  # fmt: skip
More = Annotated[
    int | None,
    typer.Option(
        metavar="N", min=0, max=10_000,
        help="Most runs added where the evidence is uncertain, and as many where a strength is; 64 "
        "where it is left out.",
    ),
]  # fmt: skip
Further = Annotated[
    int | None,
    typer.Option(
        metavar="N", min=0, max=10_000,
        help="Most runs of further experiments, to rank what to try next where the cause is open; "
        "60 where it is left out, 0: none.",
    ),
]  # fmt: skip
ExecutorName = Annotated[
    str,
    typer.Option(
        "--executor", metavar="NAME", autocompletion=completion.executors,
        help="What runs the cases: local, dask-local, dask://HOST:PORT, slurm, pbs or lsf.",
    ),
]  # fmt: skip
ExecutorPairs = Annotated[
    list[str],
    typer.Option(
        "--executor-option", metavar="NAME=VALUE",
        help="Option of a job queue, repeatable: queue, account, walltime, memory, cores, "
        "setup, directive, ...",
    ),
]  # fmt: skip
TimeLimit = Annotated[
    float | None,
    typer.Option(
        "--time-limit", metavar="SECONDS", min=LEAST_TIME_S,
        help="Longest time of a run; what takes longer is stopped and fails with class time.",
    ),
]  # fmt: skip
RunTable = Annotated[
    Path | None,
    typer.Option(
        "--runs", metavar="TABLE",
        help="Fit to the runs of a table that 'bulkcal runs' wrote, and run nothing.",
    ),
]  # fmt: skip
Seed = Annotated[int, typer.Option(min=1, help="Seed of the insertion.")]
Sizes = Annotated[
    str | None,
    typer.Option(help=f"Of the grains, {' or '.join(SIZES)}; default: as --particles says."),
]
CoarseGraining = Annotated[
    float | None,
    typer.Option(help="Diameter over that of real grains; default: as --particles says."),
]
Directory = Annotated[Path, typer.Argument(metavar="DIR", help="Case directory.")]
ExperimentName = Annotated[
    str,
    typer.Argument(
        help=f"{names_of(EXPERIMENTS)}, or the folder of an experiment of your own.",
        autocompletion=completion.experiments,
    ),
]
ExperimentFolder = Annotated[
    str,
    typer.Option(
        "--experiment",
        metavar="DIR",
        help="Folder of your own experiment, instead of a name.",
    ),
]
SurfaceName = Annotated[
    str, typer.Option(help=f"{names_of(SURFACES)}.", autocompletion=completion.surfaces)
]
ScaleName = Annotated[
    str, typer.Option(help=f"{names_of(SCALES)}.", autocompletion=completion.scales)
]
EngineName = Annotated[
    str, typer.Option(help=f"{names_of(ENGINES)}.", autocompletion=completion.engines)
]
OtherEngine = Annotated[
    str,
    typer.Option(
        help=f"{names_of(ENGINES)}; default: as generated.", autocompletion=completion.engines
    ),
]
ModeName = Annotated[
    str,
    typer.Option(
        "--mode", metavar="|".join(MODES), autocompletion=completion.offer(MODES),
        help="By stages, all targets at once, or both; default: both where the study has stages.",
    ),
]  # fmt: skip
ParameterPairs = Annotated[
    list[str],
    typer.Option(
        "-p", "--parameter", metavar="NAME=VALUE", autocompletion=completion.parameter_pairs,
        help="Contact parameter, repeatable: mu_* from 0 to 1000, e_* above 0.05 to 1.",
    ),
]  # fmt: skip
ApparatusPairs = Annotated[
    list[str],
    typer.Option(
        "-a", "--apparatus", metavar="NAME=VALUE", autocompletion=completion.apparatus_pairs,
        help="Apparatus override, repeatable; 'bulkcal apparatus EXPERIMENT' lists them.",
    ),
]  # fmt: skip
EffectPairs = Annotated[
    list[str],
    typer.Option(
        "-e", "--effect", metavar="NAME=VALUE", autocompletion=completion.effect_pairs,
        help="Model extension with its strength, repeatable; listed by the same command.",
    ),
]  # fmt: skip
FrameWord = Annotated[
    str,
    typer.Option(
        "--frame", metavar="best|first|middle|last|N",
        help="Dump to draw; best: the one that shows what is measured; N counts from 0.",
    ),
]  # fmt: skip


def one_of(what: str, word: str, known: Collection[str]) -> str:
    """Return `word` when it is known, else say the nearest one."""
    if word not in known:
        msg = f"{what}: {unknown_name(word, known)}"
        raise CalibrationError(msg)
    return word


def existing_case(directory: Path) -> Path:
    """Return a directory that holds a case, else say how to make one."""
    if not directory.is_dir():
        msg = f"{directory}: no such directory; make a case with 'bulkcal generate ... --out DIR'"
        raise CalibrationError(msg)
    return directory


def named_directory(option: str, text: str) -> Path:
    """Return the directory that an option names, whether it is there or not.

    An empty name is refused: it would mean the current directory, which nobody asks for so.

    Raises
    ------
    CalibrationError
        If the name is empty or that of a file.
    """
    if not text.strip():
        msg = f"{option} '': is empty; name a directory"
        raise CalibrationError(msg)
    path = Path(text)
    try:
        taken = path.exists() and not path.is_dir()
    except OSError as err:
        msg = f"{option} {path}: cannot be used ({err.strerror}); name another directory"
        raise CalibrationError(msg) from err
    if taken:
        msg = f"{option} {path}: is a file; name a directory"
        raise CalibrationError(msg)
    return path


def new_file(option: str, path: Path) -> Path:
    """Return the path of a file that is not there yet.

    Raises
    ------
    CalibrationError
        If it is there: what somebody has made or measured is not written over.
    """
    if path.exists():
        msg = f"{option} {path}: exists already; name another file, or remove it"
        raise CalibrationError(msg)
    return path


def chosen_experiment(
    word: str, folder: str = "", place: str = "EXPERIMENT"
) -> tuple[str, OwnExperiment | None]:
    """Return the name of an experiment and, if a folder was named, what is in it.

    Parameters
    ----------
    word : str
        Name, or a folder with `experiment.toml`.
    folder : str
        Folder given with --experiment; empty if none was.
    place : str
        Where the word stands, for messages.

    Raises
    ------
    CalibrationError
        For an unknown name, or where neither or both were given.
    CaseError
        For mistakes in the folder.
    """
    if bool(word) == bool(folder):
        msg = (
            f"{place}: give a name ({names_of(EXPERIMENTS)}) or --experiment DIR, the folder of "
            "an experiment of your own"
        )
        raise CalibrationError(msg)
    path = Path(folder or word)
    if folder or (path / DEFINITION).is_file() or "/" in word:
        own = read_experiment(path)
        return own.name, own
    return one_of(place, word, EXPERIMENTS), None
