"""`bulkcal render`: pictures, films and pages of a case, or of somebody else's output."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from calibrate.cli.arguments import AsJson, FrameWord, Quiet, Verbose, new_file
from calibrate.cli.output.options import Diameter, DumpName, UnitsName
from calibrate.cli.plans.case import plan_of_run
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import StepBar, Waiting
from calibrate.errors import CalibrationError
from liggghts_io import CaseError, Look, load_result, load_spec
from liggghts_io.case.directory import RECORD
from liggghts_io.files import shell_word
from liggghts_io.pictures.camera import camera_named
from liggghts_io.pictures.colouring import checked_colour
from liggghts_io.pictures.style import check_replaced

if TYPE_CHECKING:
    from liggghts_io.pictures.reel import Reel

__all__ = ["render"]

VIEWS: Final = "side|front|top|iso"
COLOURS: Final = "speed|height|type|size"
_SCENE: Final = "scene.png"
_CHART: Final = "chart.png"
_VELOCITY: Final = frozenset(("vx", "vy", "vz"))


ViewName = Annotated[
    str, typer.Option("--view", metavar=VIEWS, help="From where the picture is taken.")
]
ColourName = Annotated[
    str,
    typer.Option(
        "--colour",
        "--color",
        metavar=COLOURS,
        help="What colours say; default: speed, or height where a dump has no velocities.",
    ),
]
PictureFile = Annotated[
    Path | None,
    typer.Option("--out", metavar="FILE.png", help="Picture to write; default: scene.png."),
]
MovieFile = Annotated[
    Path | None,
    typer.Option("--movie", metavar="FILE", help="All frames as a film, .mp4 or .gif."),
]
TurntableFile = Annotated[
    Path | None,
    typer.Option("--turntable", metavar="FILE", help="One frame from all around, as a film."),
]
PageFile = Annotated[
    Path | None,
    typer.Option("--html", metavar="FILE", help="A page with a scene to turn by the mouse."),
]
MeshFiles = Annotated[
    list[Path],
    typer.Option("--mesh", metavar="FILE.stl", help="Mesh around foreign dumps, repeatable."),
]


def render(
    directory: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="Case directory, or any folder or file of dumps."),
    ],
    frame: FrameWord = "best",
    view: ViewName = "side",
    colour: ColourName = "",
    out: PictureFile = None,
    movie: MovieFile = None,
    turntable: TurntableFile = None,
    page: PageFile = None,
    mesh: MeshFiles = [],  # noqa: B006 - typer copies it
    dump: DumpName = "",
    units: UnitsName = "",
    diameter: Diameter = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
    as_json: AsJson = False,
) -> None:
    """Draw the grains of a run with the meshes around them: a picture, a film, or a page.

    A case is drawn with what is measured on it, and a chart of its observables.

    Example: bulkcal render heap_steel --view iso --colour height

    Example: bulkcal render their_run --mesh hopper.stl --movie run.mp4
    """
    screen = Screen(quiet, verbose)
    if not directory.exists():
        msg = f"{directory}: no such directory; make a case with 'bulkcal generate ... --out DIR'"
        raise CalibrationError(msg)
    is_case = (directory / RECORD).exists()
    if verbose and is_case:
        screen.details(plan_of_run(directory, load_spec(directory).engine))
    _check_words(view, colour)
    usual = (directory if is_case else Path()) / _SCENE
    files = {"--out": out, "--html": page, "--movie": movie, "--turntable": turntable}
    _check_files(files, usual, is_case)
    with _opened(directory, is_case, screen, (dump, units, diameter, mesh)) as (reel, best_colour):
        look = Look(frame, view, colour or best_colour)
        drawn = _films(reel, look, movie, turntable, screen)
        if page is not None:
            drawn["page"] = _page(reel, look, page, screen)
        if out is not None or not drawn:
            drawn["picture"] = _picture(reel, look, out or usual, screen)
    if is_case and list(drawn) == ["picture"] and out is None and _is_measured(directory):
        drawn["chart"] = _chart(directory, screen)
    if as_json:
        screen.json({name: str(path) for name, path in drawn.items()})
        return
    for path in drawn.values():
        screen.result(f"wrote {path}")
    screen.hint(f"next: {_next(directory, drawn)}")


def _next(directory: Path, drawn: dict[str, Path]) -> str:
    """Return what follows a drawing."""
    if "page" in drawn:
        return f"open {shell_word(drawn['page'])} in a browser, and turn it by the mouse"
    return f"bulkcal render {shell_word(directory)} --html scene.html, to turn it by the mouse"


def _check_words(view: str, colour: str) -> None:
    """Refuse a view or colour that is not there."""
    camera_named(view)
    if colour:
        checked_colour(colour)


def _check_files(files: Mapping[str, Path | None], usual: Path, is_case: bool) -> None:
    """Refuse files that cannot be written; where none is named, those of a person that are there.

    Parameters
    ----------
    files : mapping
        By option.
    usual : Path
        The picture that is drawn where none is named; beside it, of a case, the chart.
    is_case : bool
    """
    for option, target in files.items():
        _check(option, target)
    if not any(files.values()):
        for path in [usual, usual.with_name(_CHART)] if is_case else [usual]:
            check_replaced(path, "--out", case=is_case)


def _check(option: str, target: Path | None) -> None:
    """Refuse a file nobody can write, before anything is drawn."""
    known = {"--out": (".png",), "--html": (".html",)}.get(option, (".mp4", ".gif"))
    if target is None:
        return
    if target.suffix not in known or target.is_dir():
        msg = f"{option} {target}: name a file that ends in {' or '.join(known)}"
        raise CalibrationError(msg)
    if not target.parent.is_dir():
        msg = f"{option} {target}: there is no directory {target.parent}; make it first"
        raise CalibrationError(msg)
    new_file(option, target)


@contextmanager
def _opened(
    directory: Path, is_case: bool, screen: Screen, foreign: tuple[Any, ...]
) -> Iterator[tuple[Reel, str]]:
    """Open the frames of a case or of foreign output, with what they are coloured by."""
    from liggghts_io.foreign import Grains, read_output
    from liggghts_io.pictures.reels import reel_of_output
    from liggghts_io.pictures.render import reel_in

    if is_case:
        if any(foreign):
            msg = f"{directory}: is a case; --dump, --units, --diameter and --mesh are for others"
            raise CalibrationError(msg)
        with reel_in(directory, screen.remark) as reel:
            yield reel, "speed"
        return
    dump, units, diameter, meshes = foreign
    with Waiting(screen.console, f"looking at {directory}"):
        output = read_output(directory, dump, units)
        reel = reel_of_output(output, Grains(diameter=diameter), meshes)
    for note in output.notes:
        screen.remark(note)
    yield reel, "speed" if set(output.dump.columns) >= _VELOCITY else "height"


def _films(
    reel: Reel, look: Look, movie: Path | None, turntable: Path | None, screen: Screen
) -> dict[str, Path]:
    """Write the films that are asked for."""
    from liggghts_io.pictures import film

    drawn: dict[str, Path] = {}
    asked: tuple[tuple[str, Path | None, Callable[..., Path]], ...] = (
        ("movie", movie, film.time_lapse),
        ("turntable", turntable, film.turntable),
    )
    for name, target, make in asked:
        if target is not None:
            film.checked_film(target)
            with StepBar(f"drawing the {name}", screen.console) as bar:
                drawn[name] = make(reel, target, look, bar)
    return drawn


def _page(reel: Reel, look: Look, target: Path, screen: Screen) -> Path:
    from liggghts_io.pictures.render import render_page

    with Waiting(screen.console, "drawing the page"):
        return render_page(reel, target, look)


def _picture(reel: Reel, look: Look, target: Path, screen: Screen) -> Path:
    from liggghts_io.pictures.render import render_reel

    with Waiting(screen.console, "drawing the grains"):
        return render_reel(reel, target, look)


def _chart(directory: Path, screen: Screen) -> Path:
    from liggghts_io import chart_case

    with Waiting(screen.console, "drawing the chart"):
        return chart_case(directory)


def _is_measured(directory: Path) -> bool:
    try:
        return load_result(directory).status == "ok"
    except CaseError:
        return False
